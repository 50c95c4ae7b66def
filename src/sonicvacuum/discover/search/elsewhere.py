"""Effects tried, and followed, from all over their range and all along the chain, where all that was found
leaves much: slopes and running integrals may have led to another minimum.
"""

import numpy as np

from sonicvacuum.discover.fit import unequal, wide
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.places import settled
from sonicvacuum.discover.fit.refit import Fit, Starts, fit
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.accuracy import bent
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, of_one_strength, variants
from sonicvacuum.discover.search import restart, secants
from sonicvacuum.discover.search.candidates import COARSE, ITERATIONS, NONLINEAR, Effort, bends, candidate
from sonicvacuum.effects import Setup

# Where what was found gains as much as this, and leaves more than noise does, in standard deviations, trials
# of finite strength that promise this share of what the best one has gained are followed.
GAINS, LEAVES, PROMISING = 50.0, 0.5, 0.3
# Far from the data, where all effects leave more than this share of the misfit, starts may have been missed:
# pulses that miss each other lead nowhere. Trials then at each place, and starts of them that are followed.
MISSED, TRIALS = 0.05, 12
# Where more than this is left, in standard deviations of what noise leaves, effects whose slopes bend are
# followed from all over their range: four times as many for the first steps as to the end.
RUGGED, RUGGED_STEPS, RUGGED_KEPT = 1.5, 3, 24


def once_more(forward, null, found, setup):
    """The same with effects at one bead or contact searched densely, and along the chain, where all that was
    found leaves much.
    """
    excess, rest = left(forward, null, found)
    if rest < max(NONLINEAR, MISSED * excess):
        return found

    def denser(branch, c):
        one = _densely(branch, null, c.fit.hypothesis.components[0], setup)
        if one is None or not one.objective < c.fit.objective:
            return c
        return restart.alone(null, one, c, ("bound",) * bool(one.at_bound().any()))

    def inside(c):
        component = c.fit.hypothesis.components[0]
        return component.effect.places in secants.PLACES and of_one_strength(component.free)

    rest = [c for c in found if not inside(c)]
    return rest + abreast.each(forward, denser, [c for c in found if inside(c)], "effects at one place")


def all_over(forward, null, scores, found, effects, setup):
    """The same with effects of one strength all along the chain tried all over its range, where all that was
    found leaves more than noise: slopes and running integrals may lead to another minimum. Followed are those
    of which a trial promises more than they have gained, and a share of what the best has.
    """
    excess, rest = left(forward, null, found)
    noise, best = np.sqrt(2.0 * data(forward)), excess - rest
    if best < GAINS or rest < max(LEAVES * noise, MISSED * excess):
        return found
    gains = {c.effect: c.gain for c in found}

    def elsewhere(branch, effect):
        near, least = [], max(PROMISING * best, gains.get(effect.id, 0.0))
        for free in filter(of_one_strength, variants(effect, setup)):
            trials = _trials(branch, null, Component(effect, free), setup)
            if trials and trials[0].gain >= least:
                u, nu, at = (np.array(x) for x in zip(*((t.u, t.nu, [t.place]) for t in trials), strict=True))
                near.append((free, Starts(u, nu, at if effect.places else None)))
        return candidate(branch, null, scores, effect, Effort(True, ITERATIONS), near)

    more = abreast.each(forward, elsewhere, [e for e in effects if not secants.local(e)], "effects all over")
    return _better(found, more)


def rugged(forward, null, scores, found, effects, setup):
    """The same with effects whose slopes bend followed from all over their range, beside nuisances as stated,
    where all that was found leaves more than noise, or one of them leads: beads that meet once more move
    otherwise at a little more of it, so that minima are narrow, and nuisances that do the work of an effect
    lead to none of them.
    """
    explained = left(forward, null, found)[1] < RUGGED * np.sqrt(2.0 * data(forward))
    if explained and not (bent(forward.experiment) and _leading_bends(found)):
        return found
    effort = Effort(True, ITERATIONS, halved=RUGGED_STEPS, keep=RUGGED_KEPT)

    def closely(branch, effect):
        near = []
        for free in filter(of_one_strength, variants(effect, setup)):
            strength, *shapes = free
            middle = [c.starts()[len(c.starts()) // 2] for c in shapes]
            rows = [([u, *middle], nu) for u in strength.closely() for nu in wide.minima(branch, null)]
            near.append((free, Starts(*(np.array(x) for x in zip(*rows, strict=True)))))
        return candidate(branch, null, scores, effect, effort, near)

    asked = [e for e in effects if e.places is None and bends(e)]
    return _better(found, abreast.each(forward, closely, asked, "effects that bend"))


def _leading(found):
    """The effect that gains most, None where nothing was found."""
    return max(found, key=lambda c: c.gain, default=None)


def _leading_bends(found):
    leading = _leading(found)
    return leading is not None and bends(leading.fit.hypothesis.components[0].effect)


def past_minima(forward, null, found):
    """The same with the leading effect followed past the nearest of many minima, where beads that differ part
    and meet again, and it explains nearly all but leaves more than noise; all others from where its nuisances
    are then.
    """
    noise, (excess, rest) = wide.noise(forward), left(forward, null, found)
    leading = _leading(found)
    if leading is None or leading.fit.objective <= noise or rest > MISSED * excess:
        return found
    lowest = unequal.lower(forward, leading.fit, noise)
    if lowest is leading.fit:
        return found

    def beside(branch, c):
        one = lowest
        if c is not leading:
            one = fit(branch, c.fit.hypothesis, c.fit.u, lowest.nu, iterations=ITERATIONS)
        if not one.objective < c.fit.objective:
            return c
        return restart.alone(null, one, c, ("bound",) * bool(one.at_bound().any()))

    return abreast.each(forward, beside, found, "past the nearest minima")


def _better(found, more):
    """The better candidate of each effect."""
    best = {c.effect: c for c in found}
    for c in more:
        if c is not None and (c.effect not in best or c.gain > best[c.effect].gain):
            best[c.effect] = c
    return list(best.values())


def left(forward, null, found):
    """χ² that the nominal model leaves beyond the noise, and what the best of single effects leaves of it."""
    excess = null.objective - data(forward)
    return excess, excess - max((c.gain for c in found), default=0.0)


def _trials(forward, null: Fit, component: Component, setup: Setup) -> list[secants.Secant]:
    """The best trials of finite strength all over an effect's range, best first."""
    return secants.tried(forward, null, component, setup, TRIALS, secants.finely(component.free[0]))


def _densely(forward, null: Fit, component: Component, setup: Setup) -> Fit | None:
    """The best fit of an effect with a place, from trials of finite strength all over; None without any."""
    trials = _trials(forward, null, component, setup)
    if not trials:
        return None
    u, nu, at = (np.array(x) for x in zip(*((t.u, t.nu, [t.place]) for t in trials), strict=True))
    twice = [np.concatenate(pair) for pair in ((u, u), (nu, 0.0 * nu), (at, at))]
    one = fit(forward, Hypothesis((component,)), *twice, TRIALS, ITERATIONS, COARSE)
    return settled(forward, one, setup)
