"""The search for effects in a record as far as it was put right, spikes that its pulses hide left out.

A slip that takes away nearly all misfit by itself is put right before any effect is asked for. Where an
effect alone explains most of that too (a striker that is slower than stated, beside all gauges that read too
little), the two are held against each other once more, beside the effects that were found then.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover.faults import changes, clocks, counted, policy, several, zeros
from sonicvacuum.discover.faults.alone import Kept, alone
from sonicvacuum.discover.faults.examine import with_noise_of
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.judged import Judged, Model, scatter
from sonicvacuum.discover.faults.judging import Judge
from sonicvacuum.discover.faults.ranking import Ranking
from sonicvacuum.discover.faults.slips import Slip, hypotheses
from sonicvacuum.discover.faults.strays import Strays, masked, single_samples, strays, told
from sonicvacuum.discover.faults.timing import delay_left_open, late_runs
from sonicvacuum.discover.faults.weights import hollow, unexplained, weight_of
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.fit.wide import far
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.rounds import Investigation, investigate
from sonicvacuum.discover.search import pairs, singles
from sonicvacuum.effects import Catalogue


@dataclass(frozen=True)
class Led:
    """A slip that was put right before any effect was asked for.

    Attributes:
        model: of the record as it was before.
        slip: as it was judged.
        alone: single effects beside that model, best first, where they were asked for.
        findings: slips told of before.
        bench: the record with the slip put right.
    """

    model: Model
    slip: Judged
    alone: Sequence[Candidate]
    findings: Sequence[Finding]
    bench: Bench


def _sized_anew(said: Finding, judged: Judged) -> Finding:
    """What is said of a factor or a time zero that was put right, with what it is off by."""
    slip, more = judged.slip, judged.slip.value(judged.size)
    if not said.corrected or (said.fault, said.run, said.sensor) != (slip.fault, slip.run, slip.sensor):
        return said
    return replace(said, value=said.value + more if said.fault == "time-zero" else said.value * more)


class Searching(Ranking):
    """Slips of one record, and the effects in it."""

    def __init__(self, bench: Bench, catalogue: Catalogue, threads: int, plain: list[Finding]):
        super().__init__(bench, catalogue, threads, plain)
        self._nominal: Model | None = None
        self._led: Led | None = None
        self._alone = Kept()
        # Errors of tables that are taken to be of another size.
        self._sized: list[Judged] = []
        # Values of tables that are off, of which only a model tells by how much.
        self._off: list[Slip] = []
        self.given = bench.record

    def _accept(self, ranked: list[Judged], chosen: Judged, share: float = 1.0) -> None:
        """Put a slip right; its rivals are said as far as they are probable."""
        odds = np.array([j.log_odds for j in ranked])
        weights = np.exp(odds - odds.max())
        weights /= weights.sum()
        for judged, weight in zip(ranked, weights, strict=True):
            p = min(float(weight) * share, policy.PLAIN)
            if judged.slip.known and judged is chosen:
                self.findings = [_sized_anew(f, judged) for f in self.findings]
            elif judged is chosen or (p >= policy.SHOWN and not judged.slip.known):
                told = judged.findings(p)
                self.findings += [replace(finding, corrected=judged is chosen) for finding in told]
        self.bench = chosen.model.bench
        if chosen.slip.undo is not None:
            self._sized.append(chosen)
        if chosen.slip.seen is not None:
            self._off.append(chosen.slip)
        if chosen.slip.fault == "gauge-delayed":
            seen = predicted(self.make(self.bench), self.threads)
            record = delay_left_open(self.bench.record, chosen.slip.sensor, seen)
            self.bench = replace(self.bench, record=record)
        sensor, mixed = chosen.slip.sensor, chosen.slip.fault in ("gauges-swapped", "gauge-gain")
        if mixed and self.bench.record.signals:
            gauges = (sensor,) if isinstance(sensor, str) else sensor
            self.findings = with_noise_of(self.findings, self.bench.record, gauges)

    def _effects_instead(self, found: Investigation) -> Investigation:
        """The effects of the record as it was before the slip put right last, where one that alone explains
        most of what this does explains more in its place, beside those that were found.
        """
        led = self._led
        if led is None or self.bench is not led.bench or not led.slip.slip.continuous:
            return found
        most = policy.MOSTLY * led.slip.gain
        near = [c for c in led.alone if c.gain > most and c.effect not in found.final.hypothesis.ids]
        if not near or found.final is found.null:
            return found
        if self._beside_found(led, near[0], found) < led.slip.log_odds + weight_of(found):
            return found
        self.bench, self.findings = led.model.bench, list(led.findings)
        self.simulations += found.forward.chains
        return self._investigate()

    def _beside_found(self, led: Led, one: Candidate, found: Investigation) -> float:
        """Log of prior times evidence of an effect in place of a slip, beside those found with it."""
        others, forward, before = found.final, led.model.forward, led.model.forward.chains
        both = Hypothesis((*others.hypothesis.components, *one.fit.hypothesis.components))
        u = np.concatenate((others.u, one.fit.u))[None]
        joint = pairs.combination(
            led.model.fit, fit(forward, both, u, one.fit.nu[None]), singles.setup_of(forward)
        )
        self.simulations += forward.chains - before
        told = explanations.log_weights((), [joint], forward.experiment.prior_odds)
        return told.get(explanations.key(joint.effects), -math.inf)

    def _factors_anew(self, found: Investigation) -> Investigation:
        """The effects, where beside them a factor, or the time zero of one run, that was put right has
        another size with that: damping takes a part of every pulse, as less gain of all gauges would, and
        makes pulses late, as a late trigger would.
        """
        if found.final is found.null:
            return found
        model = Model(self.bench, found.forward, found.final)
        again = self.factors(hypotheses(self.bench.record), model) + self._zeros_anew(model)
        if not again:
            return found
        judge = Judge(model, self.judged)
        near = [j for j in judge.look_at(again) if j.gain > policy.OTHER_SIZE]
        better = [j for j in judge.follow_all(near) if j.gain > policy.OTHER_SIZE]
        self.simulations += judge.simulations
        if not better:
            return found
        best = max(better, key=lambda j: j.gain)
        self._accept([best], best)
        self.simulations += found.forward.chains
        return self._investigate()

    def _zeros_anew(self, model: Model) -> list[Slip]:
        """Time zeros of single runs that were put right, asked for once more beside a model that strains
        them.
        """
        runs = {f.run for f in self.findings if f.corrected and f.fault == "time-zero" and f.run}
        seen = predicted(self.make(model.bench), self.threads) if runs else {}
        late = late_runs(model.bench.record, model, seen) if runs else []
        return [replace(slip, known=True) for slip in late if slip.run in runs]

    def _clock_by_a_step(self, found: Investigation) -> Investigation:
        """The effects beside a clock that is off by a step, where one that was put right by any factor hides
        an effect: stiffer beads make all times shorter, and so would a clock; that forces are higher besides
        is left to others then.
        """
        told = next((f for f in self.findings if f.corrected and f.fault == "clock" and not f.run), None)
        same = clocks.alike(self.catalogue)
        if told is None or not (unexplained(found) or same & set(found.named)):
            return found
        asked = {step: self._beside_clock(step / told.value) for step in clocks.steps_near(told.value)}
        step, (model, best) = min(asked.items(), key=lambda one: one[1][1])
        if best > found.null.objective - policy.LEAST_GAIN:
            clocks.share(found, self.catalogue)
            return found
        before, self.bench = self.bench, model.bench
        after = investigate(self.make(model.bench), self.threads, model.fit)
        odds = weight_of(after) - weight_of(found) - 0.5 * (after.null.objective - found.null.objective)
        # Two effects that act alike stand for a clock that is off by another factor.
        worse = odds + clocks.log_prior(self._led and self._led.slip) < 0.0 or hollow(found, after)
        if worse or len(same & set(after.named)) > 1:
            self.bench = before
            self.simulations += after.forward.chains
            clocks.share(found, self.catalogue)
            return found
        self.simulations += found.forward.chains
        self.findings = [replace(f, value=step) if f is told else f for f in self.findings]
        return after

    def _zeros_as_stated(self, found: Investigation) -> Investigation:
        """The effects beside time zeros as they are stated, or but for one run, where these explain the
        record as well: what an effect delays looks at first like triggers that nobody knows.
        """
        found = counted.instead_of_zeros(self, found)
        told = [f for f in self.findings if f.corrected and f.fault == "time-zero"]
        if len(told) != 1 or (told[0].run, told[0].value) != (None, None) or found.final is found.null:
            return found
        record = zeros.stated_again(self.bench.record, self.given)
        if record is None:
            return found
        bench, one = replace(self.bench, record=record), found.final
        forward = found.forward.of(self.make(bench))
        trial = fit(forward, one.hypothesis, one.u[None], np.zeros((1, forward.layout.size)))
        self.simulations += forward.chains
        late = None
        if trial.objective - one.objective > zeros.cost(self.bench.record):
            judge = Judge(Model(bench, forward, trial), self.judged)
            late = zeros.one_late(judge, Model(self.bench, found.forward, one))
            self.simulations += judge.simulations
            if late is None:
                return found
            bench = late.model.bench
        after = investigate(self.make(bench), self.threads)
        self.simulations += found.forward.chains
        if unexplained(after) and not unexplained(found):
            return found
        others = [f for f in self.findings if f.fault != "time-zero"]
        own = late.findings(told[0].probability) if late else []
        self.bench, self.findings = bench, others + [replace(f, corrected=True) for f in own]
        return after

    def _values_beside_one_effect(self, model: Model) -> bool:
        """Whether several values of a table are all that the best effect alone leaves; they are put right
        then: sets of effects would be asked for what they do.
        """
        best = [] if self.bench.record.signals else self._alone.beside(model)[:1]
        return bool(best) and self._values_off(replace(model, fit=best[0].fit))

    def _values_off(self, model: Model) -> bool:
        """Whether several values of a table are all that a model leaves; they are put right then."""
        chosen = several.leaving_noise(self, model, policy.MOST - self._corrected())
        for one in chosen:
            self._accept([one], one)
        return bool(chosen)

    def _corrected(self) -> int:
        return sum(f.corrected for f in self.findings)

    def _values_beside(self, found: Investigation) -> Investigation:
        """The effects, where several values of a table are all that they leave, of the table without them."""
        if self.bench.record.signals or found.final is found.null or not unexplained(found):
            return found
        bench, findings = self.bench, list(self.findings)
        if not self._values_off(Model(bench, found.forward, found.final)):
            return found
        after = self._investigate()
        if not unexplained(after):
            self.simulations += found.forward.chains
            return after
        self.simulations += after.forward.chains
        self.bench, self.findings = bench, findings
        return found

    def _as_seen(self, found: Investigation) -> list[Finding]:
        """What is said, of values that are off by how much beside the effects that were found."""
        model = Model(self.bench, found.forward, found.final)
        value = {slip.at: slip.seen(model) for slip in self._off if slip.seen}
        at = [(f.fault, f.run, f.sensor, f.quantity) for f in self.findings]
        return [
            replace(f, value=value.get(k, f.value)) if f.corrected else f
            for k, f in zip(at, self.findings, strict=True)
        ]

    def _errors_as_stated(self, found: Investigation) -> Investigation:
        """The effects beside errors as a table states them, where they explain by themselves what errors of
        another size were told for, or beside a few values that are off, or in each other's place.
        """
        sized, self._sized = self._sized, []
        for errors in sized:
            chosen = several.instead_of_errors(self, found, errors, policy.MOST + 1 - self._corrected())
            if chosen is None:
                continue
            before, told = self.bench, self.findings
            kind = errors.slip.fault, errors.slip.quantity
            self.findings = [f for f in told if (f.fault, f.quantity) != kind]
            self.bench = replace(before, record=errors.slip.undo(before.record))
            for one in chosen:
                self._accept([one], one)
            after = self._investigate()
            if unexplained(after) and not unexplained(found) and not chosen:
                self.bench, self.findings = before, told
                self.simulations += after.forward.chains
                continue
            self.simulations += found.forward.chains
            found = after
        return found

    def _beside_clock(self, ratio: float) -> tuple[Model, float]:
        """The nominal model beside a clock so many times the one that was put right, and the least that one
        effect which moves all times or forces leaves beside it.
        """
        bench, before = self.bench, self.bench
        self.bench = replace(bench, record=changes.clock(bench.record, math.log(ratio)))
        model = self.nominal()
        self.bench = before
        found, chains = alone(model, clocks.alike(self.catalogue))
        self.simulations += chains
        return model, min((c.fit.objective for c in found), default=math.inf)

    def _investigate(self) -> Investigation:
        """The effects; where spikes that a pulse hid, or tails of noise, are all that they leave, without."""
        found = self._searched()
        if self.far and not far(found.forward, found.final):
            self.far, self._nominal = False, None
            self.simulations += found.forward.chains
            found = self._searched()
        if unexplained(found) and self._masks(strays(found.forward, found.final), found.final):
            found = self._searched()
        faint = unexplained(found) and single_samples(found.forward, found.final)
        if faint and self._masks(strays(found.forward, found.final, faint=True), found.final):
            return self._searched()
        return found

    def _spikes_beside_one(self, model: Model) -> bool:
        """Whether the model as it is, or the best effect alone, leaves noise and spikes, which are masked: no
        slip and no set of effects explains them. Where some show, in a trace or beside the model, others may
        hide.
        """
        if not self.bench.record.signals:
            return False
        hidden = strays(model.forward, model.fit)
        if self._masks(hidden, model.fit):
            return True
        shown = bool(hidden) or any(f.fault == "spikes" for f in self.findings)
        best = self._alone.beside(model)[:1] if shown else []
        return any(self._masks(strays(model.forward, c.fit), c.fit) for c in best)

    def _masks(self, hidden: Strays, one: Fit) -> bool:
        """Whether a fit leaves noise without some spikes, which are masked then; those of hundreds of
        standard deviations have drawn it off.
        """
        if not hidden:
            return False
        bench = masked(self.bench, hidden)
        forward = Forward(self.judged(bench), self.threads)
        found, size = fit(forward, one.hypothesis, one.u[None], one.nu[None]), data(forward)
        self.simulations += forward.chains
        if found.objective > size + scatter(size):
            return False
        self.bench, self.findings = bench, told(self.findings, hidden)
        return True

    def _searched(self) -> Investigation:
        one = self._nominal
        if one is None or one.bench is not self.bench:
            return investigate(self.make(self.bench), self.threads)
        return investigate(self.make(self.bench), self.threads, one.fit, self._alone.at_hand(one))
