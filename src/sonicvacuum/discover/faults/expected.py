"""Traces beside the nominal model's: is there a pulse at all, and is it the right way up?"""

import numpy as np

from sonicvacuum.discover.correlation import correlated
from sonicvacuum.discover.faults.traces import faint
from sonicvacuum.discover.model.noise import QUIET_PEAK, QUIET_SHARE, flicker, rounding

# A pulse is expected where the model's reading is this many standard deviations of the noise high, or where
# a matched filter would find it with so many standard deviations of its own ...
EXPECTED, MATCHED = 20.0, 60.0
# ... or with so many where it may be upside down, which shows at once ...
TURNED = 20.0
# ... and missing where the matched filter finds less than this, in standard deviations of its noise (the
# largest of a thousand shifts of pure noise is about 4) and in shares of what the model has.
SILENT, SHARE = 7.0, 0.05
# A pulse far smaller than the model's is one where at least these samples precede it, and the model's shape
# is this share of the trace's power: of pure noise, or of a slope, less.
FEWEST, ALIKE = 12, 0.5
# Of so many parts of a record the first is rest, if the model's pulse comes later.
BEGINNING = 50
# Of a gauge without a pulse nothing can be said where the model's own pulse, as late as the pulses of the
# other gauges are, would end after this share of the record.
WITHIN = 0.95
# Losses that take a pulse away before it arrives leave less than this of it at the gauge before.
FADED = 0.6
# ... unless a gauge further on shows so many times what is found.
CLEARLY = 3.0
# Upside down: the matched filter finds more below than above, by this factor.
INVERTED = 1.5
# A motion gauge reads the reflected pulse upside down: at a shift at which the model, slid along itself,
# shows this share of its power below zero, either way up is what the other one shows of the echo.
ECHO = 0.25


def verdict(trace: np.ndarray, model: np.ndarray, sigma: float, echo: float = 1.0) -> str:
    """ "silent", "inverted" or "" for (T,) measured and predicted readings, the noise of one sample, and the
    sign in which the gauge reads an echo.

    The matched filter is the model's reading slid over the trace: a pulse is found wherever it is in time.
    """
    peak, power = float(np.abs(model).max()), float(model @ model)
    if not peak > 0.0:
        return ""
    loud = peak > EXPECTED * sigma or np.sqrt(power) > MATCHED * sigma
    # Where no noise is to be seen, less would be.
    loud = loud or (still(trace) and peak > SILENT * sigma)
    found = float(np.abs(_slid(trace, model)).max()) / power
    silent = found < _least(power, sigma) and quiet(trace, sigma)
    if loud and silent and not _small(trace, model):
        return "silent"
    clear = loud or np.sqrt(power) > TURNED * sigma
    return "inverted" if clear and way(trace, model, sigma, echo) == "inverted" else ""


def way(trace: np.ndarray, model: np.ndarray, sigma: float, echo: float = 1.0) -> str:
    """ "upright", "inverted" or "", where a pulse is too weak to tell, of (T,) readings as in `verdict`."""
    if not float(model @ model) > 0.0:
        return ""
    told = _way_off(trace - np.median(trace), model, sigma, echo)
    # A pulse far broader than the model's, of a chain that loses much, may be most of the record: beside its
    # median, rest looks like a pulse the other way.
    first = trace[: max(FEWEST, len(trace) // BEGINNING)]
    if told and len(first) <= len(preceding(trace, model)):
        other = _way_off(trace - np.median(first), model, sigma, echo)
        return told if other in (told, "") else ""
    return told


def _way_off(trace, model, sigma, echo):
    """The way up of a pulse in a trace whose level is taken off."""
    power = float(model @ model)
    found = correlated(trace, model) / power
    up, down = float(found.max()), float(-found.min())
    # A motion gauge's reading swings both ways by itself: what the model's own would show.
    own = correlated(model, model) / power
    swing = max(1.0, INVERTED * max(float(-own.min()), 0.0))
    larger, other = max(up, down), max(min(up, down), 0.0)
    if larger * swing < _least(power, sigma):
        return ""
    told = "upright" if up > down else "inverted"
    if larger < INVERTED * other:
        return told if echo < 0.0 and _first(found, own) else ""
    return "" if told == "inverted" and _echo(found, own) else told


def _first(found, own):
    """Whether the larger of the largest values above and below zero of a trace slid along the model is the
    earlier one: of a motion gauge the other is then the echo, which comes later and the other way, where the
    model reads none that could lie on the pulse.
    """
    up, down = int(found.argmax()), int(found.argmin())
    return (up < down) == (found[up] > -found[down]) and float(own.min()) > -ECHO


def _echo(found, own):
    """Whether the largest value below zero of a trace slid along the model may be an upright gauge's echo: it
    stands where the model's echo lies on the pulse, and further from the model's own time than the largest
    value above. Both have the shift 0 in their middle.
    """
    middle = len(own) // 2
    above, below = int(found.argmax()) - middle, int(found.argmin()) - middle
    place = middle + below - above
    return abs(below) > abs(above) and 0 <= place < len(own) and own[place] < -ECHO


def _least(power, sigma):
    """Share of the model's pulse, of so much power, from which on it is found."""
    return max(SHARE, SILENT * sigma / np.sqrt(power))


def _small(trace, model):
    """Whether a trace that holds hardly anything of the model's pulse holds one of its own: it stands out of
    the noise before it, which may be far below the stated one, and the trace reads little else.
    """
    rest, off = preceding(trace, model), trace - np.median(trace)
    if len(rest) < FEWEST:
        return False
    noise = max(float(rest.std()), flicker(trace), rounding(trace))
    alike = float(np.abs(_slid(trace, model)).max()) ** 2 > ALIKE * float(model @ model) * float(off @ off)
    return alike and float(np.abs(off).max()) > SILENT * noise


def preceding(trace: np.ndarray, model: np.ndarray) -> np.ndarray:
    """(n,) what a trace reads before the model's pulse, of (T,) readings as in `verdict`."""
    rises = int((np.abs(model) > QUIET_PEAK * np.abs(model).max()).argmax())
    return trace[: int(QUIET_SHARE * rises)]


def cut(found: np.ndarray, trace: np.ndarray, model: np.ndarray | None, sigma: float) -> np.ndarray:
    """The quiet stretch `found` of a trace; where the pulse hardly stands out, what precedes the model's at
    most.
    """
    if model is None or not faint(trace, sigma):
        return found
    half = int((np.abs(model) > 0.5 * np.abs(model).max()).argmax())
    return found if len(found) <= half else preceding(trace, model)


def quiet(trace: np.ndarray, sigma: float) -> bool:
    """Whether no sample of (T,) readings stands out of the noise, or none of another level."""
    return still(trace) or bool(np.abs(trace).max() < SILENT * sigma)


def still(trace: np.ndarray) -> bool:
    """Whether (T,) readings never move."""
    return not np.ptp(trace) > 0.0


def _slid(trace, model):
    """Sums of products of a trace, its level off, with the model's reading, as `correlated` has them."""
    return correlated(trace - np.median(trace), model)


def share(trace: np.ndarray, model: np.ndarray) -> float:
    """How much of the model's pulse, either way up and wherever in time, (T,) measured readings hold."""
    power = float(model @ model)
    found = np.abs(_slid(trace, model))
    return float(found.max()) / power if power > 0.0 else 0.0


def found(trace: np.ndarray, model: np.ndarray, sigma: float) -> bool:
    """Whether (T,) measured readings clearly hold a pulse like the model's, wherever in time."""
    power = float(model @ model)
    return power > 0.0 and share(trace, model) > CLEARLY * _least(power, sigma)


def fades(place: float, model: np.ndarray, sigma: float, ahead: list[tuple[float, float]]) -> bool:
    """Whether a pulse may have died out on its way to a gauge.

    Args:
        place: way from the impact to the gauge.
        model: (T,) its predicted readings.
        sigma: noise of one sample.
        ahead: (way, `share`) of gauges that have a pulse. The whole pulse is there at the impact; what is
            left of it falls with the way as it does up to the last of them that it passes first.
    """
    line = sorted([(0.0, 1.0), *((way, s) for way, s in ahead if 0.0 < way < place)])
    if len(line) < 2 or not line[-1][1] < FADED:
        return False
    (way, last), (before, first) = line[-1], line[-2]
    left = last - (first - last) / (way - before) * (place - way)
    # What comes by further on has come by here.
    if max([0.0, *(s for way, s in ahead if way > place)]) > CLEARLY * _least(float(model @ model), sigma):
        return False
    return left * float(np.abs(model).max()) < SILENT * sigma


def delay(trace: np.ndarray, model: np.ndarray, time: np.ndarray) -> float:
    """How many times as late after the impact as in the model a pulse comes, for (T,) readings and instants.

    The shift is that at which the model's reading, either way up, fits the measured one best.
    """
    found = np.abs(_slid(trace, model))
    shift, interval = int(found.argmax()) - (len(model) - 1), float(time[1] - time[0])
    return 1.0 + shift * interval / max(float(time[int(np.abs(model).argmax())]), interval)


def still_to_come(model: np.ndarray, time: np.ndarray, delays: list[float]) -> bool:
    """Whether a pulse lies behind the record's end if it is as late as the other gauges' pulses are.

    Args:
        model: (T,) predicted readings.
        time: (T,) their instants after the impact.
        delays: of the gauges that have a pulse, as `delay` has them.
    """
    if not delays:
        return False
    rises = float(time[int((np.abs(model) > 0.5 * np.abs(model).max()).argmax())])
    return max(delays) * rises > time[-1] - (1.0 - WITHIN) * (time[-1] - time[0])
