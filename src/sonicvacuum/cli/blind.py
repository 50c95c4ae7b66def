"""`sonicvacuum hide`, `score`: data with something hidden in them, and how well `discover` did on them."""

import re
from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.files import InputError

folder = click.Path(file_okay=False)


@click.command()
@click.option("--study", type=click.Choice(["small", "full", "training"]), help="A fixed list of cases.")
@click.option("--cases", "path", type=existing(), help="List of cases (CSV), instead of --study.")
@click.option(
    "--list", "listing", type=click.Path(dir_okay=False), help="Write the list of cases (CSV) only."
)
@click.option("--batch", default="0/1", show_default=True, help="k/n: every n-th case from the k-th on.")
@click.option("--records", "records_folder", type=folder, help="Folder for the records, one for each case.")
@click.option(
    "--truth", "truth_folder", type=folder, help="Folder for the truth; keep it away from discover."
)
def hide(study, path, listing, batch, records_folder, truth_folder):
    """Make records in which an effect is hidden, and keep the truth elsewhere."""
    from sonicvacuum.blind import study as studies

    if (study is None) == (path is None):
        raise InputError("hide: give --study or --cases, one of them")
    specs = studies.cases(study) if study else studies.read_cases(path)
    if listing:
        studies.write_cases(specs, listing)
        return
    if not (records_folder and truth_folder):
        raise InputError("hide: --records and --truth are both needed to make data (or --list to list cases)")
    from sonicvacuum.blind.hide import write

    for spec in studies.batch(specs, *batch_of(batch)):
        try:
            write(spec, records_folder, truth_folder)
        except ValueError as error:
            raise InputError(str(error)) from None
        click.echo(spec.id)


def batch_of(text: str) -> tuple[int, int]:
    """(k, n) of k/n; InputError where there is no such batch."""
    found = re.fullmatch(r"(\d+)/(\d+)", text)
    if not found or not int(found[1]) < int(found[2]):
        raise InputError(f"--batch: is {text!r}; write k/n with k from 0 to n - 1, such as 0/4")
    return int(found[1]), int(found[2])


@click.command()
@click.option(
    "--truth", required=True, type=click.Path(exists=True, file_okay=False), help="Folder of truths."
)
@click.option(
    "--verdicts", required=True, type=click.Path(exists=True, file_okay=False), help="Folder of verdicts."
)
@click.option(
    "--out", required=True, type=click.Path(dir_okay=False), help="Score of each case (CSV) to write."
)
@click.option("--summary", required=True, type=click.Path(dir_okay=False), help="Table (CSV) to write.")
@click.option(
    "--tables",
    type=folder,
    help="Folder for the tables in detail: confusion, accuracy, reliability, coverage, seconds (CSV).",
)
def score(truth, verdicts, out, summary, tables):
    """Compare verdicts with the truth: one row for each case, and a table with 95 % intervals."""
    from sonicvacuum.blind import breakdown
    from sonicvacuum.blind import score as scoring
    from sonicvacuum.blind.summary import summary as summarise

    rows = scoring.score(truth, verdicts)
    lines = summarise(rows)
    scoring.write_table(rows, scoring.Row, out)
    scoring.write_table(lines, scoring.Line, summary)
    if tables:
        for name, (kind, table) in breakdown.TABLES.items():
            scoring.write_table(table(rows), kind, Path(tables) / f"{name}.csv")
    for line in lines:
        if line.count:
            interval = f"{line.value:.3f} [{line.low:.3f}, {line.high:.3f}]"
            click.echo(f"{line.measure}, {line.group}: {interval} of {line.count}  {line.goal}")
