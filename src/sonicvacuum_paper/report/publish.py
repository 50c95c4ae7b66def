"""What of the results is kept in git: references for later checks, and a summary in the README."""

import re

import pandas as pd

from sonicvacuum.files import InputError, read_text, replacing
from sonicvacuum_paper.report import tables

BEGIN = "<!-- {}: made by `snakemake publish`, do not edit -->"
END = "<!-- end of {} -->"
# The rows of the ledger that a reader looks for first.
HEADLINES = (
    "fig3a-speed",
    "fig3b-speed",
    "fig3a-width",
    "fig3b-width",
    "low-speed",
    "modulus-ratio",
)
# Of a blind study, what must come out again; times and estimates are left out.
NAMING = ("id", "kind", "effects", "named", "exact")


def summary(ledger: pd.DataFrame) -> str:
    """Markdown: how many claims hold, the main numbers, and every disagreement in a line."""
    counts = tables.counts(ledger)
    lines = [
        f"Of {len(ledger)} checkable statements of the paper, **{counts['reproduced']} are reproduced, "
        f"{counts['disagrees']} disagree, {counts['not testable']} cannot be tested** by this simulation.",
        "",
        "| claim | quantity | paper | σ | handbook 2.76 GPa | matched 15 GPa | as discovered | verdict |",
        "|---|---|---:|---:|---:|---:|---:|---|",
    ]
    known = ledger.set_index("claim")
    for claim in HEADLINES:
        if claim in known.index:
            lines.append(_row(claim, known.loc[claim]))
    lines += ["", "Where paper and simulation disagree, largest difference first:", ""]
    lines += [
        f"* `{row.claim}`: {tables.shown(row.reason)}" for row in tables.disagreements(ledger).itertuples()
    ]
    return "\n".join(lines)


def _row(claim, row):
    unit = "" if row["unit"] in ("", "1") else f", {row['unit']}"
    numbers = [tables.number(row[c]) for c in ("measured", "sigma", "handbook", "matched", "named")]
    return f"| {claim} | {row['quantity']}{unit} | " + " | ".join(numbers) + f" | {row['verdict']} |"


def with_part(readme: str, name: str, text: str) -> str:
    """The README with the text between the two markers of a part replaced.

    Raises:
        InputError: where the markers are missing.
    """
    begin, end = BEGIN.format(name), END.format(name)
    if begin not in readme or end not in readme:
        raise InputError(f"README.md: the markers are missing; put {begin} and {end} around its {name}")
    pattern = re.compile(re.escape(begin) + ".*?" + re.escape(end), re.DOTALL)
    return pattern.sub(lambda _: f"{begin}\n{text.strip()}\n{end}", readme)


def naming(score_path) -> pd.DataFrame:
    """What a blind study named, case by case: the columns `NAMING` of a table of `sonicvacuum blind score`.

    Raises:
        InputError: where a column is missing.
    """
    table = pd.read_csv(score_path, dtype=str, keep_default_na=False)
    missing = [column for column in NAMING if column not in table]
    if missing:
        raise InputError(f"{score_path}: no column {missing[0]}; make the table with sonicvacuum blind score")
    return table[list(NAMING)]


def publish_study(score_path, reference_path) -> None:
    """Keep what the small blind study named, so that a later run can be held against it."""
    with replacing(reference_path) as stream:
        naming(score_path).to_csv(stream, index=False, lineterminator="\n")


def publish(ledger_path, readme_path, reference_path, benchmark_path=None) -> None:
    """Copy the ledger to its place in git; renew the README's summary, and its benchmark if one is given."""
    ledger = tables.read(ledger_path, tables.LEDGER)
    renewed = with_part(read_text(readme_path), "results", summary(ledger))
    if benchmark_path is not None:
        renewed = with_part(renewed, "benchmark", read_text(benchmark_path))
    with replacing(reference_path) as stream:
        stream.write(read_text(ledger_path))
    with replacing(readme_path) as stream:
        stream.write(renewed)
