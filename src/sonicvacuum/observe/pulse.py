"""The pulses of one signal: where they peak, how long they last, whether they are separate.

A solitary wave shows as one hump; a long impulse splits into a train of humps, the highest first; noise and
the wave's own tail add small ones. Rules, so that a count means something:

* The *main pulse* is the first separate peak that reaches `MAIN` × the largest force of the record. It need
  not be the largest sample: reflections that meet later pulses rise higher.
* Two peaks are *separate* when the force between them falls below the lower one by more than `PROMINENCE` ×
  the main peak, and by more than 8 standard deviations of the noise.
* Of two humps of one pulse that are as high as each other but for `TIE`, the first is its peak, where there
  is no noise: where two contacts share a gauge and the wave is short, which is the higher is chance.
* A pulse that the record does not show is absent; one whose rise or fall the record cuts off is truncated;
  one that does not fall to a level before the next separate pulse is merged at that level. Values are then
  NaN, with the reason.
* The beginning of a longer signal (`Trace.goes_on`) tells what the whole would tell, or raises `Unsettled`.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from sonicvacuum.observe.trace import Trace, Unsettled, maximum, top_of

MAIN = 0.25
# The main pulse of a beginning is that of the whole as long as no later force exceeds it 1/`MAIN` times; it
# is taken for that where no force so far has exceeded it so many times.
HIGHER = 2.0
PROMINENCE = 0.05
THRESHOLD = 0.15
_NOISE_SWING = 8.0
_NOISE_FLOOR = 6.0


@dataclass(frozen=True)
class Pulse:
    """One peak of a signal.

    Attributes:
        time: of the peak in s, between samples; NaN where there is no pulse.
        force: at the peak in N.
        peak: highest sample.
        seen: sample by which the force has fallen enough to make it a peak.
        width: samples of its top, to which the peak was fitted.
        reason: why there is no pulse; empty where there is one.
    """

    time: float
    force: float
    peak: int = -1
    seen: int = -1
    width: int = 0
    reason: str = ""

    @property
    def found(self) -> bool:
        """Whether there is a pulse."""
        return not self.reason


def main_pulse(trace: Trace, floor: float = 0.0) -> Pulse:
    """The main pulse; absent where no force exceeds `floor` (N) or six standard deviations of the noise.

    Raises:
        Unsettled: where more of the signal may show another one.
    """
    found = _main_pulse(trace, floor)
    if trace.goes_on and not (found.found and trace.force.max() <= HIGHER * found.force):
        raise Unsettled
    return found


def _main_pulse(trace, floor):
    force = trace.force
    largest = float(force.max())
    floor = max(floor, _NOISE_FLOOR * trace.noise)
    if not largest > floor:
        return _no_pulse(f"absent: the force never exceeds {floor:g} N")
    first = int((force >= MAIN * largest).argmax())
    highest = np.maximum.accumulate(force[first:])
    fallen = force[first:] < highest - np.maximum(PROMINENCE * highest, _NOISE_SWING * trace.noise)
    if not fallen.any():
        return _no_pulse("truncated: the record ends before the force falls from its peak")
    seen = first + int(fallen.argmax())
    peak = first + int(force[first:seen].argmax())
    if peak == 0:
        return _no_pulse("truncated: the record starts after the peak")
    return _fitted(trace, peak, seen, force[peak])


def pulses(
    trace: Trace,
    main: Pulse,
    until: float = math.inf,
    threshold: float = THRESHOLD,
    prominence: float = PROMINENCE,
) -> tuple[Pulse, ...]:
    """The main pulse and the separate ones after it that peak before `until` (s).

    Args:
        trace: the signal.
        main: its main pulse.
        until: end of the search, for example the return of the reflection.
        threshold: lowest peak that counts, as a fraction of the main one.
        prominence: see the rules of this module.

    Returns:
        Pulses in the order of time; empty without a main pulse. A peak whose fall the record cuts off is left
        out.

    Raises:
        Unsettled: where more of the signal may show another one before `until`.
    """
    if not main.found:
        return ()
    end = len(trace.force) if until == math.inf else 2 + int((until - trace.start) / trace.interval)
    trace.settled(end)
    found = [main, *_later(trace, main, end, prominence)]
    return tuple(p for p in found if p.force >= threshold * main.force and (p.time < until or p is main))


def highest(trace: Trace, main: Pulse, start: float, end: float) -> Pulse:
    """The highest peak between two times in s; absent where it is below `PROMINENCE` × the main one.

    Raises:
        Unsettled: where the signal goes on and ends before that.
    """
    trace.settled((end - trace.start) / trace.interval)
    first = max(0, int((start - trace.start) / trace.interval) + 1)
    window = trace.force[first : int((end - trace.start) / trace.interval) + 1]
    if len(window) < 3:
        return _no_pulse("truncated: the record ends before it")
    peak = int(window.argmax())
    height = float(window[peak])
    if peak == 0 or not height > drop_of(trace, main, PROMINENCE):
        return _no_pulse("absent: no peak stands out there")
    if first + peak >= len(trace.force) - 2:
        return _no_pulse("truncated: the record ends before the force falls from its peak")
    return _fitted(trace, first + peak, first + peak, height)


def _no_pulse(reason):
    return Pulse(math.nan, math.nan, reason=reason)


def _fitted(trace, peak, seen, height):
    first, last = top_of(trace, peak, height)
    trace.settled(last)
    # Noise makes humps of its own.
    place, force = maximum(trace.force, first, last, None if trace.noise > 0.0 else peak)
    return Pulse(trace.time(place), force, peak, seen, last - first + 1)


def _later(trace, main, end, prominence):
    """Separate peaks after the main one whose highest sample lies before sample `end`."""
    drop = drop_of(trace, main, prominence)
    for valley, peak, seen in turns(trace.force, main.seen, drop):
        if peak >= end:
            return
        if seen is None:
            trace.settled(len(trace.force))
            return
        yield _fitted(trace, peak, seen, trace.force[peak] - trace.force[valley])


def drop_of(trace: Trace, main: Pulse, prominence: float) -> float:
    """Fall in N that separates two peaks."""
    return max(prominence * main.force, _NOISE_SWING * trace.noise)


def turns(force: np.ndarray, start: int, drop: float) -> Iterator[tuple[int, int, int | None]]:
    """Peaks that the force rises to by more than `drop` and falls from by more than `drop`, from sample
    `start`.

    Yields samples: the valley before, the peak, the local extreme that shows the fall. None stands for the
    last where the signal ends before that.
    """
    step = np.diff(force[start:])
    up, down = step > 0.0, step < 0.0
    inner = start + 1 + np.flatnonzero((up[:-1] != up[1:]) | (down[:-1] != down[1:]))
    samples = [start, *inner.tolist(), len(force) - 1]
    values = force[samples].tolist()
    valley = peak = 0
    rising = False
    for k, value in enumerate(values):
        if rising:
            if value > values[peak]:
                peak = k
            elif value < values[peak] - drop:
                yield samples[valley], samples[peak], samples[k]
                rising, valley = False, k
        elif value < values[valley]:
            valley = k
        elif value > values[valley] + drop:
            rising, peak = True, k
    if rising:
        yield samples[valley], samples[peak], None
