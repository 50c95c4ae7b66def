"""The small pipeline of `make crash` on a real Slurm of one node, held against a local run to the byte.

Four times: undisturbed, with a job put back as by preemption, with a job that is killed, with the node's
daemon killed in the middle and started again. One row each, exit code 1 where products differ or a run does
not end well.
"""

import argparse
import csv
import sys
import tempfile
import time
from datetime import datetime
from pathlib import Path

from crash import Run, project
from one_node import Slurm
from reproduce import unequal

TRIALS = ("undisturbed", "job put back", "job killed", "node fails")
COLUMNS = ("trial", "exit", "same_bytes", "wall_s", "slurm_jobs", "in_jobs_s", "in_commands_s")
TARGET = "results/metrics.csv"
OPTIONS = (
    "--workflow-profile", "workflow/profiles/slurm",
    "--default-resources", "slurm_partition=main", "runtime=10", "mem_mb=500",
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


def main() -> int:
    """The table; 1 where a trial did not end as it should."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trials", nargs="+", choices=TRIALS, default=TRIALS)
    parser.add_argument("--out", type=Path, required=True)
    asked = parser.parse_args()
    failed = 0
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        place = Path(name).resolve()
        place.chmod(0o755)
        with Slurm(place / "slurm") as slurm, open(asked.out, "w", newline="") as stream:
            local = Run(project(place / "local"), TARGET)
            if local.end():
                sys.exit(f"the local run failed:\n{local.log.read_text()[-4000:]}")
            table = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
            table.writeheader()
            for number, trial in enumerate(asked.trials):
                row = attempt(slurm, place / f"run-{number}", trial, place / "local")
                table.writerow(row)
                stream.flush()
                print(*row.values(), flush=True)
                failed += row["exit"] != 0 or not row["same_bytes"]
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
