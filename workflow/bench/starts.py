"""How long each verb of the command line takes to start: processor seconds, written as CSV.

`python workflow/bench/starts.py RESULTS OUT [VERB …]` runs every verb, or those named, on the smallest input
that makes sense, in a temporary folder; RESULTS is the folder of a finished pipeline. Five numbers for each,
in seconds of user and system time of the process: `--help`; all that a run spends until it reads its input
(`started.py` says how that is told); what it spends on loading modules, wherever that happens, the start of
the interpreter included; what it spends on reading compiled kernels; the whole run, its work included.
Each is the least of several, of which the first warms the caches: other work on the machine only adds.
Importing numba alone stands first, as a yardstick. Python keeps its bytecode, whatever the environment says:
without it every start compiles the package's sources anew.
"""

import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from sonicvacuum.cli import GROUPS, VERBS
from sonicvacuum_blind.cli import blind
from sonicvacuum_paper.cli import paper

ROOT = Path(__file__).resolve().parents[2]
REPEATS = 3
LONG = 10.0  # s; what runs so long is run once
STARTED = Path(__file__).with_name("started.py")
CHAIN = "--beads 10 --diameter 20mm --material bearing-steel --speed 0.5"
MEASURED = "workflow/resources/measured/daraio-nesterenko-2006"
SMALL = "{results}/blind/small"
STUDIED = f"--truth {SMALL}/truth --verdicts {SMALL}/verdicts"
CLAIMS = "--claims workflow/resources/claims.csv"
# Verb → what it is run with; {results} is the finished pipeline, {out} a folder of its own, in which later
# verbs find what earlier ones wrote. A star stands for names of files.
INPUTS = {
    "card": "--case fig3b --out {out}/card.json",
    "materials": "",
    "effects": "",
    "schema": "--out {out}/schema.json",
    "simulate": "{results}/cards/fig3b.nominal.json --out {out}/history.npz",
    "predict": CHAIN,
    "design": f"--effects sensor-droop,kuwabara-kono {CHAIN}",
    "record": f"check {MEASURED}-steel",
    "discover": f"{SMALL}/records/0/small-0019 --out {{out}}/found --no-figures --threads 1",
    "page": "{out}/steel",
    "compare": f"{MEASURED}-steel --model {{results}}/discover/daraio-nesterenko-2006-steel/model.json "
    "--json {out}/score.json",
    "export": "--law kuwabara-kono --time_us 2 --mass_g 4 --diameter_mm 10 --material stainless-steel "
    "--speeds 0.1 2",
    "paper observe": "{results}/cards/fig3b.nominal.json {results}/histories/fig3b.nominal.npz "
    "--signals {out}/signals.csv --metrics {out}/metrics.csv",
    "paper metrics": "{results}/metrics/*.csv --out {out}/all.csv",
    "paper uncertainty": f"{CLAIMS} --draws 2 --out {{out}}/probable.csv",
    "paper rivals": "--map {out}/map.csv --picture {out}/map.svg --experiments {out}/runs.csv --relaxation "
    "{out}/solids.csv --losses {out}/laws.csv --explained {out}/fits.csv --record " + f"{MEASURED}-coated",
    "paper ledger": f"{{results}}/metrics.csv {CLAIMS} --out {{out}}/ledger.csv",
    "paper audit": "{results}/metrics.csv --assumptions workflow/resources/assumptions.csv --out {out}/a.csv",
    "paper draw": "fig3 --cards {results}/cards --histories {results}/histories --out {out}",
    "paper digitised": "{out}/points.yaml --figure figures/fig4.csv",
    "paper report": "--ledger {results}/ledger.csv --assumptions {results}/assumptions.csv --metrics "
    "{results}/metrics.csv --claims workflow/resources/claims.csv --figure figures/fig3.svg "
    "--card {results}/cards/fig3b.nominal.json --out {out}/report.html",
    "paper runs": "{results}/cards/fig3b.nominal.json --histories {results}/histories --metrics "
    "{results}/metrics.csv --out {out}/runs.html",
    "paper animate": "solitary --out {out}/solitary.svg",
    "paper publish": f"--ledger {{results}}/ledger.csv {CLAIMS} --readme {{out}}/README.md "
    "--guide {out}/guide.md --reference {out}/reference.csv",
    "paper timings": "{results}/benchmarks --out {out}/timings.csv",
    "blind hide": "--study small --list {out}/cases.csv",
    "blind score": f"{STUDIED} --out {{out}}/study/score.csv --summary {{out}}/study/summary.csv",
    "blind slips": "--batch 0/270 --records {out}/slips --truth {out}/slipped",
    "blind slips-score": "--truth {out}/slipped --verdicts {out}/verdicts-slips --out {out}/s.csv "
    "--summary {out}/summary.csv",
    "blind extras": "--first 1 --records {out}/extras --truth {out}/extra",
    "blind extras-score": "--truth {out}/extra --verdicts {out}/verdicts-extras --out {out}/s.csv "
    "--summary {out}/summary.csv",
    "blind follow": f"--study small --verdicts {SMALL}/verdicts --choice random --records {{out}}/followed",
    "blind resolved": f"{STUDIED} --proposed {{out}}/proposed {SMALL}/verdicts --random {{out}}/followed "
    f"{SMALL}/verdicts --out {{out}}/study/resolved.csv --summary {{out}}/study/resolved_summary.csv",
    "blind calibrate": f"{STUDIED} --out {{out}}/calibration.json",
    "blind baselines": f"--rule bic --records {SMALL}/records {STUDIED} --out {{out}}/study/baselines.csv",
    "blind ideal": "--study small --batch 0/36 --out {out}/ideal.csv",
    "blind draw": f"{SMALL} --picture accuracy --out {{out}}",
    "blind page": f"--small {SMALL}/summary.csv --out {{out}}/blind.html",
    "blind publish": "{out}/study --page {out}/study.md --keep {out}/kept",
}
# One point of Fig. 4(a), as `paper digitised` is given them.
POINTS = """format: 1
figure: fig4
panel: a
what: one point
provenance: {who: nobody, how: made up, scale: none, date: "2026-01-31"}
error: {x: 0.01, y: 1.0}
points: [[1.0, 200.0]]
"""
# The command as the installed script calls it.
COMMAND = "import sys; sys.argv[0] = 'sonicvacuum'; from sonicvacuum.cli import main; main()"
# Python writes no bytecode where the first is set.
NOT_OURS = ("PYTHONDONTWRITEBYTECODE",)


def verbs() -> list[str]:
    """Every verb, those of groups with the group's name before it."""
    below = {"paper": paper.verbs, "blind": blind.verbs}
    return [*(v for v in VERBS if v not in GROUPS), *(f"{g} {v}" for g in GROUPS for v in below[g])]


def spent(*words: str) -> float:
    """Processor seconds of a Python process; raises where it ends badly."""
    with subprocess.Popen(
        [sys.executable, *words],
        cwd=ROOT,
        env={name: value for name, value in os.environ.items() if name not in NOT_OURS},
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


def expanded(words: str) -> list[str]:
    """Words of a command line, stars replaced by the files that they stand for."""
    return [
        found
        for word in words.split()
        for found in (map(str, sorted(Path("/").glob(word[1:]))) if "*" in word else [word])
    ]


def measured(verb: str, results: Path, folder: Path) -> list[str]:
    """Row of one verb: seconds of `--help`, until its input is read, of loading, reading kernels and the run;
    empty where not run.
    """
    helped = min(spent("-P", "-c", COMMAND, *verb.split(), "--help") for _ in range(REPEATS))
    if verb not in INPUTS:
        return [verb, f"{helped:.2f}", "", "", "", "", ""]
    options = expanded(INPUTS[verb].format(results=results, out=folder))
    told = folder / "told.json"
    rows: list[tuple[float, ...]] = []
    while len(rows) < REPEATS and (not rows or rows[-1][-1] < LONG):
        run = spent("-P", str(STARTED), str(told), *verb.split(), *options)
        rows.append((*json.loads(told.read_text()).values(), run))
    shown = (
        f"{verb} {INPUTS[verb]}".replace("{results}", "results").replace("{out}/", "").replace("{out}", ".")
    )
    return [verb, *(f"{seconds:.2f}" for seconds in (helped, *map(min, zip(*rows, strict=True)))), shown]


def furnish(folder: Path, results: Path) -> None:
    """What some verbs start from: a verdict to draw, copies to renew, a verdict for each case made."""
    shutil.copytree(results / "discover/daraio-nesterenko-2006-steel", folder / "steel")
    for source, name in (
        ("README.md", "README.md"),
        ("figures/README.md", "guide.md"),
        ("docs/study.md", "study.md"),
    ):
        shutil.copy(ROOT / source, folder / name)
    (folder / "points.yaml").write_text(POINTS)
    (folder / "study").mkdir()
    for table in (results / "blind/small").glob("*.csv"):
        shutil.copy(table, folder / "study")
    verdict = min((results / "blind/small/verdicts").rglob("verdict.json"))
    for kind in ("slips", "extras"):
        own = folder / f"verdicts-{kind}" / f"{kind}-0000"
        own.mkdir(parents=True)
        shutil.copy(verdict, own)
    follow = INPUTS["blind follow"].replace("random", "proposed").replace("followed", "proposed")
    spent("-P", "-c", COMMAND, "blind", "follow", *follow.format(results=results, out=folder).split())


def main(results: Path, out: Path, names: list[str]) -> None:
    """Measure all verbs, or those named, and write the table."""
    with tempfile.TemporaryDirectory() as folder, open(out, "w", encoding="utf-8", newline="") as stream:
        furnish(Path(folder), results)
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["verb", "help_s", "begun_s", "load_s", "kernels_s", "run_s", "run_with"])
        numba = min(spent("-P", "-c", "import numba") for _ in range(REPEATS))
        table.writerow(["(import numba)", "", "", f"{numba:.2f}", "", "", ""])
        for verb in names or verbs():
            table.writerow(measured(verb, results, Path(folder)))
            stream.flush()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("results", metavar="RESULTS", type=Path, help="folder of a finished pipeline")
    parser.add_argument("out", metavar="OUT", type=Path, help="table (CSV) to write")
    parser.add_argument("verbs", metavar="VERB", nargs="*", help="by default all")
    given = parser.parse_args()
    main(given.results.resolve(), given.out, given.verbs)
