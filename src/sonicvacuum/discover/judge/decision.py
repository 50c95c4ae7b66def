"""What is named, once single effects are fitted: one, several, or unknown, by what each leaves."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import discrepancy, enough, evidence, heldout, smooth
from sonicvacuum.discover.fit.evidence import Candidate, Combination
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import explanations, gross, weighing
from sonicvacuum.discover.judge.beside import Beside
from sonicvacuum.discover.judge.decided import Decision, View, viewed
from sonicvacuum.discover.judge.left import Left, left, short, sure
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import directions, pairs, planes, restart, screen, several, unknown
from sonicvacuum.effects import Setup

# Pairs that are asked what they leave.
ASKED = 2
UNKNOWN = explanations.UNKNOWN


@dataclass(frozen=True)
class Case:
    """A data set and its single effects, best first."""

    forward: Forward
    null: Fit
    scores: screen.Screen
    found: list[Candidate]
    known: discrepancy.Shapes | None
    setup: Setup

    def nothing(self, few: Sequence[str] = ()) -> Decision:
        """No effect can be named: none, or unknown where the nominal model leaves a sure misfit.

        `few` says for which effects the data do not suffice, see `enough`.
        """
        seen = left(self.forward, self.null, self.known)
        opposed = self._opposed(seen)
        if opposed is not None:
            return opposed
        reasons = list(few) or ["no single effect passes the threshold"]
        if not sure(seen):
            return Decision([], self.null, {"none": seen.p}, reasons, seen.p)
        return self._unknown({"none": seen.p}, [*reasons, f"{seen.where} is left"], seen)

    def _unknown(self, alarms, reasons, seen: Left, tried=()) -> Decision:
        """Something is missing, and nothing can be said of it."""
        size = seen.size.size if seen.size.found else 0.0
        view = viewed(self.forward, self.null, self.null, self.known, seen.size) if size else None
        return Decision([UNKNOWN], self.null, alarms, reasons, seen.p, list(tried), size, view)

    def decide(self) -> Decision:
        """Name the best single, a pair, more, or unknown."""
        best, forward = self.found[0], self.forward
        beside = directions.catalogue(self.setup, (best.effect, *forward.experiment.excluded))
        scores = screen.screen(forward, best.fit, beside, also=unknown.families(forward))
        needed = scores.threshold(policy.FALSE_ALARM)
        shape, most = unknown.simplest(self.forward, self.null)
        seen = left(self.forward, best.fit, self.known, scores, short(best.gain, most))
        alarms = {"single": seen.p}
        alone = self._smooth_alone()
        instead = alone > best.log_bayes + seen.size.log_odds
        if instead and not gross.gross(self.forward, best.fit, self.known):
            return self._out_of_smooth(best, needed, most, alarms, alone)
        if seen.shapes.failed or seen.fit.failed or seen.size.found:
            return self._more(needed, most, shape, alarms, seen)
        instead = self._pair_instead(needed, most, alarms, seen)
        if instead is not None:
            return instead
        if seen.behind > 0.0:
            return self._unknown(alarms, [f"{shape} explains more than {best.effect}"], seen)
        if heldout.better(self.null, best.fit, share=policy.BY_CHANCE):
            reason = f"{best.effect} leaves nothing significant"
            return Decision([best.effect], best.fit, alarms, [reason], seen.p)
        reason = f"{best.effect} does not predict unseen runs better"
        return Decision([], self.null, alarms, [reason], seen.p)

    def _smooth_alone(self) -> float:
        """Log evidence of a smooth misfit of the nominal model, and nothing else."""
        return -np.inf if self.known is None else smooth.infer(self.forward, self.null, self.known).log_odds

    def _out_of_smooth(self, best: Candidate, needed, most, alarms, alone: float) -> Decision:
        """Several effects that leave nothing and together explain more than the smooth misfit of the nominal
        model does; or those that earn their evidence with that counted as noise; else unknown.
        """
        whole = self._without_smooth(needed, most, alarms, best.fit, alone, 2, [])
        if whole is not None:
            return whole
        turns = several.Turns(self.forward, self.known, needed, self.setup)
        grown = turns.grow(self.null, self.null)
        without = left(self.forward, self.null, self.known)
        size = 100.0 * without.size.size
        reason = f"a smooth misfit of {size:.2g} % of the peak explains more than {best.effect}"
        if not grown.best.effects:
            return self._unknown({"none": without.p, **alarms}, [reason], without)
        final = restart.moved(self.forward, grown.best.fit)
        behind = short(self.null.objective - final.objective, most)
        after = left(self.forward, final, self.known, behind=behind)
        if not after.failed and pairs.combination(self.null, final, self.setup).log_bayes > alone:
            return self._nothing_left(turns, grown, final, after, most, alarms, [])
        return self._beside(grown, needed, {**alarms, "set": after.p}, after, [])

    def _nothing_left(
        self, turns: several.Turns, grown: several.Grown, final: Fit, after: Left, most, alarms, tried
    ) -> Decision:
        """Effects, one or several, that leave nothing."""
        if len(final.hypothesis.ids) > 1:
            final, after = self._rivalled(turns, final, after, most)
        alarms, effects = {**alarms, "set": after.p}, list(final.hypothesis.ids)
        if len(effects) == 1:
            reason = f"{effects[0]} leaves nothing significant"
            return Decision(effects, final, alarms, [reason], after.p, tried)
        own = pairs.combination(self.null, final, self.setup)
        others = () if grown.size.size else grown.tried.values()
        tried = explanations.together(tried, others, own)
        return self._whole(own, others, alarms, after, tried, most)

    def _more(self, needed, most, shape, alarms, seen: Left) -> Decision:
        """Name the first pair that leaves nothing and gains enough over the best single; else go on."""
        of_two = pairs.Pairs(self.forward, self.null, self.scores, self.found)
        tried = of_two.search()
        lower = restart.lower(self.forward, self.null, tried[:ASKED], self.found)
        if lower is not None:
            return self._anew(lower)
        passed, start, lowest = self._passing(tried, needed, most, alarms, seen)
        if passed is None and not gross.gross(self.forward, start, self.known):
            asked, tried = tried[:ASKED], of_two.again()
            if [id(pair) for pair in tried[:ASKED]] != [id(pair) for pair in asked]:
                lower = restart.lower(self.forward, self.null, tried[:ASKED], self.found)
                if lower is not None:
                    return self._anew(lower)
                passed, start, lowest = self._passing(tried, needed, most, alarms, seen)
        return passed or self._set(needed, most, shape, alarms, start, lowest, tried)

    @property
    def _two_promised(self) -> bool:
        """Whether slopes promise of two effects far more than the best single one gains."""
        return bool(self.found) and planes.promised(self.scores) > self.found[0].gain + policy.PROMISED

    def _opposed(self, seen: Left) -> Decision | None:
        """A pair where no single effect passes, as each of the two takes back most of what the other does."""
        if not self._two_promised:
            return None
        needed, most = self.scores.threshold(policy.FALSE_ALARM), unknown.simplest(self.forward, self.null)[1]
        return self._pair_instead(needed, most, {"none": seen.p}, seen)

    def _pair_instead(self, needed, most, alarms, seen: Left) -> Decision | None:
        """A pair instead of one effect that leaves nothing but stands for both, where slopes promise more."""
        if not self._two_promised:
            return None
        tried = pairs.Pairs(self.forward, self.null, self.scores, self.found).search()
        passed = self._passing(tried, needed, most, dict(alarms), seen)[0]
        return passed if passed is not None and UNKNOWN not in passed.named else None

    def _anew(self, lower: list[Candidate]) -> Decision:
        """The same with single effects of which one has a lower minimum than it was known to have."""
        better = evidence.ranked(lower, self.forward.experiment.prior_odds)
        one = replace(self, found=better).decide()
        return one if one.singles else replace(one, singles=better)

    def _passing(self, tried, needed, most, alarms, seen: Left) -> tuple[Decision | None, Fit, Left]:
        """The first pair that is named, or None; the fit that sets start from, and what it leaves."""
        best = self.found[0]
        single = max(c.gain for c in self.found)
        rival = best.log_bayes + seen.size.log_odds
        start, lowest, least = best.fit, seen, -np.inf
        for pair in tried[:ASKED]:
            if pair.gain - single <= needed or not enough.suffice(self.forward, pair.fit):
                continue
            # A third effect may hide in what the record states: nuisances that strain leave no residual.
            more = pairs.screened(self.forward, pair.fit, self.setup)
            after = left(self.forward, pair.fit, self.known, more, short(pair.gain, most))
            alarms.setdefault("pair", after.p)
            if pair.log_bayes + after.size.log_odds <= rival:
                continue
            if pair.log_bayes < least:
                # What it leaves is not seen by chance: a third beside the best pair is asked for first.
                break
            if not after.failed:
                alarms["pair"] = after.p
                singles = [pairs.combination(self.null, c.fit, self.setup) for c in self.found]
                return self._whole(pair, singles, alarms, after, tried, most), pair.fit, after
            if start is best.fit:
                start, lowest, least = pair.fit, after, pair.log_bayes - policy.FURTHER
        return None, start, lowest

    def _whole(self, found: Combination, others, alarms, after: Left, tried, most) -> Decision:
        """A set that leaves nothing is named; less of it and something unknown, where its last effect earns
        so little that something outside the catalogue may as well be there.
        """
        names = set(found.effects)
        fewer = [c for c in others if set(c.effects) < names and len(c.effects) == len(names) - 1]
        seen_of = abreast.each(self.forward, lambda branch, c: left(branch, c.fit, self.known), fewer)
        parts = zip(fewer, seen_of, strict=True)
        part, seen = max(parts, key=lambda x: x[0].log_bayes + x[1].size.log_odds, default=(None, after))
        count = "a pair leaves" if len(found.effects) == 2 else f"{len(found.effects)} effects together leave"
        if part is None or found.log_bayes - part.log_bayes - seen.size.log_odds > policy.FURTHER:
            reason = f"{count} nothing significant"
            return Decision(list(found.effects), found.fit, alarms, [reason], after.p, tried)
        two_more = self._two_more(part, seen, most)
        if two_more is not None:
            more, p = two_more
            reason = f"{len(more.effects)} effects together leave nothing significant"
            return Decision(list(more.effects), more.fit, {**alarms, "set": p}, [reason], p, [*tried, more])
        (further,) = names - set(part.effects)
        reason = (
            f"{seen.where} is left, which {further} would explain, too little to tell it from anything else"
        )
        named, beside = [*part.effects, UNKNOWN], {explanations.key(part.effects): 0.0}
        return Decision(named, part.fit, alarms, [reason], seen.p, tried, beside=beside)

    def _two_more(self, part: Combination, seen: Left, most) -> tuple[Combination, float] | None:
        """A set with two effects more than one beside which a single one earns little, and the p-value of
        what it leaves: where slopes promise that only both together explain what is left, and they leave
        nothing; None without any.
        """
        if len(part.effects) + 2 > policy.MOST_EFFECTS:
            return None
        starts = planes.linear(pairs.screened(self.forward, part.fit, self.setup), self.setup, ASKED)
        fits = pairs.followed(self.forward, starts)
        found = [pairs.combination(self.null, one, self.setup) for one in fits]
        best = max(found, key=lambda c: c.log_bayes, default=part)
        if best.log_bayes - part.log_bayes - seen.size.log_odds <= policy.FURTHER:
            return None
        after = left(self.forward, best.fit, self.known, behind=short(best.gain, most))
        return None if after.failed else (best, after.p)

    def _set(self, needed, most, shape, alarms, start: Fit, seen: Left, tried) -> Decision:
        """Effects added and taken away; what is found is kept, and said beside what is left."""
        nearest = min([start, *(c.fit for c in tried)], key=lambda f: f.objective)
        large = self.known is not None and gross.gross(self.forward, nearest, self.known)
        of_three = gross.of_three(self.forward, self.null, tried, self.setup) if large else None
        if of_three is not None:
            start = of_three
        elif large:
            found = [pairs.combination(self.null, c.fit, self.setup) for c in self.found]
            prior = self.forward.experiment.prior_odds
            standing = gross.standing_out(self.forward, self.null, [*found, *tried], self.setup, prior)
            if standing.fit is None or gross.gross(self.forward, standing.fit, self.known):
                return self._standing_out(standing, alarms, seen, tried, shape, most)
            start = standing.fit
        if seen.size.found:
            rival = pairs.combination(self.null, start, self.setup).log_bayes + seen.size.log_odds
            whole = self._without_smooth(needed, most, alarms, start, rival, 3, tried)
            if whole is not None:
                return whole
        turns = several.Turns(self.forward, self.known, needed, self.setup, self.known is not None)
        grown = turns.grow(self.null, start)
        effects = list(grown.best.effects)
        final = restart.moved(self.forward, grown.best.fit) if grown.size.size else grown.best.fit
        if len(effects) == 1 and (lower := restart.led(self.null, final, self.found)):
            return self._anew(lower)
        behind = short(self.null.objective - final.objective, most)
        if behind > 0.0 and effects and grown.size.size:
            # Slow shapes take up the smooth misfit itself: they and effects are held against each other with
            # that counted as noise.
            most = unknown.simplest(grown.forward, grown.null)[1]
            behind = short(grown.null.objective - grown.best.fit.objective, most)
        after = left(self.forward, final, self.known, behind=behind) if effects else seen
        if effects and not after.failed:
            return self._nothing_left(turns, grown, final, after, most, alarms, tried)
        alarms["set"] = after.p
        if len(effects) > 1:
            own = pairs.combination(self.null, final, self.setup)
            others = () if grown.size.size else grown.tried.values()
            tried = explanations.together(tried, others, own)
        if behind > 0.0:
            return self._unknown(alarms, [f"{shape} explains more than any effect or set"], after, tried)
        return self._beside(grown, needed, alarms, after, tried)

    def _without_smooth(
        self, needed, most, alarms, start: Fit, rival: float, fewest: int, tried
    ) -> Decision | None:
        """So many effects or more that leave nothing, where that is likelier than what a smooth misfit
        explains beside fewer, with a log evidence of `rival`.

        Once a discrepancy is counted as noise it hides weak effects, so that these are asked for before.
        """
        turns = several.Turns(self.forward, self.known, needed, self.setup, infer=False, rival=rival)
        grown = turns.grow(self.null, start)
        best = grown.best
        if len(best.effects) < fewest or best.log_bayes <= rival:
            return None
        after = left(self.forward, best.fit, self.known, behind=short(best.gain, most))
        if after.failed:
            return None
        final, after = self._rivalled(turns, best.fit, after, most)
        best = pairs.combination(self.null, final, self.setup)
        ranked = explanations.together(tried, grown.tried.values(), best)
        return self._whole(best, grown.tried.values(), {**alarms, "set": after.p}, after, ranked, most)

    def _rivalled(self, turns: several.Turns, final: Fit, after: Left, most) -> tuple[Fit, Left]:
        """A set that leaves nothing, or a likelier one like it that does so too, and what it leaves; those
        that might stand in its place have been fitted then, and share its probability.
        """
        other = turns.rivals(final)
        if other is not final:
            behind = short(self.null.objective - other.objective, most)
            instead = left(self.forward, other, self.known, behind=behind)
            if not instead.failed:
                return other, instead
        return final, after

    def _standing_out(self, standing: gross.Standing, alarms, seen: Left, tried, shape, most) -> Decision:
        """What stands out of a misfit that is large beside the noise, and something unknown."""
        one = standing.fit
        if one is not None and short(self.null.objective - one.objective, most) > 0.0:
            return self._unknown(alarms, [f"{shape} explains more than any effect or set"], seen, tried)
        after = left(self.forward, one, self.known) if one is not None else seen
        reasons = [f"what is left is large beside the noise: {after.where}"]
        reasons += [
            f"{name}: part of what explains these data with probability {p:.2f}"
            for name, p in sorted(standing.shares.items(), key=lambda x: -x[1])
            if p > policy.TOLD
        ]
        names = one.hypothesis.ids if one is not None else ()
        if any(standing.shares[name] <= policy.STANDS_OUT for name in names):
            reasons.append(f"a law that takes energy, whichever: with probability {standing.loss:.2f}")
        view = View(*weighing.widened(self.forward, self.null, one or self.null))
        if one is None:
            nothing = self._unknown(alarms, [*reasons, "no effect stands out of it"], after, tried)
            return replace(nothing, counted=view, rivals=standing.rivals)
        alarms["set"] = after.p
        reasons += standing.instead
        tried = explanations.together(tried, standing.found, pairs.combination(self.null, one, self.setup))
        return Decision(
            [*names, UNKNOWN],
            one,
            alarms,
            reasons,
            after.p,
            tried,
            after.size.size,
            view,
            standing.weights,
            rivals=standing.rivals,
        )

    def _beside(self, grown: several.Grown, needed, alarms, after: Left, tried) -> Decision:
        """What stays named beside something unknown."""
        beside = Beside(self.forward, self.null, self.found, self.known, self.setup)
        return beside.decide(grown, needed, alarms, after, tried)
