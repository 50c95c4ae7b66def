"""What each effect of the catalogue costs."""

import statistics
import time

import numpy as np
from problems import INTERVAL, PROBLEMS, STEP

from sonicvacuum.effects import CATALOGUE, Setup
from sonicvacuum.physics.methods import BLANES_MOAN, CARPENTER_KENNEDY
from sonicvacuum.physics.run import simulate

CHAINS = 200
ROUNDS = 5
COLUMNS = ["effect", "stepper", "ns_per_contact_and_stage", "ratio_same_stepper", "ratio_default_run"]


def _median(run):
    run()
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def _seconds(chain, **options):
    p = PROBLEMS["P3"]
    return _median(lambda: simulate(chain, [p.contact], p.duration, INTERVAL, **options))


def _per_stage(chain, symplectic):
    """Nanoseconds per contact, stage and chain at a given step."""
    method = BLANES_MOAN if chain.laws(symplectic).splits else CARPENTER_KENNEDY
    stages = len(method.second) * round(PROBLEMS["P3"].duration / (5 * STEP))
    seconds = _seconds(chain, step=5 * STEP, symplectic=symplectic)
    return seconds / (stages * (chain.beads + 1) * chain.lanes) * 1e9


def measure_effects():
    """Rows of bench_effects.csv: each effect at its typical strength, in `CHAINS` chains."""
    bare = PROBLEMS["P3"].chain.take(np.linspace(0, 999, CHAINS).astype(int))
    base = {splits: _per_stage(bare, splits) for splits in (True, False)}
    default = _seconds(bare)
    rows = [["none", "splitting", base[True], 1.0, 1.0]]
    rows += [["none", "Runge–Kutta", base[False], 1.0, _seconds(bare, symplectic=False) / default]]
    for effect in CATALOGUE:
        if effect.places == "sensor" or effect.id.startswith("sensor"):
            continue
        setup = Setup(bare)
        values = {p.name: p.at(1.0, setup) for p in effect.parameters}
        if effect.places:
            values[effect.places] = effect.candidates(setup)[0]
        chain = effect.apply(setup, **values).chain
        splits = chain.laws().splits
        cost = _per_stage(chain, True)
        name = "splitting" if splits else "Runge–Kutta"
        rows.append([effect.id, name, cost, cost / base[splits], _seconds(chain) / default])
    return rows
