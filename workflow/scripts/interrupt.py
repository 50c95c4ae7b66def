"""Every verb that works for a while, interrupted from the keyboard at several moments of its work.

Commands are those that a finished run was made with, one of each rule by its provenance.json, and verbs that
stand in no rule. Each is started in a copy of that run and interrupted once it has used so much time of a
processor: during imports, compilation (with an empty cache of compiled code), kernels, drawing. Moments are
counted in processor time, so that they lie in the same work on any machine. Prints and writes one row a
command; exit code 1 where one told a traceback, ended otherwise than interrupted, or left anything changed.
"""

import argparse
import csv
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from reproduce import equal

ROOT = Path(__file__).resolve().parents[2]
MOMENTS = (0.1, 0.3, 0.6, 1.0, 2.0, 4.0, 8.0, 16.0)
COMPILING = (1.5, 4.0, 8.0, 16.0)
COLUMNS = ("command", "cache", "moments", "longest_s", "longest_cpu_s", "ended_by_itself", "exits", "faults")
TICK = os.sysconf("SC_CLK_TCK")
CODES = (130, -signal.SIGINT)

STEEL = "--diameter 5mm --material bearing-steel --speed 0.5"
MEASURED = "workflow/resources/measured/daraio-nesterenko-2006"
STUDY = "--truth results/blind/small/truth --verdicts results/blind/small/verdicts"
MADE = "--records made/records --truth made/truth"
TABLES = "--out made/rows.csv --summary made/summary.csv"
# Compile the most, and work with another engine each.
COMPILED = ("simulate", "predict", "discover_hidden")
OTHERS = {
    "predict": f"predict --beads 400 {STEEL} --gauges 100,wall --out made/shown.svg",
    "design": f"design --effects kuwabara-kono,gravity --beads 12 {STEEL} --most 3 --out made/design.svg",
    "record check": "record check results/blind/small/records/0/*",
    "record import": "record import docs/example/shot1.csv --record docs/example/chain.yaml --impact-at 0us "
    "--channel CH1=g5 --channel CH2=g11 --channel CH3=wall --scale g5=25N/V --scale g11=25N/V "
    "--scale wall=50N/V --out made/scope",
    "page (verdict)": f"page results/discover/{Path(MEASURED).name}-coated",
    "compare": f"compare {MEASURED}-coated --model results/discover/{Path(MEASURED).name}-coated/model.json "
    "--json made/score.json",
    "export": "export --law hunt-crossley --damping_s_per_m 0.1 --mass_g 4 --diameter_mm 10 --material brass "
    "--speeds 0.5 2 --to all --out made/law.txt",
    "blind slips": f"blind slips --batch 0/30 {MADE}",
    "blind extras": f"blind extras --batch 0/30 {MADE}",
    "blind baselines": f"blind baselines --records results/blind/small/records {STUDY} "
    "--rule best-chi2 --rule bic --rule nearest-shape --out made/rules.csv",
    "blind calibrate": f"blind calibrate {STUDY} --out made/calibration.json",
    "blind follow": "blind follow --study small --verdicts results/blind/small/verdicts/0 --batch 0/4 "
    "--choice proposed --records made/further",
    "blind draw": "blind draw results/blind/small --picture confusion --out made",
    "blind publish": "blind publish workflow/resources/reference/blind_full --page docs/study.md "
    "--keep made/kept",
    "blind ideal": "blind ideal --study small --batch 0/4 --out made/ideal.csv",
    "blind tables": "blind tables results/blind/small --out made/tables",
    "paper timings": "paper timings results/benchmarks --out results/benchmarks.csv",
    "paper publish": "paper publish --ledger results/ledger.csv --claims workflow/resources/claims.csv "
    "--readme README.md --guide figures/README.md --reference made/kept.csv "
    "--study results/blind/small/score.csv --naming made/naming.csv",
}


def commands(finished: Path) -> dict[str, str]:
    """Name → command without where its output goes: one of each rule of a finished run, then the others."""
    found: dict[str, str] = {}
    for path in sorted(finished.rglob("provenance.json")):
        for made in json.loads(path.read_text(encoding="utf-8"))["files"].values():
            line = re.sub(r"\s2?> .*$", "", made.get("command") or "")
            if line.startswith("sonicvacuum "):
                # Rules that differ in a number differ in their cards alone.
                rule = re.sub(r"_\d+$", "", made["rule"])
                found.setdefault(rule, line.removeprefix("sonicvacuum "))
    return found | OTHERS


def project(folder: Path, results: Path) -> Path:
    """A folder with a finished run, which every command finds what it reads in."""
    folder.mkdir(parents=True)
    for part in ("config.yaml", "requirements.lock", "requirements-build.lock", "README.md"):
        shutil.copy2(ROOT / part, folder / part)
    for part in ("docs", "figures", "workflow"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(results, folder / "results")
    return folder


def state(folder: Path) -> dict[Path, tuple]:
    """File → what changes where it is written."""
    found = {path: path.stat() for path in folder.rglob("*") if path.is_file()}
    return {path: (s.st_ino, s.st_size, s.st_mtime_ns) for path, s in found.items()}


def used(number: int) -> float:
    """Seconds of a processor that a process has used."""
    words = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / TICK


def runs(number: int) -> bool:
    """Whether a child still runs; one that has ended can be waited for afterwards."""
    return os.waitid(os.P_PID, number, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None


def hears() -> None:
    """Let a process hear interruptions as one that was started at a terminal."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def interrupted(folder: Path, line: str, moment: float, environment: dict) -> dict:
    """One start, interrupted after `moment` s: whether it still ran, code, seconds to its end, its words."""
    with tempfile.TemporaryFile("w+") as told:
        process = subprocess.Popen(
            ["bash", "-c", f"exec {sys.executable} -m sonicvacuum {line}"],
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=told,
            start_new_session=True,
            preexec_fn=hears,
        )
        spent = 0.0
        while spent < moment and runs(process.pid):
            time.sleep(0.01)
            spent = used(process.pid)
        running = runs(process.pid)
        asked = time.monotonic()
        if running:
            os.killpg(process.pid, signal.SIGINT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall, cpu = time.monotonic() - asked, usage.ru_utime + usage.ru_stime - spent
        told.seek(0)
        said = told.read()
    return {"running": running, "code": process.returncode, "wall": wall, "cpu": cpu, "said": said}


def faults(result: dict, changed: list[str]) -> list[str]:
    """What is wrong with one start that was interrupted."""
    found = [f"changed {path}" for path in changed]
    if "Traceback" in result["said"] or "Exception ignored" in result["said"]:
        found.append(f"traceback: {result['said'].strip().splitlines()[-1]}")
    if result["running"] and result["code"] not in (*CODES, 0):
        found.append(f"exit {result['code']}: {result['said'][-200:]}")
    return found


def changes(folder: Path, before: dict[Path, tuple], kept: Path) -> list[str]:
    """Files that an interrupted command left otherwise than they were, or half-written; all is put back.

    A file made again with the same content is no change; a whole new product beside others is none either.
    """
    after, found = state(folder), []
    for path in sorted(before.keys() | after.keys()):
        place = path.relative_to(folder)
        if path not in after or (path in before and before[path] != after[path]):
            if path not in after or not equal(path, kept / place):
                found.append(f"{place}")
            path.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(kept / place, path)
        elif path not in before:
            if path.name.startswith(".") or path.name.endswith(".partial"):
                found.append(f"{place}")
            path.unlink()
    shutil.rmtree(folder / "made", ignore_errors=True)
    return found


def renewed(folder: Path, line: str, kept: Path, environment: dict) -> None:
    """Let a command make its products anew, undisturbed: the finished run may be of other sources."""
    before = state(kept)
    interrupted(kept, line, math.inf, environment)
    after = state(kept)
    shutil.rmtree(kept / "made", ignore_errors=True)
    for path in sorted(path for path in after if path.exists() and before.get(path) != after[path]):
        shutil.copy2(path, folder / path.relative_to(kept))


def row(name: str, line: str, folder: Path, kept: Path, moments, cache: Path | None = None) -> dict:
    """One command at all its moments, until it ends by itself before one.

    Args:
        name, line: of the command.
        folder, kept: a finished run to work in, and the same untouched.
        moments: in seconds of a processor.
        cache: folder of compiled code to be emptied before each start; None for the user's.
    """
    environment = os.environ | ({"SONICVACUUM_CACHE_DIR": str(cache)} if cache else {})
    results, wrong = [], []
    for moment in moments:
        if cache:
            shutil.rmtree(cache, ignore_errors=True)
        before = state(folder)
        result = interrupted(folder, line, moment, environment)
        if changed := changes(folder, before, kept):
            renewed(folder, line, kept, environment)
            before = state(folder)
            result = interrupted(folder, line, moment, environment)
            changed = changes(folder, before, kept)
        wrong += [f"at {moment} s: {fault}" for fault in faults(result, changed)]
        if not result["running"]:
            if result["code"]:
                wrong.append(f"failed without an interruption: {result['said'][-300:]}")
            break
        results.append(result)
    values = (
        name,
        "empty" if cache else "filled",
        len(results),
        round(max((r["wall"] for r in results), default=0.0), 2),
        round(max((r["cpu"] for r in results), default=0.0), 2),
        len(results) < len(moments),
        " ".join(sorted({str(r["code"]) for r in results})),
        "; ".join(wrong),
    )
    return dict(zip(COLUMNS, values, strict=True))


def main() -> int:
    """The table; 1 where an interruption did harm."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=Path, default=Path("results"), help="Of a finished run.")
    parser.add_argument("--only", nargs="*", help="Commands, by name.")
    parser.add_argument("--out", type=Path, required=True)
    asked = parser.parse_args()
    lines = {
        name: line for name, line in commands(asked.results).items() if not asked.only or name in asked.only
    }
    asked.out.parent.mkdir(parents=True, exist_ok=True)
    failed = 0
    with tempfile.TemporaryDirectory() as name, open(asked.out, "w", newline="") as stream:
        place = Path(name).resolve()
        folder, kept = (project(place / part, asked.results) for part in ("work", "kept"))
        table = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        table.writeheader()
        trials = [(n, line, MOMENTS, None) for n, line in lines.items()]
        trials += [(n, lines[n], COMPILING, place / "cache") for n in COMPILED if n in lines]
        for command, line, moments, cache in trials:
            found = row(command, line, folder, kept, moments, cache)
            table.writerow(found)
            stream.flush()
            print(*found.values(), flush=True)
            failed += bool(found["faults"])
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
