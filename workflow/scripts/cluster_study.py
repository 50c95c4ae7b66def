"""The full blind study on a Slurm of one node, or the first records of it, held against a local run.

One number says how many records: 2034 is the study as `make study` makes it, in 24 batches; for fewer the
study is cut into smaller batches, of which the first are made. Records, truths, verdicts and scores must be
the same to the byte, times excepted.
"""

import csv
import math
from pathlib import Path

from crash import Run, project
from one_node import Slurm
from reproduce import equal

RECORDS, BATCHES = 2034, 24
TARGET = "results/blind/full/score.csv"
COLUMNS = (
    "records",
    "batches",
    "exit",
    "same_bytes",
    "slurm_jobs",
    "in_jobs_s",
    "cpu_s_per_record",
    "cpu_h_all",
)


def size(records: int) -> tuple[str, ...]:
    """Options of Snakemake for so many records, two jobs at least."""
    batch = min(math.ceil(RECORDS / BATCHES), math.ceil(records / 2))
    parts = {"full_batches": math.ceil(RECORDS / batch), "full_taken": math.ceil(records / batch)}
    # The last option ends the list of the first, so that the target is not taken for one of it.
    return ("--config", *(f"{key}={value}" for key, value in parts.items()), "--nocolor")


def untimed(path: Path) -> list[dict]:
    """Rows of a table of the study without the times in it."""
    with open(path, newline="", encoding="utf-8") as stream:
        rows = [{k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(stream)]
    return [row for row in rows if row.get("measure") != "seconds per record"]


def unequal(one: Path, other: Path) -> list[str]:
    """Files of the study that are missing on one side or differ in more than times."""
    studies = [folder / "results/blind/full" for folder in (one, other)]
    mine, yours = (
        {p.relative_to(s).as_posix() for p in s.rglob("*") if p.is_file() and p.name != "seconds.csv"}
        for s in studies
    )
    differ = {
        p
        for p in mine & yours
        if (
            untimed(studies[0] / p) != untimed(studies[1] / p)
            if "/" not in p
            else not equal(studies[0] / p, studies[1] / p)
        )
    }
    return sorted(differ | (mine ^ yours))


def processor_s(folder: Path) -> float:
    """Seconds of one core that the verdicts of a run took, by its benchmark files."""
    tables = (folder / "results/benchmarks/discover_hidden").glob("*.tsv")
    return sum(float(next(csv.DictReader(path.open(), delimiter="\t"))["cpu_time"]) for path in tables)


def row(slurm: Slurm, place: Path, records: int, options: tuple[str, ...], finished) -> dict:
    """One row of `COLUMNS`; the run on Slurm in a folder of its own beside the local one.

    Args:
        slurm: at work.
        place: folder that both runs are made in.
        records: how many.
        options: of Snakemake, to run on this Slurm.
        finished: call, job of this Slurm that has ended → seconds that it took.
    """
    local = Run(project(place / "study-local"), TARGET, *size(records))
    if local.end():
        raise SystemExit(f"the local run failed:\n{local.log.read_text()[-4000:]}")
    before = finished(slurm)
    run = Run(project(place / "study"), TARGET, *options, *size(records), environment=slurm.environment)
    code = run.end()
    if code:
        print(run.log.read_text()[-4000:])
    different = unequal(place / "study-local", place / "study")
    print("".join(f"  differs: {path}\n" for path in different), end="")
    took = [seconds for number, seconds in finished(slurm).items() if number not in before]
    made = len(untimed(place / "study-local" / TARGET))
    each = processor_s(place / "study-local") / made
    batches = len(list((place / "study-local/results/blind/full/verdicts").iterdir()))
    values = (made, batches, code, not different, len(took), sum(took), round(each, 1))
    return dict(zip(COLUMNS, (*values, round(each * RECORDS / 3600.0, 2)), strict=True))
