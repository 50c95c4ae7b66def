"""What of the results is kept in git: the ledger as a reference, and its summary in the README."""

import re

import pandas as pd

from sonicvacuum.files import InputError, read_text, replacing
from sonicvacuum.report import tables

BEGIN = "<!-- results: made by `snakemake publish`, do not edit -->"
END = "<!-- end of results -->"
# The rows of the ledger that a reader looks for first.
HEADLINES = (
    "fig3a-speed",
    "fig3b-speed",
    "fig3a-width",
    "fig3b-width",
    "low-speed",
    "modulus-ratio",
)


def summary(ledger: pd.DataFrame) -> str:
    """Markdown: how many claims hold, the main numbers, and every disagreement in a line."""
    counts = tables.counts(ledger)
    lines = [
        f"Of {len(ledger)} checkable statements of the paper, **{counts['reproduced']} are reproduced, "
        f"{counts['disagrees']} disagree, {counts['not testable']} cannot be tested** by this simulation.",
        "",
        "| claim | quantity | paper | σ | handbook 2.76 GPa | matched 15 GPa | verdict |",
        "|---|---|---:|---:|---:|---:|---|",
    ]
    known = ledger.set_index("claim")
    for claim in HEADLINES:
        if claim in known.index:
            lines.append(_row(claim, known.loc[claim]))
    lines += ["", "Where paper and simulation disagree, largest difference first:", ""]
    lines += [f"* `{row.claim}`: {row.reason}" for row in tables.disagreements(ledger).itertuples()]
    return "\n".join(lines)


def _row(claim, row):
    unit = "" if row["unit"] in ("", "1") else f", {row['unit']}"
    numbers = [tables.number(row[c]) for c in ("measured", "sigma", "handbook", "matched")]
    return f"| {claim} | {row['quantity']}{unit} | " + " | ".join(numbers) + f" | {row['verdict']} |"


def with_summary(readme: str, text: str) -> str:
    """The README with the text between its two markers replaced.

    Raises:
        InputError: where the markers are missing.
    """
    if BEGIN not in readme or END not in readme:
        raise InputError(f"README.md: the markers are missing; put {BEGIN} and {END} around the result table")
    pattern = re.compile(re.escape(BEGIN) + ".*?" + re.escape(END), re.DOTALL)
    return pattern.sub(lambda _: f"{BEGIN}\n{text}\n{END}", readme)


def publish(ledger_path, readme_path, reference_path) -> None:
    """Copy the ledger to its place in git and renew the README's summary."""
    ledger = tables.read(ledger_path, tables.LEDGER)
    renewed = with_summary(read_text(readme_path), summary(ledger))
    with replacing(reference_path) as stream:
        stream.write(read_text(ledger_path))
    with replacing(readme_path) as stream:
        stream.write(renewed)
