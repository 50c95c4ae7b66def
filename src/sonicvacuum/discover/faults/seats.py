"""Gauges elsewhere than stated: in a bead and at the wall or the other way round, or several beads away.

A gauge at the wall reads the last contact alone, which bears about two and a half times the force of the wave
on its way, so that traces of the wrong height betray it; which bead a gauge sits in is told by when it reads
what, beside the others. A gauge that is a bead off is asked for in any case (`slips`).
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from sonicvacuum.discover.correlation import correlated
from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.faults.slips import Slip, constant, ignoring
from sonicvacuum.discover.faults.timing import arrival, lag
from sonicvacuum.gauges import Gauge
from sonicvacuum.records import Record

# Run → gauge → (T,) readings.
Readings = Mapping[str, Mapping[str, np.ndarray]]
# A gauge's pulses are as much higher than the model's, beside other gauges', where it is at the wall, or as
# much lower where it is in a bead; in the last one the force is three fifths of that at the wall.
HIGHER = math.log(1.15)
# Beads that are asked for: those at which the model reads most nearly what was recorded.
NEAREST = 3
# ... and, of a gauge in a bead, more nearly than in its own by so much of a trace's size in every run: a
# pulse that is two beads off has a third of its own's likeness left, one that an effect distorts nine tenths.
NEARER = 0.1


def seats(record: Record, predicted: Readings, read: Callable[[Sequence[Gauge]], Readings]) -> list[Slip]:
    """The slips that a gauge which is stated in a bead is at the wall, or the other way round, or that one
    sits two beads and more from its own.

    Args:
        record: as far as it was put right.
        predicted: what the nominal model reads.
        read: what it reads at other gauges, run → gauge → (T,).
    """
    found = []
    walled = [g for g in record.gauges if g.kind == "wall"]
    embedded = [g for g in record.gauges if g.kind == "embedded"]
    free = sorted(set(range(1, record.beads + 1)) - {g.bead for g in embedded})
    for gauge in embedded if not walled else []:
        if _elsewhere(record, gauge, predicted, [None], read, 1.0):
            found.append(_slip(gauge.id, None, len(embedded)))
    for gauge in walled:
        beads = _elsewhere(record, gauge, predicted, free, read, -1.0)
        found += [_slip(gauge.id, bead, len(free)) for bead in beads]
    return found + _far(record, predicted, read)


def _far(record, predicted, read):
    """The slips that a gauge sits two beads and more from where it is stated."""
    inside = [g for g in record.gauges if g.bead is not None]
    free = sorted(set(range(1, record.beads + 1)) - {g.bead for g in inside})
    places = {gauge.id: [bead for bead in free if abs(bead - gauge.bead) > 1] for gauge in inside}
    if not any(places.values()):
        return []
    asked = [_at(gauge, bead) for gauge in inside for bead in (gauge.bead, *places[gauge.id])]
    model, found = read(asked), []
    for gauge in inside:
        far = places[gauge.id]
        for bead in _nearer(record, gauge, predicted, far, model):
            change = partial(ignoring, changes.gauges_at, {gauge.id: bead})
            found.append(_moved(gauge.id, bead, change, len(far) * len(inside)))
    return found


def _at(gauge, bead):
    """The same gauge in a bead, under a name of its own."""
    return replace(gauge, id=f"{gauge.id} {bead}", bead=bead)


def _nearer(record, gauge, predicted, beads, model):
    """The beads at which the model reads more nearly what a gauge recorded than in its own."""
    ids = [_at(gauge, bead).id for bead in (gauge.bead, *beads)]
    alike = _alike(record, gauge, predicted, {run: {id: own[id] for id in ids} for run, own in model.items()})
    gained = (alike[1:] - alike[0]) / max(1, sum(gauge.id in own for own in predicted.values()))
    best = np.argsort(-gained, kind="stable")[:NEAREST]
    return [beads[k] for k in best if gained[k] > NEARER]


def _elsewhere(record, gauge, predicted, places, read, sign):
    """The places, beads or None for the wall, where a gauge is asked for: at most `NEAREST`, none where its
    traces are as high as they should be; of one whose height says nothing those that are likelier than its
    own.
    """
    if gauge.calibrated and sign * _higher(record, gauge.id, predicted) < HIGHER:
        return []
    others = [
        Gauge(f"{gauge.id} {place}", "wall" if place is None else "embedded", place) for place in places
    ]
    alike = _alike(record, gauge, predicted, read([replace(gauge, id="own"), *others]))
    likeliest = [int(k) for k in np.argsort(-alike[1:], kind="stable")[:NEAREST]]
    return [places[k] for k in likeliest if gauge.calibrated or alike[1 + k] > alike[0]]


def _slip(id: str, bead: int | None, alternatives: int) -> Slip:
    """The slip that a gauge sits in a bead, or, where that is None, at the wall."""
    return _moved(id, bead, partial(ignoring, changes.gauge_seated, id, bead), alternatives)


def _moved(id, bead, change, alternatives):
    return Slip(
        "gauge-misplaced",
        change,
        sensor=id,
        alternatives=alternatives,
        value=partial(constant, None if bead is None else float(bead)),
        shown=True,
    )


def _higher(record, id, predicted):
    """Logarithm of a gauge's peaks over the model's, beside those of the other gauges, if there are any; the
    median over runs.
    """
    found = []
    for run, model in predicted.items():
        read = record.signals[run].readings
        peaks = {g: (np.ptp(read[g]), np.ptp(model[g])) for g in model if g in read}
        ratios = {g: math.log(own / of) for g, (own, of) in peaks.items() if own > 0.0 and of > 0.0}
        own = ratios.pop(id, None)
        if own is not None and (ratios or len(record.gauges) == 1):
            found.append(own - (float(np.median(list(ratios.values()))) if ratios else 0.0))
    return float(np.median(found)) if found else 0.0


def _alike(record, gauge, predicted, model):
    """(n,) how much a gauge's traces are like those that the model reads at n places, heights left aside."""
    alike = np.zeros(max(len(own) for own in model.values()))
    for run, signals in record.signals.items():
        if gauge.id not in signals.readings or run not in model:
            continue
        trace, time = signals.readings[gauge.id], signals.time_us
        others = [id for id in signals.readings if id != gauge.id and id in predicted.get(run, {})]
        early = lag(record, run, predicted, others) if others else 0.0
        usual = np.median([arrival(time, predicted[run][id]) for id in others]) if others else 1.0
        for place, own in enumerate(model[run].values()):
            size = max(float(np.linalg.norm(own) * np.linalg.norm(trace)), 1e-300)
            products = correlated(own, trace) / size
            # Others' traces are early or late because all are, or because the wave is fast or slow; one that
            # the window does not hold tells no speed.
            shifts = (early, early * arrival(time, own) / usual if usual > 0.0 else early)
            at = [len(trace) - 1 + round(shift / (1e6 * signals.interval_s)) for shift in shifts]
            alike[place] += max(products[np.clip(at, 0, len(products) - 1)])
    return alike
