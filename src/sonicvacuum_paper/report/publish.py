"""What of the results is kept in git: references for later checks, and a summary in the README."""

import re

import pandas as pd

from sonicvacuum.files import InputError, read_text, reading, replacing
from sonicvacuum.report.inline import typeset
from sonicvacuum_paper import ladder
from sonicvacuum_paper.report import tables

BEGIN = "<!-- {}: made by `snakemake publish`, do not edit -->"
END = "<!-- end of {} -->"
# Parts of a model's total, and what they are called.
PARTS = (
    ("agrees", "agrees"),
    ("fitted", "fitted to it"),
    ("excluded", "excluded by"),
    ("outside", "outside it, or not simulated"),
)
# What must come out again of a blind study; times and estimates are left out.
NAMING = ("id", "kind", "effects", "named", "exact")


def summary(ledger: pd.DataFrame) -> str:
    """Markdown: how many claims hold, the main numbers under each model, totals, and every disagreement."""
    models = [c for c in ladder.COLUMNS if ladder.MODELS[c].counted]
    lines = [
        tables.headline(ledger),
        "",
        "| printed | " + " | ".join(ladder.title(c) for c in models) + " |",
        "|---|" + "---:|" * len(models),
    ]
    lines += [
        f"| {' | '.join(map(_cell, (row['printed'], *row['cells'])))} |" for row in tables.first(ledger)
    ]
    totals = {t.model: t for t in ladder.totals(ledger.to_dict("records"))}
    for part, name in PARTS:
        cells = [str(getattr(totals[c], part)) if c in totals else "–" for c in models]
        lines.append(f"| *statements: {name}* | " + " | ".join(cells) + " |")
    lines.append("| *free parameters* | " + " | ".join(ladder.MODELS[c].free for c in models) + " |")
    lines += ["", "Where paper and layer disagree, largest difference first:", ""]
    lines += [
        f"* `{_safe(row.claim)}`: {_cell(row.reason)}" for row in tables.disagreements(ledger).itertuples()
    ]
    return "\n".join(lines)


def _cell(text):
    """A text of a table as one cell or line of Markdown, set as the report sets it."""
    return _safe(typeset(text))


def _safe(text):
    """A text in which nothing is a tag or a border of Markdown."""
    return re.sub(r"<(?=[A-Za-z/!?])", "&lt;", " ".join(text.split()).replace("|", "\\|"))


def with_part(readme: str, name: str, text: str, path="README.md") -> str:
    """A page, the README or one of docs/, with the text between the two markers of a part replaced.

    Raises:
        InputError: where the markers are missing.
    """
    begin, end = BEGIN.format(name), END.format(name)
    if begin not in readme or end not in readme:
        raise InputError(f"{path}: the markers are missing; put {begin} and {end} around its {name}")
    pattern = re.compile(re.escape(begin) + ".*?" + re.escape(end), re.DOTALL)
    return pattern.sub(lambda _: f"{begin}\n{text.strip()}\n{end}", readme)


def naming(score_path) -> pd.DataFrame:
    """What a blind study named, case by case: the columns `NAMING` of a table of `sonicvacuum blind score`.

    Raises:
        InputError: where a column is missing.
    """
    with reading(score_path, "make the table with sonicvacuum blind score"):
        table = pd.read_csv(score_path, dtype=str, keep_default_na=False)
    missing = [column for column in NAMING if column not in table]
    if missing:
        raise InputError(f"{score_path}: no column {missing[0]}; make the table with sonicvacuum blind score")
    return table[list(NAMING)]


def publish_study(score_path, reference_path) -> None:
    """Keep what the small blind study named, so that a later run can be held against it."""
    with replacing(reference_path) as stream:
        naming(score_path).to_csv(stream, index=False, lineterminator="\n")


def publish_benchmark(benchmark_path, page_path) -> None:
    """Renew the table of the page on speed; InputError where the page lacks the markers."""
    renewed = with_part(read_text(page_path), "benchmark", read_text(benchmark_path), page_path)
    with replacing(page_path) as stream:
        stream.write(renewed)


def publish(ledger_path, readme_path, reference_path) -> None:
    """Copy the ledger to its place in git and renew the README's summary."""
    ledger = tables.read_ledger(ledger_path)
    renewed = with_part(read_text(readme_path), "results", summary(ledger))
    with replacing(reference_path) as stream:
        stream.write(read_text(ledger_path))
    with replacing(readme_path) as stream:
        stream.write(renewed)
