"""The full blind study on a Slurm of one node, or the first records of it, held against a local run.

Two numbers say how much: records made on Slurm, and how many of these are made locally too. All of them are
the study as `make study` makes it, in its batches; for fewer the study is cut into smaller batches, of which
the first are made. Records, truths, verdicts and scores must be the same to the byte, times excepted. Both
runs stand in folders that are kept where one is named: a further start goes on in them.
"""

import csv
import json
import math
import shutil
from functools import cache
from pathlib import Path

from crash import Run, project
from one_node import Slurm
from reproduce import equal

from sonicvacuum_blind import study

# As in workflow/rules/blind_common.smk.
BATCHES = 100
STUDY = "results/blind/full"
TARGET = f"{STUDY}/score.csv"
COLUMNS = (
    "records",
    "batches",
    "exit",
    "compared",
    "same_bytes",
    "slurm_jobs",
    "in_jobs_s",
    "cpu_s_per_record",
    "cpu_h_all",
)


@cache
def whole() -> int:
    """Records of the full study."""
    return len(study.cases("full"))


def size(records: int, made: int) -> tuple[str, ...]:
    """Options of Snakemake for the batches that hold the first `made` records of a study of `records`.

    A batch is one of the full study's, or half of the records if that is less.
    """
    batches = max(BATCHES, math.ceil(whole() / math.ceil(records / 2)))
    parts = {"full_batches": batches, "full_taken": -(-made * batches // whole())}
    # The last option ends the list of the first, so that the target is not taken for one of it.
    return ("--config", *(f"{key}={value}" for key, value in parts.items()), "--nocolor")


def untimed(path: Path) -> list[dict]:
    """Rows of a table of the study without the times in it."""
    with open(path, newline="", encoding="utf-8") as stream:
        rows = [{k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(stream)]
    return [row for row in rows if row.get("measure") != "seconds per record"]


def unequal(all_of_it: Path, part: Path) -> list[str]:
    """Files that one folder holds of the study's batches in another, missing or different in more than times.

    Tables over all records are compared where both folders hold the same batches; of the scores, those of
    the records that both hold.
    """
    ours, theirs = (folder / STUDY for folder in (all_of_it, part))
    batches = {path.name for path in (theirs / "records").iterdir()}
    mine, yours = (
        {
            path.relative_to(s)
            for kind in s.iterdir()
            if kind.is_dir()
            for path in kind.rglob("*")
            if path.is_file()
        }
        for s in (ours, theirs)
    )
    mine = {path for path in mine if path.parts[1] in batches}
    differ = (mine ^ yours) | {path for path in mine & yours if not equal(ours / path, theirs / path)}
    if batches == {path.name for path in (ours / "records").iterdir()}:
        tables = {p.name for s in (ours, theirs) for p in s.glob("*.csv")} - {"seconds.csv"}
        differ |= {Path(name) for name in tables if untimed(ours / name) != untimed(theirs / name)}
    elif not all(row in untimed(ours / "score.csv") for row in untimed(theirs / "score.csv")):
        differ.add(Path("score.csv"))
    return sorted(map(str, differ))


def processor_s(folder: Path) -> float:
    """Seconds of one core that the verdicts of a run took, by its benchmark files."""
    tables = (folder / "results/benchmarks/discover_hidden").glob("*.tsv")
    return sum(float(next(csv.DictReader(path.open(), delimiter="\t"))["cpu_time"]) for path in tables)


def kept(folder: Path) -> Path:
    """The folder of a run: made at its first start, and as it was left at each further one."""
    if not folder.exists():
        partial = folder.with_name(f".{folder.name}.partial")
        shutil.rmtree(partial, ignore_errors=True)
        project(partial).rename(folder)
    return folder


def ended(slurm: Slurm, place: Path, before, finished) -> dict[str, float]:
    """Jobs of this and of earlier starts in a folder → seconds each took; written beside the runs."""
    path = place / "jobs.json"
    earlier = json.loads(path.read_text()) if path.exists() else {}
    # Numbers of jobs begin anew with each Slurm.
    new = {f"{len(earlier)}+{n}": took for n, took in finished(slurm).items() if n not in before}
    path.write_text(json.dumps(earlier | new, indent=1))
    return earlier | new


def row(slurm: Slurm, place: Path, records: int, local: int, options: tuple[str, ...], finished) -> dict:
    """One row of `COLUMNS`; the run on Slurm in a folder of its own beside the local one.

    Args:
        slurm: at work.
        place: folder that both runs are made in.
        records: how many.
        local: how many of these are made locally too, and compared.
        options: of Snakemake, to run on this Slurm.
        finished: call, job of this Slurm that has ended → seconds that it took.
    """
    before = finished(slurm)
    options = (*options, *size(records, records))
    run = Run(kept(place / "study"), TARGET, *options, environment=slurm.environment)
    try:
        code = run.end()
    finally:
        took = ended(slurm, place, before, finished)
    if code:
        raise SystemExit(f"the run on Slurm failed:\n{run.log.read_text()[-4000:]}")
    beside = Run(kept(place / "study-local"), TARGET, *size(records, local))
    if beside.end():
        raise SystemExit(f"the local run failed:\n{beside.log.read_text()[-4000:]}")
    different = unequal(place / "study", place / "study-local")
    print("".join(f"  differs: {path}\n" for path in different), end="")
    made, compared = (len(untimed(place / name / TARGET)) for name in ("study", "study-local"))
    each = processor_s(place / "study") / made
    batches = len(list((place / "study" / STUDY / "verdicts").iterdir()))
    values = (made, batches, code, compared, not different, len(took), sum(took.values()), round(each, 1))
    return dict(zip(COLUMNS, (*values, round(each * whole() / 3600.0, 2)), strict=True))
