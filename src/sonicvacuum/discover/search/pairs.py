"""Two effects together: which pairs the nominal screen sees, which second effect the residual of each good
single fit asks for, then both fitted jointly.

Taking the best single first and adding to it often starts from the wrong one, so that several singles are
followed, and all pairs of the nominal screen, whose joint gains are algebra. Once a pair is found, pairs that
share one effect with it are tried as well.
"""

from collections.abc import Collection, Iterable
from dataclasses import replace
from functools import partial

import numpy as np

from sonicvacuum.discover.fit import bounds, enough, places
from sonicvacuum.discover.fit.evidence import Candidate, Combination, log_bayes
from sonicvacuum.discover.fit.refit import Fit, finished, fit, polish
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis
from sonicvacuum.discover.search import around, directions, mixtures, restart, screen, secants, strengths
from sonicvacuum.discover.search.planes import Start, linear, variant
from sonicvacuum.discover.search.starts import setup_of, starts_of
from sonicvacuum.discover.search.sums import summed
from sonicvacuum.effects import Setup

# Singles that pairs start from.
STARTED = 4
# Pairs refitted from the nominal screen, from single fits, in place of the best one, in each round of
# exchanges, and from the trials of all effects.
LINEAR, BESIDE, MIXED, EXCHANGED, ROUNDS, SUMMED = 3, 3, 3, 4, 2, 4
# What may stand in for an effect of the best pair promises this share of what that gains beside the other; so
# many are fitted, so often as that leads to another pair.
STANDS, STANDING, AGAIN = 0.7, 3, 4
# Pairs that are started again, and what that has to gain in log evidence before others follow it.
LEADING, WORTH = 4, 0.5
# Beside a pair that leaves so many times the noise, so many others are tried; where it leaves so many times
# as much, neither places nor trials beside the nominal model tell of more.
FAR_OFF, GROSS, LOST = 1.5, 20, 10.0
# Trials of an effect that its start is made of.
TRIALS = 3
# Sets this far behind the best one are not followed along the chain, nor are the last steps of their fits
# taken: these gain some hundredths, or some units with laws of several parameters.
BEHIND = 30.0
ITERATIONS = 12
# Pairs of which narrow minima are looked for, those at most this far behind the best one in log evidence.
REFINED, NEAR = 3, 10.0


class Pairs:
    """The pairs of one record.

    Args:
        forward: the predictor.
        null: the nominal model, fitted.
        scores: its screen.
        candidates: the singles, best first.
    """

    def __init__(self, forward: Forward, null: Fit, scores: screen.Screen, candidates: list[Candidate]):
        self.forward, self.null, self.setup = forward, null, setup_of(forward)
        self.candidates = candidates
        let_go = partial(_let_go, candidates)
        self.seen = [let_go(s) for s in linear(scores, self.setup)]
        started = [c for c in candidates[:STARTED] if c.gain > 0.0]
        self.asked = [let_go(s) for c in started for s in beside(forward, null, c.fit, self.setup)]
        self.found: dict[frozenset, Combination] = {}
        self.likeliest: dict[frozenset, Fit] = {}
        self.tried: set[tuple] = set()

    @property
    def ranked(self) -> list[Combination]:
        """Those fitted so far, best first."""
        return sorted(self.found.values(), key=lambda p: -p.log_bayes)

    def search(self) -> list[Combination]:
        """The best pairs, best first."""
        self._refit(_best(self.asked, self.found, BESIDE))
        self._refit(_best(self.seen, self.found, LINEAR))
        self._refit(_best(mixtures.starts(self.forward, self.null, self.candidates), self.found, MIXED))
        self._exchange()
        if not self._gross(LOST):
            self._refit(_best(summed(self.forward, self.null, self.setup), self.found, SUMMED))
        self._stood_in()
        self._refine()
        self._with_other_strengths()
        return self.ranked

    def again(self) -> list[Combination]:
        """The same with the leading pairs started again, see `restart`, each effect of the best one exchanged
        for every other at any strength, and pairs that share an effect with what that led to.
        """
        for _ in range(ROUNDS):
            leading = self.ranked[:LEADING]
            if not leading:
                break
            restarted = partial(restart.restarted, setup=self.setup)
            fits = [pair.fit for pair in leading]
            for one in abreast.each(self.forward, restarted, fits, "pairs of effects again"):
                self._note(one)
            best = self.ranked[0].fit
            others = (s for k in range(2) for s in instead(self.forward, self.null, best, k, self.setup))
            self._refit(_best(others, self.found, GROSS if self._gross() else BESIDE))
            if self.ranked[0].log_bayes < leading[0].log_bayes + WORTH:
                break
            self._exchange()
        self._with_other_strengths()
        return self.ranked

    def _gross(self, times: float = FAR_OFF) -> bool:
        """Whether the best pair leaves far more than noise: what slopes promise beside it is worth little."""
        return bool(self.found) and self.ranked[0].fit.objective > times * enough.data(self.forward)

    def _exchange(self):
        """Pairs that share either effect with the best one, as they started and as the best one has it."""
        for _ in range(ROUNDS):
            if not self.found:
                return
            best = self.ranked[0]
            near = [s for s in (*self.seen, *self.asked) if len(s.effects & set(best.effects)) == 1]
            self._refit(_in_turn(_best(near, self.found), best)[:EXCHANGED])
            adapted = [b for s in near if (b := _adapted(s, best)) and _key(b, best) not in self.tried]
            chosen = _in_turn(_best(adapted, {}), best)[:EXCHANGED]
            self.tried |= {_key(b, best) for b in chosen}
            self._refit(chosen)
            if self.ranked[0] is best:
                return

    def _stood_in(self):
        """In place of either effect of the best pair, what promises nearly as much there; beside one near a
        bound whatever promises most: it may tend there to another law, of which no start was made.
        """
        for _ in range(AGAIN):
            if not self.found:
                return
            best = self.ranked[0]
            self._refit([s for k in range(2) for s in self._standing(best.fit, k)])
            if self.ranked[0] is best:
                return

    def _standing(self, best: Fit, k: int) -> list[Start]:
        """What may stand in effect k's place, best first."""
        beside = restart.less(self.forward, best, k)
        others = everywhere(self.forward, self.null, beside, self.setup, best.hypothesis.ids)
        starts = _best(others, self.found, STANDING)
        if not starts or any(bounds.near(best)[best.hypothesis.columns[k]]):
            return starts
        gained = self.null.objective - best.objective
        left = self.null.objective - restart.promised(beside)
        return [s for s in starts if s.gain > left + STANDS * (gained - left)]

    def _refine(self):
        """Look for narrow minima of effects with a place in the leading pairs, see `around`."""
        near = [one for one in self._near() if places.placed(one)]
        refined = partial(around.refined, setup=self.setup)
        for one in abreast.each(self.forward, refined, near, "places of pairs"):
            self._note(one)

    def _with_other_strengths(self):
        """The likeliest strengths of effects with several in the leading pairs, see `strengths`."""
        for one in self._near():
            key = frozenset(one.hypothesis.ids)
            if strengths.several(one, self.setup) and self.likeliest.get(key) is not one:
                self.likeliest[key] = strengths.settled(self.forward, self.null, one, self.setup)
                self.found[key] = combination(self.null, self.likeliest[key], self.setup)

    def _near(self):
        """Fits of the leading pairs that are not far behind the best one."""
        leading = self.ranked[:REFINED]
        return [p.fit for p in leading if p.log_bayes > leading[0].log_bayes - NEAR]

    def _refit(self, starts: list[Start]):
        """Fit pairs and note them."""
        least = min((p.fit.objective for p in self.found.values()), default=np.inf)
        found = followed(self.forward, starts, least, "pairs of effects")
        for one in found:
            self._note(one)
        least = min((p.fit.objective for p in self.found.values()), default=np.inf)
        # Where even the best one leaves more than noise, it is no measure of what a place may gain.
        more = 0.0 if self._gross(LOST) else least - enough.data(self.forward)
        near = [one for one in found if places.placed(one) and one.objective < least + max(BEHIND, more)]
        settled = partial(places.settled, setup=self.setup)
        for one in abreast.each(self.forward, settled, near, "places of pairs"):
            self._note(one)

    def _note(self, one: Fit):
        """Keep a fit where it is the best of its effects."""
        if not np.isfinite(one.objective):
            return
        new = combination(self.null, one, self.setup)
        key = frozenset(new.effects)
        if key not in self.found or self.found[key].gain < new.gain:
            self.found[key] = new


def _let_go(candidates: list[Candidate], start: Start) -> Start:
    """The start with each effect as free as it had to be alone: a bound may make it look the worse."""
    alone = {c.effect: c.fit.hypothesis.components[0].free for c in candidates if "beyond" in c.flags}
    parts = []
    for c in start.hypothesis.components:
        further = {x.parameter.name: x for x in alone.get(c.effect.id, ())}
        parts.append(replace(c, free=tuple(further.get(x.parameter.name, x) for x in c.free)))
    return replace(start, hypothesis=Hypothesis(tuple(parts)))


def _key(start: Start, best: Combination) -> tuple:
    """What an adapted start shares with the best pair, coarsely: much the same need not be fitted twice."""
    (name,) = start.effects & set(best.effects)
    k = start.hypothesis.ids.index(name)
    values = start.u[0, start.hypothesis.columns[k]]
    return (start.hypothesis.ids, name, int(start.places[0, k]), *np.round(values, 2).tolist())


def _adapted(start: Start, best: Combination) -> Start | None:
    """The start with the effect that it shares with the best pair as it is there; None where that has other
    parameters.

    Alone an effect may have been fitted at another place and strength than it takes beside a second one.
    """
    (name,) = start.effects & set(best.effects)
    k, own = start.hypothesis.ids.index(name), best.effects.index(name)
    columns, values = start.hypothesis.columns[k], best.fit.u[best.fit.hypothesis.columns[own]]
    if len(values) != columns.stop - columns.start:
        return None
    u, places = start.u.copy(), start.places.copy()
    u[:, columns], places[:, k] = values, best.fit.hypothesis.components[own].place or 0
    _, rows = np.unique(np.column_stack([u, places]), axis=0, return_index=True)
    u, places = np.tile(u[rows], (2, 1)), np.tile(places[rows], (2, 1))
    nu = np.concatenate([start.nu[rows], np.broadcast_to(best.fit.nu, start.nu[rows].shape)])
    return Start(start.gain, start.hypothesis, u, nu, places)


def _best(starts, found, most=None):
    """The most promising start of each pair that has not been fitted, `most` of them, best first."""
    best: dict[frozenset, Start] = {}
    for s in sorted(starts, key=lambda s: -s.gain):
        if s.effects not in found:
            best.setdefault(s.effects, s)
    return list(best.values())[:most]


def _in_turn(starts: list[Start], best: Combination) -> list[Start]:
    """Starts that share one effect with the best pair, by turns those with the one and with the other.

    What starts promise tells more of the effect that was fitted alone than of the one put beside it: all with
    the one that is better alone would come first.
    """
    kept = [next(iter(s.effects & set(best.effects))) for s in starts]
    turns = [kept[:k].count(name) for k, name in enumerate(kept)]
    return [starts[k] for k in sorted(range(len(starts)), key=turns.__getitem__)]


def screened(forward: Forward, first: Fit, setup: Setup) -> screen.Screen:
    """Roughly what the residual of a fit says of every effect that is not in it."""
    present = (*first.hypothesis.ids, *forward.experiment.excluded)
    return screen.screen(forward, first, directions.catalogue(setup, present), rough=True)


def beside(forward: Forward, null: Fit, first: Fit, setup: Setup, only: Collection[str] = ()) -> list[Start]:
    """Every effect beside those of a first fit, or some only."""
    scores = screened(forward, first, setup)
    gained = null.objective - first.objective
    own = np.array([c.place or 0 for c in first.hypothesis.components], dtype=int)
    asked = [(name, k) for name, k in scores.best().items() if not only or name in only]

    def start(branch, best):
        second, k = best
        effect = setup.catalogue.effect(second)
        finite = secants.search(branch, first, effect, setup, 2, sparse=True)
        more = max([float(np.square(scores.z[k])), *(one.gain for one in finite)])
        free = variant(scores.directions[k], setup)
        u, places, nu = starts_of(branch, first, scores, effect, free, False, finite)
        if not len(u):
            return None
        u = np.column_stack([np.repeat(first.u[None], len(u), axis=0), u])
        places = np.zeros((len(u), 1), dtype=int) if places is None else places
        places = np.column_stack([np.tile(own, (len(u), 1)), places])
        hypothesis = first.hypothesis.with_component(Component(effect, free))
        return Start(gained + more, hypothesis, u, nu, places)

    return [s for s in abreast.each(forward, start, asked, calls=abreast.SLOPES) if s is not None]


def instead(forward: Forward, null: Fit, one: Fit, k: int, setup: Setup) -> list[Start]:
    """Every effect of the catalogue, tried all over its range, in place of effect k of a set; all others
    stand where they are.
    """
    beside = restart.less(forward, one, k)
    return everywhere(forward, null, beside, setup, one.hypothesis.ids)


def everywhere(
    forward: Forward, null: Fit, beside: Fit, setup: Setup, known=(), sizes=secants.coarsely
) -> list[Start]:
    """Every effect of the catalogue but those known, tried all over its range beside those of a fit."""
    if not np.isfinite(beside.objective):
        return []
    left = null.objective - restart.promised(beside)

    def start(branch, component):
        trials = secants.tried(branch, beside, component, setup, TRIALS, sizes(component.free[0]))
        return _tried(beside, component, trials, left) if trials else None

    present = (*beside.hypothesis.ids, *known, *forward.experiment.excluded)
    able = secants.components(setup, present)
    return [s for s in abreast.each(forward, start, able) if s is not None]


def _tried(beside: Fit, component: Component, trials, left: float) -> Start:
    """The start of one effect beside others from its best trials."""
    hypothesis = beside.hypothesis.with_component(component)
    u = hypothesis.inside(np.array([[*t.beside, *t.u] for t in trials]))
    own = [c.place or 0 for c in beside.hypothesis.components]
    places = np.array([[*own, t.place or 0] for t in trials])
    return Start(left + trials[0].gain, hypothesis, u, np.array([t.nu for t in trials]), places)


def followed(forward: Forward, starts: Iterable[Start], least: float = np.inf, stage: str = "") -> list[Fit]:
    """The joint fits from starts; `finished` is false for those far behind the best one, and `least`."""
    found = abreast.each(forward, partial(fitted, finish=False), starts, stage)
    least = min([least, *(one.objective for one in found)])
    near = [k for k, one in enumerate(found) if one.objective < least + BEHIND]
    last = abreast.each(forward, finished, [found[k] for k in near])
    for k, one in zip(near, last, strict=True):
        found[k] = one
    return found


def fitted(forward, start: Start, finish: bool = True) -> Fit:
    """The joint fit from a start."""
    how = {"keep": 3, "iterations": ITERATIONS, "finish": finish}
    one = fit(forward, start.hypothesis, start.u, start.nu, start.places, **how)
    return one if one.settled else polish(forward, one, ITERATIONS, finish)


def combination(null: Fit, one: Fit, setup: Setup) -> Combination:
    """A fit of several effects with its evidence against the nominal model."""
    gain, names = null.objective - one.objective, one.hypothesis.ids
    return Combination(names, one, gain, log_bayes(one, gain) - _places(names, setup))


def _places(names, setup):
    """Log of the number of places that all effects could have had."""
    effects = [setup.catalogue.effect(name) for name in names]
    counts = [len(e.candidates(setup)) for e in effects if e.places]
    return float(sum(np.log(max(1, c)) for c in counts))
