"""Which strengths of an effect act in a set: a striker that is slower does nearly what a lighter one does.

A set is fitted with the strength that slopes, or the effect alone, promised; beside the others another may
explain more, and the one that is told then stands far from the truth. So each of the others is tried all over
its range in place of what the effect has, and all are free at last from where the best one stands.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.fit.evidence import log_bayes
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis, of_one_strength, variants
from sonicvacuum.discover.search import restart, secants
from sonicvacuum.effects import Setup

# Trials of a strength that a fit starts from, its steps, and how far behind in χ² it is of no interest.
TRIALS, ITERATIONS, BEHIND = 3, 12, 15.0


def several(one: Fit, setup: Setup) -> bool:
    """Whether some effect of a fit has several strengths."""
    return any(len(variants(c.effect, setup)) > 1 for c in one.hypothesis.components)


def settled(forward: Forward, null: Fit, one: Fit, setup: Setup) -> Fit:
    """The likeliest of a fit and of those with other strengths; `null` is the nominal model."""
    return max([one, *others(forward, one, setup)], key=lambda f: log_bayes(f, null.objective - f.objective))


def others(forward: Forward, one: Fit, setup: Setup) -> list[Fit]:
    """Fits of the same effects at their places with other strengths of one of them free.

    Args:
        forward: the predictor.
        one: a fit, followed to its minimum.
        setup: which knows what the effects may be.
    """
    found: list[Fit] = []
    for k, component in enumerate(one.hypothesis.components):
        ways = [w for w in variants(component.effect, setup) if _names(w) != _names(component.free)]
        beside = restart.less(forward, one, k) if ways else one
        if not np.isfinite(beside.objective):
            continue
        hypotheses = [_with(one.hypothesis, k, free) for free in ways]
        single = [h for h in hypotheses if of_one_strength(h.components[k].free)]

        def starts(branch, hypothesis, k=k, beside=beside):
            return _starts(branch, hypothesis.components[k], beside, setup)

        def fitted(branch, given, k=k):
            hypothesis, trials = given
            return _fitted(branch, one, hypothesis, restart.put(hypothesis, k, trials))

        trials = abreast.each(forward, starts, single, calls=abreast.SLOPES)
        fits = abreast.each(
            forward, fitted, [given for given in zip(single, trials, strict=True) if given[1]]
        )
        best = min([one, *fits], key=lambda f: f.objective)
        together = [h for h in hypotheses if h not in single]
        found += [*fits, *(_fitted(forward, one, h, _freed(h, k, best)) for h in together)]
    return [f for f in found if np.isfinite(f.objective)]


def _starts(forward, component, beside, setup):
    """The best trials of one strength all over its range beside the others as they stand."""
    at = None if component.place is None else (component.place,)
    return secants.tried(forward, beside, component, setup, TRIALS, secants.finely(component.free[0]), at)


def _fitted(forward, one, hypothesis, starts):
    return fit(forward, hypothesis, *starts, iterations=ITERATIONS, reach=one.objective + BEHIND)


def _freed(hypothesis, k, best):
    """(1, p) coordinates and (1, q) nuisances of a fit with more strengths of effect k, off at first."""
    own = dict(
        zip(_names(best.hypothesis.components[k].free), best.u[best.hypothesis.columns[k]], strict=True)
    )
    values = [own.get(name, 0.0) for name in _names(hypothesis.components[k].free)]
    rest = np.delete(best.u, np.arange(*best.hypothesis.columns[k].indices(len(best.u))))
    return hypothesis.inside(np.insert(rest, hypothesis.columns[k].start, values)[None]), best.nu[None]


def _with(hypothesis: Hypothesis, k: int, free) -> Hypothesis:
    """A hypothesis with other parameters of effect k free."""
    components = list(hypothesis.components)
    components[k] = replace(components[k], free=free)
    return Hypothesis(tuple(components))


def _names(free):
    return tuple(c.parameter.name for c in free)
