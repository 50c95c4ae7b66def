"""The search for what is missing in one record: with the engine, and with scipy's solver in its place.

The chains that one search simulates are counted and timed; a sample of them, effects and gravity left out,
is integrated by DOP853 at the tolerance that reaches the engine's accuracy. That is less work than the search
asks for, so that the time with scipy is a lower bound.
"""

import time
from dataclasses import dataclass, field

import numpy as np
from peers import dop853_chain

from sonicvacuum.discover.session import discover
from sonicvacuum.physics import run
from sonicvacuum_blind import hide, study

EFFECT, STRENGTH = "tsuji", 10.0
SAMPLE = 40
RTOL = 1e-8
COLUMNS = ["what", "value", "unit"]


@dataclass
class Spy:
    """Stands in for the engine: passes calls on, adds up their time and keeps what they asked for."""

    simulate: object
    seconds: float = 0.0
    asked: list = field(default_factory=list)

    def __call__(self, chain, contacts, duration, interval, **options):
        """As `physics.run.simulate`."""
        start = time.perf_counter()
        found = self.simulate(chain, contacts, duration, interval, **options)
        self.seconds += time.perf_counter() - start
        self.asked += [(chain, lane, duration, interval) for lane in range(chain.lanes)]
        return found


def record():
    """A record with one hidden effect, of four runs and three gauges."""
    for spec in study.cases("training"):
        if spec.kind == "single" and spec.effects == (EFFECT,) and spec.d_prime >= STRENGTH:
            made, truth = hide.hide(spec)
            if truth["runs"] == 4 and truth["gauges"] == 3:
                return made
    raise LookupError(f"no training case of four runs and three gauges hides {EFFECT} at d′ ≥ {STRENGTH:g}")


def through_scipy(asked):
    """Mean seconds of DOP853 for one of the chains that a search asked for."""
    times = []
    for k in np.linspace(0, len(asked) - 1, SAMPLE).astype(int):
        many, lane, duration, interval = asked[k]
        chain = many.take(np.array([lane]))
        bodies = chain.beads + 1
        stiffness, inverse = chain.stiffnesses(bodies)[:, 0], 1.0 / chain.masses(bodies)[:, 0]
        moments = np.arange(0.0, duration, interval)
        speed = float(np.ravel(chain.speed)[0])
        start = time.perf_counter()
        dop853_chain(stiffness, inverse, speed, moments, RTOL)
        times.append(time.perf_counter() - start)
    return float(np.mean(times))


def measure_inference():
    """Rows of bench_inference.csv."""
    data = record()
    # With one thread: what copies of the process simulate is not seen here.
    discover(data, threads=1)
    spy = Spy(run.simulate)
    run.simulate = spy
    try:
        begin = time.perf_counter()
        discover(data, threads=1)
        whole = time.perf_counter() - begin
    finally:
        run.simulate = spy.simulate
    chains, each = len(spy.asked), through_scipy(spy.asked)
    scipy = whole - spy.seconds + chains * each
    return [
        ["search, engine", whole, "s"],
        ["of it in the engine", spy.seconds, "s"],
        ["chains simulated", chains, ""],
        [f"scipy DOP853 at {RTOL:g}, one chain", each, "s"],
        ["search, scipy DOP853 in place of the engine, at least", scipy, "s"],
        ["ratio, at least", scipy / whole, ""],
    ]


def sentence(rows):
    """What the README says of it."""
    own, _, chains, _, scipy, ratio = (value for _, value, _ in rows)
    return (
        "\nA search for what is missing in a record of four runs and three gauges, on one core: "
        f"{own:.2g} s for {chains} chains; with scipy's DOP853 in place of the engine "
        f"at least {scipy:.0f} s, {ratio:.0f} times as long.\n"
    )
