"""Runs of a small pipeline disturbed at random moments, each followed by what `make` does: nothing is lost.

Disturbances: the whole process group killed, one job killed, Snakemake alone killed, an interruption from the
keyboard, a disk that takes no more (no file may grow beyond a small size). After each, one more run without
any cure by hand must end well, give the products of an undisturbed run to the byte, and leave nothing to be
made. Prints and writes one row a moment; exit code 1 where one failed.
"""

import argparse
import csv
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from reproduce import PARTS, products, unequal
from start import processes

ROOT = Path(__file__).resolve().parents[2]
KINDS = ("group", "job", "snakemake", "interrupt", "disk")
COLUMNS = (
    "moment",
    "kind",
    "after_s",
    "files_by_then",
    "disturbed_exit",
    "recovered_exit",
    "same_bytes",
    "idle_then",
)
BALL = """\
format: 1
title: Steel ball on a steel wall
chain:
  beads: 0
  orientation: vertical
  bead: {diameter_mm: 10.0, mass_g: 4.0, material: stainless-steel}
  wall: {material: stainless-steel}
sensors: []
runs:
  - id: slow
    striker: {shape: sphere, diameter_mm: 10.0, material: stainless-steel, mass_g: 4.0, speed_m_s: 0.5}
    observables: [{quantity: restitution, value: 0.99, sigma: 0.01, unit: 1}]
"""
CONFIG = """\
discover: [records/ball]
ledger: {handbook: [soft, nominal], named: [found]}
cases:
  coated:
    title: Five coated beads
    chain:
      beads: 5
      orientation: horizontal
      bead: {diameter_mm: 4.86, mass_g: 0.44, material: parylene-c, coating_um: 50, core: stainless-steel}
      wall: {material: stainless-steel}
    striker: {shape: flat, material: alumina, mass_g: 0.47, speed_m_s: 0.44}
    sensors: [{id: g2, kind: embedded, bead: 3}, {id: wall, kind: wall}]
    duration_us: 400
    variants:
      soft: {}
      found: {model: {record: ball}}
"""


def project(folder: Path) -> Path:
    """A folder with a pipeline of a record and two cards, and nothing made in it."""
    folder.mkdir(parents=True)
    for part in PARTS:
        source = ROOT / part
        if source.is_dir():
            shutil.copytree(source, folder / part, ignore=shutil.ignore_patterns("__pycache__", "*.pyc"))
        elif part != "config.yaml":
            shutil.copy2(source, folder / part)
    (folder / "config.yaml").write_text(CONFIG)
    (folder / "records/ball").mkdir(parents=True)
    (folder / "records/ball/record.yaml").write_text(BALL)
    return folder


class Run:
    """One start of the pipeline as `make` starts it, in a process group of its own."""

    def __init__(
        self,
        folder: Path,
        target: str,
        *options: str,
        largest: int | None = None,
        environment: dict | None = None,
    ):
        """
        Args:
            folder, target: where, and the file that is asked for.
            options: further arguments of Snakemake.
            largest: bytes beyond which no file may grow; none by default.
            environment: of the run, this process's by default.
        """
        command = [
            sys.executable,
            str(folder / "workflow/scripts/start.py"),
            "--cores",
            "2",
            *options,
            target,
        ]
        self.log = folder / "said.log"
        with open(self.log, "w") as said:
            self.process = subprocess.Popen(
                command,
                cwd=folder,
                env=(environment or os.environ) | {"PYTHONPATH": str(folder / "src")},
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=lambda: largest and resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest)),
            )

    def disturb(self, kind: str) -> None:
        """Send what the kind of disturbance stands for, to the next job for `job`; nothing after the end."""
        try:
            if kind == "group":
                os.killpg(self.process.pid, signal.SIGKILL)
            elif kind == "interrupt":
                os.killpg(self.process.pid, signal.SIGINT)
            elif kind == "snakemake":
                self.process.kill()
            elif kind == "job":
                while self.process.poll() is None and not (found := list(jobs(self.process.pid))):
                    time.sleep(0.01)
                if self.process.poll() is None:
                    os.kill(found[0], signal.SIGKILL)
        except ProcessLookupError:
            return

    def end(self) -> int:
        """Exit code; negative where a signal ended it. An interruption is handed on and waited for."""
        try:
            return self.process.wait()
        except KeyboardInterrupt:
            self.disturb("interrupt")
            self.process.wait()
            raise


def jobs(group: int) -> Iterator[int]:
    """Processes of a group that run the command `sonicvacuum`."""
    for number, path in processes().items():
        try:
            words = (path / "cmdline").read_bytes().split(b"\0")
            if os.getpgid(number) == group and any(word.endswith(b"/sonicvacuum") for word in words[:3]):
                yield number
        except OSError:
            continue


def attempt(folder: Path, target: str, kind: str, after_s: float, largest: int, whole: Path) -> dict:
    """One moment: a run in a fresh folder, its disturbance, and what one more run makes of it.

    Args:
        folder: to be made, and removed at the end.
        target: file that is asked for.
        kind: one of `KINDS`.
        after_s: seconds from the start of the run to the disturbance.
        largest: bytes that a file may have where the kind is `disk`.
        whole: folder of an undisturbed run.
    """
    disturbed = Run(project(folder), target, largest=largest if kind == "disk" else None)
    until = time.monotonic() + after_s
    while kind != "disk" and disturbed.process.poll() is None and time.monotonic() < until:
        time.sleep(0.01)
    by_then = len(products(folder))
    disturbed.disturb(kind)
    ended = disturbed.end()
    recovered = Run(folder, target).end()
    same = not unequal(folder, whole)
    again = Run(folder, target, "--dry-run")
    idle = again.end() == 0 and "Nothing to be done" in again.log.read_text()
    values = (kind, round(after_s, 1), by_then, ended, recovered, same, idle)
    if recovered == 0 and same and idle:
        shutil.rmtree(folder)
    return dict(zip(COLUMNS[1:], values, strict=True))


def rows(folder: Path, target: str, moments: int, seed: int = 1) -> Iterator[dict]:
    """One row for each of a number of moments, kinds in turn; columns are `COLUMNS`."""
    begun = time.monotonic()
    whole = Run(project(folder / "whole"), target)
    if whole.end():
        sys.exit(f"the undisturbed run failed:\n{whole.log.read_text()[-4000:]}")
    took, draw = time.monotonic() - begun, random.Random(seed)
    for moment in range(moments):
        # From what holds no lock file to what holds all but the largest product, evenly in the logarithm.
        largest = round(2 ** draw.uniform(4, 16))
        after = draw.uniform(0.0, 1.02 * took)
        kind = KINDS[moment % len(KINDS)]
        row = attempt(folder / str(moment), target, kind, after, largest, folder / "whole")
        yield {"moment": moment, **row}


def main() -> int:
    """The table; 1 where a moment was not recovered from."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--moments", type=int, default=60)
    parser.add_argument("--target", default="results/metrics.csv")
    parser.add_argument("--seed", type=int, default=1, help="Of the moments.")
    parser.add_argument("--out", type=Path, required=True)
    asked = parser.parse_args()
    failed = 0
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, open(asked.out, "w", newline="") as stream:
        table = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        table.writeheader()
        for row in rows(Path(folder).resolve(), asked.target, asked.moments, asked.seed):
            table.writerow(row)
            stream.flush()
            print(*row.values(), flush=True)
            failed += row["recovered_exit"] != 0 or not row["same_bytes"] or not row["idle_then"]
    print(f"{asked.moments} moments, {failed} not recovered from")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
