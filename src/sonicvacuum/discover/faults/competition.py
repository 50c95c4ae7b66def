"""Slips and effects in competition for the same misfit: what is put right, what is said of it, how sure.

First what traces show by themselves is put right. Then, while the nominal model leaves a misfit, every slip
is looked at; one that takes away nearly all of it is put right before any effect is searched for. The search
for effects follows, and what it finds is weighed against the best of the other slips: the evidence of all
explanations of the record as it is against that of all explanations of the record put right. Where effects
leave a misfit, slips are looked at once more beside them, those that the traces showed included.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from sonicvacuum.discover.faults import policy, tables
from sonicvacuum.discover.faults.alone import wholes
from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.judged import (
    Judged,
    Model,
    each_once,
    excess,
    exchanged,
    most_of,
    obvious,
    of_one_run,
    other_clock,
    scatter,
    suspicious,
    without_slip,
)
from sonicvacuum.discover.faults.retract import retracted, value
from sonicvacuum.discover.faults.searching import Led, Searching
from sonicvacuum.discover.faults.table import FAULTS
from sonicvacuum.discover.faults.timing import counted_on
from sonicvacuum.discover.faults.weights import (
    ALIKE,
    NUISANCES,
    acts_like,
    alias,
    as_likely,
    give_way,
    hollow,
    least_gain,
    odds_of,
    part_without,
    parts,
    refused,
    unexplained,
    weight_beside,
    weight_of,
)
from sonicvacuum.discover.fit import evidence
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import together
from sonicvacuum.discover.policy import SAME_MINIMUM
from sonicvacuum.discover.rounds import Investigation, investigate
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.records import Record
from sonicvacuum.records.suspects import weights


@dataclass(frozen=True)
class Outcome:
    """What was found, slips and effects.

    Attributes:
        found: effects, of the record put right.
        findings: slips, most probable first.
        record: the (first) record put right.
        simulations: chains simulated for the slips.
    """

    found: Investigation
    findings: tuple[Finding, ...]
    record: Record
    simulations: int = 0


def discover(records: Sequence[Record], catalogue: Catalogue = CATALOGUE, threads: int = 1) -> Outcome:
    """Slips and effects of one record, or of records taken together.

    Of several records only what traces show by themselves is looked for: they share a chain and its gauges,
    and each has its own slips. Of a record without traces slips are asked for from `policy.FEWEST_VALUES`
    values on (`tables.asked`), eight; fewer are searched for effects only.
    """
    seen = [predicted(together((r,), catalogue), threads) if r.signals else {} for r in records]
    looked = [examine(*one) for one in zip(records, seen, strict=True)]
    benches, findings = [bench for bench, _ in looked], [f for _, own in looked for f in own]
    if len(records) > 1 or not (benches[0].record.signals or tables.asked(benches[0].record)):
        return Outcome(_investigated(benches, catalogue, threads), tuple(findings), benches[0].record)
    search = Search(benches[0], catalogue, threads, findings)
    outcome = search.run()
    return _asked_again(outcome, findings, records[0], seen[0], search)


def _asked_again(outcome: Outcome, findings, record: Record, seen, search: "Search") -> Outcome:
    """The outcome without slips that effects explain better; once one is gone, others may be."""
    spared: set[tuple[str, str]] = set()
    for _ in range(policy.MOST):
        more = retracted(outcome.found, findings, record, seen, search.make, spared)
        if not more:
            break
        spared |= more
        bench, findings = examine(record, seen, spared)
        search = Search(bench, search.catalogue, search.threads, findings)
        other, before = search.run(), outcome
        old, new = (value(o.found.forward, o.found.final) for o in (before, other))
        chosen = before if unexplained(other.found) and new > old else other
        outcome = replace(chosen, simulations=before.simulations + other.simulations)
        if chosen is before:
            break
    return outcome


def _investigated(benches, catalogue, threads):
    experiment = together([b.record for b in benches], catalogue)
    lost = {at: rows for b in benches for at, rows in b.lost.items()}
    lines = {at: line for b in benches for at, line in b.lines.items()}
    return investigate(Bench(benches[0].record, lost, lines).masked(experiment), threads)


class Search(Searching):
    """Slips of one record that only the model can tell, in competition with effects."""

    def __init__(self, bench: Bench, catalogue: Catalogue, threads: int, plain: list[Finding]):
        super().__init__(bench, catalogue, threads, plain)
        # Effects that alone explain as much as the likeliest slip, which moves all pulses as they may.
        self._matching: set[str] = set()

    def run(self) -> Outcome:
        """Slips that leave nothing to doubt, then effects, then the rest of the slips against them."""
        for _ in range(policy.MOST):
            model = self._nominal = self.nominal()
            looked = suspicious(model)
            if looked and self._spikes_beside_one(model):
                continue
            ranked = self.ranked(model) if looked else []
            if ranked and obvious(ranked[0], model) and (lower := without_slip(ranked[0], model)):
                model = self._nominal = lower
                ranked = self.ranked(model)
            if ranked and self._sure(ranked[0], model):
                told, alone = tuple(self.findings), self._alone.at_hand(model) or []
                self._accept(ranked, ranked[0])
                self._led = Led(model, ranked[0], alone, told, self.bench)
            elif (one := self._beside_one_effect(ranked, model)) is not None:
                self._accept([one], one)
            elif not (looked and self._values_beside_one_effect(model)):
                break
        else:
            ranked, looked = [], True
        bench = self.bench
        found = self._clock_by_a_step(self._factors_anew(self._effects_instead(self._investigate())))
        found = self._values_beside(self._errors_as_stated(self._zeros_as_stated(found)))
        anew = self.bench is not bench
        if anew or (model.bench is bench and found.null.objective < model.fit.objective - SAME_MINIMUM):
            # What slips gained beside spikes, or on a fit that had stopped short, is none of their own.
            model = self.nominal() if anew else Model(bench, model.forward, found.null)
            self._nominal, looked = model, suspicious(model)
            ranked = self.ranked(model) if looked else []
        traced = bool(self.bench.record.signals)
        if not ranked and set(found.named) - {explanations.UNKNOWN}:
            ranked = self.as_small(model, found) if traced else []
        elif ranked and traced and any(self._like_slips(found, name) for name in found.named):
            ranked = self.ranked(model, afar=True, least=least_gain(found, found.null))
        for _ in range(policy.MOST):
            better = self._instead(found, ranked)
            if better is None:
                break
            found, ranked = self._zeros_as_stated(self._factors_anew(better)), []
        order = sorted(counted_on(self._as_seen(found), found), key=lambda f: -f.probability)
        return Outcome(found, tuple(order), self.bench.record, self.simulations + self._alone.simulations)

    def _sure(self, judged: Judged, model: Model) -> bool:
        """Whether a slip is put right before effects are asked for."""
        if exchanged(judged, model):
            return True
        if obvious(judged, model):
            return not self._matched(judged, model)
        least = judged.gain - policy.AHEAD
        return of_one_run(judged, model) and all(c.gain < least for c in self._alone.beside(model))

    def _matched(self, judged: Judged, model: Model) -> bool:
        """Whether an effect alone explains about as much as a slip, or more: one that moves all pulses as an
        effect may, or leaves a misfit of its own. A gauge in volts fits far better in its neighbour's place.
        """
        if judged.slip.plain:
            return False
        rest = excess(model) - judged.gain
        leaves = rest > max(policy.SURE_GAIN, policy.REST * excess(model))
        if not (FAULTS[judged.slip.fault].stretches or judged.slip.of_values or leaves):
            return False
        if not leaves and other_clock(judged, model):
            return False
        found = self._alone.beside(model)
        self._matching = {c.effect for c in found if c.gain > judged.gain - ALIKE}
        return bool(self._matching) or any(tables.beyond_chance(judged, c.gain) for c in found)

    def _beside_one_effect(self, ranked: list[Judged], model: Model) -> Judged | None:
        """A slip beside which one effect explains the record, see `alone`; any run's own zero, for one's."""
        ranked = sorted([*ranked, *self.aside], key=lambda j: -j.log_odds)
        gross = excess(model) > max(policy.SURE_GAIN, policy.BURIED * data(model.forward))
        shown = any(judged.slip.shown for judged in self.behind)
        if excess(model) < policy.SURE_GAIN or not (wholes(ranked) or gross or shown):
            return None
        return self._beside_the_leading(model) or self._alone.explained(ranked, model, self.behind)

    def _beside_the_leading(self, model: Model) -> Judged | None:
        """The only slip that leaves noise beside the effect that explains nearly all, but not all, by itself:
        where a strong effect acts, the nominal model does not tell which slip was made.
        """
        size, best = data(model.forward), [c.fit for c in self._alone.beside(model)[:1]]
        left = min((one.objective for one in best), default=math.inf) - size
        if not max(policy.GROSS * size, policy.SURE_GAIN) < left < policy.NEARLY * excess(model):
            return None
        behind, most = self.behind, policy.SHARE * (left - scatter(size))
        beside, self.behind = self.ranked(replace(model, fit=best[0]), afar=True, least=most), behind
        fitting = [j for j in beside if left - j.gain < scatter(size)]
        return fitting[0] if len(fitting) == 1 else None

    def _like_slips(self, found: Investigation, name: str) -> bool:
        """Whether an effect named moves data as some slip does."""
        if name == explanations.UNKNOWN:
            return False
        like = acts_like(found, name)
        # Contacts of balls of another size are stiffer or softer, as those of another modulus.
        sized = "modulus" in like and any(ball.off for ball in weights(self.bench.record))
        return name in self._matching or sized or bool(NUISANCES & like)

    def _instead(self, found: Investigation, ranked: list[Judged]) -> Investigation | None:
        """The investigation of the record with one slip more put right, where that explains it better."""
        left, size = unexplained(found), float(found.sizes.sum())
        if left:
            # What is left is more than a slip that explains little of it. A run that is far off is not to be
            # mistaken for anything else, and may leave as much as an effect makes.
            most = most_of(found.null.objective, size)
            rivals = [j for j in ranked if j.gain > (policy.ALONE if j.slip.far else 1.0) * most]
        else:
            rivals = [*ranked, *self._in_place(found)]
        if left or refused(found):
            rivals += self._beside_the_best(found)
        # Runs whose stated errors are strained may be all that betrays a slip beside the right effect.
        final = Model(self.bench, found.forward, found.final)
        if found.final is not found.null and (left or suspicious(final)):
            rivals += self._beside(found)
        rivals = each_once(rivals)
        better = self.weighed(found, rivals, left) if rivals else None
        if better is None and left and len(as_likely(rivals)) > 1:
            # Slips that are as likely beside a wrong effect need not be so beside the right one.
            better = self.weighed(found, rivals[1:], left)
        return better

    def _beside(self, found: Investigation) -> list[Judged]:
        """Slips beside the effects that were found, as if beside the nominal model: their gain included."""
        own = found.null.objective - found.final.objective
        if own <= 0.0:
            # Led by a smooth misfit that explains nearly anything: nothing is the better beside it.
            return []
        judged = self._included(found, found.final, weight_of(found) - math.log(evidence.PRIOR_NONE))
        least = most_of(found.final.objective, float(found.sizes.sum())) if unexplained(found) else 0.0
        return [j for j in judged if j.gain - own > least]

    def _beside_the_best(self, found: Investigation) -> list[Judged]:
        """Slips beside the likeliest effect, which was not named though it leaves noise or a little more."""
        if found.final is not found.null or not found.candidates:
            return []
        best, size = found.candidates[0], float(found.sizes.sum())
        if best.gain < most_of(found.null.objective, size):
            return []
        judged = self._included(found, best.fit, weight_beside(found, best.effect))
        return [j for j in judged if j.gain - best.gain > most_of(best.fit.objective, size)]

    def _in_place(self, found: Investigation) -> list[Judged]:
        """Slips in place of one effect of a set that moves data as some slip does, or of all that do, beside
        the others; and of all but one.
        """
        like = [name for name in found.named if self._like_slips(found, name)]
        judged, alone = [], [[n for n in found.named if n != one] for one in found.named]
        for names in dict.fromkeys(map(tuple, [*([name] for name in like), like, *alone])):
            if 0 < len(names) < len(found.named) and (part := part_without(found, names)):
                rest, fit = part
                judged += self._included(found, fit, weight_beside(found, rest))
        return judged

    def _included(self, found: Investigation, fit: Fit, weight: float) -> list[Judged]:
        """Slips beside a fit, what the fit itself gains and weighs against the nominal model included."""
        own = found.null.objective - fit.objective
        beside, least = Model(self.bench, found.forward, fit), least_gain(found, fit)
        ranked = self.ranked(beside, afar=True, least=least)
        return [replace(j, gain=j.gain + own, log_bayes=j.log_bayes + weight) for j in ranked]

    def weighed(self, found, rivals, left):
        """The investigation of the record with the best rival put right, None where that is no better."""
        same = [j for j in rivals if alias(j, found)]
        near = [j for j in rivals if same and j.gain > same[0].gain - ALIKE]
        if same and parts(near, same[0]).max() <= policy.LIKELIER:
            self._share(found, near, same[0])
            return None
        best, as_is = rivals[0], weight_of(found)
        put_right = best.log_odds + math.log(evidence.PRIOR_NONE)
        hopeless = put_right < as_is - math.log(1.0 / policy.SHOWN)
        if not left and hopeless and not self._nearly_all(best, found):
            return None
        bench, before = self.bench, list(self.findings)
        self._accept(rivals, best)
        after = self._investigate()
        base = best.log_odds if best.model.fit.hypothesis.components == () else odds_of(best, found, after)
        odds = base + weight_of(after) - as_is
        p = 1.0 / (1.0 + math.exp(-max(min(odds, 700.0), -700.0)))
        if p > 0.5 and not hollow(found, after):
            self.findings = [
                f if f in before else replace(f, probability=min(f.probability * p, policy.PLAIN))
                for f in self.findings
            ]
            return after
        self.bench, self.findings = bench, before
        if p >= policy.SHOWN and not hollow(found, after):
            self._share(found, [best], None, p, after)
        return None

    def _nearly_all(self, best: Judged, found: Investigation) -> bool:
        """Whether a slip explains nearly all that a set does in which an effect is like some slip: with
        another effect beside it, it may explain the rest.
        """
        own = found.null.objective - found.final.objective
        like = len(found.named) > 1 and any(self._like_slips(found, name) for name in found.named)
        return like and best.gain > policy.SHARE * own

    def _share(self, found: Investigation, rivals: list[Judged], like: Judged | None, p=1.0, after=None):
        """Say slips that explain as well as the effects named, and take their share from these.

        With `like`, the slip among them that moves the data exactly as one effect: both weigh the same.
        `after` are the effects with the slip put right.
        """
        weights = p * parts(rivals, like)
        for judged, weight in zip(rivals, weights, strict=False):
            if weight >= policy.SHOWN:
                self.findings += judged.findings(float(weight))
        missing = give_way(found, float(weights[: len(rivals)].sum()), like, after)
        names = " or ".join(dict.fromkeys(j.slip.fault for j in rivals))
        found.reasons.append(
            f"a slip, {names}, explains these data as well: {missing} is missing where it was made"
        )
