"""A record looked through trace by trace: what its traces show by themselves is put right and said."""

from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import replace

import msgspec
import numpy as np

from sonicvacuum.discover.faults import changes, expected, policy, traces, waves
from sonicvacuum.discover.faults.exchanges import read_twice, taken_twice
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.heard import heard
from sonicvacuum.discover.faults.pickup import lines
from sonicvacuum.discover.faults.pulses import pulses
from sonicvacuum.discover.faults.table import FAULTS
from sonicvacuum.discover.model.autoregression import Autoregression
from sonicvacuum.discover.model.masks import AROUND, cut, spikes
from sonicvacuum.discover.model.noise import STEPPED, audible, even, loudness, rounding
from sonicvacuum.discover.model.weak import wanders
from sonicvacuum.records import Record, Signals


def examine(
    record: Record,
    predicted: dict[str, dict[str, np.ndarray]] | None = None,
    spared: Collection[tuple[str, str]] = (),
):
    """Slips that traces show by themselves.

    Args:
        record: as read.
        predicted: run id → gauge id → (T,) reading of the nominal model; without it, gauges without a pulse
            and gauges of the wrong sign are not looked for.
        spared: (slip, gauge id or, where no gauge is meant, run id) that are known not to have been made, of
            those in `FEIGNED` and `SILENCE`.

    Returns:
        The `Bench` with what was put right, and the findings.
    """
    look = _Look(record, predicted or {}, spared)
    runs = [run for run in record.runs if run.signals is not None]
    for run in runs:
        look.samples(run)
    look.pulses()
    look.copies()
    look.pickup()
    for run in runs:
        look.quiet(run)
    for gauge in record.gauges:
        look.noise(gauge)
    return look.bench(), look.findings()


def with_noise_of(findings: list[Finding], record: Record, gauges: Sequence[str]) -> list[Finding]:
    """Findings in which the noise of some gauges is that of another record: those whose names were mixed up
    had each other's stated noise.
    """
    kept = [f for f in findings if f.fault != "noise-misstated" or f.sensor not in gauges]
    return kept + [f for f in examine(record)[1] if f.fault == "noise-misstated" and f.sensor in gauges]


# Slips that an effect may feign in a trace, so that they are asked for once more beside it; and those that a
# pulse feigns which dies on its way.
FEIGNED, SILENCE = ("drift", "baseline", "gauge-inverted"), ("gauge-dead", "run-without-impact")
# Slips of which a level is part.
UNLEVEL = ("drift", "pickup", "gauge-dead")
# Share of a level that differs from run to run by which it may change within a run.
MOVING = 0.3


class _Look:
    """One pass over a record."""

    def __init__(self, record, predicted, spared=()):
        self.record, self.predicted, self.spared = record, predicted, spared
        self.noises = heard(record)
        self.readings = {k: dict(s.readings) for k, s in record.signals.items()}
        self.lost, self.seen, self.rests = {}, defaultdict(dict), defaultdict(dict)
        self.levels, self.stretches = defaultdict(dict), defaultdict(dict)
        self.silent, self.blank, self.lines = set(), [], {}
        # Gauge → noise that remembers more than one sample.
        self.coloured: dict[str, Autoregression | None] = {}
        # As `taken_twice` and `read_twice` yield them.
        self.twice, self.read_twice = [], []
        # Gauge → what is known of its level and of its drift only so well, in its unit.
        self.unsure = defaultdict(dict)

    def _own(self, run):
        """Gauges of a run by id."""
        return {g.id: g for g in self.record.gauges if g.id in run.signals.readings}

    def samples(self, run):
        """Single samples of all traces of one run."""
        for gauge in self._own(run).values():
            self._sample_slips(run.id, gauge)

    def quiet(self, run):
        """What precedes the pulses in all traces of one run."""
        for id, gauge in self._own(run).items():
            if (run.id, id) not in self.silent:
                self._quiet_slips(run, gauge)

    def noise(self, gauge):
        """Noise of another size than stated, in the quiet stretches of all runs."""
        stretches = self.stretches[gauge.id]
        read = [self.record.signals[run].readings[gauge.id] for run in stretches]
        coloured = self.coloured.get(gauge.id), max(map(len, read), default=0)
        found = traces.misstated(stretches, gauge.sigma, max(map(rounding, read), default=0.0), *coloured)
        if found:
            self.seen["noise-misstated", gauge.id] = found

    def pickup(self):
        """A steady line in a gauge's traces: one frequency in all runs that show it, taken off."""
        models = {
            run: {id: model for id, model in own.items() if model.any()}
            for run, own in self.predicted.items()
        }
        found, self.coloured = lines(self.record, self.readings, models, self.noises, self.silent)
        for id, line in found.items():
            for run, wave in line.waves.items():
                cycles = line.frequency * self.record.signals[run].interval_s
                self.readings[run][id] = waves.without_wave(self.readings[run][id], wave, cycles)
                self.seen["pickup", id][run] = 1e-3 * line.frequency
                self.lines[run, id] = float(np.hypot(*wave)), line.frequency
            # Where a run's own rest does not show it, it may be there all the same, with any phase.
            most = max(self.lines[run, id][0] for run in line.waves)
            self.lines |= {(run, id): (most, line.frequency) for run in line.unseen}

    def _sample_slips(self, run, gauge):
        """Spikes and clipping: samples that are masked."""
        trace = self.readings[run][gauge.id]
        noise = audible(trace, self.noises[gauge.id])
        # A trace that never moves has no pulse to be cut off.
        held = cut(trace, noise) if np.ptp(trace) > 0.0 else np.zeros(len(trace), dtype=bool)
        at = spikes(trace, noise) & ~held
        if at.any():
            self.readings[run][gauge.id] = traces.without_spikes(trace, at)
            odd = at & ~self._narrow(run, gauge.id, noise, len(at))
            if odd.any():
                self.seen["spikes", gauge.id][run] = float(odd.sum())
        if held.any():
            self.seen["gauge-clipped", gauge.id][run] = float(trace[held][0])
        if at.any() or held.any():
            self.lost[run, gauge.id] = at | held

    def _narrow(self, run, gauge, noise, samples):
        """(T,) where the nominal model reads a pulse as narrow within `AROUND` samples: few samples on one of
        hard bodies make its peak look like a spike. It is masked as one, and not told.
        """
        model = self._model(run, gauge)
        if model is None or len(model) != samples:
            return np.zeros(samples, dtype=bool)
        near = np.ones(2 * AROUND + 1)
        return np.convolve(spikes(model, noise), near)[AROUND:-AROUND] > 0.0

    def pulses(self):
        """No pulse where the model has one, or a pulse upside down."""
        found = pulses(self.record, self.readings, self.predicted, self.spared)
        self.blank, self.silent = found.blank, found.silent
        for id, runs in found.dead.items():
            self.seen["gauge-dead", id] = dict.fromkeys(runs)
        for id, runs in found.inverted.items():
            self.seen["gauge-inverted", id] = dict.fromkeys(runs)
            for run in runs:
                self.readings[run][id] = -self.readings[run][id]

    def copies(self):
        """Traces that are another run's or gauge's: they are left out of the one that they do not fit."""
        if not self.predicted:
            return
        self.twice = list(taken_twice(self.record, self.predicted, self.silent))
        self.silent |= {(run, id) for _, _, run, ids in self.twice for id in ids}
        self.read_twice = list(read_twice(self.record, self.predicted, self.silent))
        self.silent |= {(run, id) for *_, id in self.read_twice for run in self.record.signals}

    def _quiet_slips(self, run, gauge):
        """What the stretch before the pulse shows: a slope, a level, the size of the noise."""
        trace = self.readings[run.id][gauge.id]
        steps = rounding(trace)
        noise, coloured = max(self.noises[gauge.id], steps), self.coloured.get(gauge.id)
        loud = loudness(trace, noise)
        stretch = expected.cut(traces.quiet(trace, loud), trace, self._model(run.id, gauge.id), loud)
        hides = traces.faint(trace, loud)
        drifting = traces.drift(stretch, noise, coloured)
        if drifting is not None and hides and not traces.straight(stretch, loud):
            drifting = None
        if drifting is not None and ("drift", gauge.id) not in self.spared:
            slope, error = drifting
            self.seen["drift", gauge.id][run.id] = slope * len(trace)
            self._unsure(gauge.id, "drift", error * len(trace))
            trace = trace - traces.line(stretch, np.arange(len(trace)))
            stretch = trace[: len(stretch)]
        self.stretches[gauge.id][run.id] = even(stretch) if hides else stretch
        # All readings on one step of the recorder are off by as much.
        common = steps if steps > STEPPED * audible(trace, noise) else 0.0
        level = None
        if not (hides and wanders(stretch)):
            self.rests[gauge.id][run.id] = traces.rest(stretch, noise, common, coloured)
            level = traces.level(stretch, noise, common, noise=coloured)
        self.levels[gauge.id][run.id] = len(stretch), level
        self.readings[run.id][gauge.id] = trace

    def _model(self, run, gauge):
        """(T,) reading of the nominal model, None where there is none."""
        model = self.predicted.get(run, {}).get(gauge)
        return model if model is not None and model.any() else None

    def _unsure(self, gauge, what, error):
        self.unsure[gauge][what] = max(self.unsure[gauge].get(what, 0.0), error)

    def bench(self) -> Bench:
        """The record without what is wrong in its traces."""
        self._levels()
        self._baselines()
        if self.blank and len(self.blank) == len(self.predicted):
            # No trace tells of an impact: no sample counts, and nothing is put right.
            signals = self.record.signals.items()
            nothing = {(k, id): np.ones(s.samples, dtype=bool) for k, s in signals for id in s.readings}
            return Bench(self.record, nothing)
        for run, id in self.silent:
            self.readings[run].pop(id, None)
        signals = {
            k: Signals(s.time_us, self.readings[k])
            for k, s in self.record.signals.items()
            if k not in self.blank and self.readings[k]
        }
        gone = [k for k in self.record.signals if k not in signals]
        lost = {at: rows for at, rows in self.lost.items() if at not in self.silent}
        lines = {at: line for at, line in self.lines.items() if at not in self.silent and at[0] in signals}
        changed = any((self.seen, lost, gone, self.twice, self.read_twice))
        if not changed:
            return Bench(self.record, lost)
        return Bench(changes.looser(_without_runs(self.record, signals, gone), self.unsure), lost, lines)

    def _levels(self):
        """One level in all runs: readings count from rest, so that the recorder's zero is off."""
        for gauge in self.record.gauges:
            id = gauge.id
            told = self._one_level(gauge)
            if (
                not told
                or any((slip, id) in self.seen for slip in UNLEVEL)
                or ("baseline", id) in self.spared
            ):
                continue
            self.rests.pop(id)
            for run, (mean, error) in told.items():
                self.seen["baseline", id][run] = mean
                self.readings[run][id] = self.readings[run][id] - mean
                self._unsure(id, "baseline", error)
            # What differs from run to run need not stand still within one.
            self._unsure(id, "drift", float(np.std([mean for mean, _ in told.values()])))

    def _one_level(self, gauge) -> dict[str, tuple[float, float]]:
        """Run → level and its error, of a gauge that surely rests off 0, and alike in all runs."""
        found = self.levels[gauge.id]
        told = {run: level for run, (_, level) in found.items() if level is not None}
        if len(told) < len(found) or sum(count for count, _ in found.values()) < traces.LEVEL_FEWEST:
            return {}
        means, errors = np.array(list(told.values())).T
        together = float((errors**-2.0).sum()) ** -0.5
        common = float(np.average(means, weights=errors**-2.0))
        alike = np.all(np.abs(means - common) < np.maximum(traces.SURE * errors, MOVING * abs(common)))
        sure = abs(common) > traces.SURE * max(together, gauge.baseline_sigma)
        return told if alike and sure else {}

    def _baselines(self):
        """Levels that differ from run to run."""
        for id, found in self.rests.items():
            sure = {k: (m, e) for k, (m, e) in found.items() if np.isfinite(e)}
            if len(sure) < 2 or ("baseline", id) in self.spared:
                continue
            means, errors = np.array(list(sure.values())).T
            common = float(np.average(means, weights=errors**-2.0))
            others = float(np.median(means))
            # Two runs that differ do not say which of them is as usual: both count from 0.
            usual = min(others, common, key=abs) if len(means) > 2 else 0.0
            for run, mean, error in zip(sure, means, errors, strict=True):
                if abs(mean - others) > traces.SURE * error and abs(mean) > traces.SURE * error:
                    self.seen["baseline", id][run] = mean
                    self.readings[run][id] = self.readings[run][id] - (mean - usual)
                    # A level that is another one in each run need not stand still within a run: what looks
                    # like one may be a part of a slow swing, of mains above all.
                    self._unsure(id, "baseline", MOVING * abs(mean))
                    self._unsure(id, "drift", MOVING * abs(mean))

    def findings(self) -> list[Finding]:
        """One finding for a gauge whose runs all show it, else one for each run."""
        result = [
            Finding("run-without-impact", run, probability=policy.PLAIN, corrected=True) for run in self.blank
        ]
        for a, b, _, ids in self.twice:
            whole = set(ids) >= set(self.record.signals[a].readings) & set(self.record.signals[b].readings)
            for id in [None] if whole else ids:
                result.append(Finding("runs-swapped", f"{a} and {b}", id, None, policy.PLAIN, True))
        for one, two, _ in self.read_twice:
            result.append(Finding("gauges-swapped", None, (one, two), None, policy.PLAIN, True))
        for (fault, id), runs in self.seen.items():
            having = [k for k, s in self.record.signals.items() if id in s.readings and k not in self.blank]
            everywhere = len(runs) == len(having)
            for run, value in [(None, _shared(fault, runs))] if everywhere else runs.items():
                result.append(Finding(fault, run, id, value, policy.PLAIN, FAULTS[fault].corrected))
        return result


def _shared(fault, runs):
    """One value for all runs: how many spikes, the median of everything else."""
    values = [v for v in runs.values() if v is not None]
    if not values:
        return None
    return float(sum(values)) if fault == "spikes" else float(np.median(values))


def _without_runs(record, signals, gone):
    """The record with new traces; a run that lost all of them is left out, unless it has scalars."""
    blocks = [r for r in record.block.runs if r.id not in gone or r.observables]
    kept = [r if r.id not in gone else msgspec.structs.replace(r, signals=None) for r in blocks]
    return replace(record, block=msgspec.structs.replace(record.block, runs=kept), signals=signals)
