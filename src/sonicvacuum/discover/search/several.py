"""More effects than one, while something smooth may be left: added and taken away one at a time.

At each turn the size of the smooth discrepancy is inferred at the model so far and counted as noise
(`smooth`). An effect is added while it passes the noise of the whole catalogue under that, is ten times
likelier than without, and predicts unseen runs no worse; one that no longer does is taken away; each is held
against those that might stand in its place, and against two of them, and so are any two of a set against one.
A misfit in one direction leaves room for the effect that makes it, one that is spread over many does not: a
systematic error names nothing.
"""

import itertools
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import bounds, enough, heldout, places, smooth
from sonicvacuum.discover.fit.evidence import Combination
from sonicvacuum.discover.fit.refit import Fit, finished
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import around, pairs, planes, prospects, restart, secants, strengths
from sonicvacuum.discover.search.grown import Grown
from sonicvacuum.discover.search.once import Once
from sonicvacuum.effects import Setup

# Starts that are fitted jointly at each turn, by what they should gain; those of the first effect beside a
# smooth misfit, where no single fit tells what it is.
TRIED, FIRST = 2, 5
# Effects of the largest set that is searched in every way: beside something large from outside the catalogue
# sets grow as far as they may, and exchanging all of six took eight minutes to no avail.
FEW = 4
# What slopes promise may fall short of what a fit gains by this share.
PROMISE = 0.6
# Without one effect others are moved along the chain where they still gain this share.
NEAR = 0.8
# Once a set is found, all that slopes promise this share of what an effect gains there are fitted in its
# place, so many of each.
STANDS, STANDING = 0.7, 6
# One run may be predicted worse by so much of what all runs gain.
WORSE = 0.1
TURNS = policy.MOST_EFFECTS + 2


class Turns:
    """One search; `forward` has no discrepancy, `known` are its `discrepancy.Shapes`, `needed` is the Δχ²
    that an effect has to gain, `rival` a log evidence that is asked of a set, as is that it leaves nothing.
    """

    def __init__(
        self, forward: Forward, known, needed: float, setup: Setup, infer: bool = True, rival: float = -np.inf
    ):
        self.plain, self.known, self.needed, self.setup, self.infer = forward, known, needed, setup, infer
        self.rival = rival
        self.forward, self.null, self.tried = forward, None, {}
        self.size, self._once = smooth.Size(0.0, 0.0), Once()

    def grow(self, null: Fit, start: Fit) -> Grown:
        """From a start to where nothing more is added, taken away, exchanged or found from elsewhere."""
        plain_null, fit = null, start
        moves = [self._exchanged, self._again, self._two, self._one_for_two]
        for _ in range(TURNS):
            fit = self._counted(plain_null, fit)
            fit = self._pruned(fit)
            if self._hopeless(fit):
                return self._grown(fit)
            more = self._added(fit)
            if more is not None and len(fit.hypothesis.components) == 2:
                # A pair that holds an effect which is none would grow as far as it may.
                more = max(filter(None, (more, self._two(fit))), key=self._evidence)
            if more is not None and self._hopeless(fit, more):
                return self._grown(more)
            if more is None:
                more = self._elsewhere(fit, moves)
            if more is None:
                before = self.size
                fit = self._counted(plain_null, fit)
                if before.same(self.size):
                    break
                continue  # what was taken away leaves another discrepancy, beside which more may be seen
            fit = more
        return self._grown(self._pruned(self._counted(plain_null, fit)))

    def _elsewhere(self, fit, moves: list) -> Fit | None:
        """Where the first of some moves leads that leads anywhere; none of them has two turns but exchanges,
        which are worth another one once a single effect took the place of two.
        """
        few = len(fit.hypothesis.components) <= FEW
        if np.isfinite(self.rival) and prospects.remains(self.forward, fit, self.setup, self._room(fit)):
            return None
        for move in [m for m in moves if few or m == self._again]:
            moves.remove(move)
            more = move(fit)
            if more is not None:
                if move == self._one_for_two and self._exchanged not in moves:
                    moves.append(self._exchanged)
                return more
        return None

    def _grown(self, fit) -> Grown:
        return Grown(self.forward, self.null, self._noted(fit), self.size, self.tried)

    def _hopeless(self, fit, more=None) -> bool:
        """Whether a set would stay behind its rival, or leave something, with all that may still be added: by
        slopes beside it or, once there is one more, by what that gained.
        """
        own = self._evidence(fit)
        if more is not None:
            return prospects.by_last(own, self._evidence(more), self._room(more)) < self.rival
        if np.isinf(own) or np.isinf(self.rival):
            return False
        return prospects.hopeless(self.forward, fit, self.setup, self._room(fit), own, self.rival)

    def _room(self, fit) -> int:
        """How many effects may still be added."""
        return policy.MOST_EFFECTS - len(fit.hypothesis.components)

    def _counted(self, plain_null, fit):
        """The fit with the discrepancy at it counted as noise; what was tried under another is forgotten."""
        size = smooth.infer(self.plain, fit, self.known) if self.infer else smooth.Size(0.0, 0.0)
        size = size if size.found else smooth.Size(0.0, size.drop)
        if self.null is None or not size.same(self.size):
            self.forward, self._once = self.plain, Once()
            if size.size:
                e, how = self.plain.experiment, (size.excess, size.kernel)
                self.forward = self.plain.of(smooth.with_size(e, size.size, self.known, *how))
            self.null = restart.moved(self.forward, plain_null) if size.size else plain_null
            self.tried = {}
        self.size = size
        # Once each: what a first fit left early in a valley may still go on, what has been followed does not.
        fit = self._once.of(fit, "moved", partial(restart.moved, self.forward, fit))
        self._once.of(fit, "moved", lambda: fit)
        self._noted(fit)
        return fit

    def _noted(self, fit) -> Combination:
        """The evidence of a fit, kept."""
        new = pairs.combination(self.null, fit, self.setup)
        key = frozenset(new.effects)
        if key not in self.tried or self.tried[key].gain < new.gain:
            self.tried[key] = new
        return self.tried[key]

    def _pruned(self, fit):
        """Without effects that do not earn their evidence beside the others."""
        while fit.hypothesis.components:
            weakest = self._once.of(fit, "weakest", partial(self._weakest, fit))
            if self._earned(weakest, fit):
                return fit
            fit = weakest
        return fit

    def _weakest(self, fit):
        """The best fit without one effect, whichever."""
        less = self._settled(fit, self._each_less(fit, range(len(fit.hypothesis.components))))
        return min(less, key=lambda one: one.objective)

    def _each_less(self, fit, which) -> list[Fit]:
        """The best fits without one effect, each of `which` in turn."""

        def without(branch, k):
            return restart.fewer(branch, self.null, fit, k, pairs.ITERATIONS)

        found = self._once.of_each(fit, which, lambda new: abreast.each(self.forward, without, new))
        for one in (f for f in found if f.hypothesis.components):
            self._noted(one)
        return found

    def _promised(self, fit) -> list[planes.Start]:
        """Every effect beside those of a fit."""
        return self._once.of(fit, "beside", partial(pairs.beside, self.forward, self.null, fit, self.setup))

    def _settled(self, fit, less: list[Fit]) -> list[Fit]:
        """Fits without one effect, the others at the places that are best for them alone."""
        gained = self.null.objective - fit.objective
        near = [self.null.objective - one.objective > NEAR * gained for one in less]
        return self._refined(less, near) if len(less) > 2 else less

    def _refined(self, found: list[Fit], near: list[bool]) -> list[Fit]:
        """Fits with narrow minima looked for in those that are near the best; all are kept."""
        asked = [
            k for k, one in enumerate(found) if near[k] and self._thorough(len(one.hypothesis.components))
        ]
        refined = partial(around.refined, setup=self.setup)
        found = list(found)
        for k, one in zip(asked, abreast.each(self.forward, refined, [found[k] for k in asked]), strict=True):
            found[k] = one
            self._noted(one)
        return found

    def _thorough(self, count: int) -> bool:
        """Whether sets of so many effects are searched in every way: nothing smooth hides what they do."""
        return count <= FEW and not self.size.size

    def _less(self, fit, k):
        """The best fit without effect k."""
        (found,) = self._each_less(fit, [k])
        return found

    def _earned(self, before: Fit, after: Fit) -> bool:
        """Whether one more effect is worth it."""
        return self._worth(before, after) and heldout.better(before, after, share=WORSE)

    def _worth(self, before: Fit, after: Fit) -> bool:
        """The same, whatever becomes of runs left out."""
        gain = before.objective - after.objective
        ratio = self._evidence(after) - self._evidence(before)
        return (
            gain > self._asked(before)
            and ratio > policy.LEAST_LOG10_BAYES * np.log(10.0)
            and enough.suffice(self.forward, after)
        )

    def _asked(self, before: Fit) -> float:
        """Δχ² that one more effect has to gain."""
        if not self.size.size:
            return self.needed
        return policy.BESIDE_SMOOTH[bool(before.hypothesis.components)] * self.needed

    def _evidence(self, fit):
        return pairs.combination(self.null, fit, self.setup).log_bayes if fit.hypothesis.components else 0.0

    def _added(self, fit):
        """The fit with the effect that earns most, None where none does."""
        for one in self._beside(fit):
            if self._earned(fit, one):
                return one
            further = self._further(fit, one)
            if further is not None:
                return further
        return None

    def _beside(self, fit) -> Iterator[Fit]:
        """Fits with one effect more, the likeliest first."""
        if self._room(fit) < 1:
            return
        starts = self._promised(fit)
        if self._thorough(1 + len(fit.hypothesis.components)):
            # Slopes promise little of some that strengths all over the range do.
            starts = starts + pairs.everywhere(self.forward, self.null, fit, self.setup, sizes=secants.finely)
        yield from self._ranked(starts, self.null.objective - fit.objective + PROMISE * self._asked(fit))

    def _two(self, fit) -> Fit | None:
        """The fit with two effects more, or with two in place of one, that only together explain what is
        left; None where none do.
        """
        count = len(fit.hypothesis.components)
        beside = [fit] if count + 2 <= FEW else []
        beside += self._each_less(fit, range(count if 1 < count < FEW else 0))
        starts = []
        for one in beside:
            gained = self.null.objective - one.objective
            scores = pairs.screened(self.forward, one, self.setup)
            starts += [replace(s, gain=s.gain + gained) for s in planes.linear(scores, self.setup)]
        least = self.null.objective - fit.objective + PROMISE * self._asked(fit)
        return next((one for one in self._ranked(starts, least) if self._earned(fit, one)), None)

    def _further(self, fit, one) -> Fit | None:
        """A fit with two effects more, where the first is worth it but predicts a run worse: while the second
        is missing, it makes up for that in each run by another size.
        """
        if not self._worth(fit, one):
            return None
        further = next(self._beside(one), None)
        if further is None or not (self._earned(one, further) and self._earned(fit, further)):
            return None
        return further

    def _likeliest(self, starts, enough) -> Fit | None:
        """The likeliest of the most promising starts, fitted."""
        return next(self._ranked(starts, enough), None)

    def _ranked(self, starts, enough) -> Iterator[Fit]:
        """The most promising starts, fitted, likeliest first; what was tried before is not tried again."""
        best = {s.effects: s for s in sorted(starts, key=lambda s: s.gain)}
        chosen = [s for s in best.values() if s.gain > enough and s.effects not in self.tried]
        first = self.size.size and all(len(s.effects) == 1 for s in chosen)
        chosen = sorted(chosen, key=lambda s: -s.gain)[: FIRST if first else TRIED]
        found = [one for one in pairs.followed(self.forward, chosen) if np.isfinite(one.objective)]
        for one in found:
            self._noted(one)
        least = min((one.objective for one in found), default=np.inf)
        found = self._refined(found, [one.objective < least + pairs.BEHIND for one in found])
        for one in sorted(found, key=self._evidence, reverse=True):
            one = places.settled(self.forward, finished(self.forward, one), self.setup)
            one = strengths.settled(self.forward, self.null, one, self.setup)
            self._noted(one)
            yield one

    def _exchanged(self, fit):
        """The fit with one effect exchanged for a likelier one, None where there is none.

        One alone has had its rivals, but beside a smooth misfit under another one than there is with it.
        """
        own, count = self._evidence(fit), len(fit.hypothesis.components)
        for k in range(count if count > 1 or self.size.size else 0):
            less = self._less(fit, k)
            enough = PROMISE * (self.null.objective - fit.objective)
            best = self._likeliest(self._promised(less), enough)
            if best is not None and self._evidence(best) > own + pairs.WORTH:
                return best
        return None

    def _one_for_two(self, fit):
        """The fit with one effect in place of two, None where that is not likelier.

        What was added first may be but the nearest to an effect that was never asked for, and a second one
        make up for the difference.
        """
        count, gained = len(fit.hypothesis.components), self.null.objective - fit.objective
        found = []
        for j, k in itertools.combinations(range(count), 2) if count > 2 else ():
            less = self._less(self._less(fit, k), j)
            found.append(self._likeliest(self._promised(less), PROMISE * gained))
        best = max((one for one in found if one is not None), key=self._evidence, default=None)
        better = best is not None and self._evidence(best) > self._evidence(fit) + pairs.WORTH
        return best if better else None

    def rivals(self, fit) -> Fit:
        """The fit, or what is likelier with one effect exchanged, once all have been fitted that may stand in
        an effect's place; the turns fit no more than it takes to find the best.

        What is stated of a set holds only beside all of these: laws of loss often stand in for each other.
        """
        gained, starts, ends = self.null.objective - fit.objective, {}, bounds.near(fit)
        for k, less in enumerate(self._each_less(fit, range(len(fit.hypothesis.components)))):
            left = self.null.objective - less.objective
            promised = self._promised(less)
            if any(ends[fit.hypothesis.columns[k]]):
                # There it may tend to another law, of which slopes at the fit without it promise too little.
                promised = promised + pairs.instead(self.forward, self.null, fit, k, self.setup)
            standing = [s for s in promised if s.gain > left + STANDS * (gained - left)]
            for s in sorted(standing, key=lambda s: -s.gain)[:STANDING]:
                if s.effects not in self.tried:
                    starts[s.effects] = max(s, starts.get(s.effects, s), key=lambda s: s.gain)
        for one in pairs.followed(self.forward, starts.values(), fit.objective):
            if np.isfinite(one.objective):
                self._noted(one)
        same = [c for c in self.tried.values() if len(c.effects) == len(fit.hypothesis.components)]
        likeliest = max(same, key=lambda c: c.log_bayes)
        return likeliest.fit if likeliest.log_bayes > self._evidence(fit) + pairs.WORTH else fit

    def _again(self, fit):
        """The same effects from other starts, None where that leads nowhere else."""
        if len(fit.hypothesis.components) < 2:
            return None
        better = restart.restarted(self.forward, fit, self.setup)
        return better if self._evidence(better) > self._evidence(fit) + pairs.WORTH else None
