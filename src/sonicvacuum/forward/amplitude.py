"""The speed of a wave of given amplitude at a gauge, whatever struck the chain: striker speeds are swept."""

import math
from dataclasses import replace

import numpy as np

from sonicvacuum.gauges import Gauge, needed, position, reading
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.observe.quantities import measure
from sonicvacuum.observe.run import Geometry
from sonicvacuum.observe.sweep import speed_at_amplitude as interpolated
from sonicvacuum.observe.trace import Measured, missing
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.run import simulate
from sonicvacuum.physics.scales import CROSSINGS, impact_scales, passage_of, sampling_of

# Striker speeds tried, over the one expected to give the amplitude.
LADDER = np.geomspace(0.5, 2.0, 8)
TRIES = 6
# The speed is taken over this many beads on either side of the gauge, where the chain has them.
REACH = 2
# Beads before the wall in which the reflection lies on the pulse.
CLEAR = 2
# Amplitudes grow about as striker speed to the power 6/5.
_POWER = 5.0 / 6.0
# Roughly the share of the striker's force on a rigid surface that a gauge inside a bead reads.
_SHARE = 0.45


def speed_at_amplitude(
    chain: Chain, diameters: Bodies | float, sensor: Gauge, amplitude: float, refine: float = 1.0
) -> Measured:
    """Speed in m/s of the wave that peaks at `amplitude` N at a gauge.

    Args:
        chain: one lane, with its effects; its striker's speed is the first guess.
        diameters: of the beads in m.
        sensor: the gauge, with its electronics and gain.
        amplitude: reading in N.
        refine: divides the step of the simulation.

    Returns:
        Peak-to-peak speed between gauges 2 beads before and behind (near the wall: over the last 4 beads that
        are clear of the reflection), interpolated between striker speeds; NaN with a reason if there is none.
    """
    pair = _pair(sensor, chain.beads)
    if pair is None:
        return missing("short: the chain has too few beads for a speed at this gauge")
    centre = float(chain.speed[0]) * (amplitude / (_SHARE * impact_scales(chain)[0])) ** _POWER
    found = missing("outside: no striker speed gives this amplitude")
    for _ in range(TRIES):
        amplitudes, speeds = _sweep(chain, diameters, sensor, pair, centre * LADDER, refine)
        known = amplitudes[np.isfinite(amplitudes)]
        if not len(known):
            return missing(f"absent: no pulse at {sensor.id}")
        found = interpolated(amplitude, amplitudes, speeds)
        if found.known:
            return found
        centre *= (amplitude / np.exp(np.log(known).mean())) ** _POWER
    return found


def _pair(sensor, beads):
    """The virtual gauges between which the speed is taken, clear of the wall's reflection."""
    place = math.ceil(beads - position(sensor, beads, 1.0))
    last = min(place + REACH, beads - CLEAR)
    first = max(1, min(place - REACH, last - 2 * REACH))
    if first >= last:
        return None
    return Gauge("(before)", "embedded", first), Gauge("(behind)", "embedded", last)


def _sweep(chain, diameters, sensor, pair, speeds, refine):
    """(n,) amplitudes at the gauge and speeds across the pair, for n striker speeds."""
    lanes = replace(chain.take(np.zeros(len(speeds), dtype=int)), speed=speeds)
    gauges = (replace(sensor, id="(gauge)"), *pair, Gauge("(end)", "wall", None))
    contacts, bodies = needed(gauges, chain.beads)
    interval = sampling_of(lanes)
    history = simulate(lanes, contacts, passage_of(lanes, CROSSINGS), interval, bodies=bodies, refine=refine)
    readings = {s.id: reading(s, history, chain.beads) for s in gauges}
    geometry = Geometry(chain.beads, diameters, gauges)
    heights = measure("amplitude", readings, history.time, geometry, sensor="(gauge)")
    fast = measure("speed", readings, history.time, geometry, from_=pair[0].id, to=pair[1].id)
    return np.array([m.value for m in heights]), np.array([m.value for m in fast])
