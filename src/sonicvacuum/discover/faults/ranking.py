"""Which slips explain a record, as far as it was put right, beside a model of it.

Of every slip that a laboratory can make slopes tell what it may gain; those that promise enough are followed
to their size (`judging`), and the likeliest come first.
"""

from dataclasses import replace

from sonicvacuum import stages
from sonicvacuum.discover.faults import policy, tables
from sonicvacuum.discover.faults.afar import from_afar
from sonicvacuum.discover.faults.exchanges import exchanged_gauges, exchanged_traces, other_order
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.gains import beside, gains_of_one, rough_gains
from sonicvacuum.discover.faults.judged import (
    Judged,
    Model,
    both_off,
    excess,
    obvious,
    of_the_chain,
    out_of_reach,
    speaks_for,
)
from sonicvacuum.discover.faults.judging import Judge
from sonicvacuum.discover.faults.lines import drifts
from sonicvacuum.discover.faults.seats import seats
from sonicvacuum.discover.faults.slips import Slip, hypotheses
from sonicvacuum.discover.faults.starts import FACTORS, run_clock, run_clocks, unfinished, with_starts
from sonicvacuum.discover.faults.table import FAULTS
from sonicvacuum.discover.faults.timing import late_runs, time_zero, unknown_zeros
from sonicvacuum.discover.faults.weights import ALIKE
from sonicvacuum.discover.faults.zeros import simplest
from sonicvacuum.discover.fit import smooth
from sonicvacuum.discover.fit.refit import fit, polish
from sonicvacuum.discover.fit.wide import far, nominal
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.nominal import predicted, read_at, read_to_the_end
from sonicvacuum.discover.model.problem import together
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.effects import Catalogue


def _as_well(judged: Judged, plain: Judged) -> bool:
    """Whether the speed of a run explains a value of it that stands out: where it moves that one alone."""
    same = judged.slip.fault == "run-off" and judged.slip.run == plain.slip.run
    return same and judged.gain > plain.gain - ALIKE


def _one_gain(ranked: list[Judged]) -> list[Judged]:
    """Slips, the likeliest first, with one gain of each trace: by a step of a range, or by any factor."""
    seen = [j.slip.at if j.slip.fault == "gauge-gain" else None for j in ranked]
    return [j for k, j in enumerate(ranked) if seen[k] is None or seen[k] not in seen[:k]]


def _possible(slips: list[Slip], model: Model) -> list[Slip]:
    """Slips without those that move an effect: in a chain of another length the place of one at a bead or a
    contact would be another one, or none.
    """
    placed = any(c.effect.places in ("bead", "contact") for c in model.fit.hypothesis.components)
    return [s for s in slips if not (placed and of_the_chain(s))]


class Ranking:
    """Slips of one record beside models of it.

    Attributes:
        bench: the record as far as it was put right.
        catalogue: effects that may act in it.
        threads: processors to use.
        findings: slips that are told of.
        simulations: chains simulated so far.
        behind: gauges exchanged, and slips that traces show, fitted beside the last model, which gain nothing
            by themselves.
        aside: time zeros of each run's own, fitted beside the last model, where that of one explains as much.
        far: whether the last model leaves so much that simulations need not be as accurate as noise asks.
    """

    def __init__(self, bench: Bench, catalogue: Catalogue, threads: int, plain: list[Finding]):
        self.bench, self.catalogue, self.threads = bench, catalogue, threads
        self.findings, self.simulations = list(plain), 0
        self.behind: list[Judged] = []
        self.aside: list[Judged] = []
        self.far = False

    def make(self, bench: Bench) -> Experiment:
        """The data set of a record as far as it was put right."""
        return replace(bench.masked(together((bench.record,), self.catalogue)), approximate=self.far)

    def judged(self, bench: Bench) -> Experiment:
        """The same with the smooth misfit that the record states counted as noise, as the search has it."""
        experiment = self.make(bench)
        size = experiment.model_floor_rel
        return smooth.with_size(experiment, size) if size else experiment

    def nominal(self) -> Model:
        """The nominal model of the record as far as it was put right."""
        self.far = False
        forward = Forward(self.judged(self.bench), self.threads)
        found = nominal(forward)
        # Far from the data nuisances creep; a slip must not be asked to do what they would have done.
        found = found if found.settled else polish(forward, found)
        self.simulations += forward.chains
        if forward.cut > 1.0 and far(forward, found):
            self.far = True
            forward = Forward(self.judged(self.bench), self.threads)
            same = fit(forward, found.hypothesis, found.u[None], found.nu[None])
            found = replace(same, others=found.others, elsewhere=found.elsewhere)
            self.simulations += forward.chains
        return Model(self.bench, forward, found)

    def factors(self, slips: list[Slip], model: Model) -> list[Slip]:
        """Factors that were put right before, asked for once more beside a model; `slips` are all of a
        record.
        """
        rough = [f for f in self.findings if f.corrected and f.fault in FACTORS]
        common = {f.fault for f in rough if not f.run}
        again = [s for s in slips if s.fault in common] + [run_clock(f.run) for f in rough if f.run]
        again += rough_gains(self.findings, model)
        return [replace(s, known=True) for s in again]

    def ranked(self, model: Model, afar: bool = False, least: float | None = None) -> list[Judged]:
        """Slips that gain enough beside a model, fitted, the likeliest first; masses also `afar`. Those that
        do not come to the `least` gain that counts, where it is known, are not followed to their end.
        """
        judge, record = Judge(model, self.judged, least=least), model.bench.record
        if not record.signals:
            return self._of_table(judge, _possible(tables.hypotheses(record, model), model))
        seen = predicted(self.make(model.bench), self.threads)
        done = {(f.fault, f.run, f.sensor) for f in self.findings}
        every = hypotheses(record)
        whole = self._whole(model.bench, seen)
        slips = [*with_starts(every, record, seen, model, whole), *late_runs(record, model, seen)]
        slips += [*run_clocks(record, whole), *unknown_zeros(record, seen)]
        order = other_order(record, seen)
        slips += [*exchanged_traces(record, seen), *exchanged_gauges(record, seen), *order]
        slips += seats(record, seen, lambda gauges: read_at(self.make(model.bench), gauges, self.threads))
        slips = [*(s for s in slips if (s.fault, s.run, s.sensor) not in done), *self.factors(every, model)]
        slips = _possible(slips, model)
        read = beside(model) if model.fit.hypothesis.components else None
        shown = [*time_zero(record, seen), *drifts(record, read or seen, known=bool(read))]
        shown += gains_of_one(record, whole)
        stages.begin("slips of the laboratory")
        far = excess(model) > policy.SURE_GAIN
        looked = judge.look_at(slips)
        if far and afar:
            looked = [from_afar(judge, j) if FAULTS[j.slip.fault].curved else j for j in looked]
        looked.sort(key=lambda j: -j.log_odds)
        worth = [j for j in looked if j.gain > policy.LEAST_GAIN][: policy.FOLLOWED]
        # Where a run is far off, or all of them, its size is known roughly at first: too roughly for a look.
        started = [j for j in looked if j.slip.start and j.slip.sensor is None and j not in worth]
        # Strong pulses miss each other at a size that is nearly right: the best is fitted anyway.
        best = next((j for j in started if j.slip.expected), None) if far else None
        worth += [j for j in started if not j.slip.expected or j is best or speaks_for(j, model)]
        # Slopes know nothing of a pulse that comes a bead earlier, or with another run's speed.
        apart = [j for j in looked if not (j.slip.continuous or j in worth or out_of_reach(j, model))]
        if far:
            pairs = both_off(worth) | {slip.run for slip in order}
            worth += [j for j in apart if of_the_chain(j.slip) or j.slip.each or j.slip.run in pairs]
        whole = judge.look_at([s for s in shown if (s.fault, s.run, s.sensor) not in done])
        followed = judge.follow_all([*worth, *whole])
        if far and not any(obvious(j, model) for j in followed):
            followed += judge.follow_all([j for j in apart if j not in worth])
        return self._kept(judge, followed)

    def _whole(self, bench: Bench, seen):
        """What the nominal model reads, with whole pulses where the record ends before they have passed."""
        return read_to_the_end(self.make(bench), self.threads) if unfinished(bench.record, seen) else seen

    def _of_table(self, judge: Judge, slips: list[Slip]) -> list[Judged]:
        """The same of a table: the best of each kind are fitted."""
        done = {(f.fault, f.run, f.sensor, f.quantity) for f in self.findings if f.corrected}
        stages.begin("slips of the laboratory")
        looked = judge.look_at([s for s in slips if s.at not in done])
        worth = tables.worth(looked)
        far = [j for j in looked if j.slip.far and j not in worth]
        kept = self._kept(judge, judge.follow_all([*worth, *far]))
        # What shows by itself is put right first, whatever may explain more of all that there is.
        plain = next((j for j in kept if j.slip.plain), None)
        return [j for j in kept if j is plain or _as_well(j, plain)] if plain else tables.earned(kept)

    def _kept(self, judge: Judge, followed: list[Judged]) -> list[Judged]:
        """Those that gain enough, the likeliest first."""
        self.simulations += judge.simulations
        kept = [j for j in followed if j.gain > policy.LEAST_GAIN and j.log_odds > 0.0]
        simple, self.aside = simplest(kept)
        self.behind = [
            j
            for j in followed
            if (j.slip.fault == "gauges-swapped" and j.gain < 0.0) or (j.slip.shown and j not in kept)
        ]
        return _one_gain(sorted(simple, key=lambda j: -j.log_odds))

    def as_small(self, model: Model, found: Investigation) -> list[Judged]:
        """Slips that explain what is as small as to be no misfit by itself, and was named an effect.

        Only sizes can be so small, and only those count that explain about as much as the effects do.
        """
        judge, own = Judge(model, self.judged), found.null.objective - found.final.objective
        looked = judge.look_at([s for s in hypotheses(model.bench.record) if s.continuous])
        near = [j for j in looked if j.gain > policy.FORESEEN * own - ALIKE]
        followed = judge.follow_all(sorted(near, key=lambda j: -j.log_odds)[: policy.FOLLOWED])
        self.simulations += judge.simulations
        kept = [j for j in followed if j.gain > own - ALIKE and j.log_odds > 0.0]
        return sorted(kept, key=lambda j: -j.log_odds)
