"""What each effect of the catalogue costs, and what composing laws costs those who use none."""

import statistics
import time

import numpy as np
from numba import njit
from problems import INTERVAL, PROBLEMS, STEP

from sonicvacuum.effects import CATALOGUE, Setup
from sonicvacuum.physics import run
from sonicvacuum.physics.lanes import LANES, power_3_2
from sonicvacuum.physics.laws import LawSet
from sonicvacuum.physics.methods import BLANES_MOAN, CARPENTER_KENNEDY
from sonicvacuum.physics.run import simulate
from sonicvacuum.physics.table import INVERSE_MASS, OPTIONS, REST, Composition, U, V, get, put

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


@njit(**OPTIONS)
def _bare_kernel(c, table, step, steps):
    """Verlet on Hertz contacts with nothing to choose: what the composed stepper is held against."""
    bodies = table.shape[1] - 1
    for g in range(table.shape[0]):
        first = g * (bodies + 1)
        for _ in range(steps):
            speed = get(c, table, first, V)
            x = get(c, table, first, U) + step * speed
            force_before = speed - speed
            for body in range(first, first + bodies):
                ahead_speed = get(c, table, body + 1, V)
                ahead = get(c, table, body + 1, U) + step * ahead_speed
                force = get(c, table, body, REST) * power_3_2(x - ahead)
                put(c, table, body, U, x)
                put(
                    c,
                    table,
                    body,
                    V,
                    speed + step * get(c, table, body, INVERSE_MASS) * (force_before - force),
                )
                force_before = force
                x = ahead
                speed = ahead_speed


def composed_over_bare(method):
    """Time of the engine's stepper over that of one without choices: same table, beads and passes."""
    p = PROBLEMS["P3"]
    stages = len(method.second)
    front, run.FRONT = run.FRONT, -1.0  # all beads from the start
    try:
        batch = run._Batch(p.chain, LawSet(), 22, (12,), 2, p.duration, stages * STEP, 1.0, False)
    finally:
        run.FRONT = front
    table, clock, cursor = batch.table.copy(), batch.clock.copy(), batch.cursor.copy()
    composition = Composition(LawSet(), LANES)

    def composed():
        batch.table[:], batch.clock[:], batch.cursor[:] = table, clock, cursor
        batch.run(method, 1)

    def bare():
        batch.table[:] = table
        _bare_kernel(composition, batch.table, STEP, p.steps)

    composed()
    bare()
    ratios = []
    for _ in range(4 * ROUNDS):
        start = time.perf_counter()
        composed()
        middle = time.perf_counter()
        bare()
        ratios.append((middle - start) / (time.perf_counter() - middle))
    return statistics.median(ratios)
