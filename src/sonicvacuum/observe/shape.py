"""The shape of a pulse: when it rises and falls, how long it lasts, how it splits, how it leans.

Levels are fractions of the pulse's own peak. Where a level is not passed (truncated), or not before another
separate pulse (merged), or is too close to the noise, the value is NaN with that reason. Where pulses are
followed `through` others, none is merged: a pulse lasts until the force has fallen to the level, and does not
cease to last when a shoulder of its own grows into a pulse. With noise, the force passes a level to and fro;
the crossings are then balanced so that a duration is the time spent above the level.
"""

import math

import numpy as np

from sonicvacuum.observe.pulse import PROMINENCE, THRESHOLD, Pulse, drop_of, pulses, turns
from sonicvacuum.observe.trace import Measured, Trace, crossing, maximum, missing

_NOISE_LEVEL = 3.0
_NOISE_DIP = 4.0


def onset(trace: Trace, pulse: Pulse, level: float, through: bool = False) -> Measured:
    """Time in s at which the force rises through `level` × peak on its way to the peak."""
    return _edge(trace, pulse, level, True, through)


def ending(trace: Trace, pulse: Pulse, level: float, through: bool = False) -> Measured:
    """Time in s at which the force falls through `level` × peak after the peak."""
    return _edge(trace, pulse, level, False, through)


def duration(trace: Trace, pulse: Pulse, level: float = 0.01) -> Measured:
    """Time in s for which a pulse exceeds `level` × its peak."""
    return lasting(onset(trace, pulse, level), ending(trace, pulse, level))


def lasting(rise: Measured, fall: Measured) -> Measured:
    """Time in s from a rise to a fall, or why one of them is not known."""
    if not (rise.known and fall.known):
        return fall if rise.known else rise
    return Measured(fall.value - rise.value)


def valley_depth(trace: Trace, main: Pulse, until: float = math.inf) -> Measured:
    """How far the force falls between the main pulse and the next: 1 − valley / lower peak, within 0 and 1.

    1: to rest or below, fully separate. 0: not at all, no second pulse before `until`, so no split.
    """
    if not main.found:
        return missing(main.reason)
    both = pulses(trace, main, until)[:2]
    if len(both) < 2:
        return Measured(0.0)
    lowest = _valley(trace, main, both[1])
    return Measured(min(max(1.0 - lowest / min(p.force for p in both), 0.0), 1.0))


def asymmetry(trace: Trace, pulse: Pulse, level: float = 0.5) -> Measured:
    """(fall − rise)/(fall + rise), times between the peak and `level` × peak; above 0: falls more slowly."""
    rise, fall = onset(trace, pulse, level), ending(trace, pulse, level)
    if not (rise.known and fall.known):
        return fall if rise.known else rise
    return Measured((fall.value + rise.value - 2.0 * pulse.time) / (fall.value - rise.value))


def extra_pulse_fraction(
    trace: Trace, main: Pulse, until: float = math.inf, prominence: float = 0.005
) -> Measured:
    """Highest separate peak after the main pulse and before `until`, as a fraction of the main peak; 0 for
    none.

    Counts the small pulses that follow the main one in the coated chain (Daraio & Nesterenko 2006, Fig. 3a),
    hence a smaller prominence.
    """
    if not main.found:
        return missing(main.reason)
    later = pulses(trace, main, until, 0.0, prominence)[1:]
    return Measured(max((p.force for p in later), default=0.0) / main.force)


def _valley(trace, before, after):
    """Lowest force between two pulses, fitted like a peak where there is room for it."""
    force, half = trace.force, min(before.width, after.width) // 2
    lowest = before.peak + int(force[before.peak : after.peak].argmin())
    half = min(half, lowest - before.peak, after.peak - lowest)
    if half < 2:
        return float(force[lowest])
    return -maximum(-force, lowest - half, lowest + half)[1]


def _edge(trace, pulse, level, rising, through):
    """Crossing of `level` × peak next to a pulse, on one side of it."""
    if not 0.0 < level < 1.0:
        raise ValueError(f"level is {level}; it must lie between 0 and 1")
    if not pulse.found:
        return missing(pulse.reason)
    target = level * pulse.force
    if target < _NOISE_LEVEL * trace.noise:
        return missing(f"noise: {target:g} N is within {_NOISE_LEVEL:g} standard deviations of zero")
    outward = trace.force[pulse.peak :: -1] if rising else trace.force[pulse.peak :]
    if outward[0] < target:
        return missing(f"unresolved: no sample reaches {level:g} of the peak")
    low = outward < target - min(_NOISE_DIP * trace.noise, 0.5 * target)
    if not rising:
        trace.settled(pulse.peak + int(low.argmax()) if low.any() else len(trace.force))
    if not low.any():
        return missing(f"truncated: the record {'starts' if rising else 'ends'} above {level:g} of the peak")
    outward = outward[: int(low.argmax()) + 1]
    # What only falls, as a simulated pulse does, has no other peak; that is soon seen.
    alone = through or bool((outward[1:] <= outward[:-1]).all())
    peaks = () if alone else turns(outward, 0, drop_of(trace, pulse, PROMINENCE))
    if any(outward[peak] >= THRESHOLD * pulse.force for _, peak, _ in peaks):
        return missing(f"merged: the force does not fall to {level:g} of the peak before another pulse")
    return Measured(trace.time(_balanced(trace.force, outward, pulse.peak, target, rising)))


def _balanced(force, outward, peak, target, rising):
    """Where the force passes the target (sample); with noise, which makes it pass to and fro, the balance of
    these.

    Outward, falls count with + and rises with −, so that the distance from the peak is the time above the
    target.
    """
    passed = np.flatnonzero(np.diff(outward < target))
    before = peak - passed - 1 if rising else peak + passed
    places = [crossing(force, int(sample), target) for sample in before]
    return sum(places[0::2]) - sum(places[1::2])
