"""Evidence by nested sampling beside that of the search, which takes Laplace's approximation of it.

For each record its likeliest single explanations as fitted: the same data, nuisances and priors (flat in the
logarithm of the size in the data for strengths, flat over the bounds for shapes; `discover.fit.evidence`),
but the integral over strengths and shapes by nested sampling (dynesty: J. S. Speagle, Mon. Not. R. Astron.
Soc. 493, 3132, 2020), every point simulated, the nuisances at their best for it; a row for each explanation.

    python workflow/bench/nested.py RECORD… --out table.csv     (or: make nested)

With `--live 40 --most 1`, of the likeliest explanation and with twice the variance, it takes a fifth of it.
"""

import argparse
import math
import time
from pathlib import Path

import numpy as np

from sonicvacuum import records
from sonicvacuum.blas import one_thread
from sonicvacuum.discover import session
from sonicvacuum.discover.draws import pareto_k
from sonicvacuum.discover.fit.evidence import STRONG, WEAK, log_bayes
from sonicvacuum.discover.posterior import Around, proposed
from sonicvacuum.tables import write_csv

LIVE, SEED = 80, 20061018
# Explanations less likely than the best by more than this (natural logarithm) decide nothing.
AWAY, MOST = 7.0, 3
COLUMNS = (
    "record",
    "effect",
    "dimensions",
    "log_laplace",
    "log_nested",
    "error",
    "calls",
    "pareto_k",
    "cpu_s",
)


class Prior:
    """From the unit cube to the coordinates of a fit, whose strengths grow as their size in the data does.

    Args:
        one: fit.
        gain: its Δχ², the square of that size.
    """

    def __init__(self, one, gain: float):
        self.coordinates, self.u = one.hypothesis.coordinates, one.u
        self.size = math.sqrt(max(gain, WEAK))

    def __call__(self, cube: np.ndarray) -> np.ndarray:
        return np.array([self._value(k, x) for k, x in enumerate(cube)])

    def _value(self, k, x):
        c = self.coordinates[k]
        if not c.parameter.switches or c.parameter.known:
            return c.low + x * (c.high - c.low)
        sign, x = (
            (math.copysign(1.0, x - 0.5), abs(2.0 * x - 1.0)) if c.two_sided else (np.sign(self.u[k]), x)
        )
        relative = WEAK * (STRONG / WEAK) ** x / self.size
        return self.u[k] + math.log(relative) if c.endless else sign * abs(self.u[k]) * relative


def sampled(forward, null, one, gain: float, live: int = LIVE) -> tuple[float, float, int]:
    """Logarithm of the Bayes factor against the nominal model, its error, and how often was simulated.

    `live` points are followed at a time; the error goes as one over their root.
    """
    from dynesty import NestedSampler  # in the environment of `make bench` only

    prior, around = Prior(one, gain), Around(forward, one)
    low, high = np.array([(c.low, c.high) for c in one.hypothesis.coordinates]).T

    def gained(u):
        inside = np.all((u >= np.minimum(low, one.u)) & (u <= np.maximum(high, one.u)))
        value = around.log_posterior(u[None])[0] if inside else -np.inf
        return max(float(value + 0.5 * null.objective), -1e10)

    state = np.random.Generator(np.random.PCG64(np.random.SeedSequence(SEED)))
    # The first bound early: the cube is wide beside where the likelihood is.
    early = {"min_ncall": 2 * live, "min_eff": 60.0}
    sampler = NestedSampler(
        gained, prior, len(one.u), nlive=live, bound="multi", sample="unif", rstate=state, first_update=early
    )
    sampler.run_nested(dlogz=0.05, print_progress=False)
    found = sampler.results
    return float(found.logz[-1]), float(found.logzerr[-1]), int(np.sum(found.ncall))


@one_thread
def rows(folder: Path, live: int = LIVE, most: int = MOST):
    """The rows of one record, of so many of its likeliest explanations."""
    found = session.discover(records.read(folder), threads=1).found
    if not found.candidates:
        return
    best = max(c.log_bayes for c in found.candidates)
    likely = [c for c in found.candidates if c.log_bayes > best - AWAY and len(c.fit.u)]
    for c in sorted(likely, key=lambda c: -c.log_bayes)[:most]:
        begun = time.process_time()
        laplace = log_bayes(c.fit, c.gain)
        value, error, calls = sampled(found.forward, found.null, c.fit, c.gain, live)
        u, density = proposed(c.fit)
        weight = Around(found.forward, c.fit).log_posterior(u) - density
        k = pareto_k(np.exp(weight - weight.max()))
        spent = time.process_time() - begun
        numbers = (f"{x:.4g}" for x in (laplace, value, error))
        yield folder.name, c.effect, len(c.fit.u), *numbers, calls, f"{k:.3g}", f"{spent:.3g}"


def main() -> None:
    """The table, a row at a time."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--live", type=int, default=LIVE, help="points that are followed at a time")
    parser.add_argument("--most", type=int, default=MOST, help="explanations of each record")
    asked = parser.parse_args()
    made = []
    for folder in asked.records:
        for row in rows(folder, asked.live, asked.most):
            made.append(row)
            print(*row, flush=True)
            write_csv(asked.out, COLUMNS, made)


if __name__ == "__main__":
    main()
