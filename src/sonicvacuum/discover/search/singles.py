"""Every effect of the catalogue fitted alone: starts from the screen, and from a grid where the misfit is
large.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.evidence import Candidate, ranked
from sonicvacuum.discover.fit.refit import Fit, Starts, roughly
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis
from sonicvacuum.discover.search import elsewhere, secants
from sonicvacuum.discover.search.candidates import (
    COARSE,
    ITERATIONS,
    NONLINEAR,
    Effort,
    begun,
    bends,
    candidate,
)
from sonicvacuum.discover.search.screen import Screen
from sonicvacuum.discover.search.starts import (
    CLEAR,
    along,
    coordinates,
    kept,
    setup_of,
    strayed,
    within,
)
from sonicvacuum.effects import Effect

# Slopes may point the wrong way too where the nominal model leaves more than this, and no effect promises
# more than this share of it.
UNFORESEEN, FORESEEN = 1000.0, 0.6
# Effects whose predicted gain is this far behind the best, beyond the share by which slopes err, are not
# refitted while slopes can be trusted.
HOPELESS, ERR = 20.0, 0.2
# That share where all that were refitted leave much, or slopes did not foresee what the best one gains; of
# one at a bead or contact they often do not, which says less of others. And of effects whose slopes bend.
ERR_FAR, ERR_PLACED = 0.75, 0.5
# A nominal fit whose nuisances stand so many standard errors off does the work of what is missing with them.
STRAINED = 5.0
# A deviation that the screen puts beyond this many typical ones may lie where slopes do not reach.
FAR = 0.1
# Steps of the first search where all effects are followed and the best are polished later.
FIRST = 5
# After so many of these it shows which effects come near the data: those that are not further behind the best
# one than this share of what is left without any.
LED, AHEAD = 3, 0.3
# They explain the data if they leave no more than noise does, so many of its standard deviations; steps of
# all others then.
EXPLAINED, GLANCE = 2.0, 2
# What hardly acts, in typical deviations.
HARDLY = 1e-4


def fit_all(forward: Forward, null: Fit, scores: Screen) -> list[Candidate]:
    """Candidates, best first; where slopes can be trusted, their last steps are yet to be taken."""
    best = scores.best()
    gains = {e: float(np.square(scores.z[k])) for e, k in best.items()}
    largest = max(gains.values(), default=0.0)
    traced = any(r.has_signals for r in forward.experiment.runs)
    nonlinear = largest > NONLINEAR or _beyond_slopes(forward, null, largest) or _strained(forward, null)
    # Few scalars with large errors leave room for large deviations, which slopes do not foresee.
    rough = nonlinear and wide.wide(forward)
    loose = nonlinear or (not traced and largest > CLEAR)
    steps = FIRST if loose else ITERATIONS
    setup = setup_of(forward)
    left = list(setup.catalogue.candidates(setup, forward.experiment.excluded))
    if nonlinear and traced and not rough:
        found = _raced(forward, null, scores, gains, left, Effort(True, steps, COARSE))
        found = elsewhere.once_more(forward, null, found, setup)
        found = elsewhere.all_over(forward, null, scores, found, left, setup)
        found = elsewhere.rugged(forward, null, scores, found, left, setup)
        found = elsewhere.past_minima(forward, null, found)
        return ranked(found, forward.experiment.prior_odds)
    found: list[Candidate] = []
    best_gain, err, odd = largest, ERR, bool(strayed(forward, null))

    def follow(branch, effect):
        far = effect.id in best and abs(scores.strength[best[effect.id]]) > FAR
        grid = nonlinear or (loose and far and not secants.local(effect))
        # Most are far behind another; near the nominal model, those that are not are finished once all
        # are known. Far from it the last steps are as good as any.
        effort = Effort(grid, steps, finish=loose, shaped=ITERATIONS)
        effort = Effort(True, ITERATIONS, halved=wide.FIRST) if grid and rough else effort
        return candidate(branch, null, scores, effect, effort)

    effects = list(left)
    while left:
        # Places and strengths may not keep what slopes promise: others are measured against what was found.
        always = [e for e in left if (secants.applies(e) and largest > CLEAR) or (odd and _scatters(e))]
        chosen = left if loose else [e for e in left if e in always or _promises(e, gains, err, best_gain)]
        found += abreast.each(forward, follow, chosen, "single effects")
        left = [e for e in left if e not in chosen]
        leading = max((c for c in found if c is not None), key=lambda c: c.gain, default=None)
        achieved = leading.gain if leading else 0.0
        if chosen and achieved < best_gain:
            best_gain = achieved
        elif err == ERR and not loose and wide.leaves_much(forward, null.objective - achieved):
            err = ERR_FAR
        elif err == ERR and not loose and _unforeseen(leading, gains):
            placed = secants.local(leading.fit.hypothesis.components[0].effect)
            best_gain, err = (best_gain, ERR_PLACED) if placed else (achieved, ERR_FAR)
        else:
            break
    found = elsewhere.all_over(forward, null, scores, [c for c in found if c is not None], left, setup)
    if traced:
        found = elsewhere.rugged(forward, null, scores, found, effects, setup)
        found = elsewhere.past_minima(forward, null, found)
    return ranked(found, forward.experiment.prior_odds)


def _scatters(effect: Effect) -> bool:
    """Whether beads that differ within what the record allows do the same as the effect."""
    return any(p.scatters for p in effect.parameters)


def _promises(effect: Effect, gains: dict[str, float], err: float, best: float) -> bool:
    """Whether slopes, which err by a share, promise as much of an effect as may come up to the best one."""
    share = max(err, ERR_FAR) if bends(effect) else err
    return gains.get(effect.id, -np.inf) > max((1.0 - share) * best - HOPELESS, 0.5)


def _unforeseen(leading: Candidate | None, gains: dict[str, float]) -> bool:
    """Whether the leading effect gains more than slopes foresee, by more than they err: those of others err,
    too.
    """
    if leading is None:
        return False
    return (1.0 - ERR) * leading.gain > gains.get(leading.effect, leading.gain)


def _raced(forward, null, scores, gains, effects, effort) -> list[Candidate]:
    """Far from the data: all effects a few steps along running integrals of the traces, and from there those
    that come near the data. If these explain them, all others are behind for good, and only glanced at.
    """

    def led(branch, effect):
        ways = begun(branch, null, scores, effect, effort)
        return [(free, _led(branch, effect, free, one, effort)) for free, one in ways]

    def follow(branch, effect):
        return candidate(branch, null, scores, effect, replace(effort, coarse=COARSE - LED), ways[effect.id])

    def glance(branch, effect):
        near = [(free, _glanced(null, scores, effect, free, one)) for free, one in ways[effect.id]]
        effort = Effort(True, GLANCE, finish=False, shapes=False)
        return candidate(branch, null, scores, effect, effort, near)

    found = abreast.each(forward, led, effects, "effects, a few steps")
    ways = {effect.id: one for effect, one in zip(effects, found, strict=True)}
    left = {name: min((s.objective.min() for _, s in one), default=np.inf) for name, one in ways.items()}
    nothing = roughly(forward, null.hypothesis, Starts(null.u[None], null.nu[None]), 1, LED).objective[0]
    size, least = data(forward), min(left.values(), default=np.inf)
    # What gauges do is told by slopes, and part of it not by integrals.
    enough = (1.0 - AHEAD) * (null.objective - size)
    ahead = [
        e for e in effects if left[e.id] - least <= AHEAD * (nothing - size) or gains.get(e.id, 0.0) >= enough
    ]
    behind = [e for e in effects if e not in ahead]
    found = abreast.each(forward, follow, ahead, "single effects")
    rest = min((c.fit.objective for c in found if c is not None), default=np.inf) - size
    explained = rest < EXPLAINED * np.sqrt(2.0 * size)
    found += abreast.each(forward, glance if explained else follow, behind, "single effects")
    return [c for c in found if c is not None]


def _glanced(null: Fit, scores: Screen, effect: Effect, free, led: Starts) -> Starts:
    """The best start that was led somewhere, and one with an effect that hardly acts: no effect explains less
    than the nominal model does.
    """
    best = led.take([int(np.argmin(led.objective))])
    for k in along(scores, effect, free)[:1]:
        d = scores.directions[k]
        size = HARDLY * (np.sign(scores.z[k]) or 1.0)
        place = np.array([[d.place or 0]]) if effect.places else None
        best = best.beside(Starts(within(free, [coordinates(free, d, size)]), null.nu[None], place))
    return best


def _led(forward, effect, free, one, effort):
    """Starts after the first steps along running integrals of the traces."""
    hypothesis = Hypothesis((Component(effect, free),))
    return roughly(forward, hypothesis, one, kept(effect, free, effort.grid), LED)


def _beyond_slopes(forward: Forward, null: Fit, largest: float) -> bool:
    """Whether the nominal model leaves much of which slopes promise too little, `largest` in χ²."""
    excess, _ = elsewhere.left(forward, null, ())
    return excess > UNFORESEEN and largest < FORESEEN * excess


def _strained(forward: Forward, null: Fit) -> bool:
    """Whether the nominal fit strains what the record states, so that slopes are taken far from it."""
    return not wide.wide(forward) and float(np.abs(null.nu).max(initial=0.0)) > STRAINED
