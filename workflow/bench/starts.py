"""How long each verb of the command line takes to start: processor seconds, written as CSV.

`python workflow/bench/starts.py RESULTS OUT [VERB …]` runs every verb, or those named, on the smallest input
that makes sense, in a temporary folder; RESULTS is the folder of a finished pipeline. Three numbers for each,
in seconds of user and system time of the process: `--help`; loading all that the verb loads in that run, in a
fresh interpreter; the whole run, its work included. Each is the least of several, of which the first warms
the caches: other work on the machine only adds. Importing numba alone stands first, as a yardstick.
"""

import csv
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from sonicvacuum.cli import GROUPS, VERBS
from sonicvacuum_blind.cli import blind
from sonicvacuum_paper.cli import paper

ROOT = Path(__file__).resolve().parents[2]
REPEATS = 2
CHAIN = "--beads 10 --diameter 20mm --material bearing-steel --speed 0.5"
MEASURED = "workflow/resources/measured/daraio-nesterenko-2006"
SMALL = "{results}/blind/small"
# Verb → what it is run with; {results} is the finished pipeline, {out} a folder of its own.
INPUTS = {
    "card": "--case fig3b --out {out}/card.json",
    "materials": "",
    "effects": "",
    "schema": "--out {out}/schema.json",
    "simulate": "{results}/cards/fig3b.nominal.json --out {out}/history.npz",
    "predict": CHAIN,
    "design": f"--effects sensor-droop,kuwabara-kono {CHAIN}",
    "record": f"check {MEASURED}-steel",
    "discover": f"{SMALL}/records/3/small-0019 --out {{out}}/found --no-figures --threads 1",
    "page": "{out}/steel",
    "compare": f"{MEASURED}-steel --model {{results}}/discover/daraio-nesterenko-2006-steel/model.json "
    "--json {out}/score.json",
    "export": "--law kuwabara-kono --time_us 2 --mass_g 4 --diameter_mm 10 --material stainless-steel "
    "--speeds 0.1 2",
    "paper observe": "{results}/cards/fig3b.nominal.json {results}/histories/fig3b.nominal.npz "
    "--signals {out}/signals.csv --metrics {out}/metrics.csv",
    "paper ledger": "{results}/metrics.csv --claims workflow/resources/claims.csv --out {out}/ledger.csv",
    "paper audit": "{results}/metrics.csv --assumptions workflow/resources/assumptions.csv --out {out}/a.csv",
    "paper draw": "fig3 --cards {results}/cards --histories {results}/histories --out {out}",
    "paper report": "--ledger {results}/ledger.csv --assumptions {results}/assumptions.csv --metrics "
    "{results}/metrics.csv --claims workflow/resources/claims.csv --figure figures/fig3.svg "
    "--out {out}/report.html",
    "paper runs": "{results}/cards/fig3b.nominal.json --histories {results}/histories --metrics "
    "{results}/metrics.csv --out {out}/runs.html",
    "paper animate": "solitary --out {out}/solitary.svg",
    "paper timings": "{results}/benchmarks --out {out}/timings.csv",
    "blind hide": "--study small --list {out}/cases.csv",
    "blind score": f"--truth {SMALL}/truth --verdicts {SMALL}/verdicts --out {{out}}/s.csv "
    "--summary {out}/summary.csv",
    "blind draw": f"{SMALL} --picture accuracy --out {{out}}",
    "blind page": f"--small {SMALL}/summary.csv --out {{out}}/blind.html",
}
# What a verb has loaded when it ends, one module in each line.
LOADED = """
import atexit, os, sys
atexit.register(lambda: open(os.environ["LOADED"], "w").write("\\n".join(sys.modules)))
sys.argv = ["sonicvacuum", *sys.argv[1:]]
from sonicvacuum.cli import main
main()
"""
LOAD = """
import contextlib, importlib, sys
for name in open(sys.argv[1]).read().split():
    with contextlib.suppress(Exception):
        importlib.import_module(name)
"""


def verbs() -> list[str]:
    """Every verb, those of groups with the group's name before it."""
    below = {"paper": paper.verbs, "blind": blind.verbs}
    return [*(v for v in VERBS if v not in GROUPS), *(f"{g} {v}" for g in GROUPS for v in below[g])]


def spent(*words: str, **variables: str) -> float:
    """Processor seconds of a Python process; raises where it ends badly."""
    with subprocess.Popen(
        [sys.executable, *words],
        cwd=ROOT,
        env={**os.environ, **variables},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        said = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(words[-4:])}: {said[-500:]}")
    return usage.ru_utime + usage.ru_stime


def least(*words: str, **variables: str) -> float:
    """Of several runs; the first warms the caches."""
    return min(spent(*words, **variables) for _ in range(REPEATS))


def measured(verb: str, results: Path, folder: Path) -> list[str]:
    """Row of one verb: seconds of `--help`, of loading and of the run; empty where it is not run."""
    words = verb.split()
    helped = least("-c", LOADED, *words, "--help", LOADED=str(folder / "help.txt"))
    if verb not in INPUTS:
        return [verb, f"{helped:.2f}", "", "", ""]
    options = INPUTS[verb].format(results=results, out=folder)
    run = least("-c", LOADED, *words, *options.split(), LOADED=str(folder / "run.txt"))
    load = least("-c", LOAD, str(folder / "run.txt"))
    shown = (
        f"{verb} {INPUTS[verb]}".replace("{results}", "results").replace("{out}/", "").replace("{out}", ".")
    )
    return [verb, f"{helped:.2f}", f"{load:.2f}", f"{run:.2f}", shown]


def main(results: Path, out: Path, names: list[str]) -> None:
    """Measure all verbs, or those named, and write the table."""
    with tempfile.TemporaryDirectory() as folder, open(out, "w", encoding="utf-8", newline="") as stream:
        own = Path(folder, "steel")
        own.mkdir()
        for path in (results / "discover/daraio-nesterenko-2006-steel").iterdir():
            (own / path.name).write_bytes(path.read_bytes())
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["verb", "help_s", "load_s", "run_s", "run_with"])
        table.writerow(["(import numba)", "", f"{least('-c', 'import numba'):.2f}", "", ""])
        for verb in names or verbs():
            table.writerow(measured(verb, results, Path(folder)))
            stream.flush()


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]), sys.argv[3:])
