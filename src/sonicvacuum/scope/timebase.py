"""Start and interval of a trace from its column of times, or from what the header says; the unit of time.

A header and a column may contradict each other. The unit of time is the one for which most witnesses speak:
the label of the column, the header's unit, and the sampling interval or rate that the header gives. Where
they draw, the label of the column counts; what was overruled is said.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.scope.keys import Keys
from sonicvacuum.scope.units import Unit, unit_of

# A header's interval is that of the times within this (headers print few digits).
ALIKE = 0.02
# Steps off the mean by more than this fraction of it: times are uneven, or printed with few digits.
EVEN = 0.01
# A header's interval this near to that of rounded times is the finer statement.
FINER = 2e-3
# Steps are whole numbers of the usual one within this share of it; digits are finer than that.
FINE = 0.1
# So few odd steps are lost rows, whatever the digits: rounded, the interval would hardly be off one digit.
SINGLE = 2
# Share of lost times that are filled, and of steps that are not the usual one; relative error of an interval
# from coarse times that is borne.
MOST_LOST, COARSEST = 0.1, 0.1
# Said where time zero is that of the first sample for want of anything better.
NO_TRIGGER = "Time counts from the first sample: the file does not say where the trigger is."
# Said where the times have no unit, as those of most oscilloscopes, which are in s.
SECONDS = "The unit of time is not given; s assumed."
# Said where envelopes are written as two rows of each time.
PAIRS = "Each time stands twice, as where the least and the most are kept (envelope): export the samples."
# Steps of missing samples that are told.
MISSING = 5
# Numbers of a day, as spreadsheets (from 1900 or 1904: the years 1954 to 2119) and MATLAB (1970 to 2100) have
# them; steps of what is fast enough to show a pulse, and those that may be seconds where they are round.
DAYS = ((20_000.0, 80_000.0), (719_529.0, 767_011.0))
FAST, SLOW = 1e-7, 1e-5
_FACTORS = {1.0: "s", 1e-3: "ms", 1e-6: "us", 1e-9: "ns", 1e-12: "ps"}


@dataclass(frozen=True, eq=False)
class TimeBase:
    """When samples were taken: start and interval in s (None: unknown), uneven times if so, and remarks."""

    start_s: float | None
    interval_s: float | None
    notes: tuple[str, ...] = ()
    times_s: np.ndarray | None = None


def declared_interval(keys: Keys, place: int = 0, column: int = 0) -> float | None:
    """Sampling interval in s as the header gives it, directly, by a rate or by start, stop and count."""
    interval = keys.number("interval", "s", place, column)
    rate = keys.number("rate", "Hz", place, column)
    # A key that may mean something else, as `Resolution`, says less than one that does not.
    if interval and not (rate and "interval" in keys.vague and "rate" not in keys.vague):
        return tidy(abs(interval))
    if rate and 0.0 < 1.0 / rate < np.inf:
        return tidy(1.0 / rate)
    start, stop, count = (keys.number(m, b) for m, b in (("start", "s"), ("stop", "s"), ("count", "")))
    if start is not None and stop is not None and stop > start and count and count > 1:
        return (stop - start) / count
    return None


def tidy(number: float) -> float:
    """The number without the last digits, which are rounding errors of units and differences."""
    return float(f"{number:.12g}")


def from_header(
    keys: Keys, place: int = 0, column: int = 0, why: str = "the file has no times and no interval"
) -> TimeBase:
    """Time base of a table without times that say it, and why they do not."""
    interval = declared_interval(keys, place, column)
    start = keys.number("start", "s", place, column)
    notes = []
    if interval is None:
        odd = " and ".join(f"{k} {v!r}" for m, (k, v) in keys.odd.items() if m in ("interval", "rate"))
        said = f"the header's {odd} is not understood" if odd else why
        return TimeBase(None, None, (f"No time: {said}; give --interval.",))
    if any(keys.bare(m) for m in ("interval", "start")) and (unit := _scaled(keys, interval)):
        said = f"a number of the header has no unit, and its unit of time is {unit}"
        return TimeBase(None, None, (f"No time: {said}; give --interval and --start.",))
    trigger = keys.number("trigger", "", place, column)
    if start is None and trigger is not None:
        start = tidy(-trigger * interval)
        notes.append(f"Time counts from the trigger, sample {trigger:g}.")
    if start is None:
        start = 0.0
        notes.append(NO_TRIGGER)
    return TimeBase(start, interval, tuple(notes))


def from_column(
    times: np.ndarray, label: Unit | None, keys: Keys, place: int = 0, column: int = 0, odd: str = ""
) -> TimeBase:
    """Time base of a column of times, one shot, whose label may hold an odd text in place of a unit.

    First the line through the times, in their unit; then what makes seconds of it, by label, header and the
    interval that the header declares.
    """
    gap = int(np.isfinite(times).argmin()) + 1
    times, notes = _filled(times)
    if times is None:
        return _headers(keys, place, column, f"the column of times has gaps, the first at sample {gap}")
    declared = declared_interval(keys, place, column)
    if (np.diff(times) < 0.0).any():  # rounding never turns times round
        return _backwards(times, keys, place, column)
    places = _places(times)
    slope = float(times[-1] - times[0]) / places[-1]
    broken = bool((np.diff(places) != 1).any())
    rounded, uneven = (False, False) if broken else _spacing(times, slope)
    begin, rough = float(times[0]), 0.0
    if (rounded and not uneven) or slope == 0.0:
        slope, begin, rough = _line(times)
        if rough > COARSEST:
            return _headers(keys, place, column, "the times are printed too coarsely to tell an interval")
    if not slope > 0.0:
        return _headers(keys, place, column, "the times do not rise")
    unit = _scaled(keys, declared) if label is None and declared and keys.bare("interval") else ""
    if unit and abs(slope / declared - 1.0) < ALIKE:
        said = f"times and interval have no unit, and the header's unit of time is {unit}"
        return TimeBase(None, None, (f"No time: {said}; write it behind their name, or give --interval.",))
    factor, said = _factor(slope, label, declared, keys)
    if factor is None and odd:
        return _headers(keys, place, column, f"the unit of time, {odd!r}, is not known")
    if factor is None and _are_days(begin, slope):
        return _headers(keys, place, column, _days(begin, slope))
    factor = factor or 1.0
    interval, start, notes = tidy(slope * factor), tidy(begin * factor), [*notes, *said]
    if declared and rounded and not uneven and abs(declared / interval - 1.0) < max(FINER, 3.0 * rough):
        interval, start = declared, tidy(float(times[0]) * factor)
        notes.append("Times are printed with few digits; the interval is the header's.")
    elif declared and abs(declared / interval - 1.0) > ALIKE:
        notes.append(f"The header gives an interval of {declared:g} s, the times one of {interval:g} s.")
    elif rough:
        notes.append(
            f"Times are printed with few digits; the interval, of a line through them, is good to "
            f"{100.0 * rough:.2g} %: give --interval where it is known better."
        )
    if broken:
        return TimeBase(start, interval, (*notes, *_rows(times * factor, places)), times * factor)
    if uneven:
        return TimeBase(start, interval, (*notes, *_steps(times, factor)), times * factor)
    return TimeBase(start, interval, tuple(notes))


def _are_days(begin, step):
    """Whether times without a unit are numbers of days: no recorder counts 0.1 us over half a day."""
    if not any(low < begin < high for low, high in DAYS):
        return False
    few = (float(f"{number:.1e}") / number for number in (step, 1.0 / step))
    return step < FAST or (step < SLOW and all(abs(ratio - 1.0) > 1e-3 for ratio in few))


def _days(begin, step):
    return (
        f"the times, without a unit, from {begin:.10g} on by {step:.4g}, look like numbers of days, as "
        f"spreadsheets keep them (steps of {86400.0 * step:.4g} s); write seconds, as in =(A2-A$2)*86400"
    )


def _steps(times, factor):
    """Remarks on uneven times, of which `factor` makes seconds."""
    steps = np.diff(times) * factor
    if not steps[::2].any():
        yield PAIRS
    yield f"Times are uneven: steps of {steps.min():.4g} to {steps.max():.4g} s; the interval is the mean."
    missing = round(float(steps.max() / np.median(steps))) - 1 if np.median(steps) > 0.0 else 0
    if missing > MISSING:
        at = float(times[steps.argmax()]) * factor
        yield f"Behind {at:.6g} s {missing} samples are missing: a straight line stands there."


def _places(times):
    """(S,) places of samples on even times: one after the other but where rows are lost or stand twice, which
    all steps between are whole numbers of most of them tell.
    """
    steps, usual = np.diff(times), np.arange(len(times))
    step = float(np.median(steps)) if len(steps) else 0.0
    if not step > 0.0:
        return usual
    counts = np.round(steps / step)
    odd = counts != 1.0
    if not odd.any() or odd.mean() > MOST_LOST or np.abs(steps / step - counts).max() > FINE:
        return usual
    # Of times that are multiples of the step rounding makes odd steps too, at even distances.
    if odd.sum() > SINGLE and _last_digit(times) > FINE * step:
        return usual
    # More missing than there are samples: another record follows, and the time between is not filled.
    if counts.sum() > 2.0 * len(times):
        return usual
    return np.concatenate([[0], np.cumsum(counts)]).astype(int)


def _rows(times, places):
    """Remarks on rows that are lost or stand twice."""
    steps = np.diff(places)
    lost, twice = np.flatnonzero(steps > 1), int((steps == 0).sum())
    if len(lost):
        where = f"the first behind {times[lost[0]]:.6g} s, sample {lost[0] + 1}"
        yield f"Samples missing, left out: {int((steps[lost] - 1).sum())}, {where}."
    if twice:
        first = int((steps == 0).argmax())
        yield f"Times that stand twice: {twice}, the first {times[first]:.6g} s; one sample of each counts."


def _scaled(keys, interval):
    """The header's unit of time, "" where it names none but s, or the sampling rate says that it is in s."""
    said = next((t for t in keys.texts("time unit") if (u := unit_of(t)) and u.base == "s"), "")
    rate = keys.number("rate", "Hz")
    sure = not said or unit_of(said).factor == 1.0 or (rate and abs(rate * interval - 1.0) < ALIKE)
    return "" if sure else said


def _headers(keys, place, column, why):
    base = from_header(keys, place, column, why)
    if base.interval_s is None:
        return base
    said = f"{why[0].upper()}{why[1:]}; start and interval are the header's."
    return TimeBase(base.start_s, base.interval_s, (*base.notes, said))


def _backwards(times, keys, place, column):
    """No times, but the header's interval where they start again only, as fractions of a second do."""
    steps, span = np.diff(times), float(np.ptp(times))
    k = int((steps < 0.0).argmax())
    said = f"the times run backwards behind sample {k + 1}, from {times[k]:.9g} to {times[k + 1]:.9g}"
    if (steps[steps < 0.0] < -0.5 * span).all():
        return _headers(keys, place, column, said)
    return TimeBase(None, None, (f"No time: {said}; put the rows in order, or give --interval.",))


def _filled(times):
    """Times with single lost ones between their neighbours, and a remark; None where too many are lost."""
    lost = ~np.isfinite(times)
    if len(times) < 2 or lost[[0, -1]].any() or lost.mean() > MOST_LOST:
        return None, []
    if not lost.any():
        return times, []
    places = np.arange(len(times))
    filled = np.interp(places, places[~lost], times[~lost])
    return filled, [f"{int(lost.sum())} times are lost: taken between their neighbours."]


def _line(times):
    """Slope and begin of the line through times printed with few digits, and the slope's relative error.

    Times rounded to a step that m of fit into the record are off by step/√12, alike over each step: the slope
    of the line of least squares is off by m^-1.5 of itself.
    """
    distinct = np.unique(times)
    if len(distinct) < 2:
        return 0.0, float(times[0]), np.inf
    slope, begin = np.polyfit(np.arange(len(times)), times - times[0], 1)
    return float(slope), float(times[0] + begin), float(len(distinct) - 1) ** -1.5


def _spacing(times, slope):
    """Whether steps differ from the mean at all, and whether by more than the digits printed explain."""
    spread = np.abs(np.diff(times) - slope).max()
    if slope <= 0.0 or spread <= EVEN * slope:
        return False, slope <= 0.0
    off = np.abs(times - (times[0] + slope * np.arange(len(times)))).max()
    return True, bool(off > 1.01 * _last_digit(times))


def _last_digit(times):
    """A unit of the last digit printed of the largest times, from the digits of some of them."""
    some = times[:: max(1, len(times) // 500)]
    digits = max(len(f"{abs(t):.14e}".split("e")[0].replace(".", "").rstrip("0")) for t in some)
    return 10.0 ** (np.floor(np.log10(np.abs(times).max())) - (digits - 1))


def _factor(slope, label, declared, keys):
    """Seconds in one unit of the column (None: nothing tells them), and remarks on contradictions."""
    header = next((u for u in map(unit_of, keys.texts("time unit")) if u and u.base == "s"), None)
    label = label if label and label.base == "s" else None
    votes = {}
    for unit in (label, header):
        if unit:
            votes[unit.factor] = votes.get(unit.factor, 0) + 1
    told = None
    if declared and slope > 0.0:
        told = next((f for f in _FACTORS if abs(slope * f / declared - 1.0) < ALIKE), None)
        if told:
            votes[told] = votes.get(told, 0) + 1
    if not votes:
        return None, [SECONDS]
    most = max(votes.values())
    order = [label and label.factor, told, header and header.factor]
    factor = next(f for f in order if f and votes[f] == most)
    return factor, _contradictions(factor, label, header, told)


def _contradictions(factor, label, header, told):
    witnesses = {
        "the label of the column": label and label.factor,
        "the header's unit": header and header.factor,
        "the header's interval or rate": told,
    }
    against = [f"{who} says {_FACTORS.get(f, f)}" for who, f in witnesses.items() if f and f != factor]
    if against:
        return [f"Times are in {_FACTORS.get(factor, factor)}, although {' and '.join(against)}."]
    if label is None and header is None:
        return [f"The unit of time, {_FACTORS.get(factor, factor)}, follows from the header's interval."]
    return []
