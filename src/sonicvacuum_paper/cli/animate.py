"""`sonicvacuum paper animate`: a wave that moves."""

import click

from sonicvacuum.cli.helped import examples
from sonicvacuum.files import replacing


@click.command(
    epilog=examples(
        "sonicvacuum paper animate solitary --out solitary.svg",
    )
)
@click.argument("name")
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="Moving picture (SVG) to write.")
def animate(name, out):
    """Write the moving picture NAME (solitary or train)."""
    from sonicvacuum_paper.report.animation import animation

    text = animation(name)
    with replacing(out) as stream:
        stream.write(text)
