"""One run from raw channels to traces of a record: scaled, at rest before the pulse, trimmed and thinned."""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.records.signals import Signals
from sonicvacuum.scope import thin
from sonicvacuum.scope.options import Options
from sonicvacuum.scope.quiet import Trace, look, white
from sonicvacuum.scope.runs import Shot, common_grid
from sonicvacuum.scope.timebase import NO_TRIGGER, tidy
from sonicvacuum.scope.units import STANDARD_GRAVITY

# Lost samples in a row that are bridged by a straight line.
BRIDGED = 5
# Kept before the first arrival and after the last sample that stands out, and at most after the arrival,
# in widths of the pulse at half height; samples that are kept before it at least.
BEFORE, AFTER, LONGEST = 15.0, 10.0, 150.0
LEAST = 200
FEWEST_QUIET = 40
# Lengths of the recording by which the impact may lie before it, as where the recorder waits for a delay.
FARTHEST = 3.0
# Digits of readings that are written.
DIGITS = 7
# Base units that a record's gauges count in.
FORCE_UNITS = ("N", "m/s", "m/s^2")


@dataclass(frozen=True, eq=False)
class CleanRun:
    """One run as the record takes it.

    Attributes:
        id: its name.
        signals: traces; time 0 is `zero_s` on the recorder's clock.
        sigma, unit: gauge → white noise of one written sample, and its unit.
        zero_s, zero_sigma_s: time zero on the recorder's clock in s, its standard error (None: unknown).
        lead_s: time from the first written sample to the first arrival.
        notes: whole sentences on the run, those on one gauge begin with its id.
    """

    id: str
    signals: Signals
    sigma: dict[str, float]
    unit: dict[str, str]
    zero_s: float
    zero_sigma_s: float | None
    lead_s: float
    notes: tuple[str, ...]


def clean(shot: Shot, options: Options) -> CleanRun:
    """Scale, level, trim and thin one run; InputError where samples are lost that cannot be bridged."""
    notes = list(shot.notes)
    start, step, samples, said = common_grid(shot)
    notes += said
    values, unit = {}, {}
    for gauge, channel in shot.channels.items():
        notes += [f"{gauge}: {n}" for n in channel.notes]
        where = f"{shot.files[gauge]}: channel {channel.name} (run {shot.id}, {gauge})"
        whole = _bridged(samples[gauge], where, (start, step), gauge, notes)
        factor, unit[gauge] = _scaled(channel, gauge, options, notes)
        values[gauge] = whole * factor
    seen = {g: look(v) for g, v in values.items()}
    for gauge, trace in seen.items():
        notes += [f"{gauge}: {n}" for n in _found(trace, unit[gauge], step, start)]
        values[gauge] = _without_spikes(values[gauge] - trace.rest, trace)
    count = len(next(iter(values.values())))
    impact = options.impacts.get(shot.id, options.impacts.get(""))
    if impact is not None:
        notes += _held_against(impact, start, step, count, seen, shot.id)
    begin, end, factor = _window(values, seen, None if impact is None else (impact - start) / step, options)
    left = thin.kept(begin, end, count, factor)
    notes += _told_cut(begin, end, left, count)
    if factor > 1:
        notes.append(
            f"Thinned by {factor}, from {tidy(step):g} to {tidy(step * factor):g} s, behind a zero-phase "
            "low-pass that halves the power at the new Nyquist frequency and leaves white noise white."
        )
    begin = left.start
    written = {g: thin.thinned(v, left) for g, v in values.items()}
    sigma = {g: _sigma(written[g], seen[g], begin, factor) for g in written}
    other = {g: s for g, s in sigma.items() if f"{s:.3g}" != f"{seen[g].sigma:.3g}"}
    notes += [f"{g}: noise {s:.3g} {unit[g]} a written sample." for g, s in other.items()]
    first = min((t.arrival for t in seen.values() if t.arrival is not None), default=None)
    zero, zero_sigma = _zero(impact, start, step, begin, first, seen, notes)
    count = len(next(iter(written.values())))
    time_us = np.array([tidy((start + begin * step - zero + k * factor * step) * 1e6) for k in range(count)])
    readings = {g: _rounded(v, sigma[g]) for g, v in written.items()}
    lead = ((first if first is not None else begin) - begin) * step
    return CleanRun(shot.id, Signals(time_us, readings), sigma, unit, zero, zero_sigma, lead, tuple(notes))


def _bridged(values, where, times, gauge, notes):
    """Samples without lost ones (bridged) and without infinities (the largest of the others instead)."""
    finite = np.isfinite(values)
    if finite.all():
        return values
    if not finite.any():
        raise InputError(f"{where}: no sample is a finite number; leave the channel out")
    values = values.copy()
    over = np.isinf(values)
    values[values == np.inf], values[values == -np.inf] = values[finite].max(), values[finite].min()
    if over.any():
        notes.append(f"{gauge}: {int(over.sum())} samples over range stand at the end of the range: clipped.")
    lost = np.isnan(values)
    edges = np.flatnonzero(np.diff(np.concatenate(([0], lost.astype(int), [0]))))
    rows = edges[1::2] - edges[::2]
    if len(rows) and rows.max() > BRIDGED:
        first = int(edges[::2][rows.argmax()])
        raise InputError(
            f"{where}: {int(rows.max())} samples in a row are lost, from sample {first + 1} at "
            f"{times[0] + first * times[1]:.6g} s on; cut the file there, or leave the channel out"
        )
    places = np.arange(len(values))
    values[lost] = np.interp(places[lost], places[~lost], values[~lost])
    return values


def _scaled(channel, gauge, options, notes):
    """Factor to the record's unit, and that unit; volts stay where no sensitivity is given."""
    scale = options.scales.get(gauge)
    if scale is None:
        if channel.unit == "g":
            return STANDARD_GRAVITY, "m/s^2"
        if channel.unit not in FORCE_UNITS:
            notes.append(
                f"{gauge}: readings stay in {channel.unit or 'an unknown unit'}: no --scale is given."
            )
        return 1.0, channel.unit
    found = scale.of(channel.unit)
    if found is None and channel.unit == "":
        found = scale.of("V")
        notes.append(f"{gauge}: readings taken as volts.")
    if found is None or found[1] not in FORCE_UNITS:
        raise InputError(
            f"--scale {gauge}: is for {scale.unit} and {scale.per}, while channel {channel.name} is in "
            f"{channel.unit or 'no unit'}; give newtons (or m/s, m/s^2) for its unit"
        )
    return found


def _found(trace: Trace, unit, step, start):
    unit = unit or "as written"
    yield f"baseline {trace.rest:.4g} {unit} removed ({trace.quiet} samples at rest before the pulse)."
    yield f"noise {trace.sigma:.3g} {unit} a sample as recorded."
    if trace.slow > 1.6 * trace.sigma:
        yield f"slow noise (hum, drift) {trace.slow:.3g} {unit} at rest is not white."
    if trace.arrival is None:
        yield "no pulse found: nothing stands out of the noise."
    else:
        yield (
            f"peak {trace.peak:.4g} {unit}; arrives at {1e6 * (start + trace.arrival * step):.6g} us of the "
            f"recorder, {1e6 * trace.width * step:.3g} us wide at half height."
        )
        if trace.quiet < FEWEST_QUIET:
            yield "hardly any rest before the pulse: baseline, noise and the sign of the pulse are uncertain."
        elif trace.peak < 0.0:
            yield "the largest excursion is negative; compression must be positive: give a negative --scale."
    if trace.step:
        yield f"the converter's step is {trace.step:.3g} {unit}."
    if trace.clipped:
        yield f"{trace.clipped} samples lie at an end of the range: clipped."
    if len(trace.spikes):
        yield f"{len(trace.spikes)} single samples lay far off their neighbours (spikes): medians instead."


def _without_spikes(values, trace):
    if not len(trace.spikes):
        return values
    values = values.copy()
    for k in trace.spikes:
        values[k] = np.median(values[max(0, k - 2) : k + 3])
    return values


def _window(values, seen, impact, options):
    """First and last sample to keep (the impact, a sample or None, is among them) and the thinning."""
    count = len(next(iter(values.values())))
    found = {g: t for g, t in seen.items() if t.arrival is not None}
    if options.keep_all or not found:
        return 0, count, 1
    width = max(t.width for t in found.values())
    first, last = min(t.arrival for t in found.values()), max(t.last for t in found.values())
    begin = max(0, min(first, first if impact is None else int(impact)) - max(int(BEFORE * width), LEAST))
    end = min(count, last + int(AFTER * width), first + int(LONGEST * width))
    factor = thin.factor_for(
        [values[g][begin:end] for g in found],
        [t.width for t in found.values()],
        [t.arrival - begin for t in found.values()],
    )
    return begin, max(end, min(count, begin + 16 * factor)), factor


def _told_cut(begin, end, left, count):
    """How many of `count` samples are left out and why: those outside `begin` and `end`, and some within."""
    parts = [
        (begin, f"before the pulse (farther than {BEFORE:g} of its widths and {LEAST} samples)"),
        (
            count - end,
            f"behind it ({AFTER:g} widths after it has died away, or {LONGEST:g} after it arrives)",
        ),
        (left.start - begin + end - left.stop, "at the ends, which the low-pass needs"),
    ]
    if told := [f"{number} {where}" for number, where in parts if number]:
        kept = left.stop - left.start
        yield f"Cut from {count} to {kept} samples, without {', '.join(told)}; --keep-all keeps all."


def _sigma(written, trace, begin, factor):
    """White noise of one written sample: measured at rest where that lasts, else as the filter says."""
    rest = (trace.arrival - begin) // factor if trace.arrival is not None else 0
    quiet = written[: int(0.9 * rest)]
    floor = trace.step / np.sqrt(12.0) if factor == 1 else 0.0
    if len(quiet) >= FEWEST_QUIET:
        found = white(quiet, 0.0)
        return max(found, floor, 0.5 * trace.sigma * thin.noise_left(factor))
    return max(trace.sigma * thin.noise_left(factor), floor)


def _held_against(impact, start, step, count, seen, run):
    """Remarks on a moment of impact that is odd; InputError for one that cannot be that of the recording."""
    end, length = start + (count - 1) * step, count * step
    given, span = f"--impact-at: run {run}: is {impact:g} s", f"which lasts from {start:.6g} to {end:.6g} s"
    cure = "give the moment on the recorder's clock with its unit, as in 12us"
    if impact > end:
        raise InputError(f"{given}, behind the recording, {span}; {cure}")
    if impact < start - FARTHEST * length:
        raise InputError(f"{given}, more than {FARTHEST:g} lengths before the recording, {span}; {cure}")
    # Without rest before it, where the pulse arrives is not sure.
    sure = {g: t for g, t in seen.items() if t.arrival is not None and t.quiet >= FEWEST_QUIET}
    arrivals = {g: start + t.arrival * step for g, t in sure.items()}
    late = [g for g, at in arrivals.items() if impact > at + seen[g].width * step]
    if late and len(late) == len(arrivals):
        last = max(arrivals.values())
        raise InputError(f"{given}, when the pulse has passed every gauge, the last at {last:.6g} s; {cure}")
    if late:
        yield f"The impact is given behind the arrival of the pulse at {', '.join(late)}."
    if impact < start:
        yield f"The impact is given {start - impact:.4g} s before the recording begins."


def _zero(impact, start, step, begin, first, seen, notes):
    """Time zero of the record on the recorder's clock, and its standard error (None: unknown)."""
    if impact is not None:
        notes.append(f"Time counts from the impact, given as {1e6 * impact:g} us of the recorder.")
        return impact, step
    if first is None:
        return start, None
    arrival, width = start + first * step, max(t.width for t in seen.values()) * step
    # Where the file knows no trigger, its zero is the first sample, as a remark on it says.
    zero = "recorder's zero" if any(NO_TRIGGER in n for n in notes) else "trigger"
    if start + begin * step <= 0.0 <= arrival + width:
        notes.append(f"Time counts from the {zero}; how long before or after it the impact was is not known.")
        return 0.0, None
    notes.append(f"The {zero} lies far off: time counts from the first arrival; the impact was before it.")
    return arrival, None


def _rounded(values, sigma):
    """Values to a thousandth of the noise, or to DIGITS digits of the largest."""
    top = float(np.abs(values).max())
    unit = 10.0 ** np.floor(np.log10(sigma / 1e3)) if sigma > 0.0 else 0.0
    least = 10.0 ** (np.floor(np.log10(top)) - DIGITS) if top > 0.0 else 0.0
    digits = int(-np.log10(max(unit, least))) if max(unit, least) > 0.0 else 12
    return np.round(values, min(15, digits)) + 0.0
