"""What stays named beside something unknown: what nothing from outside the catalogue would do as well.

What is unknown may be smooth, as a systematic error is: counted as noise it leaves nothing, and what stands
out of it is what it seems. Or it has shapes that no smooth error has. Then an effect may be no more than what
comes nearest to it in the catalogue; of a bead's mass or a gap, which can sit at any of tens of places, this
is so more often than not, and they are not named.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import discrepancy, evidence, smooth
from sonicvacuum.discover.fit.evidence import Candidate, Combination
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import explanations, weighing
from sonicvacuum.discover.judge.decided import Decision, View
from sonicvacuum.discover.judge.left import Left
from sonicvacuum.discover.judge.rivals import of_weights
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import candidates, pairs, restart, several, unknown
from sonicvacuum.discover.search.unknown import ShapeTest
from sonicvacuum.effects import Setup


@dataclass(frozen=True)
class Beside:
    """A data set, its single effects, best first, and the shapes of a smooth discrepancy."""

    forward: Forward
    null: Fit
    found: list[Candidate]
    known: discrepancy.Shapes | None
    setup: Setup

    def decide(self, grown: several.Grown, needed: float, alarms, after: Left, tried) -> Decision:
        """What stays named of a set that leaves something; `needed` is the Δχ² that a name asks for."""
        reasons = [f"{after.where} is left"]
        rivals, prior = self._rivals(grown), self.forward.experiment.prior_odds
        weights = explanations.log_weights((), [*grown.tried.values(), *rivals], prior)
        # With what is left as noise a rival may be likelier than what the search has found.
        rival = [c.fit for c in sorted(rivals, key=lambda c: -c.log_bayes)[:1]]
        more_than_smooth = False
        for one in (grown.best.fit, *rival, grown.null):
            seen = unknown.shape_test(grown.forward, one) if one.hypothesis.components else None
            more_than_smooth |= seen is not None and seen.p < policy.SHAPED
            fit_ = self._irreplaceable(grown, one, seen, needed, reasons)
            named = list(fit_.hypothesis.ids)
            # Of sets only as they are: more beside two may as well be what stands for one unknown thing.
            whole = weighing.merged(weights, named) if len(named) == 1 else weights
            if not named or explanations.clear(whole, named):
                break
            reasons.append(f"{' + '.join(named)}: not clearly the best beside what is left")
        final = restart.moved(self.forward, fit_) if named else self.null
        if len(named) == 1 and _idle(fit_):
            reasons.append(f"{named[0]}: none of it is left where what is unknown counts as noise")
            named, fit_, final = [], grown.null, self.null
        if not named and not more_than_smooth:
            reasons += explanations.one_of(weights)
        likely = of_weights(weights, [*grown.tried.values(), *rivals])
        weights = whole if named else weights
        return Decision(
            [*named, explanations.UNKNOWN],
            final,
            alarms,
            reasons,
            after.p,
            tried,
            grown.size.size,
            View(grown.forward, grown.null, fit_) if grown.size.size else None,
            weights,
            rivals=likely,
            smooth_only=grown.size.found and seen is not None and not seen.failed,
        )

    def _irreplaceable(
        self, grown: several.Grown, one: Fit, seen: ShapeTest | None, needed: float, reasons: list[str]
    ) -> Fit:
        """A fit less the effects for which a shape outside the catalogue would do; said in `reasons`."""
        if seen is None or not seen.failed:
            return one
        kept, fit_ = unknown.irreplaceable(seen, one, needed), one
        for k in reversed(range(len(one.hypothesis.components))):
            nearest = seen.p < policy.SHAPED and self._inside(fit_, k)
            if nearest or (k not in kept and not self._ahead(fit_, k)):
                name = fit_.hypothesis.ids[k]
                reasons.append(f"{name} may be no more than the nearest to {unknown.in_words(seen.group)}")
                fit_ = restart.fewer(grown.forward, grown.null, fit_, k)
        return fit_

    def _inside(self, one: Fit, k: int) -> bool:
        """Whether effect k sits at one bead or contact of the chain."""
        return self.setup.catalogue.effect(one.hypothesis.ids[k]).places in ("bead", "contact")

    def _ahead(self, whole: Fit, k: int) -> bool:
        """Whether effect k gains clearly more than any one shape outside the catalogue would in its place,
        noise as it is, and is likelier than more of a discrepancy instead.

        Only far from the data, where slopes of sixty shapes together promise to replace anything.
        """
        if self.known is None:
            return False
        with_it = restart.moved(self.forward, whole)
        if self.null.objective - with_it.objective < candidates.NONLINEAR:
            return False
        less = restart.fewer(self.forward, self.null, with_it, k)
        gain = less.objective - with_it.objective
        instead = smooth.infer(self.forward, less, self.known).log_odds
        beside = smooth.infer(self.forward, with_it, self.known).log_odds
        price = evidence.occam(with_it, gain) - evidence.occam(less, gain)
        earned = 0.5 * gain + price + beside - instead
        if earned < policy.LEAST_LOG10_BAYES * np.log(10.0):
            return False
        return gain > (1.0 + policy.SHARE) * unknown.simplest(self.forward, less)[1] + policy.MARGIN

    def _rivals(self, grown: several.Grown) -> list[Combination]:
        """Single effects that were near the best, with the discrepancy counted as noise."""
        most = max(c.gain for c in self.found)
        near = [c for c in self.found if c.gain > 0.5 * most and frozenset((c.effect,)) not in grown.tried]
        fits = [restart.moved(grown.forward, c.fit) for c in near[:4]]
        return [pairs.combination(grown.null, f, self.setup) for f in fits]


def _idle(one: Fit) -> bool:
    """Whether the size of the one effect of a fit is none within its error."""
    inside = one.hypothesis.inside(one.u)
    return max(one.hypothesis.strengths(inside, one.sigma)) < policy.IDLE
