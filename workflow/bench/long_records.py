"""Whether a million samples a run are searched as fast as a thousand: the worked example, sampled four times.

`python workflow/bench/long_records.py OUT [SAMPLES …]` makes the impacts of docs/example anew with so many
samples of a run (the same stretch of time, the same noise of one sample), as a record of forces, and searches
it on one thread. One row for each: processor seconds of reading and of searching, memory, what was named.
"""

import argparse
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "workflow/scripts"))
import example  # noqa: E402

SAMPLES = (1_000, 10_000, 100_000, 1_000_000)
LASTS = example.INTERVAL * example.SAMPLES
# What one process spends; the first import brings all modules, so that reading is reading.
CODE = """
import json, resource, sys, time
from sonicvacuum import records
from sonicvacuum.discover import session
start = time.process_time()
record = records.read(sys.argv[1])
read = time.process_time()
found = session.discover(record, threads=1)
spent = read - start, time.process_time() - read
memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
v = found.verdict
print(json.dumps([*(f"{s:.1f}" for s in spent), f"{memory:.0f}", f"{'+'.join(v.named)} {v.probability:.2f}"]))
"""


def write(folder: Path, samples: int) -> None:
    """The example as a record with so many samples of each run."""
    known = yaml.safe_load((ROOT / "docs/example/chain.yaml").read_text(encoding="utf-8"))
    newtons, rest = (np.array(list(d.values()))[:, None] for d in (example.NEWTON_PER_VOLT, example.OFFSET_V))
    sensors = zip(example.GAUGES.values(), newtons.ravel(), example.NOISE_V.values(), strict=True)
    known |= {"format": 1, "trigger_sigma_us": 1.0}
    known["sensors"] = [
        {"id": g.id, "kind": g.kind, "sigma_N": float(scale * noise), "gain_rel_sigma": 0.02}
        | ({"bead": g.bead} if g.bead else {})
        for g, scale, noise in sensors
    ]
    interval = LASTS / samples
    shots = example.volts(example.design(interval, samples), 0)
    time = 1e6 * interval * np.arange(shots.shape[2])
    for run, volts in zip(known["runs"], shots, strict=True):
        run["signals"] = f"{run['id']}.csv"
        head = ",".join(["time_us", *(g.id for g in example.GAUGES.values())])
        table = np.column_stack([time, *((volts - rest) * newtons)])
        np.savetxt(folder / run["signals"], table, delimiter=",", fmt="%.9g", header=head, comments="")
    (folder / "record.yaml").write_text(yaml.safe_dump(known), encoding="utf-8")


def main(out: Path, sizes: list[int]) -> None:
    """Search all sizes, or those given, and write the table."""
    with open(out, "w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["samples", "reading_s", "search_s", "memory_MB", "named"])
        for samples in sizes or SAMPLES:
            with tempfile.TemporaryDirectory() as name:
                write(Path(name), samples)
                done = subprocess.run([sys.executable, "-c", CODE, name], capture_output=True, text=True)
            if done.returncode:
                raise SystemExit(done.stderr)
            table.writerow([samples, *json.loads(done.stdout)])
            stream.flush()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", metavar="OUT", type=Path, help="table (CSV) to write")
    parser.add_argument(
        "samples", metavar="SAMPLES", nargs="*", type=int, help="of a run; by default a thousand to a million"
    )
    given = parser.parse_args()
    main(given.out, given.samples)
