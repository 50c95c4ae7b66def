"""Where a simulation leaves what its physics holds for: one function for each condition, one sentence each.

A warning names the number and what it is held against, so that a result carries its own doubts. What has no
meaning at all (beads pressed into each other by their own radius, forces that are no numbers) is refused.
"""

from collections.abc import Mapping

import numpy as np

from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.history import History
from sonicvacuum.physics.touching import touched

# Hertz: the contact radius √(R* δ) is small against R*. At δ = R*/10 it is a third of it, and exact solutions
# for spheres differ by several per cent (Johnson, Contact Mechanics, 1985, Sec. 4.2 and 5.5).
OVERLAP = 0.1
# A vibration of angular frequency ω is stable for steps below about 2/ω, and followed well below half of it.
STEP = 1.0
# Energy made of nothing, in units of the impact's; the steps chosen keep it to 2e-6.
ENERGY = 1e-3
# Fully plastic contacts bear 4.5 yield strengths at their centre (Johnson, Sec. 6.3: 3 in the mean).
YIELD = 2.0 * 4.5
# A law that was fitted to data is warned of from so many times their largest compression and rate on.
FURTHER = 1.2
# A gauge that reads less than this part of the largest force has seen nothing yet.
SILENT = 1e-3
_MICRO = 1e-6


class MeaninglessError(ValueError):
    """A result that says nothing about any chain; the message names the number."""


def warnings(chain: Chain, history: History, yields: Mapping[str, float | None] | None = None) -> list[str]:
    """All that is doubtful about the motion of some chains.

    Args:
        chain: as integrated.
        history: its contact forces, with or without balance.
        yields: material → yield strength in Pa, where known.

    Raises:
        MeaninglessError: for overlaps of a bead's radius or more, or forces that are no numbers.
    """
    check_forces(history)
    if not history.contacts:
        return []
    force = _largest(chain, history)
    depth = np.stack([chain.depth_at(c, force[k][None])[0] for k, c in enumerate(history.contacts)])
    found = [overlap(chain, history, depth), layer(chain, depth), coarse_step(chain, history, force, depth)]
    found += [energy(chain, history), pressure(chain, history, force, depth, yields or {})]
    found += [extrapolation(chain, depth)]
    return [told for told in found if told]


def _largest(chain, history):
    """(contacts, lanes) largest force in N that each contact bears, the static one included."""
    static = chain.static_forces(max(history.contacts, default=0) + 1)[list(history.contacts)]
    return np.maximum(history.force.max(axis=0) + static, 0.0)


def check_forces(history: History) -> None:
    """MeaninglessError for forces that are no numbers."""
    bad = ~np.isfinite(history.force).all(axis=0)
    if bad.any():
        contact, lane = np.argwhere(bad)[0]
        raise MeaninglessError(
            f"the force of contact {history.contacts[contact]} in run {lane} is no finite number; check the "
            "parameters of the effects"
        )


def overlap(chain: Chain, history: History, depth: np.ndarray) -> str:
    """Beads pressed into each other beyond what contact laws hold for.

    Args:
        chain, history: see `warnings`.
        depth: (contacts, lanes) largest compression in m.
    """
    radii = chain.reduced_radii(max(history.contacts) + 1)[list(history.contacts)]
    share = depth / radii
    contact, lane = np.unravel_index(np.argmax(share), share.shape)
    worst = share[contact, lane]
    if not worst > OVERLAP:
        return ""
    place = f"contact {history.contacts[contact]} is pressed by {depth[contact, lane] / _MICRO:.3g} um, "
    if worst >= 1.0:
        raise MeaninglessError(
            f"{place}{worst:.3g} times its effective radius: no contact law holds there; check modulus, mass "
            "and speed"
        )
    return f"{place}{worst:.2g} of its effective radius: contact laws hold for less than {OVERLAP:g}"


def layer(chain: Chain, depth: np.ndarray) -> str:
    """Coatings pressed through: two of them share the compression of a contact, (contacts, lanes) in m."""
    thinnest = min((float(np.min(body.coating)) for body in chain.solids), default=np.inf)
    worst = float(depth.max())
    if not worst > 2.0 * thinnest:
        return ""
    return (
        f"a contact is pressed by {worst / _MICRO:.3g} um, more than its coatings of {thinnest / _MICRO:.3g} "
        "um each are thick: what lies under them bears the load"
    )


def extrapolation(chain: Chain, depth: np.ndarray) -> str:
    """A law fitted to data (parameters `deepest` in m, `fastest` in m/s) where contacts go farther than these
    did, (contacts, lanes) in m.

    Compressions are those of the loading curve: a force that has damping in it passes for a deeper contact.
    """
    worst, speed = float(depth.max()), float(chain.speed.max())
    for action in chain.actions:
        known = [float(np.min(action.parameters.get(name, np.inf))) for name in ("deepest", "fastest")]
        if worst > FURTHER * known[0] or speed > FURTHER * known[1]:
            return (
                f"contacts are pressed by {worst / _MICRO:.3g} um at impacts of {speed:.3g} m/s; the law "
                f"{action.term.name} was fitted to data of up to {known[0] / _MICRO:.3g} um and "
                f"{known[1]:.3g} m/s, and stays what it is there beyond"
            )
    return ""


def coarse_step(chain: Chain, history: History, force: np.ndarray, depth: np.ndarray) -> str:
    """A step too long for the stiffest contact: twice √(k/m) of the lightest bead, k = 3 F/(2 δ) of Hertz."""
    with np.errstate(invalid="ignore", divide="ignore"):
        stiffness = np.where(depth > 0.0, 1.5 * force / depth, 0.0).max(axis=0)
    turns = history.step * 2.0 * np.sqrt(stiffness / np.minimum(chain.lightest, chain.striker_mass))
    worst = float(np.max(turns))
    if not worst > STEP:
        return ""
    return (
        f"the step of {history.step[np.argmax(turns)]:.3g} s is {worst:.3g} radians of the fastest "
        f"vibration: motion is followed well below {STEP:g} and unstable above 2"
    )


def energy(chain: Chain, history: History) -> str:
    """Energy that nothing gave, or, where nothing takes it, energy that went."""
    if not len(history.energy):
        return ""
    impact = 0.5 * chain.striker_mass * chain.speed**2
    change = (history.energy - history.energy[0]) / impact
    worst = float(change.max())
    if chain.laws().splits:
        worst = float(np.abs(change).max())
    if not worst > ENERGY:
        return ""
    return f"the energy is off by {worst:.2g} of the impact's, more than {ENERGY:g}: take a smaller step"


def pressure(chain: Chain, history: History, force: np.ndarray, depth: np.ndarray, yields: Mapping) -> str:
    """Contacts that would yield: the pressure at their centre against the beads' yield strength."""
    known = [s for s in (yields.get(b.surface.name) for b in chain.solids) if s]
    if not known or any(a.term.slot == "path" for a in chain.actions):
        return ""
    seen = [touched(chain, contact, depth[k][None]) for k, contact in enumerate(history.contacts)]
    radius, steeper = (np.concatenate(part) for part in zip(*seen, strict=True))
    with np.errstate(invalid="ignore", divide="ignore"):
        largest = np.nanmax(np.where(depth > 0.0, steeper * force / (np.pi * radius**2), 0.0))
    if not largest > YIELD * min(known):
        return ""
    return (
        f"the contact pressure reaches {largest / 1e9:.3g} GPa, {largest / min(known):.3g} times the yield "
        "strength: contacts would yield, which elastic laws leave out"
    )


def unseen(name: str, readings: np.ndarray, interval: float) -> str:
    """A record that ends before the pulse has come to a gauge, or while it still rises.

    Args:
        name: of the gauge.
        readings: (samples, lanes).
        interval: between samples, in s.
    """
    size = np.abs(readings)
    last, end = size[-1], (len(readings) - 1) * interval / _MICRO
    if np.any(size.max(axis=0) == 0.0) or np.any(last >= size.max(axis=0)):
        return f"the record ends after {end:.4g} us, before the pulse has passed {name}: simulate longer"
    return ""
