"""`sonicvacuum design`: where to put how many gauges, and which runs to make, to tell effects apart."""

import json

import click

from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.cli.predict import chain_options


@verb(
    "sonicvacuum design --effects sensor-droop,kuwabara-kono --beads 12 --diameter 5mm "
    "--material bearing-steel --speed 0.5",
    short_help="Where to put gauges, and which runs tell effects apart.",
)
@click.option("--effects", required=True, metavar="A,B", help="To tell apart; ids: sonicvacuum effects.")
@chain_options
@click.option("--most", type=int, default=3, show_default=True, help="Largest number of gauges.")
@click.option("--strength", type=float, default=0.3, show_default=True, help="In typical deviations.")
@click.option("--noise", type=float, default=0.01, show_default=True, help="Of a sample, over the peak.")
@click.option("--echo/--no-echo", default=True, help="Whether the wall's reflection is recorded as well.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("--out", type=WRITTEN, help="Picture (.svg, .png, .pdf) to write as well.")
def design(as_json, out, **given):
    """Say where to put gauges and which runs to make, so that effects can be told apart, and from none."""
    if out:
        from sonicvacuum.figures.prediction import check_name

        check_name(out)
    from sonicvacuum.prediction.design import design as designed
    from sonicvacuum.prediction.design_text import content, text

    found = designed(**given)
    if out:
        from sonicvacuum.figures.design import write

        write(found, out)
    click.echo(json.dumps(content(found), indent=1, allow_nan=False) if as_json else text(found))
