"""`sonicvacuum report`, `publish`, `timings`: the page, what of it is kept in git, and how long it took."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.card import read_card
from sonicvacuum.files import InputError, replacing

_FILE = existing()
_FOLDER = click.Path(exists=True, file_okay=False)


@click.command()
@click.option("--ledger", required=True, type=_FILE)
@click.option("--assumptions", required=True, type=_FILE)
@click.option("--metrics", required=True, type=_FILE)
@click.option("--claims", required=True, type=_FILE)
@click.option("--figure", "figures", multiple=True, type=_FILE, help="SVG of a figure; repeat.")
@click.option("--card", "cards", multiple=True, type=_FILE, help="Resolved card; repeat.")
@click.option("--lock", "locks", multiple=True, type=_FILE, help="Lock file of the environment; repeat.")
@click.option(
    "--discovery",
    "discoveries",
    multiple=True,
    type=_FOLDER,
    help="Folder that discover wrote; repeat.",
)
@click.option("--blind-small", type=_FILE, help="Summary of the small blind study.")
@click.option("--blind-full", type=_FOLDER, help="Folder of the full one's tables.")
@click.option("--picture", "pictures", multiple=True, type=_FILE, help="SVG of the full study; repeat.")
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="Page (HTML) to write.")
def report(
    ledger,
    assumptions,
    metrics,
    claims,
    figures,
    cards,
    locks,
    discoveries,
    blind_small,
    blind_full,
    pictures,
    out,
):
    """Write the self-contained page with figures, ledger, audit, discoveries and provenance."""
    from sonicvacuum.figures import caption, study_caption
    from sonicvacuum.report.page import build

    captioned = [(figure, caption(Path(figure).stem)) for figure in figures]
    read = [read_card(card) for card in cards]
    tables = (ledger, assumptions, metrics, claims)
    seen = [(picture, study_caption(Path(picture).stem)) for picture in pictures]
    text = build(*tables, captioned, read, locks, discoveries, blind_small, blind_full, seen)
    with replacing(out) as stream:
        stream.write(text)


@click.command()
@click.option("--ledger", required=True, type=_FILE)
@click.option("--claims", required=True, type=_FILE, help="Table of the paper's claims.")
@click.option("--readme", required=True, type=_FILE, help="README whose result table is renewed.")
@click.option(
    "--guide", required=True, type=click.Path(dir_okay=False), help="Guide to the figures (Markdown)."
)
@click.option(
    "--reference", required=True, type=click.Path(dir_okay=False), help="Where the ledger is kept in git."
)
@click.option("--benchmark", type=_FILE, help="Table of the benchmark (Markdown), where one was made.")
@click.option("--study", type=_FILE, help="Scores of the small blind study.")
@click.option("--naming", type=click.Path(dir_okay=False), help="Where its naming is kept in git.")
def publish(ledger, claims, readme, guide, reference, benchmark, study, naming):
    """Keep the ledger as the reference of later checks; renew the README's table and the figures' guide."""
    from sonicvacuum import figures
    from sonicvacuum.report import publish as keep

    if (study is None) != (naming is None):
        raise InputError("publish: --study and --naming go together: give both, or neither")
    keep.publish(ledger, readme, reference, benchmark)
    if study:
        keep.publish_study(study, naming)
    with replacing(guide) as stream:
        stream.write(figures.readme(claims))


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False))
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="Summary (CSV) to write.")
def timings(folder, out):
    """Summarise the benchmark files of the workflow in FOLDER."""
    from sonicvacuum.report.timings import write

    write(folder, out)
