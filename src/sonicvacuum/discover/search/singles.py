"""Every effect of the catalogue fitted alone: starts from the screen, and from a grid where the misfit is
large.
"""

from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.evidence import Candidate, log_bayes, ranked
from sonicvacuum.discover.fit.places import settled
from sonicvacuum.discover.fit.refit import Fit, Starts, fit, roughly
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, of_one_strength, variants
from sonicvacuum.discover.search import restart, secants
from sonicvacuum.discover.search.screen import Screen
from sonicvacuum.discover.search.starts import (
    CLEAR,
    along,
    coordinates,
    kept,
    setup_of,
    starts_of,
    strayed,
    within,
)
from sonicvacuum.effects import Effect, Setup

# Beyond this misfit of the nominal model (in χ²) its slopes may point the wrong way: whole ranges are
# searched.
NONLINEAR = 1500.0
# So they do where the nominal model leaves more than this, and no effect promises more than this share of it.
UNFORESEEN, FORESEEN = 1000.0, 0.6
# Where what was found gains as much as this, and leaves more than noise does, in standard deviations, trials
# of finite strength that promise this share of what the best one has gained are followed.
GAINS, LEAVES, PROMISING = 50.0, 0.5, 0.3
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
# Far from the data, where all effects leave more than this share of the misfit, starts may have been missed:
# pulses that miss each other lead nowhere. Trials then at each place, and starts of them that are followed.
MISSED, TRIALS = 0.05, 12
# Other strengths of an effect that weigh less than this below the best (natural log) do not explain the data.
INSTEAD = 7.0
# Steps of the search; of the first one where all effects are followed and the best are polished later.
ITERATIONS, FIRST = 14, 5
COARSE = 6
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
        found = _once_more(forward, null, found, setup)
        found = _all_over(forward, null, scores, found, left, setup)
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
    found = _all_over(forward, null, scores, [c for c in found if c is not None], left, setup)
    return ranked(found, forward.experiment.prior_odds)


def _scatters(effect: Effect) -> bool:
    """Whether beads that differ within what the record allows do the same as the effect."""
    return any(p.scatters for p in effect.parameters)


def _promises(effect: Effect, gains: dict[str, float], err: float, best: float) -> bool:
    """Whether slopes, which err by a share, promise as much of an effect as may come up to the best one."""
    share = max(err, ERR_FAR) if any(p.bends for p in effect.parameters) else err
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


def _once_more(forward, null, found, setup):
    """The same with effects at one bead or contact searched densely, and along the chain, where all that was
    found leaves much.
    """
    excess, rest = _left(forward, null, found)
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


def _all_over(forward, null, scores, found, effects, setup):
    """The same with effects of one strength all along the chain tried all over its range, where all that was
    found leaves more than noise: slopes and running integrals may lead to another minimum. Followed are those
    of which a trial promises more than they have gained, and a share of what the best has.
    """
    excess, rest = _left(forward, null, found)
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
    better = [c for c in more if c is not None and c.gain > gains.get(c.effect, -np.inf)]
    return list(({c.effect: c for c in found} | {c.effect: c for c in better}).values())


def _left(forward, null, found):
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


def _beyond_slopes(forward: Forward, null: Fit, largest: float) -> bool:
    """Whether the nominal model leaves much of which slopes promise too little, `largest` in χ²."""
    excess, _ = _left(forward, null, ())
    return excess > UNFORESEEN and largest < FORESEEN * excess


def _strained(forward: Forward, null: Fit) -> bool:
    """Whether the nominal fit strains what the record states, so that slopes are taken far from it."""
    return not wide.wide(forward) and float(np.abs(null.nu).max(initial=0.0)) > STRAINED


@dataclass(frozen=True)
class Effort:
    """How an effect is searched: `grid` adds starts over the whole range to those of the screen; all are
    followed for so many `steps`, on integrals of the traces for `coarse` steps before. `halved` and `finish`:
    see `fit`; without `finish` those with a shape are finished all the same, if `shapes` are. These are
    followed for `shaped` steps at least: their last steps take longer than all others, and would have to be
    taken again.
    """

    grid: bool
    steps: int
    coarse: int = 0
    halved: int = 0
    finish: bool = True
    shapes: bool = True
    shaped: int = 0


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
        keep = kept(effect, free, effort.grid)
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
