"""The speed of a wave of given amplitude at a gauge, whatever struck the chain.

The striker's speed at which the gauge reads that amplitude is sought, for all chains of a batch side by side.
"""

import math
from dataclasses import replace

import numpy as np

from sonicvacuum.effects import Setup
from sonicvacuum.forward.motion import see
from sonicvacuum.gauges import Gauge, position
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.observe.quantities import measure_run
from sonicvacuum.observe.run import Geometry
from sonicvacuum.observe.trace import Measured, Unsettled, missing
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.scales import (
    EMBEDDED_SHARE,
    STRIKER_POWER,
    WAVE_POWER,
    impact_forces,
    passage_of,
    sampling_of,
)

# The search ends once all amplitudes are so near (natural log): what the slope between the last two strikes
# then errs by, a few hundredths, moves a speed by a few parts in 1e4 at most.
NEAR = 0.03
TRIES = 8
# Steps in the logarithm of the striker's speed go no further than this.
STRIDE = math.log(4.0)
# The speed is taken over this many beads on either side of the gauge, where the chain has them.
REACH = 2
# Beads before the wall in which the reflection lies on the pulse.
CLEAR = 2
# The wave has reached the wall, and has passed all gauges, after so many crossings of the slowest chain; most
# waves have after MOSTLY.
MOSTLY, CROSSED = 0.7, 1.7
# Within these the exponent that two strikes show is believed; strikes nearer than this show none.
_LEAST, _MOST, _APART = 0.4, 1.6, 1e-4


def speed_at_amplitude(
    chain: Chain, diameters: Bodies | float, sensor: Gauge, amplitude: float, refine: float = 1.0
) -> list[Measured]:
    """Speed in m/s of the wave that peaks at `amplitude` N at a gauge, one for each lane.

    Args:
        chain: with its effects; the strikers' speeds do not matter.
        diameters: of the beads in m.
        sensor: the gauge, with its electronics and gain.
        amplitude: reading in N.
        refine: divides the step of the simulation.

    Returns:
        Peak-to-peak speeds between gauges 2 beads before and behind (near the wall: over the last 4 beads
        that are clear of the reflection), a power law of the amplitude between the last two strikes; NaN with
        a reason where there is none.
    """
    pair = _pair(sensor, chain.beads)
    if pair is None:
        return [missing("short: the chain has too few beads for a speed at this gauge")] * chain.lanes
    target = math.log(amplitude)
    strike = last = first = np.log(_first_guess(chain, amplitude))
    before, mostly = None, passage_of(chain.struck_at(np.exp(first)), MOSTLY)
    for _ in range(TRIES):
        # A contact time goes as the speed to the power −1/5.
        begun = mostly * math.exp(0.2 * float((first - strike).max()))
        seen = np.log(_struck(chain, diameters, sensor, pair, np.exp(strike), begun, refine))
        off = seen[0] - target
        known = np.isfinite(off)
        if not known.any():
            return [missing(f"absent: no pulse at {sensor.id}")] * chain.lanes
        if before is not None and np.abs(off[known]).max() < NEAR:
            break
        power = _exponent(before, seen, strike, last) if before is not None else STRIKER_POWER
        before, last = seen, strike
        # Those without a pulse stay as they are.
        strike = strike - np.where(known, np.clip(power * off, -STRIDE, STRIDE), 0.0)
    return _between(before, seen, off, sensor)


def _first_guess(chain, amplitude):
    """(lanes,) striker speeds at which a Hertz chain would read about that amplitude."""
    return chain.speed * (amplitude / (EMBEDDED_SHARE * impact_forces(chain))) ** STRIKER_POWER


def _exponent(before, now, strike, last):
    """(lanes,) d log striker speed / d log amplitude between two strikes, the usual one for strikes alike."""
    with np.errstate(divide="ignore", invalid="ignore"):
        power = (strike - last) / (now[0] - before[0])
    return np.where(np.abs(now[0] - before[0]) > _APART, np.clip(power, _LEAST, _MOST), STRIKER_POWER)


def _between(before, now, off, sensor):
    """The speeds at the amplitude wanted, `off` (lanes,) away from the last strike's (natural log)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = (now[1] - before[1]) / (now[0] - before[0])
    slope = np.where(np.abs(now[0] - before[0]) > _APART, slope, WAVE_POWER)
    return [_told(x, o, sensor) for x, o in zip(now[1] - slope * off, off, strict=True)]


def _told(log_speed, off, sensor) -> Measured:
    """One speed, or why there is none."""
    if not math.isfinite(off):
        return missing(f"absent: no pulse at {sensor.id}")
    if abs(off) > NEAR:
        return missing("outside: no striker speed gives this amplitude")
    return Measured(float(np.exp(log_speed))) if math.isfinite(log_speed) else missing("no passage")


def _pair(sensor, beads):
    """The virtual gauges between which the speed is taken, clear of the wall's reflection."""
    place = math.ceil(beads - position(sensor, beads, 1.0))
    last = min(place + REACH, beads - CLEAR)
    first = max(1, min(place - REACH, last - 2 * REACH))
    if first >= last:
        return None
    return Gauge("(before)", "embedded", first), Gauge("(behind)", "embedded", last)


def _struck(chain, diameters, sensor, pair, speeds, begun, refine):
    """(2, lanes) amplitude at the gauge and speed across the pair, of chains struck at these speeds; what is
    settled in the first `begun` seconds is not simulated for longer.
    """
    lanes = chain.struck_at(speeds)
    gauges = (replace(sensor, id="(gauge)"), *pair, Gauge("(end)", "wall", None))
    setup, geometry = Setup(lanes, gauges), Geometry(chain.beads, diameters, gauges)
    interval, found, left = sampling_of(lanes), np.empty((2, chain.lanes)), np.arange(chain.lanes)
    for goes_on in (True, False):
        own = setup if len(left) == chain.lanes else setup.take(left)
        duration = begun if goes_on else passage_of(lanes, CROSSED)
        seen = see(own, duration, interval, refine=refine, forgiving=True)
        found[:, left], unsettled = _shown(seen, geometry, goes_on)
        left = left[unsettled]
        if not len(left):
            break
    return found


def _shown(seen, geometry, goes_on):
    """(2, lanes) amplitude and speed that a simulation shows; (lanes,) whether more of it may change them."""
    # And with them compiled code, as in `motion.see`.
    from sonicvacuum.forward.columns import Columns, filled
    from sonicvacuum.forward.together import runs_of

    runs = runs_of(seen.readings, seen.history.time, geometry, goes_on)
    columns, finite = Columns(runs), np.isfinite(seen.readings).all(axis=(1, 2))
    unsettled = np.zeros(len(runs), dtype=bool)

    def shown(quantity, **options):
        def closer(lane):
            try:
                return measure_run(quantity, runs[lane], **options).value if finite[lane] else math.nan
            except Unsettled:
                unsettled[lane] = True
                return math.nan

        return np.where(finite, filled(columns.of(quantity, options), np.arange(len(runs)), closer), math.nan)

    height = shown("amplitude", sensor="(gauge)")
    return np.stack([height, shown("speed", **{"from": "(before)", "to": "(behind)"})]), unsettled
