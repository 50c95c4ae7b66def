"""Drift that shows only beside the model: where the stretch before the pulse is short, the readings between
pulses and after them tell of it.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from sonicvacuum.discover.faults import changes, traces
from sonicvacuum.discover.faults.heard import at_rest
from sonicvacuum.discover.faults.slips import Slip, constant
from sonicvacuum.records import Record

# Nothing is read where the model has less than such a share of its peak, half a pulse and more away from
# where it has more: the largest of them at which a line leaves noise alone.
NOTHING = (0.05, 0.02)
# Least gain in χ² of the lines of a gauge, and log of what a level and a slope of one run cost.
LEAST, PRICE = 50.0, 6.0
# What the model reads there differs from what there is: lines err by more than noise has it.
UNSURE = 2.0
# A run's own slope is told from so many standard errors on.
TOLD = 4.0
# Of the noise of a sample; no line is known better.
EXACT = 1e-9


@dataclass(frozen=True)
class _Line:
    """A straight line in one trace: level at the first sample, slope per sample; standard errors of slope and
    level, and of the level in the middle of the samples that tell it, in the gauge's unit; that middle; its
    gain in χ².
    """

    level: float
    slope: float
    errors: np.ndarray
    middle: float
    gain: float

    @property
    def middle_level(self) -> float:
        """Level in the middle of those samples."""
        return self.level + self.middle * self.slope


def drifts(record: Record, predicted, known: bool = False) -> list[Slip]:
    """Gauges whose readings lie along straight lines, or off zero, where the model reads nothing.

    Args:
        record: with signals.
        predicted: run id → gauge id → (T,) reading of the model.
        known: whether the model has effects, so that all of a trace may tell of its line, where little of it
            is quiet; beside the nominal model an effect would be taken for a line.
    """
    found = {
        id: _lines(record, predicted, id, sigma, known) for id, sigma in at_rest(record, bare=True).items()
    }
    return [_slip(record, id, lines) for id, lines in found.items() if lines]


def _slip(record, id, lines):
    samples = {run: len(record.signals[run].time_us) for run in lines}
    drift = np.array([line.slope * samples[run] for run, line in lines.items()])
    sigma = np.array([line.errors[0] * samples[run] for run, line in lines.items()])
    common = float(np.average(drift, weights=sigma**-2.0))
    # A run whose few quiet samples lie side by side does not tell of its end: the others do.
    told = np.abs(drift) > TOLD * sigma
    slopes = {
        run: (line.level, line.slope) if own else (line.level + line.middle * (line.slope - other), other)
        for (run, line), own in zip(lines.items(), told, strict=True)
        for other in [common / samples[run]]
    }
    known = [error for error, own in zip(sigma, told, strict=True) if own] or [float(sigma.min())]
    level = UNSURE * max(line.errors[1] for line in lines.values())
    if not told.any():
        return _off_zero(record, id, lines, level)
    # Runs that differ more than their errors have it tell that what the model reads is not yet what there is.
    apart = {"baseline": [line.level for line in lines.values()], "drift": drift}
    errors = {"baseline": level, "drift": UNSURE * max(known)}
    errors = {what: max(error, float(np.std(apart[what]))) for what, error in errors.items()}
    return Slip(
        "drift",
        partial(_straightened, id, slopes, errors),
        sensor=id,
        alternatives=len(record.gauges),
        value=lambda _: common,
        occam=-PRICE * len(lines),
    )


def _off_zero(record, id, lines, error):
    """Levels without slopes: of the one run that has one, or of the gauge."""
    levels = {run: line.middle_level for run, line in lines.items()}
    off = [run for run, line in lines.items() if abs(levels[run]) > TOLD * line.errors[2]]
    return Slip(
        "baseline",
        partial(_straightened, id, {run: (levels[run], 0.0) for run in lines}, {"baseline": error}),
        run=off[0] if len(off) == 1 else None,
        sensor=id,
        alternatives=len(record.gauges) * (1 + len(lines)),
        value=partial(constant, float(np.median([levels[run] for run in off or lines]))),
        occam=-PRICE * len(lines),
    )


def _straightened(id, lines, errors, record, _):
    return changes.looser(changes.straightened(record, id, lines), {id: errors})


def _lines(record, predicted, id, sigma, known) -> dict[str, _Line]:
    """The line of each run; none where lines leave more than noise."""
    found = {}
    for run, signals in record.signals.items():
        model = predicted.get(run, {}).get(id)
        # A trace that never moves lies along a line whatever passes.
        if model is None or id not in signals.readings or not np.ptp(signals.readings[id]) > 0.0:
            continue
        places = (np.flatnonzero(_nothing(model, share)) for share in NOTHING)
        left = signals.readings[id] - model
        line = next((one for at in places if (one := _line(at, left[at], sigma))), None)
        if line is None or known:
            whole = _line_beside(model, left, sigma)
            line = max(filter(None, (line, whole)), key=lambda one: one.gain, default=None)
        if line is None:
            return {}
        found[run] = line
    gain = sum(line.gain for line in found.values())
    return found if gain > LEAST * max(1, len(found)) else {}


def _line(at, left, sigma):
    """The line through readings at some samples, None where it leaves more than noise."""
    if len(at) < traces.FEWEST:
        return None
    (slope, level), covariance = np.polyfit(at, left, 1, cov=True)
    rest = left - level - slope * at
    if rest.std(ddof=2) > traces.NOISE_FACTOR * sigma:
        return None
    gain = float(left @ left - rest @ rest) / sigma**2
    errors = np.array([*np.sqrt(np.diag(covariance)), float(rest.std(ddof=2)) / np.sqrt(len(at))])
    # Samples that lie along a line to the last digit are no infinite weight.
    return _Line(float(level), float(slope), np.maximum(errors, EXACT * sigma), float(at.mean()), gain)


def _line_beside(model, left, sigma):
    """The line through all readings, beside a pulse a little higher and later than the model's."""
    at = np.arange(len(model))
    pulse = np.column_stack([model, np.gradient(model)])
    return _line(at, left - pulse @ _beside(pulse, at, left), sigma)


def _beside(pulse, at, left):
    """What is best of a pulse and its slope beside a line."""
    table = np.column_stack([pulse, np.ones_like(at), at / len(at)])
    return np.linalg.lstsq(table, left, rcond=None)[0][: pulse.shape[1]]


def _nothing(model, share):
    """(T,) whether the model reads nothing, nor half a pulse to either side."""
    size = np.abs(model)
    width = max(1, int(np.count_nonzero(size > 0.5 * size.max())))
    return np.convolve(size > share * size.max(), np.ones(2 * width + 1), "same") == 0
