"""Single numbers that a simulation shows, lane by lane, found by the functions of `observe`."""

import numpy as np

from sonicvacuum.forward.amplitude import speeds_at_amplitudes
from sonicvacuum.forward.motion import Seen, readings
from sonicvacuum.gauges import Gauge
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.observe.contacts import contact_duration, restitution
from sonicvacuum.observe.quantities import measure_run
from sonicvacuum.observe.run import Geometry, Run
from sonicvacuum.observe.trace import Measured

# What needs further strikes, of all lanes side by side.
SOLITARY = "speed_at_amplitude"


def virtual(gauges: tuple[Gauge, ...], beads: int) -> tuple[Gauge, ...]:
    """Gauges that only the simulation has, so that it is known when the reflection returns."""
    if beads == 0:
        return ()
    kinds = {g.kind for g in gauges}
    middle = Gauge(id="(middle)", kind="embedded", bead=max(1, beads // 2))
    end = Gauge(id="(end)", kind="wall", bead=None)
    return ((middle,) if "embedded" not in kinds else ()) + ((end,) if "wall" not in kinds else ())


def passages(
    seen: Seen,
    lanes,
    signals: np.ndarray,
    gauges: tuple[Gauge, ...],
    diameters: Bodies | float,
    goes_on: bool = False,
    through: bool = False,
) -> list[Run]:
    """What `observe` measures on: the readings of each lane, those of the virtual gauges added.

    Args:
        seen: the simulation; what `virtual` needs must have been recorded.
        lanes: slice of its lanes.
        signals: (L, S, T) readings of those lanes.
        gauges: where the S gauges sit.
        diameters: of the beads in m.
        goes_on: whether this is the beginning of a longer simulation.
        through: see `Run`; so do records, which tell for how long the main pulse exceeds a level.
    """
    from sonicvacuum.forward.together import runs_of  # and with it compiled code, as in `motion.see`

    beads, history = seen.setup.chain.beads, seen.history
    extra = virtual(gauges, beads)
    geometry = Geometry(beads, diameters, (*gauges, *extra))
    if extra:
        signals = np.concatenate([signals, readings(extra, history.take(lanes), beads)], axis=1)
    return runs_of(signals, history.time, geometry, goes_on, through)


def measured(
    observable, seen: Seen, lane: int, passage: Run, diameters: Bodies | float, refine: float = 1.0
) -> Measured:
    """One observable (with `quantity` and `options`) of one lane, in SI; NaN with a reason if there is none.

    Args:
        observable: what is asked for.
        seen: the simulation, the striker's contact recorded where the observable is of it.
        lane: of the simulation.
        passage: of that lane; not used for what is the striker's or the solitary wave's.
        diameters: of the beads in m.
        refine: divides the step of further simulations.
    """
    chain, history, options = seen.setup.chain, seen.history, observable.options
    if observable.quantity == "contact_duration":
        return contact_duration(history.time, history.of(0)[:, lane])
    if observable.quantity == "restitution":
        striker = (float(n[lane]) for n in (chain.striker_mass, chain.speed, chain.gravity))
        return restitution(history.time, history.of(0)[:, lane], *striker)
    if observable.quantity == SOLITARY:
        return of_amplitudes([observable], seen, np.array([lane]), diameters, refine)[0][0]
    return measure_run(observable.quantity, passage, **options)


def all_measured(
    observables, seen: Seen, lane: int, passage: Run, diameters: Bodies | float, refine: float = 1.0
) -> tuple[Measured, ...]:
    """Several of one lane, see `measured`; speeds of waves of all amplitudes side by side."""
    waves = [one for one in observables if one.quantity == SOLITARY]
    speeds = iter(of_amplitudes(waves, seen, np.array([lane]), diameters, refine))
    return tuple(
        next(speeds)[0] if one.quantity == SOLITARY else measured(one, seen, lane, passage, diameters, refine)
        for one in observables
    )


def of_amplitudes(
    observables, seen: Seen, lanes: np.ndarray, diameters: Bodies | float, refine: float = 1.0
) -> list[list[Measured]]:
    """Speeds of waves of n amplitudes in the chains of some lanes, whatever struck them: for each of n
    observables, of each lane. What one gauge reads is found side by side.
    """
    gauges: dict[str, list[int]] = {}
    for k, one in enumerate(observables):
        gauges.setdefault(one.options["sensor"], []).append(k)
    found: list[list[Measured]] = [[]] * len(observables)
    chain = seen.setup.chain.take(lanes)
    for name, places in gauges.items():
        gauge = next(g for g in seen.setup.sensors if g.id == name).take(lanes)
        amplitudes = [observables[k].options["amplitude"] for k in places]
        for k, one in zip(
            places, speeds_at_amplitudes(chain, diameters, gauge, amplitudes, refine), strict=True
        ):
            found[k] = one
    return found
