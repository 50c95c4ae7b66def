"""One effect fitted alone: where its fits begin, how long they are followed, and what the best one is worth
as an explanation.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.fit.evidence import Candidate, log_bayes
from sonicvacuum.discover.fit.refit import Fit, Starts, fit
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.search.screen import Screen
from sonicvacuum.discover.search.starts import kept, setup_of, starts_of
from sonicvacuum.effects import Effect

# Beyond this misfit of the nominal model (in χ²) its slopes may point the wrong way: whole ranges are
# searched.
NONLINEAR = 1500.0
# Steps of a search, and of those on running integrals before.
ITERATIONS, COARSE = 14, 6
# Other strengths of an effect that weigh less than this below the best (natural log) do not explain the data.
INSTEAD = 7.0


@dataclass(frozen=True)
class Effort:
    """How an effect is searched: `grid` adds starts over the whole range to those of the screen; all are
    followed for so many `steps`, on integrals of the traces for `coarse` steps before. `halved` and `finish`:
    see `fit`; without `finish` those with a shape are finished all the same, if `shapes` are. These are
    followed for `shaped` steps at least: their last steps take longer than all others, and would have to be
    taken again. So many are followed as `keep` says, where it does.
    """

    grid: bool
    steps: int
    coarse: int = 0
    halved: int = 0
    finish: bool = True
    shapes: bool = True
    shaped: int = 0
    keep: int = 0


def begun(forward, null: Fit, scores: Screen, effect: Effect, effort: Effort):
    """[(coordinates, starts)] of every set of strengths of an effect from which it is fitted."""
    found = []
    for free in variants(effect, setup_of(forward)):
        u, places, nu = starts_of(forward, null, scores, effect, free, effort.grid)
        if len(u):
            found.append((free, Starts(u, nu, places)))
    return found


def candidate(forward, null: Fit, scores: Screen, effect: Effect, effort: Effort, near=None):
    """The best fit of one effect over its places, shapes and sets of strengths; None where nothing fits.

    `near`: starts, as `begun` has them where they are not given.
    """
    found: list[tuple[float, Fit, float]] = []
    options = variants(effect, setup_of(forward))
    for free, one in begun(forward, null, scores, effect, effort) if near is None else near:
        u, nu, places = one.u, one.nu, one.places
        hypothesis = Hypothesis((Component(effect, free),))
        keep = effort.keep or kept(effect, free, effort.grid)
        # The evidence of a shape asks for its error, and so for slopes to second order.
        shaped = effort.shapes and any(c.parameter.known or not c.parameter.switches for c in free)
        steps = max(effort.steps, effort.shaped * shaped)
        how = (keep, steps, effort.coarse, effort.halved)
        one = fit(forward, hypothesis, u, nu, places, *how, finish=effort.finish or shaped)
        if not np.isfinite(one.objective):
            continue
        gain = null.objective - one.objective
        # Far away the screen is not asked about shapes, unless one is at a bound, where widths mean nothing.
        trusted = not effort.grid or effect.places or one.at_bound().any()
        alike = by_direction(scores, effect, gain) if trusted else None
        found.append((log_bayes(one, gain, alike), one, gain))
    if not found:
        return None
    (log, one, gain), *others = sorted(found, key=lambda f: -f[0])
    total = float(np.logaddexp.reduce([f[0] for f in found]) - np.log(len(options)))
    flags = ("bound",) * bool(one.at_bound().any()) + ("unsettled",) * (not one.settled)
    instead = tuple((other - log, way) for other, way, _ in others if other > log - INSTEAD)
    return Candidate(effect.id, one, gain, total, flags, instead)


def by_direction(scores: Screen, effect: Effect, gain: float):
    """(n,) Δχ² at each place and shape as the screen predicts it, shifted so that the best has `gain`."""
    squares = np.array(
        [np.square(z) for d, z in zip(scores.directions, scores.z, strict=True) if d.effect == effect.id]
    )
    return np.maximum(squares - squares.max() + gain, 0.0) if len(squares) > 1 else None


def bends(effect: Effect) -> bool:
    """Whether slopes at off tell little of an effect."""
    return any(p.bends for p in effect.parameters)
