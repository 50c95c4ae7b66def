"""`sonicvacuum record import`: from the files of an oscilloscope or logger to a record of measured data."""

import json
import sys

import click

from sonicvacuum.cli.helped import FOLDER, verb
from sonicvacuum.files import in_one_line


@verb(
    "sonicvacuum record import *.csv --list",
    "sonicvacuum record import *.csv --record chain.yaml --channel CH1=g5 --scale g5=25N/V --out rec",
    name="import",
    short_help="Make a record of a recorder's files as they are.",
)
@click.argument("files", nargs=-1, type=click.Path())
@click.option("--list", "listed", is_flag=True, help="Only say what is in FILES.")
@click.option("--json", "as_json", is_flag=True, help="With --list: as JSON.")
@click.option("--out", type=FOLDER, help="Folder to write record.yaml and CSV files into.")
@click.option("--run", multiple=True, metavar="RUN=FILE,…", help="These files are one run of this name.")
@click.option(
    "--channel",
    multiple=True,
    metavar="CH=GAUGE",
    help="A channel (or FILE:CH) reads this gauge; others are left out. Several of one gauge are shots.",
)
@click.option(
    "--scale", multiple=True, metavar="GAUGE=12.5N/V", help="Sensitivity, also -12.5N/V, 80mV/N, 12.5N/V±2%."
)
@click.option("--place", multiple=True, metavar="GAUGE=BEAD", help="Bead that holds a gauge, or wall.")
@click.option("--speed", multiple=True, metavar="[RUN=]M/S", help="Speed of the striker, as in 0.44±2%.")
@click.option(
    "--impact-at",
    multiple=True,
    metavar="[RUN=]TIME",
    help="Moment of impact on the recorder's clock, as in 12us.",
)
@click.option("--interval", metavar="TIME", help="Time between samples; it overrules what files say.")
@click.option("--start", metavar="TIME", help="Time of the first sample; it overrules what files say.")
@click.option("--keep-all", is_flag=True, help="Neither trim nor thin.")
@click.option("--like", type=click.Path(), help="Record with the same chain, gauges and striker.")
@click.option(
    "--record", "template", type=click.Path(), help="YAML file with keys of a record; may be incomplete."
)
@click.option("--title", help="Title of the record.")
@click.option("--force", is_flag=True, help="Overwrite a record that is there already.")
def import_(files, listed, as_json, out, like, template, title, force, **given):
    """Make a record of FILES as the recorder wrote them: text of any layout, .wfm, .trc, .isf, .tdms, .lvm,
    .mat.

    The pulse is found, the baseline removed, what lies far off cut away, what is sampled too finely thinned,
    the noise estimated; record.yaml says what was done and what is still to be filled in.
    """
    if not files and (listed or not given["run"]):
        raise click.UsageError("name the recorder's FILES, or give them by --run RUN=FILE,…")
    if listed:
        _list(files, as_json)
        return
    if as_json or out is None:
        raise click.UsageError("give --out FOLDER to import FILES, or --list [--json] to see what is in them")
    from sonicvacuum.scope import importing
    from sonicvacuum.scope.options import options

    chosen = options(**given)
    done = importing.import_files(files, out, chosen, like=like, record=template, title=title, force=force)
    click.echo("\n".join(map(in_one_line, done)))


def _list(files, as_json):
    """Print what is in files; exit code 2 where one was refused, which is told once, as an error."""
    from sonicvacuum.scope import listing

    entries = listing.listing(files)
    if as_json:
        click.echo(json.dumps(entries, indent=1, ensure_ascii=False))
    elif sound := [e for e in entries if "refused" not in e]:
        click.echo(listing.text(sound))
    refused = [e["refused"] for e in entries if "refused" in e]
    for reason in refused:
        click.echo(f"Error: {in_one_line(reason)}", err=True)
    if refused:
        sys.exit(2)
