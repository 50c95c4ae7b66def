"""`sonicvacuum paper animate`: a wave that moves."""

import click

from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.files import replacing


@verb("sonicvacuum paper animate solitary --out solitary.svg")
@click.argument("name")
@click.option("--out", required=True, type=WRITTEN, help="Moving picture (SVG) to write.")
def animate(name, out):
    """Write the moving picture NAME (solitary or train)."""
    from sonicvacuum_paper.report.animation import animation

    text = animation(name)
    with replacing(out) as stream:
        stream.write(text)
