"""Spikes that a pulse hides: samples that stand out of what a model with effects leaves.

In a trace a spike has to stand out by more than its neighbours differ, and on the flank of a strong pulse
these differ by many standard deviations. What the right model leaves there is noise, and spikes.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.fit.goodness import goodness, outliers
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.masks import SPIKE_SIGMAS
from sonicvacuum.discover.policy import MISFIT
from sonicvacuum.discover.search.unknown import raw

# What a wrong model leaves is as smooth as its pulses: neither neighbour of a spike, nor both of the samples
# beyond them, are off by such a share of it.
SMOOTH = 0.4
# Where nothing but single samples is left, those count from so many standard deviations on, larger than
# both neighbours: what smooth misfits leave is never one sample, and the test that has failed counts these.
FAINT, FAINT_SMOOTH = 4.0, 0.6
# p of the outliers of a trace below which its own tails are heavy.
HEAVY = 0.05
# (run id, gauge id) → (T,) what a model leaves, in standard deviations of the noise, 0 but for spikes.
Strays = dict[tuple[str, str], np.ndarray]


def strays(forward: Forward, fit: Fit, faint: bool = False) -> Strays:
    """Samples that stand out of what a fit leaves, by trace; traces without any are left out. With `faint`
    also those that are no larger than what heavy tails of the noise make.
    """
    e, found = forward.experiment, {}
    for run, read in zip(e.runs, raw(forward, fit), strict=True):
        for s, gauge in enumerate(e.gauges if run.has_signals else ()):
            there = np.ones(len(run.time), dtype=bool) if run.present is None else run.present[s]
            left = np.zeros(len(run.time))
            own = (run.readings[s] - read[s])[there] / e.sigma[s]
            left[there] = standing_out(own, faint and outliers(own) < HEAVY)
            if left.any():
                found[run.id, gauge.id] = left
    return found


def standing_out(left: np.ndarray, faint: bool = False) -> np.ndarray:
    """(T,) what a model leaves, (T,) in standard deviations of the noise, 0 in place of all but spikes.

    Two spikes with a sample between them are told as well: one side of each is as small as it should be.
    """
    least, smooth = (FAINT, FAINT_SMOOTH) if faint else (SPIKE_SIGMAS, SMOOTH)
    size = np.abs(left)
    around = np.pad(size, 2)
    near = np.maximum(around[1:-3], around[3:-1])
    if not faint:
        near = np.maximum(near, np.minimum(around[:-4], around[4:]))
    return np.where((size > least) & (near < smooth * size), left, 0.0)


def single_samples(forward: Forward, fit: Fit) -> bool:
    """Whether nothing but samples far beyond the noise is left of a fit, by the tests of its goodness."""
    p = goodness(forward, fit).tests
    # Values without traces have no samples.
    return p.get("outliers", 1.0) < MISFIT and all(
        one >= MISFIT for name, one in p.items() if name != "outliers"
    )


def masked(bench: Bench, found: Strays) -> Bench:
    """A record in which these samples do not count either."""
    rows = {at: left != 0.0 for at, left in found.items()}
    return replace(bench, lost=bench.lost | {at: r | bench.lost.get(at, False) for at, r in rows.items()})


def told(findings: list[Finding], found: Strays) -> list[Finding]:
    """Findings with these samples among the spikes of each trace."""
    known = {(f.run, f.sensor): f.value or 0.0 for f in findings if f.fault == "spikes"}
    count: dict[tuple[str | None, str], float] = {}
    for (run, gauge), left in found.items():
        # Where spikes are told of in all runs of a gauge they are counted together.
        at = (None, gauge) if (None, gauge) in known else (run, gauge)
        count[at] = count.get(at, known.get(at, 0.0)) + np.count_nonzero(left)
    kept = [f for f in findings if f.fault != "spikes" or (f.run, f.sensor) not in count]
    return kept + [Finding("spikes", *at, float(n), policy.PLAIN, corrected=True) for at, n in count.items()]
