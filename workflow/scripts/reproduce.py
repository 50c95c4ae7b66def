"""The reproducibility check: the whole pipeline in two clean folders, compared with each other and with git.

One folder is made with two cores, the other with one; every product must be the same to the byte. Figure
tables and ledger are then compared with the committed ones, column by column, within the tolerances of
workflow/resources/tolerances.csv; what the small blind study named must be what is committed, case by case.
Exit code 1 and a table of differences when something differs.

The blind study is made once, with two cores, and taken over into the other folder: it takes longer than all
the rest together, its jobs use one thread each however many cores there are, and what it named is held
against git besides.
"""

import argparse
import filecmp
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd

from sonicvacuum_paper.report import agreement
from sonicvacuum_paper.report.publish import naming

PARTS = ("Snakefile", "config.yaml", "workflow", "src", "requirements.lock", "requirements-build.lock")
# Times, by their nature different in every run.
UNLIKE = ("results/logs", "results/benchmarks", "results/benchmarks.csv", ".snakemake")
# Says the digests of verdicts, which hold such times.
PROVENANCE = "provenance.json"
STUDY = "results/blind"
REFERENCE = "workflow/resources/reference"


def clean_copy(root: Path, target: Path) -> Path:
    """The parts of the project that the pipeline reads, and nothing that it wrote."""
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    for part in PARTS:
        source = root / part
        if source.is_dir():
            shutil.copytree(source, target / part, ignore=shutil.ignore_patterns("__pycache__", "*.pyc"))
        else:
            shutil.copy2(source, target / part)
    return target


def run(folder: Path, cores: int) -> None:
    """The default target of the workflow in a folder."""
    print(f"running the pipeline in {folder.name} with --cores {cores}", flush=True)
    command = [sys.executable, "-m", "snakemake", "--cores", str(cores), "--quiet", "all", "--nocolor"]
    # The folder's own copy of the source, whatever becomes of the original meanwhile.
    environment = os.environ | {"PYTHONPATH": str(folder / "src")}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"the pipeline failed in {folder}:\n{done.stdout[-4000:]}{done.stderr[-8000:]}")


def products(folder: Path) -> set[str]:
    """Relative paths of all that the pipeline wrote, times and the study excepted."""
    paths = (
        p.relative_to(folder).as_posix() for top in ("results", "figures") for p in (folder / top).rglob("*")
    )
    made = {p for p in paths if (folder / p).is_file() and not p.startswith((*UNLIKE, STUDY))}
    return {p for p in made if not p.endswith(PROVENANCE)}


def unequal(one: Path, other: Path) -> list[str]:
    """Products that are missing on one side or differ in a byte."""
    mine, yours = products(one), products(other)
    differ = {p for p in mine & yours if not equal(one / p, other / p)}
    return sorted(differ | (mine ^ yours))


def equal(one: Path, other: Path) -> bool:
    """Same bytes; in a verdict, same content but for the time it took."""
    if one.name != "verdict.json":
        return filecmp.cmp(one, other, shallow=False)
    verdicts = [json.loads(path.read_text(encoding="utf-8")) for path in (one, other)]
    return len({json.dumps({**v, "timing_s": None}, sort_keys=True) for v in verdicts}) == 1


def against_git(root: Path, fresh: Path) -> list[dict]:
    """Differences of the figure tables and the ledger from the committed ones."""
    tolerances = agreement.read_tolerances(root / "workflow/resources/tolerances.csv")
    pairs = [(path, fresh / "figures" / path.name) for path in sorted(root.glob("figures/fig[0-9].csv"))]
    pairs.append((root / REFERENCE / "ledger.csv", fresh / "results/ledger.csv"))
    found = []
    for reference, made in pairs:
        tables = (pd.read_csv(path, dtype=str, keep_default_na=False) for path in (reference, made))
        found += agreement.differences(reference.stem, *tables, tolerances)
    study = (
        naming(path) for path in (root / REFERENCE / "blind_small.csv", fresh / STUDY / "small/score.csv")
    )
    return found + agreement.differences("blind_small", *study, tolerances)


def main() -> int:
    """Run and compare; 0 when everything agrees."""
    root = Path.cwd()
    first, second = (
        clean_copy(root, root / "results/reproduce" / name) for name in ("two-cores", "one-core")
    )
    run(first, 2)
    # With the times of its files, so that the workflow takes it as made.
    shutil.copytree(first / STUDY, second / STUDY)
    run(second, 1)
    folders = (first, second)
    different = unequal(*folders)
    print(
        f"--cores 2 against --cores 1: {len(products(folders[0]))} files, {len(different)} differ", flush=True
    )
    print("".join(f"  {path}\n" for path in different), end="")
    found = against_git(root, folders[0])
    print(f"against the committed tables: {len(found)} cells differ beyond their tolerance")
    if found:
        print(agreement.readable(found))
        print(
            "If the change is meant: make, then .venv/bin/snakemake --cores 1 publish, and commit the tables."
        )
    return 1 if different or found else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.parse_args()
    sys.exit(main())
