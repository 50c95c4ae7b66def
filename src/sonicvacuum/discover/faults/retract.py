"""Slips that traces seemed to show by themselves, asked for once more beside the effects that were found.

Where a pulse hardly arrives, what an effect leaves behind it looks like a drift, a level or a pulse upside
down, and is put right before any effect is known; where it does not arrive, like a dead gauge or a shot that
missed. Beside the right effect the trace as it is fits better, or as well.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.examine import FEIGNED, SILENCE, examine
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.judged import noise_volume
from sonicvacuum.discover.faults.weights import ALIKE, unexplained
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.masks import stuck
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.records import Record

# (slip, id of its gauge, or of its run where it has none).
Slipped = tuple[str, str]


def retracted(
    found: Investigation,
    findings: Sequence[Finding],
    record: Record,
    predicted: dict[str, dict[str, np.ndarray]],
    make: Callable[[Bench], Experiment],
    spared: Collection[Slipped] = (),
) -> set[Slipped]:
    """Slips that effects named explain as well, or, where these leave a misfit, better.

    Args:
        found: of the record put right, what was put right beside effects included.
        findings: slips that the traces showed.
        record, predicted: as `examine` takes them.
        make: a record → its data set.
        spared: slips of which that is known already.
    """
    if found.final is found.null:
        return set()
    told = [(f.fault, f.sensor or f.run) for f in findings if f.corrected]
    ask = _Asked(found, record, predicted, make, spared)
    silent = {one for one in told if one[0] in SILENCE and ask.silence(one)}
    feigned = {one for one in told if one[0] in FEIGNED}
    return silent | (ask.better(feigned) if feigned and unexplained(found) else set())


def value(forward: Forward, one: Fit) -> float:
    """−2 log L of a fit, up to a constant of the record."""
    return one.objective + noise_volume(forward.experiment)


class _Asked:
    """The effects found, fitted to the record with some of its slips left as they are."""

    def __init__(self, found, record, predicted, make, spared):
        self.found, self.record, self.predicted, self.make = found, record, predicted, make
        self.spared = spared
        experiment = found.forward.experiment
        # What an effect leaves in a trace would count as noise of another size.
        self.noise = {k: getattr(experiment, k) for k in ("sigma", "correlation", "colours")}

    def _fitted(self, spared) -> tuple[Forward, Fit]:
        bench, _ = examine(self.record, self.predicted, {*self.spared, *spared})
        experiment = self.make(bench)
        if len(experiment.sigma) == len(self.noise["sigma"]):
            experiment = replace(experiment, **self.noise)
        forward, one = self.found.forward.of(experiment), self.found.final
        return forward, fit(forward, one.hypothesis, one.u[None], np.zeros((1, forward.layout.size)))

    def better(self, slips: set[Slipped]) -> set[Slipped]:
        """Those, alone or all, without which −2 log L is lowest; none where it is as low with them."""
        tried = {frozenset((one,)) for one in slips} | {frozenset(slips)}
        after = {spared: value(*self._fitted(spared)) for spared in sorted(tried, key=sorted)}
        best = min(after, key=after.get)
        lower = value(self.found.forward, self.found.final) - after[best]
        return set(best) if lower > policy.LEAST_GAIN else set()

    def silence(self, slip: Slipped) -> bool:
        """Whether the effects say of the traces that were left out what silence says of them; an effect of
        gauges, which takes readings down to nothing, is that slip in other words.
        """
        if any(c.effect.of_gauges for c in self.found.final.hypothesis.components):
            return False
        if self._stuck(slip):
            return False
        forward, one = self._fitted({slip})
        more = one.objective - self.found.final.objective
        return more < self._silent(slip, forward.experiment) + ALIKE

    def _silent(self, slip: Slipped, experiment: Experiment) -> float:
        """χ² of the traces that a slip of silence takes away, as if they read nothing."""
        fault, id = slip
        sigma = {g.id: s for g, s in zip(experiment.gauges, experiment.sigma, strict=True)}
        return sum(
            float(np.square(trace / sigma[gauge]).sum())
            for run, signals in self.record.signals.items()
            for gauge, trace in signals.readings.items()
            if gauge in sigma and id == (run if fault == "run-without-impact" else gauge) and not stuck(trace)
        )

    def _stuck(self, slip: Slipped) -> bool:
        """Whether a gauge was left out that is stuck: no sample of it counts, whatever effects say."""
        fault, id = slip
        read = [s.readings[id] for s in self.record.signals.values() if id in s.readings]
        return fault == "gauge-dead" and any(map(stuck, read))
