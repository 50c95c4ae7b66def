"""What in a valid record looks suspicious: no errors, but worth a look before a verdict is trusted."""

from collections import Counter
from itertools import pairwise

import numpy as np

from sonicvacuum.gauges import Gauge, position
from sonicvacuum.observe.pulse import main_pulse
from sonicvacuum.physics.scales import impact_scales
from sonicvacuum.records.assemble import assemble
from sonicvacuum.records.reader import read
from sonicvacuum.records.record import Record, Run

# Samples per contact time below which pulses are poorly resolved.
FEW_SAMPLES = 8
WEAK = 10.0
# Estimated over stated noise outside of these is worth a word, given enough samples at rest.
NOISE = (0.5, 2.0)
REST_SAMPLES = 20
# A trace rests until it exceeds so many standard deviations and 5 % of its peak; the last part is left out.
ONSET = 6.0
QUIET = 0.7
# Equal samples in a row at the top of a trace: the recorder's range was exceeded.
CLIPPED = 5
HEAVY = 300.0
FAST = 20.0
SLOW = 1e-3
# Relative errors from which on per cent may be meant.
LARGE = 0.5


def check(path) -> list[str]:
    """Warnings about a record that can be read; InputError for one that cannot."""
    return warnings(read(path))


def warnings(record: Record) -> list[str]:
    """One line for each suspicious thing, beginning with the place it concerns."""
    found = [*_materials(record), *_gauges(record), *_strikers(record)]
    for run, contact in zip(record.runs, _contact_times(record), strict=True):
        if run.signals is not None:
            found += _traces(record, run, contact)
    return found


def noise_at_rest(run: Run, gauge: Gauge) -> tuple[float, float, int]:
    """Mean and standard deviation of a trace before the pulse arrives, and the number of samples."""
    force = run.signals.readings[gauge.id]
    # A trace that rests far off zero rests all the same.
    level = np.median(force[:REST_SAMPLES])
    above = np.abs(force - level) > max(ONSET * gauge.sigma, 0.05 * float(np.abs(force).max()))
    quiet = force[: int(QUIET * (above.argmax() if above.any() else len(force)))]
    if len(quiet) < 2:
        return 0.0, 0.0, len(quiet)
    return float(quiet.mean()), float(quiet.std(ddof=1)), len(quiet)


def _contact_times(record):
    times = [0.0] * len(record.runs)
    for batch in assemble(record):
        for lane, k in enumerate(batch.runs):
            times[k] = impact_scales(batch.chain.take([lane]))[1]
    return times


def _materials(record):
    used = {m.name for m in record.specimen.materials}
    used |= {r.striker.material for r in record.block.runs}
    for name in record.block.materials:
        if name not in used:
            yield f"materials.{name}: nothing in the record is made of it"
    touching = record.specimen.first.surface.name
    if record.modulus_rel_sigma(touching) is None:
        yield f"materials.{touching}: no modulus_rel_sigma; say how well the modulus is known"


def _gauges(record):
    """Errors that are likely slips, and gauges at one place, which may be meant."""
    stands: dict[tuple, str] = {}
    for k, gauge in enumerate(record.gauges):
        key = f"sensors[{k}] ({gauge.id})"
        if gauge.calibrated and gauge.gain_rel_sigma >= LARGE:
            yield f"{key}: {_large('gain_rel_sigma', gauge.gain_rel_sigma)}; uncalibrated gauges have unknown"
        first = stands.setdefault((gauge.kind, gauge.bead), gauge.id)
        if first != gauge.id:
            where = "at the wall" if gauge.bead is None else f"in bead {gauge.bead}"
            yield f"{key}: is {where}, as {first} is, and of the same kind; is the place right?"
    if record.signals and record.trigger_sigma_s == 0.0:
        yield (
            "trigger_sigma_us: is 0 or left out, so that the time zero of each run counts as exact; say how "
            "well the moment of impact is known, or write unknown"
        )


def _large(key, error):
    meant = f"where {error:g} % is meant, write {error / 100.0:g}"
    return f"{key} is {error:g}, an error of {100.0 * error:g} %; {meant}"


def _strikers(record):
    bead = record.specimen.first
    mass_g = 1e3 * bead.mass_kg
    for k, run in enumerate(record.block.runs):
        s, key = run.striker, f"runs[{k}].striker ({run.id})"
        if s.shape == "flat" and s.diameter_mm is not None:
            yield f"{key}: diameter_mm of a flat striker is not used"
        if record.beads == 0:
            if s.material != bead.surface.name:
                yield f"{key}: material {s.material} is not used: {bead.surface.name} touches (chain.bead)"
            if (s.diameter_mm / 1e3, s.mass_g / 1e3) != (bead.diameter_m, bead.mass_kg):
                yield f"{key}: diameter or mass differ from chain.bead; the striker's are used"
        elif s.mass_g > HEAVY * mass_g:
            yield f"{key}: mass_g is {s.mass_g:g}, {s.mass_g / mass_g:.0f} beads' masses; is it in mg?"
        if s.speed_rel_sigma >= LARGE:
            yield f"{key}: {_large('speed_rel_sigma', s.speed_rel_sigma)}"
        if not SLOW <= s.speed_m_s <= FAST:
            yield f"{key}: speed_m_s is {s.speed_m_s:g}; is the unit right?"
    files = Counter(r.signals for r in record.block.runs if r.signals)
    yield from (f"{name}: serves {n} runs" for name, n in files.items() if n > 1)


def _traces(record, run, contact):
    signals, name = run.signals, f"run {run.id}"
    if signals.interval_s * FEW_SAMPLES > contact:
        yield (
            f"{name}: samples are {signals.interval_s * 1e6:.3g} us apart, a contact lasts about "
            f"{contact * 1e6:.3g} us: pulses are poorly resolved"
        )
    if signals.start_s > contact:
        yield f"{name}: starts {signals.start_s * 1e6:.3g} us after the impact"
    peaks = {}
    for gauge in record.gauges:
        if gauge.id not in signals.readings:
            continue
        yield from _trace(run, gauge, f"{name}, {gauge.id}")
        pulse = main_pulse(signals.trace(gauge.id, gauge.sigma))
        if pulse.found:
            peaks[gauge.id] = pulse.time
        elif pulse.reason.startswith("truncated"):
            yield f"{name}, {gauge.id}: {pulse.reason}"
    yield from _order(record, peaks, name)


def _trace(run, gauge, name):
    force, unit = run.signals.readings[gauge.id], _unit(gauge)
    top, bottom = float(force.max()), float(force.min())
    if gauge.sigma > 0.0 and top < WEAK * gauge.sigma:  # without a noise, what is below 0 is no weak peak
        yield f"{name}: the peak, {top:.3g} {unit}, is only {top / gauge.sigma:.2g} times the noise"
    if gauge.unit == "N" and -bottom > max(top, ONSET * gauge.sigma):
        yield (
            f"{name}: swings further down ({bottom:.3g} {unit}) than up; positive force means compression: "
            "is the sign right?"
        )
    flat = _row(force == top)
    if top > WEAK * gauge.sigma and flat >= CLIPPED:
        yield f"{name}: {flat} equal samples at the top, {top:.3g} {unit}: the recorder seems to clip"
    steps = np.unique(np.abs(np.diff(np.unique(force))))
    if (
        len(steps)
        and 0.0 < gauge.sigma < 0.9 * float(steps[0]) / np.sqrt(12.0)
        and len(np.unique(force)) < len(force) / 2
    ):
        key = gauge.what.noise_key
        yield f"{name}: values lie {steps[0]:.3g} {unit} apart; {key} must be at least that over √12"
    yield from _rest(run, gauge, name)


def _unit(gauge):
    """Unit of a gauge's numbers; without a calibration those of a force are as the recorder has them."""
    return "as recorded" if gauge.unit == "N" and not gauge.calibrated else gauge.unit


def _rest(run, gauge, name):
    mean, spread, samples = noise_at_rest(run, gauge)
    if samples < REST_SAMPLES:
        return
    if gauge.sigma and not NOISE[0] * gauge.sigma <= spread <= NOISE[1] * gauge.sigma:
        stated = f"{gauge.what.noise_key} says {gauge.sigma:g}"
        yield f"{name}: noise before the pulse is {spread:.2g} {_unit(gauge)}, {stated}"
    if abs(mean) > max(gauge.sigma or spread, 5.0 * spread / np.sqrt(samples)):
        yield f"{name}: the trace rests at {mean:.2g} {_unit(gauge)} before the pulse, not at 0"


def _order(record, peaks, name):
    """Gauges must see the pulse in the order in which they stand behind the striker."""
    place = {g.id: -position(g, record.beads, 1.0) for g in record.gauges}
    ids = sorted(peaks, key=lambda s: place[s])
    for near, far in pairwise(ids):
        if place[near] < place[far] and peaks[near] > peaks[far]:
            yield (
                f"{name}: the pulse reaches {far} before {near}, which stands closer to the striker; bead 1 "
                "is the struck one: are the beads counted from the wrong end, or columns exchanged?"
            )


def _row(flags):
    """Length of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(int), [0]))))
    return int((edges[1::2] - edges[::2]).max(initial=0))
