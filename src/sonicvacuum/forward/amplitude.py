"""Speeds of waves of given amplitudes at a gauge, whatever struck the chain.

Strikers' speeds are sought at which the gauge reads these amplitudes, for all chains of a batch and all
amplitudes side by side. Strikes of one chain are points of one smooth curve, speed over amplitude: each tells
of all amplitudes near it, so that a table takes hardly more strikes than it has values.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sonicvacuum.effects import Setup
from sonicvacuum.forward.curve import Curve
from sonicvacuum.forward.motion import see
from sonicvacuum.gauges import Gauge, position
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.observe.quantities import measure_run
from sonicvacuum.observe.run import Geometry
from sonicvacuum.observe.trace import Measured, Unsettled, missing
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.lanes import LANES
from sonicvacuum.physics.scales import (
    EMBEDDED_SHARE,
    STRIKER_POWER,
    impact_forces,
    passage_of,
    sampling_of,
)

# So many times each chain is struck for an amplitude at most.
TRIES = 8
# One strike serves amplitudes that are no further from it than this (natural log); where these are dense,
# strikes so far apart tell of all of them, see `curve`.
SERVED, SPACED = 0.35, 1.0
# Strikes simulated together differ by this factor of speed at most, their contact times by a quarter: samples
# are as dense as the fastest asks for, and as many as the slowest does. Fewer than fill the stepper's lanes
# are not parted.
ALIKE = 3.0
# The speed is taken over this many beads on either side of the gauge, where the chain has them.
REACH = 2
# Beads before the wall in which the reflection lies on the pulse.
CLEAR = 2
# The wave has reached the wall, and has passed all gauges, after the last of so many crossings of the slowest
# chain; most waves have after the first.
CROSSINGS = 0.8, 1.15, 1.7


def speeds_at_amplitudes(
    chain: Chain, diameters: Bodies | float, sensor: Gauge, amplitudes: Sequence[float], refine: float = 1.0
) -> list[list[Measured]]:
    """Speeds in m/s of waves that peak at `amplitudes` (n,) in N at a gauge: for each of them, of each lane.

    Args:
        chain: with its effects; the strikers' speeds do not matter.
        diameters: of the beads in m.
        sensor: the gauge, with its electronics and gain.
        amplitudes: readings in N.
        refine: divides the step of the simulation.

    Returns:
        Peak-to-peak speeds between gauges 2 beads before and behind (near the wall: over the last 4 beads
        that are clear of the reflection), by the curve through strikes nearby; NaN with a reason where there
        is none.
    """
    pair = _pair(sensor, chain.beads)
    if pair is None:
        short = missing("short: the chain has too few beads for a speed at this gauge")
        return [[short] * chain.lanes for _ in amplitudes]
    targets = np.log(np.asarray(amplitudes, dtype=float))
    first = np.stack([np.log(_first_guess(chain, a)) for a in np.exp(_spread(targets))], axis=1)
    curves = [Curve() for _ in range(chain.lanes)]
    wanted = [(lane, strike) for lane in range(chain.lanes) for strike in first[lane].tolist()]
    for _ in range(TRIES):
        for lane, point in _struck(chain, diameters, sensor, pair, wanted, refine):
            curves[lane].add(*point)
        wanted = [(lane, s) for lane, curve in enumerate(curves) for s in _further(curve, targets)]
        if not wanted:
            break
    return [[_told(curve, target, sensor) for curve in curves] for target in targets.tolist()]


def _first_guess(chain, amplitude):
    """(lanes,) striker speeds at which a Hertz chain would read about that amplitude."""
    return chain.speed * (amplitude / (EMBEDDED_SHARE * impact_forces(chain))) ** STRIKER_POWER


def _spread(targets):
    """Logarithms of the amplitudes for which chains are struck at first: some of the (n,) wanted, or evenly
    among them where these are fewer.
    """
    own = targets[_apart(targets)]
    even = np.linspace(targets.min(), targets.max(), 1 + math.ceil(np.ptp(targets) / SPACED))
    return even if len(even) < len(own) else own


def _apart(targets):
    """Which of (n,) logarithms of amplitudes are struck, so that each is served by one of them."""
    chosen, order = [], np.argsort(targets).tolist()
    while order:
        low = targets[order[0]]
        serves = max(k for k in range(len(order)) if targets[order[k]] - low <= SERVED)
        chosen.append(order[serves])
        order = [k for k in order if targets[k] - targets[chosen[-1]] > SERVED]
    return chosen


def _further(curve, targets):
    """Logarithms of the speeds at which a chain is struck next, none where nothing more is to be learned."""
    left = np.array([t for t in targets.tolist() if not curve.tells(t)])
    if curve.empty or not len(left):
        return []
    return [curve.strike_for(left[k]) for k in _apart(left)]


def _told(curve, target, sensor) -> Measured:
    """One speed, or why there is none."""
    if curve.silent:
        return missing(f"absent: no pulse at {sensor.id} clear of the wall's reflection")
    if curve.empty:
        return missing("no passage")
    if not curve.tells(target):
        return missing("outside: no striker speed gives this amplitude")
    return Measured(math.exp(curve.speed(target)))


def _pair(sensor, beads):
    """The virtual gauges between which the speed is taken, clear of the wall's reflection."""
    place = math.ceil(beads - position(sensor, beads, 1.0))
    last = min(place + REACH, beads - CLEAR)
    first = max(1, min(place - REACH, last - 2 * REACH))
    if first >= last:
        return None
    return Gauge("(before)", "embedded", first), Gauge("(behind)", "embedded", last)


def _struck(chain, diameters, sensor, pair, wanted, refine):
    """For each strike, lane and logarithm of the striker's speed, that lane and logarithms of the striker's
    speed, the amplitude at the gauge and the speed across the pair.
    """
    lanes, strikes = np.array([w[0] for w in wanted]), np.array([w[1] for w in wanted])
    found = np.empty((2, len(wanted)))
    for here in _alike(strikes):
        struck = chain.take(lanes[here]).struck_at(np.exp(strikes[here]))
        found[:, here] = _shown_by(struck, diameters, sensor.take(lanes[here]), pair, refine)
    with np.errstate(divide="ignore", invalid="ignore"):
        heights, speeds = np.log(found)
    points = np.stack([strikes, heights, speeds], axis=1)
    return zip(lanes.tolist(), points.tolist(), strict=True)


def _alike(strikes):
    """Places of the strikes that are simulated together."""
    groups: list[list[int]] = []
    for k in np.argsort(strikes, kind="stable").tolist():
        if not groups or (len(groups[-1]) >= LANES and strikes[k] - strikes[groups[-1][0]] > math.log(ALIKE)):
            groups.append([])
        groups[-1].append(k)
    return groups


def _shown_by(lanes, diameters, sensor, pair, refine):
    """(2, lanes) amplitude at the gauge and speed across the pair that chains show; what a part of the time
    settles is not simulated for longer.
    """
    gauges = (replace(sensor, id="(gauge)"), *pair, Gauge("(end)", "wall", None))
    setup, geometry = Setup(lanes, gauges), Geometry(lanes.beads, diameters, gauges)
    interval, found, left = sampling_of(lanes), np.empty((2, lanes.lanes)), np.arange(lanes.lanes)
    for crossings in CROSSINGS:
        own = setup if len(left) == lanes.lanes else setup.take(left)
        seen = see(own, passage_of(lanes, crossings), interval, refine=refine, forgiving=True)
        found[:, left], unsettled = _shown(seen, geometry, crossings < CROSSINGS[-1])
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
