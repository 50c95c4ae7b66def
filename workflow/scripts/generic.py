"""Figure tables, ledger and verdicts computed for a plain 64-bit processor, held against those in git.

Numba makes code for the processor `generic`, without vector units beyond those that each has: other
instructions, so other roundings. Writes, for each column of numbers, the largest difference and how many
cells lie beyond their tolerance in workflow/resources/tolerances.csv; exit code 1 where any does. Verdicts
are held against those for the machine's own processor, see `generic_verdicts`.
"""

import argparse
import csv
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import generic_verdicts
import pandas as pd
from reproduce import REFERENCE, clean_copy

from sonicvacuum_paper.report import agreement

PROCESSOR = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
TARGETS = (*(f"figures/fig{k}.csv" for k in (3, 4, 5, 6)), "results/ledger.csv")
COLUMNS = ("table", "column", "cells", "largest_difference", "relative", "beyond_tolerance")


def rows(reference: pd.DataFrame, fresh: pd.DataFrame, name: str, tolerances: pd.DataFrame) -> list[dict]:
    """One row for each column of two versions of a table, which hold text."""
    beyond = agreement.differences(name, reference, fresh, tolerances)
    found = []
    for column in reference.columns:
        old, new = (pd.to_numeric(table[column], errors="coerce") for table in (reference, fresh))
        apart = (new - old).abs()
        if old.notna().any():
            largest, size = apart.max(), old.abs().max()
            count = sum(entry["column"] == column for entry in beyond)
            values = (
                name,
                column,
                int(old.notna().sum()),
                f"{largest:.3g}",
                f"{largest / size if size else 0.0:.3g}",
            )
            found.append(dict(zip(COLUMNS, (*values, count), strict=True)))
    words = [entry for entry in beyond if entry["column"] not in {row["column"] for row in found}]
    return [*found, dict(zip(COLUMNS, (name, "(words)", "", "", "", len(words)), strict=True))]


def compute(folder: Path, targets: list[str], cores: int) -> None:
    """Make some products for the plain processor in a clean copy of the project."""
    command = [sys.executable, "-m", "snakemake", "--cores", str(cores), "--quiet", "all", "--", *targets]
    environment = os.environ | PROCESSOR | {"PYTHONPATH": str(folder / "src")}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"the pipeline failed:\n{done.stdout[-4000:]}{done.stderr[-8000:]}")


def main() -> int:
    """The table; 1 where a cell lies beyond its tolerance."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--targets", nargs="*", choices=TARGETS, default=TARGETS)
    parser.add_argument("--verdicts", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--out", type=Path, required=True)
    asked, root = parser.parse_args(), Path.cwd()
    tolerances = agreement.read_tolerances(root / "workflow/resources/tolerances.csv")
    found = []
    with tempfile.TemporaryDirectory() as name:
        if asked.verdicts:
            found += generic_verdicts.rows(Path(name), PROCESSOR, COLUMNS)
        folder = clean_copy(root, Path(name) / "generic") if asked.targets else None
        if folder:
            compute(folder, asked.targets, asked.cores)
        for target in asked.targets:
            kept = root / REFERENCE / "ledger.csv" if "ledger" in target else root / target
            pair = (pd.read_csv(path, dtype=str, keep_default_na=False) for path in (kept, folder / target))
            found += rows(*pair, Path(target).stem, tolerances)
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    with open(asked.out, "w", newline="") as stream:
        table = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(found)
    beyond = sum(int(row["beyond_tolerance"]) for row in found)
    print(f"{sum(int(row['cells'] or 0) for row in found)} numbers, {beyond} cells beyond their tolerance")
    return int(beyond > 0)


if __name__ == "__main__":
    sys.exit(main())
