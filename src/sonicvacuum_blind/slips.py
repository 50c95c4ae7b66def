"""Slips of the laboratory, made in records: a gauge on the wrong cable, beads weighed wrongly, late triggers.

A slip is either something that truly was otherwise than written down (`plan`), or something wrong in what was
written down (`written`). Each is made with and without a hidden effect, so that what `discover` calls a slip,
an effect or nothing can be counted. Sizes are those of the bench: a few percent of a scale, one bead, cables.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import msgspec
import numpy as np

from sonicvacuum.records import Record, Signals
from sonicvacuum_blind.plan import Plan
from sonicvacuum_blind.slip_bench import Bench, Place, Trace, of_gauge, sensors_of, times_of, traces_of

# Ratio by which one run's speed, or the gain of all gauges, is off; and the recorder's time.
TOO_MUCH, CLOCK = 1.125, 1.02
# The same of a run that is far off; and by how many pulses a run's trigger may be.
FAR, LATE = (0.1, 0.5, 2.0, 10.0), (0.2, 2.0)


def _swapped(bench: Bench):
    one, two = bench.drawn(bench.gauges, 2)
    names = {one: two, two: one}
    signals = {
        k: Signals(s.time_us, {g: s.readings[names.get(g, g)] for g in s.readings})
        for k, s in bench.record.signals.items()
    }
    return replace(bench.record, signals=signals), Place(sensor=(one, two))


def _at_one_gauge(change: Callable[[Bench, str], Trace], bench: Bench):
    """All traces of one gauge changed."""
    (gauge,) = bench.drawn(bench.gauges)
    return of_gauge(bench.record, gauge, change(bench, gauge)), Place(sensor=(gauge,))


def _inverted(_bench, _gauge):
    return np.negative


def _dead(bench, gauge):
    return lambda trace: bench.sigma(gauge) * bench.random.standard_normal(len(trace))


def _clipped(bench, gauge):
    """At six tenths of the highest peak."""
    end = 0.6 * max(s.readings[gauge].max() for s in bench.record.signals.values())
    return lambda trace: np.minimum(trace, end)


def _delayed(bench, gauge):
    """By half a pulse, in whole samples; what came before is noise."""
    interval = next(iter(bench.record.signals.values())).interval_s * 1e6
    late = max(2, round(0.5 * bench.pulse_us / interval))

    def delayed(trace):
        quiet = bench.sigma(gauge) * bench.random.standard_normal(late)
        return np.concatenate([quiet, trace[:-late]])

    return delayed


def _drifting(_bench, _gauge):
    """By a tenth of the peak over the record."""
    return lambda trace: trace + 0.1 * np.abs(trace).max() * np.linspace(0.0, 1.0, len(trace))


def _ringing(bench, gauge):
    """Ten periods of a switching supply in the record, five standard deviations high, of any phase."""

    def ringing(trace):
        angle = 2.0 * np.pi * (10.3 * np.linspace(0.0, 1.0, len(trace)) + bench.random.random())
        return trace + 5.0 * bench.sigma(gauge) * np.sin(angle)

    return ringing


def _hum(bench: Bench):
    """50 Hz in all gauges, a twentieth of the peak, of any phase in each run: a level that slowly bends."""
    record = bench.record
    phases = {run: bench.random.random() for run in record.signals}

    def humming(run, _, trace):
        angle = 2.0 * np.pi * (50e-6 * record.signals[run].time_us + phases[run])
        return trace + 0.05 * np.abs(trace).max() * np.sin(angle)

    return traces_of(record, humming), Place()


def _spikes(bench: Bench):
    """0.2 % of all samples, and at least one, off by half a peak or more."""

    def spiked(run, gauge, trace):
        at = bench.random.random(len(trace)) < 0.002
        if (run, gauge) == (bench.runs[0], bench.gauges[0]):
            at[int(bench.random.integers(len(trace)))] = True
        size = np.abs(trace).max() * bench.random.uniform(0.5, 1.5, len(trace))
        return np.where(at, trace + size * bench.random.choice([-1.0, 1.0], len(trace)), trace)

    return traces_of(bench.record, spiked), Place()


def _noise_stated(factor: float, bench: Bench):
    """True noise over the stated one is `factor`."""
    changed = sensors_of(bench.record, lambda s: msgspec.structs.replace(s, sigma_N=s.sigma_N / factor))
    return changed, Place()


def _runs_swapped(bench: Bench):
    one, two = bench.drawn(bench.runs, 2)
    names = {one: two, two: one}
    signals = {k: bench.record.signals[names.get(k, k)] for k in bench.record.signals}
    return replace(bench.record, signals=signals), Place(run=" and ".join(sorted((one, two))))


def _run_off(bench: Bench):
    """Struck an eighth faster than written."""
    (run,) = bench.drawn(bench.runs)
    blocks = [_struck(r, 1.0 / TOO_MUCH) if r.id == run else r for r in bench.record.block.runs]
    block = msgspec.structs.replace(bench.record.block, runs=blocks)
    return replace(bench.record, block=block), Place(run=run)


def _far_off(bench: Bench):
    """Struck at a tenth, half, twice or ten times what is written."""
    (run,) = bench.drawn(bench.runs)
    factor = float(bench.random.choice(FAR))
    blocks = [_struck(r, 1.0 / factor) if r.id == run else r for r in bench.record.block.runs]
    block = msgspec.structs.replace(bench.record.block, runs=blocks)
    return replace(bench.record, block=block), Place(run=run)


def _late(bench: Bench):
    """Triggered a fifth of a pulse to two pulses early or late, in whole samples."""
    (run,) = bench.drawn(bench.runs)
    signals = dict(bench.record.signals)
    own = signals[run]
    pulses = math.exp(bench.random.uniform(*np.log(LATE))) * bench.random.choice([-1.0, 1.0])
    samples = round(float(pulses) * bench.pulse_us / (own.interval_s * 1e6)) or 1
    shift = samples * own.interval_s * 1e6
    signals[run] = Signals(np.round(own.time_us + shift, 9), own.readings)
    return replace(bench.record, signals=signals), Place(run=run)


def _struck(run, ratio):
    speed = float(f"{run.striker.speed_m_s * ratio:.4g}")
    return msgspec.structs.replace(run, striker=msgspec.structs.replace(run.striker, speed_m_s=speed))


def _without_impact(bench: Bench):
    (blank,) = bench.drawn(bench.runs)

    def silent(run, gauge, trace):
        noise = bench.sigma(gauge) * bench.random.standard_normal(len(trace))
        return noise if run == blank else trace

    return traces_of(bench.record, silent), Place(run=blank)


def _clock(bench: Bench):
    """Two per cent slow: intervals are written too long."""
    return times_of(bench.record, lambda s: np.round(CLOCK * s.time_us, 9)), Place()


def _triggered(bench: Bench):
    """Time is counted from the pulse's arrival at the first gauge, to the sample."""
    first = bench.gauges[0]

    def counted(signals):
        trace = signals.readings[first]
        arrival = int(np.argmax(trace > 0.1 * trace.max()))
        return np.round(signals.time_us - signals.time_us[arrival], 9)

    return times_of(bench.record, counted), Place()


def _volts(bench: Bench):
    """One gauge's column holds volts at 12.5 N/V, its noise too."""
    (gauge,) = bench.drawn(bench.gauges)

    def in_volts(sensor):
        return msgspec.structs.replace(sensor, sigma_N=0.08 * sensor.sigma_N)

    changed = sensors_of(bench.record, lambda s: in_volts(s) if s.id == gauge else s)
    return of_gauge(changed, gauge, lambda trace: 0.08 * trace), Place(sensor=(gauge,))


def _all_louder(bench: Bench):
    """All gauges calibrated an eighth too high, their noise with them."""
    changed = sensors_of(bench.record, lambda s: msgspec.structs.replace(s, sigma_N=TOO_MUCH * s.sigma_N))
    return traces_of(changed, lambda _run, _gauge, trace: TOO_MUCH * trace), Place()


def _as_is(bench: Bench):
    return bench.record, Place()


def _with(plan: Plan, key: str, ratio: float) -> Plan:
    return replace(plan, **{key: ratio * getattr(plan, key)})


def _one_more_bead(plan: Plan) -> Plan:
    return replace(plan, beads=plan.beads + 1)


def _next_bead(plan: Plan) -> Plan:
    """The first gauge that sits in a bead sits one further on."""
    first = next((g for g in plan.gauges if g.bead is not None), None)
    taken = {g.bead for g in plan.gauges}
    if first is None or first.bead == plan.beads or first.bead + 1 in taken:
        raise ValueError("no gauge can sit a bead further on")
    moved = replace(first, bead=first.bead + 1)
    return replace(plan, gauges=tuple(moved if g is first else g for g in plan.gauges))


@dataclass(frozen=True)
class Slip:
    """One kind of slip.

    Attributes:
        id: of this table.
        faults: ids of a verdict's faults that name it.
        correctable: whether what is left of the record, put right, still shows a hidden effect.
        written: `Bench` → the record as written down, and where it is wrong.
        plan: what truly happened, of what the record says.
        effects: ids of the effects that are this slip in the catalogue's own words.
    """

    id: str
    faults: tuple[str, ...]
    correctable: bool = True
    written: Callable[[Bench], tuple[Record, Place]] = _as_is
    plan: Callable[[Plan], Plan] | None = None
    effects: tuple[str, ...] = ()


def _gauge(fault, change, correctable=True):
    return Slip(fault, (fault,), correctable, partial(_at_one_gauge, change))


def _of_bodies(fault, key, percent, effects=()):
    change = partial(_with, key=key, ratio=1.0 + percent / 100.0)
    return Slip(f"{fault}-{percent}", (fault,), plan=change, effects=effects)


_STRIKER = ("striker-error",)
# Slips that need a second run beside.
_OF_RUNS = ("runs-swapped", "run-off", "run-without-impact", "run-far-off", "run-late")

SLIPS: dict[str, Slip] = {
    s.id: s
    for s in (
        Slip("sound", ()),
        Slip("gauges-swapped", ("gauges-swapped",), written=_swapped),
        _gauge("gauge-inverted", _inverted),
        _gauge("gauge-dead", _dead),
        _gauge("gauge-clipped", _clipped),
        _gauge("gauge-delayed", _delayed),
        Slip("gauge-misplaced", ("gauge-misplaced",), plan=_next_bead),
        Slip("gauge-in-volts", ("gain-common",), written=_volts, effects=("sensor-gain",)),
        Slip("gain-common", ("gain-common",), written=_all_louder),
        Slip("runs-swapped", ("runs-swapped",), written=_runs_swapped),
        Slip("run-off", ("run-off",), written=_run_off),
        Slip("run-without-impact", ("run-without-impact",), written=_without_impact),
        Slip("bead-count", ("bead-count",), plan=_one_more_bead),
        _of_bodies("bead-mass", "bead_mass", 3),
        _of_bodies("bead-mass", "bead_mass", 10),
        _of_bodies("bead-size", "bead_radius", 3),
        _of_bodies("bead-size", "bead_radius", 10),
        _of_bodies("striker-mass", "striker_mass", 10, _STRIKER),
        _of_bodies("speed-common", "speed", 12, _STRIKER),
        Slip("noise-understated", ("noise-misstated",), written=partial(_noise_stated, 3.0)),
        Slip("noise-overstated", ("noise-misstated",), written=partial(_noise_stated, 1.0 / 3.0)),
        Slip("spikes", ("spikes",), written=_spikes),
        _gauge("pickup", _ringing),
        Slip("hum", ("pickup", "drift", "baseline"), written=_hum),
        _gauge("drift", _drifting),
        Slip("clock", ("clock",), written=_clock),
        Slip("time-zero", ("time-zero",), written=_triggered),
        Slip("run-far-off", ("run-off",), written=_far_off),
        Slip("run-late", ("time-zero",), written=_late),
    )
}
# Slips of a list of their own: of one run alone.
ALONE = ("run-far-off", "run-late")


def applies(slip: Slip, plan: Plan, runs: int) -> bool:
    """Whether a slip can be made with the gauges of a plan and so many runs."""
    needed = 2 if slip.id in ("gauges-swapped", "gauge-delayed", "gauge-dead") else 1
    if len(plan.gauges) < needed or (slip.id in _OF_RUNS and runs < 2):
        return False
    try:
        return slip.plan is None or slip.plan(plan) is not None
    except ValueError:
        return False
