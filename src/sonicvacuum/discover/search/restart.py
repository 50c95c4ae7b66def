"""Sets of effects fitted once more, from each of their effects at other strengths and places.

A joint fit starts where effects alone, or slopes, have put them, and may end in a minimum from which no slope
leads to the lower one. Here one effect of the set at a time is taken away and tried all over its range beside
the others, as `secants` does it. Single effects start again from pairs, less their other effect.
"""

from collections.abc import Sequence

import numpy as np

from sonicvacuum.discover.fit import bounds, evidence, refit
from sonicvacuum.discover.fit.evidence import Candidate, Combination
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.places import stronger
from sonicvacuum.discover.fit.refit import Fit, fit, polish
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis, of_one_strength, without
from sonicvacuum.discover.search import secants
from sonicvacuum.discover.search.secants import Secant
from sonicvacuum.effects import Setup

# Trials of an effect; the best ones, one at each place, that the joint fit starts from, and its steps. What a
# start leaves at first tells nothing: others have to follow an effect that moves far.
TRIALS, FOLLOWED, ITERATIONS = 60, 3, 12
# Strengths over the one found that a single effect is begun with beside another one's nuisances, if it gains
# no less than the leading one by more than this in χ².
AROUND, BESIDE = np.geomspace(0.5, 2.0, 7), 40.0
# A single effect is fitted anew where a pair leads it to a minimum that is lower by more than this.
LOWER = 6.0


def restarted(forward: Forward, one: Fit, setup: Setup) -> Fit:
    """The better of a fit of several effects and of one from each of them tried all over its range."""
    found = [one]
    for k in range(len(one.hypothesis.components)):
        trials = _trials(forward, one, k, setup)
        if trials:
            found.append(fit(forward, one.hypothesis, *put(one.hypothesis, k, trials), FOLLOWED, ITERATIONS))
    return min(found, key=lambda f: f.objective)


def _trials(forward, one, k, setup):
    """The best trials of effect k all over its range beside the others as they stand."""
    component = one.hypothesis.components[k]
    if not of_one_strength(component.free):
        return []
    beside = less(forward, one, k)
    if not np.isfinite(beside.objective):
        return []
    sizes = secants.finely(component.free[0])
    trials = secants.tried(forward, beside, component, setup, TRIALS, sizes)
    return (secants.one_a_place(trials) if component.effect.places else trials)[:FOLLOWED]


def put(
    hypothesis: Hypothesis, k: int, trials: Sequence[Secant]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(L, p) coordinates, (L, q) nuisances and (L, effects) places of a set with effect k as L trials put it,
    the others as they follow.
    """
    u = np.array([np.insert(t.beside, hypothesis.columns[k].start, t.u) for t in trials])
    places = np.tile([c.place or 0 for c in hypothesis.components], (len(trials), 1))
    places[:, k] = [t.place or 0 for t in trials]
    return hypothesis.inside(u), np.array([t.nu for t in trials]), places


def moved(forward: Forward, one: Fit, iterations: int = ITERATIONS) -> Fit:
    """A fit followed to its minimum in another view of the data, from where nuisances stand and from none.

    A misfit strains them, and strained they stand in the way once it counts as noise.
    """
    nu = np.stack([one.nu, 0.0 * one.nu])
    return fit(forward, one.hypothesis, np.repeat(one.u[None], 2, axis=0), nu, iterations=iterations)


def fewer(forward: Forward, null: Fit, one: Fit, k: int, iterations: int = refit.ITERATIONS) -> Fit:
    """The best fit without effect k, from where a fit stands; `null` where none is left."""
    if len(one.hypothesis.components) == 1:
        return null
    return moved(forward, less(forward, one, k), iterations)


def less(forward: Forward, one: Fit, k: int) -> Fit:
    """A fit with effect k taken away and all else as it stands."""
    hypothesis, u = without(one.hypothesis, one.u, k)
    return Fit(hypothesis, linearise(forward, hypothesis, u[None], one.nu[None]))


def promised(one: Fit) -> float:
    """The objective that slopes promise at the minimum."""
    gradient, hessian = one.normal.total()
    return one.objective - float(gradient[0] @ np.linalg.lstsq(hessian[0], gradient[0], rcond=1e-12)[0])


def lower(
    forward: Forward, null: Fit, found: list[Combination], singles: list[Candidate]
) -> list[Candidate] | None:
    """Single effects with those fitted anew that pairs, less their other effect, lead to lower minima; None
    where there are none.

    One that was never fitted alone, since slopes promised little of it, has to come out ahead of all others.
    """
    known = {c.effect: c for c in singles}
    least = min((c.fit.objective for c in singles), default=null.objective)
    better: dict[str, Candidate] = {}
    for pair in found:
        for k, name in enumerate(reversed(pair.fit.hypothesis.ids)):
            own = better.get(name, known.get(name))
            before = own.fit.objective if own else least
            if np.isinf(before):
                continue
            one = less(forward, pair.fit, k)
            if not one.normal.has_slopes[0] or promised(one) > before - LOWER:
                continue
            inside = polish(forward, one)
            one, held = bounds.beyond(forward, inside)
            if one.objective < before - LOWER:
                flags = ("beyond",) * (one is not inside) + ("bound",) * held
                better[name] = alone(null, one, own, flags)
    return [*(known | better).values()] if better else None


def beside_leading(forward: Forward, null: Fit, found: list[Candidate]) -> list[Candidate]:
    """Single effects of one strength along the chain, where nuisances as the leading effect leaves them lead
    to a lower minimum fitted anew: speeds and time zeros that make up for each other have several.
    """
    first = max(found, key=lambda c: c.gain)

    def anew(branch, c):
        strength = c.fit.hypothesis.coordinates[0]
        u = stronger(strength, c.fit.u, AROUND[:, None])
        nu = np.repeat(first.fit.nu[None], len(u), axis=0)
        one = fit(branch, c.fit.hypothesis, u, nu, keep=1, reach=c.fit.objective - LOWER)
        return alone(null, one, c) if one.objective < c.fit.objective - LOWER else c

    near = [c for c in found if c is not first and c.gain > first.gain - BESIDE and _of_one(c.fit.hypothesis)]
    better = dict(zip(map(id, near), abreast.each(forward, anew, near), strict=True))
    return [better.get(id(c), c) for c in found]


def _of_one(hypothesis: Hypothesis) -> bool:
    """Whether there is one parameter, and no place."""
    (component,) = hypothesis.components
    return len(component.free) == 1 and component.place is None


def led(null: Fit, one: Fit, singles: list[Candidate]) -> list[Candidate] | None:
    """Single effects with one that a search of sets has led to a lower minimum; None where it has not."""
    known = {c.effect: c for c in singles}
    (name,) = one.hypothesis.ids
    own = known.get(name)
    if own and not one.objective < own.fit.objective - LOWER:
        return None
    return [*(known | {name: alone(null, one, own)}).values()]


def alone(null: Fit, one: Fit, own: Candidate | None, flags: tuple[str, ...] = ()) -> Candidate:
    """A single effect as it is fitted now; `own` is what was known of it."""
    gain = null.objective - one.objective
    log_bayes = own.log_bayes + 0.5 * (gain - own.gain) if own else evidence.log_bayes(one, gain)
    (component,) = one.hypothesis.components
    flags += ("unsettled",) * (not one.settled)
    return Candidate(component.effect.id, one, gain, log_bayes, flags)
