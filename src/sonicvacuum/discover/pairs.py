"""Two effects together: which second effect the residual of each good single fit asks for, then both fitted
jointly.

The beam is wide (several singles, all effects beside each) because taking the best single first and adding
to it often starts from the wrong one.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover import directions, screen, secants, singles
from sonicvacuum.discover.evidence import Candidate, log_bayes
from sonicvacuum.discover.forward import Forward
from sonicvacuum.discover.hypothesis import Component, Hypothesis, is_law, variants
from sonicvacuum.discover.refit import Fit, fit, polish
from sonicvacuum.effects import Setup, effect

BEAM = 5
REFITTED = 6
ITERATIONS = 12


@dataclass(frozen=True)
class Pair:
    """Two effects as fitted: `gain` is Δχ² against the nominal model."""

    effects: tuple[str, str]
    fit: Fit
    gain: float
    log_bayes: float


def search(forward: Forward, null: Fit, candidates: list[Candidate]) -> list[Pair]:
    """The best pairs, best first."""
    setup = singles.setup_of(forward)
    asked: dict[frozenset, tuple[float, Candidate, screen.Screen, str]] = {}
    for first in candidates[:BEAM]:
        if first.gain <= 0.0:
            continue
        families = directions.catalogue(setup, first.fit.hypothesis.ids)
        scores = screen.screen(forward, first.fit, families)
        for second, k in scores.best().items():
            both = frozenset((first.effect, second))
            finite = secants.search(forward, first.fit, effect(second), setup, 1)
            more = max([float(np.square(scores.z[k])), *(one.gain for one in finite)])
            expected = first.gain + more
            if both not in asked or expected > asked[both][0]:
                asked[both] = (expected, first, scores, second)
    ranked = sorted(asked.values(), key=lambda a: -a[0])[:REFITTED]
    found = [p for a in ranked if (p := _refit(forward, null, setup, *a[1:]))]
    return sorted(found, key=lambda p: -p.log_bayes)


def _refit(forward, null: Fit, setup: Setup, first: Candidate, scores, second: str):
    """Both effects fitted jointly, from where the single fit and its screen point."""
    added = effect(second)
    best = scores.directions[scores.best()[second]].strength
    free = next(v for v in variants(added, setup) if v[0].parameter.name == best)
    u, places, nu = singles.starts(forward, first.fit, scores, added, free, False)
    if not len(u):
        return None
    u = np.column_stack([np.repeat(first.fit.u[None], len(u), axis=0), u])
    own = first.fit.hypothesis.components[0].place or 0
    if places is None:
        places = np.zeros((len(u), 1), dtype=int)
    places = np.column_stack([np.full(len(u), own), places])
    hypothesis = joined(first.fit.hypothesis, Component(added, free), setup)
    one = fit(forward, hypothesis, u, nu, places, keep=8, iterations=ITERATIONS)
    one = one if one.settled else polish(forward, one, ITERATIONS)
    if not np.isfinite(one.objective):
        return None
    gain = null.objective - one.objective
    order = (first.effect, second) if first.gain > 0.0 else (second, first.effect)
    return Pair(order, one, gain, log_bayes(one, gain) - _places(scores, first, added, setup))


def joined(hypothesis: Hypothesis, component: Component, setup: Setup) -> Hypothesis:
    """A hypothesis with one effect more; two force laws share the common law set."""
    laws = is_law(component.effect, setup) and any(is_law(c.effect, setup) for c in hypothesis.components)
    more = hypothesis.with_component(component)
    return Hypothesis(more.components, hypothesis.common or laws)


def _places(scores, first, added, setup):
    """Log of the number of places that both effects could have had."""
    counts = [len(e.candidates(setup)) for e in (effect(first.effect), added) if e.places]
    return float(sum(np.log(max(1, c)) for c in counts))
