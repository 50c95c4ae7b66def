"""What the nominal model expects of a record's traces beside what they show, gauge by gauge and run by run.

The same functions of `observe` measure both: arrival, amplitude and duration at each gauge, the speed from
one gauge to the next, the width of the pulse in diameters.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from sonicvacuum.forward import passages, see, virtual
from sonicvacuum.gauges import position
from sonicvacuum.observe.quantities import measure_run
from sonicvacuum.observe.run import Run as Passage
from sonicvacuum.physics.scales import COUNTING, passage_of, sampling_of
from sonicvacuum.records.assemble import assemble
from sonicvacuum.records.record import Record

PER_GAUGE = {"arrival": "s", "amplitude": "", "duration_half": "s"}
# Lengths of the main pulse at half height that a record should rest before it.
REST = 1.0


@dataclass(frozen=True)
class Feature:
    """One number of a run, expected and measured; None where the traces or the model do not give it.

    Attributes:
        run, quantity: which.
        gauge: whose; of a speed or width the second of two.
        start: the first of the two gauges of a speed or width, "" otherwise.
        unit: of both numbers; SI.
        expected: by the nominal model.
        measured: in the traces.
    """

    run: str
    gauge: str
    start: str
    quantity: str
    unit: str
    expected: float | None
    measured: float | None

    @property
    def ratio(self) -> float | None:
        """Measured over expected."""
        both = self.expected is not None and self.measured is not None
        return self.measured / self.expected if both and self.expected else None


@dataclass(frozen=True)
class Window:
    """When a run's traces have to begin and end to hold the main pulse at every gauge, in s after the impact.

    Attributes:
        run: which.
        needed: a rest before the first pulse, to the end of the last.
        recorded: first and last sample.
    """

    run: str
    needed: tuple[float, float]
    recorded: tuple[float, float]


@dataclass(frozen=True)
class Expected:
    """All of it, and how long in s the wave needs for one bead (run → s) in the nominal model."""

    features: tuple[Feature, ...]
    windows: tuple[Window, ...]
    bead_passage: dict[str, float]

    def of(self, quantity: str, run: str | None = None) -> list[Feature]:
        """The features of one quantity that both show, of one run or of all."""
        found = (f for f in self.features if f.quantity == quantity and f.ratio is not None)
        return [f for f in found if run in (None, f.run)]


def expected(record: Record) -> Expected:
    """Compare every run that has traces with the nominal model; one ball on a wall has none to compare."""
    features, windows, passing = [], [], {}
    for batch in assemble(record) if record.beads else ():
        places = [k for k, run in enumerate(batch.runs) if record.runs[run].signals]
        shown = _simulated(record, batch.chain) if places else []
        for lane in places:
            run = record.runs[batch.runs[lane]]
            found = _features(record, run, shown[lane])
            features += found
            windows += _window(run, found)
            passing |= _passing(record, run, found)
    return Expected(tuple(features), tuple(windows), passing)


def _simulated(record, chain):
    """What the nominal model shows of each lane, from the impact to the reflection's return."""
    from sonicvacuum.effects.base import Setup

    setup = Setup(chain, record.gauges)
    besides = virtual(record.gauges, record.beads)
    seen = see(setup, passage_of(chain, COUNTING), sampling_of(chain), besides=besides)
    return passages(seen, slice(None), seen.readings, record.gauges, record.specimen.diameters)


def _features(record, run, model):
    noise = {g.id: g.sigma for g in record.gauges if g.id in run.signals.readings}
    data = Passage(run.signals.readings, run.signals.time_s, record.geometry, noise=noise)
    gauges = [g for g in record.gauges if g.id in run.signals.readings]
    gauges.sort(key=lambda g: -position(g, record.beads, record.specimen.diameters))
    found = []
    for gauge in gauges:
        for quantity, unit in PER_GAUGE.items():
            options = {"sensor": gauge.id}
            found.append(_feature(run, gauge.id, "", quantity, unit or gauge.unit, model, data, options))
    for first, last in pairwise(gauges):
        if record.geometry.position(first.id) > record.geometry.position(last.id):
            way = {"from": first.id, "to": last.id}
            found.append(_feature(run, last.id, first.id, "speed", "m/s", model, data, way))
            way |= {"sensor": first.id}
            found.append(_feature(run, last.id, first.id, "width_half", "diameters", model, data, way))
    return found


def _feature(run, gauge, start, quantity, unit, model, data, options):
    expected, measured = (measure_run(quantity, passage, **options).value for passage in (model, data))
    return Feature(run.id, gauge, start, quantity, unit, _known(expected), _known(measured))


def _known(value):
    return float(value) if np.isfinite(value) else None


def _window(run, features):
    """The window of a run, if one is expected at any of its gauges."""
    gauges = [f for f in features if f.quantity == "arrival" and f.expected is not None]
    lasting = {f.gauge: f.expected for f in features if f.quantity == "duration_half"}
    gauges = [f for f in gauges if lasting[f.gauge] is not None]
    if not gauges:
        return
    begins = [f.expected - (1.0 + REST) * lasting[f.gauge] for f in gauges]
    ends = [f.expected + 1.5 * lasting[f.gauge] for f in gauges]
    recorded = (run.signals.start_s, float(run.signals.time_s[-1]))
    yield Window(run.id, (float(min(begins)), float(max(ends))), recorded)


def _passing(record, run, features):
    """Run → time in s for one bead, from the speed between the first gauges that show one.

    With one gauge, or all at one bead, there is none: then from the first arrival and the way to its gauge,
    of half a bead at least.
    """
    bead = record.specimen.first.diameter_m
    speeds = [f.expected for f in features if f.quantity == "speed" and f.expected]
    if speeds:
        return {run.id: bead / speeds[0]}
    arrivals = [f for f in features if f.quantity == "arrival" and f.expected]
    if not arrivals:
        return {}
    way = record.geometry.length - record.geometry.position(arrivals[0].gauge)
    return {run.id: arrivals[0].expected / max(way / bead, 0.5)}
