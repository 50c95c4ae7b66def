"""Steady lines that traces pick up, and the noise beside which they, levels and slopes are told.

One frequency in all runs of a gauge that show it. What noise of a filter or of a ringing disc swings by is no
line: where stretches at rest remember more than one sample once what looks like lines is off, lines are told
beside noise of that spectrum.
"""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

import numpy as np

from sonicvacuum.discover.faults import expected, traces, waves
from sonicvacuum.discover.faults.pulses import Readings
from sonicvacuum.discover.model import spectrum
from sonicvacuum.discover.model.autoregression import Autoregression
from sonicvacuum.discover.model.noise import coarse
from sonicvacuum.records import Record

# Periods of a line from which on a weak pulse is not taken for it.
MANY = 8.0


@dataclass(frozen=True)
class Line:
    """A steady line in a gauge's traces.

    Attributes:
        frequency: in Hz.
        waves: run → (2,) its cosine and sine, of runs that show it.
        unseen: runs in which it may be there all the same.
    """

    frequency: float
    waves: dict[str, np.ndarray]
    unseen: list[str]


@dataclass
class _Stretches:
    """Of one gauge: run → stretch, interval in s and frequency in Hz of what looks like a line; run → stretch
    before the pulse, which may swing, and interval; and the same of those that do not.
    """

    shown: dict = field(default_factory=dict)
    hidden: dict = field(default_factory=dict)
    rests: list[tuple[np.ndarray, float]] = field(default_factory=list)


def lines(
    record: Record,
    readings: Readings,
    models: Readings,
    sigma: Mapping[str, float],
    silent: Collection[tuple[str, str]],
) -> tuple[dict[str, Line], dict[str, Autoregression | None]]:
    """Gauge → line that it picks up, of those that do; gauge → noise of its stretches at rest in its unit,
    None where it is white or of first order.

    Args:
        record: with signals.
        readings: its readings, spikes taken off.
        models: what the nominal model reads, of traces of which it reads something.
        sigma: gauge → noise of one sample.
        silent: (run id, gauge id) of traces without a pulse.
    """
    ids = [g.id for g in record.gauges]
    found = {id: _stretches(record, readings, models, sigma[id], silent, id) for id in ids}
    read = {id: [readings[run][id] for run in one.hidden] for id, one in found.items()}
    rests = [_noise(found[id], read[id], sigma[id]) for id in ids]
    every = zip(ids, spectrum.together(rests), rests, strict=True)
    noises = {id: own and spectrum.sized(own, rest) for id, own, rest in every}
    picked = {id: _line(one, readings, sigma[id], noises[id], id) for id, one in found.items()}
    return {id: line for id, line in picked.items() if line}, noises


def _stretches(record, readings, models, sigma, silent, id):
    found = _Stretches()
    for run, signals in record.signals.items():
        if id not in signals.readings or (run, id) in silent:
            continue
        trace, interval = readings[run][id], signals.interval_s
        model = models.get(run, {}).get(id)
        quiet = [traces.quiet(trace, sigma, swings) for swings in (False, True)]
        before = [expected.cut(whole, trace, model, sigma) for whole in quiet]
        for whole, rest in zip(quiet, before, strict=True):
            # Many periods are no weak pulse, wherever the model has its own.
            for stretch, least in ((whole, MANY), (rest, 0.0)):
                seen = waves.pickup(stretch, sigma)
                if seen and seen[0] * len(stretch) > least and run not in found.shown:
                    found.shown[run] = stretch, interval, seen[0] / interval
        found.rests.append((before[0], interval))
        found.hidden[run] = before[1], interval
    return found


def _noise(found, traces_, sigma):
    """Stretches at rest of a gauge less what looks like a line in any; none of rounded noise, which rests on
    few steps and has no spectrum of its own.
    """
    if coarse(traces_, sigma):
        return []
    if not found.shown:
        return spectrum.audible([rest for rest, _ in found.rests], sigma)
    frequency = waves.shared_line(list(found.shown.values()))
    cycles = [frequency * interval for _, interval in found.rests]
    bare = [
        waves.without_wave(rest, waves.wave(rest, each)[0], each)
        for (rest, _), each in zip(found.rests, cycles, strict=True)
        if len(rest) >= traces.FEWEST
    ]
    return spectrum.audible(bare, sigma)


def _line(found, readings, sigma, noise, id) -> Line | None:
    shown = {run: one for run, one in found.shown.items() if _stands_out(one[0], one[1] * one[2], noise)}
    if not shown:
        return None
    result = Line(waves.shared_line(list(shown.values())), {}, [])
    for run, (stretch, interval) in found.hidden.items():
        cycles = result.frequency * interval
        if run in shown:
            stretch = shown[run][0]
        else:
            stretch = max(stretch, waves.quiet_beside(readings[run][id], cycles, sigma), key=len)
            if not (waves.is_line(stretch, cycles, sigma) and _stands_out(stretch, cycles, noise)):
                result.unseen.append(run)
                continue
        result.waves[run] = waves.wave(stretch, cycles)[0]
    return result


def _stands_out(stretch, cycles, noise) -> bool:
    """Whether a line of so many cycles per sample stands out of noise as it has to of that of first order."""
    if noise is None:
        return True
    # Cosine and sine, level and slope, and the stretch.
    *table, own = noise.whitened(np.column_stack([waves.sinusoid(len(stretch), cycles), stretch]).T)
    without, beside = (_left(own, np.array(some)) for some in (table[2:], table))
    return without - beside > 2.0 * math.log(0.5 * len(stretch) / waves.LINE_P)


def _left(own, table):
    """Squares that are left of (n,) samples beside (m, n) of a table."""
    found, *_ = np.linalg.lstsq(table.T, own, rcond=None)
    return float(np.square(own - found @ table).sum())
