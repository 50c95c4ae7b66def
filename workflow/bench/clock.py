"""Seconds on the clock of whole verdicts by kind of record, with one thread and two, in the sources here and
in those of an earlier commit, in turns.

What is timed is what a user waits for: `sonicvacuum discover RECORD --out FOLDER`, command to page. Compiled
code, Python's too, is in its cache already: the first verdict of each version is not counted.

    python workflow/bench/clock.py one=FOLDER two=FOLDER … --before COMMIT [--repeats 3] [--out TABLE.csv]

Each FOLDER holds records of one kind. A record counts with the least of its times, a kind with the median of
its records.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from seconds import ROOT, earlier

from sonicvacuum.tables import write_csv

COLUMNS = ("kind", "record", "sources", "threads", "seconds")
THREADS = (1, 2)
COMMAND = "from sonicvacuum.cli import main; main()"


def verdict(source: Path, record: Path, threads: int, folder: Path) -> float:
    """Seconds of one verdict."""
    environment = os.environ | {"PYTHONPATH": str(source), "PYTHONPYCACHEPREFIX": str(folder / "pycache")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    options = ["--out", str(folder / "out"), "--threads", str(threads), "--quiet"]
    begun = time.perf_counter()
    subprocess.run(
        [sys.executable, "-c", COMMAND, "discover", str(record), *options],
        check=True,
        env=environment,
        stdout=subprocess.DEVNULL,
    )
    return time.perf_counter() - begun


def measured(sources: dict[str, Path], records: list[tuple[str, Path]], repeats: int) -> list[tuple]:
    """Rows of the table: the least seconds of each record, version and number of threads."""
    rows = []
    ways = [(name, threads) for threads in THREADS for name in sources]
    with tempfile.TemporaryDirectory() as folder:
        for kind, record in records:
            found = {way: [] for way in ways}
            for turn in range(repeats + 1):
                for name, threads in ways if turn else ways[: len(sources)]:
                    seconds = verdict(sources[name], record, threads, Path(folder))
                    found[name, threads] += [seconds] if turn else []
            for (name, threads), seconds in found.items():
                rows.append((kind, record.name, name, threads, f"{min(seconds):.3f}"))
                print(*rows[-1], flush=True)
    return rows


def markdown(rows: list[tuple]) -> str:
    """Medians and ranges of each kind, as they stand in docs/benchmark.md."""
    found: dict[tuple, list[float]] = {}
    for kind, _, name, threads, seconds in rows:
        found.setdefault((kind, name, threads), []).append(float(seconds))
    ways = list(dict.fromkeys(way[1:] for way in found))
    header = [f"{name}, {threads} thread{'s' * (threads > 1)}" for name, threads in ways]
    lines = ["| records | " + " | ".join(header) + " |", "|---|" + "---:|" * len(ways)]
    for kind in dict.fromkeys(kind for kind, _, _ in found):
        own = [found[kind, *way] for way in ways]
        cells = [f"{statistics.median(s):.1f} ({min(s):.1f} to {max(s):.1f})" for s in own]
        lines.append(f"| {kind}, {len(own[0])} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinds", nargs="+", metavar="KIND=FOLDER")
    parser.add_argument("--before", required=True, help="an earlier commit")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--out", type=Path, default=Path("results/clock.csv"))
    given = parser.parse_args()
    named = [kind.partition("=") for kind in given.kinds]
    records = [
        (kind, path.parent)
        for kind, _, folder in named
        for path in sorted(Path(folder).glob("*/record.yaml"))
    ]
    if not records:
        parser.error("no folder holds records (FOLDER/NAME/record.yaml)")
    with tempfile.TemporaryDirectory() as folder:
        sources = {"before": earlier(given.before, Path(folder)), "now": ROOT / "src"}
        rows = measured(sources, records, given.repeats)
    write_csv(given.out, COLUMNS, rows)
    print(markdown(rows))


if __name__ == "__main__":
    main()
