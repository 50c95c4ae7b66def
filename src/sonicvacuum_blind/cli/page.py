"""`sonicvacuum blind page`: both studies on a page of their own."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import PRESENT, WRITTEN, verb
from sonicvacuum.files import replacing
from sonicvacuum.outputs import check_apart


@verb("sonicvacuum blind page --small results/blind/small/summary.csv --out blind.html")
@click.option("--small", type=existing(), help="Summary of the small study.")
@click.option("--full", type=PRESENT, help="Folder of the full one's tables.")
@click.option("--picture", "pictures", multiple=True, type=existing(), help="SVG of the full study; repeat.")
@click.option("--out", required=True, type=WRITTEN, help="Page (HTML) to write.")
def page(small, full, pictures, out):
    """Write the page of the blind studies."""
    check_apart([out], [small, full, *pictures])
    from sonicvacuum_blind import kept
    from sonicvacuum_blind.page import build

    seen = [(picture, kept.caption(Path(picture).stem)) for picture in pictures]
    text = build(small, full, seen)
    with replacing(out) as stream:
        stream.write(text)
