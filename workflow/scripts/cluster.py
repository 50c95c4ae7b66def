"""The small pipeline of `make crash` on a real Slurm of one node, held against a local run to the byte.

Four times: undisturbed, with a job put back as by preemption, with a job that is killed, with the node's
daemon killed in the middle and started again. One row each, exit code 1 where products differ or a run does
not end well. With `--records`, so many of the full blind study after it, see `cluster_study`.
"""

import argparse
import csv
import shutil
import signal
import sys
import tempfile
import time
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

import cluster_study
import yaml
from crash import Run, project
from one_node import Slurm
from reproduce import unequal

TRIALS = ("undisturbed", "job put back", "job killed", "node fails")
COLUMNS = ("trial", "exit", "same_bytes", "wall_s", "slurm_jobs", "in_jobs_s", "in_commands_s")
TARGET = "results/metrics.csv"
PROFILE = Path("workflow/profiles/slurm")
# Of the command line they replace those of the profile as a whole.
RESOURCES = yaml.safe_load((Path(__file__).resolve().parents[2] / PROFILE / "config.yaml").read_text())
OPTIONS = (
    "--workflow-profile", str(PROFILE),
    "--default-resources", "slurm_partition=main", *RESOURCES["default-resources"],
    "--latency-wait", "20",
    "--slurm-init-seconds-before-status-checks", "5",
    "--slurm-status-command", "squeue",
    "--slurm-no-account",
)  # fmt: skip


def finished(slurm: Slurm) -> dict[str, float]:
    """Job of Slurm → seconds from start to end, of all jobs that have ended."""
    rows = (
        line.split() for line in slurm.call("squeue", "-h", "-t", "all", "-o", "%i %T %S %e").splitlines()
    )
    ended = {
        number: (begin, end) for number, state, begin, end in rows if state not in ("RUNNING", "PENDING")
    }
    return {
        number: (datetime.fromisoformat(end) - datetime.fromisoformat(begin)).total_seconds()
        for number, (begin, end) in ended.items()
        if "N/A" not in (begin, end)
    }


def commands(folder: Path) -> float:
    """Seconds that the commands of a run took, by its benchmark files."""
    tables = (folder / "results/benchmarks").rglob("*.tsv")
    return sum(float(path.read_text().splitlines()[1].split("\t")[0]) for path in tables)


def disturb(slurm: Slurm, run: Run, trial: str) -> None:
    """Wait for a job of Slurm that runs, and do to it what the trial stands for."""
    running: list[str] = []
    while not running and run.process.poll() is None:
        time.sleep(0.5)
        running = slurm.call("squeue", "-h", "-t", "running", "-o", "%i").split()
    time.sleep(3.0)
    if not running:
        return
    if trial == "job put back":
        slurm.call("scontrol", "requeue", running[0])
    elif trial == "job killed":
        slurm.call("scancel", "--signal=KILL", "--full", running[0])
    elif trial == "node fails":
        slurm.kill("slurmd")
        time.sleep(10.0)
        slurm.start("slurmd")


def attempt(slurm: Slurm, folder: Path, trial: str, whole: Path) -> dict:
    """One row: a run in a new folder, disturbed or not."""
    before, begun = finished(slurm), time.monotonic()
    run = Run(project(folder), TARGET, *OPTIONS, environment=slurm.environment)
    if trial != "undisturbed":
        disturb(slurm, run, trial)
    code, wall = run.end(), time.monotonic() - begun
    if code:
        print(run.log.read_text()[-4000:], file=sys.stderr)
    new = {number: took for number, took in finished(slurm).items() if number not in before}
    values = (trial, code, not unequal(folder, whole), round(wall, 1), len(new), sum(new.values()))
    return dict(zip(COLUMNS, (*values, round(commands(folder), 1)), strict=True))


def tried(slurm: Slurm, place: Path, trials, stream) -> int:
    """Write the table of the small pipeline; how many trials did not end as they should."""
    local = Run(project(place / "local"), TARGET)
    if local.end():
        sys.exit(f"the local run failed:\n{local.log.read_text()[-4000:]}")
    failed, table = 0, csv.DictWriter(stream, COLUMNS, lineterminator="\n")
    table.writeheader()
    for number, trial in enumerate(trials):
        row = attempt(slurm, place / f"run-{number}", trial, place / "local")
        table.writerow(row)
        stream.flush()
        print(*row.values(), flush=True)
        failed += row["exit"] != 0 or not row["same_bytes"]
    return failed


def studied(slurm: Slurm, place: Path, records: int, local: int, stream) -> int:
    """Write the row of the blind study; 1 where it did not end as it should."""
    row = cluster_study.row(slurm, place, records, local, OPTIONS, finished)
    table = csv.DictWriter(stream, row, lineterminator="\n")
    table.writeheader()
    table.writerow(row)
    print(*(f"{key}: {value}" for key, value in row.items()), sep=", ", flush=True)
    return int(row["exit"] != 0 or not row["same_bytes"])


@contextmanager
def folder(named: Path | None):
    """The folder that is named, or one that goes away."""
    if named:
        named.mkdir(parents=True, exist_ok=True)
        for made_anew in ("slurm", "trials"):
            shutil.rmtree(named / made_anew, ignore_errors=True)
        yield named.resolve()
    else:
        with tempfile.TemporaryDirectory() as name:
            yield Path(name).resolve()


def main() -> int:
    """The table; 1 where a trial did not end as it should."""
    all_of_it = cluster_study.whole()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trials", nargs="*", choices=TRIALS, default=TRIALS)
    parser.add_argument(
        "--records", type=int, default=0, help=f"Of the full blind study; {all_of_it} are all."
    )
    parser.add_argument("--local", type=int, help="So many of them locally too; all if not given.")
    parser.add_argument(
        "--place", type=Path, help="Folder for the runs, kept: a further start goes on in it."
    )
    parser.add_argument("--out", type=Path, required=True, help="Table; that of the study gets -study.")
    asked = parser.parse_args()
    records = min(asked.records, all_of_it)
    local = records if asked.local is None else max(1, min(asked.local, records))
    failed = 0
    # Asked to end, it ends its run and its Slurm as after an interruption.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    with folder(asked.place) as place:
        place.chmod(0o755)
        with Slurm(place / "slurm") as slurm:
            if asked.trials:
                with open(asked.out, "w", newline="") as stream:
                    failed += tried(slurm, place / "trials", asked.trials, stream)
            if records:
                with open(asked.out.with_stem(f"{asked.out.stem}-study"), "w", newline="") as stream:
                    failed += studied(slurm, place, records, local, stream)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
