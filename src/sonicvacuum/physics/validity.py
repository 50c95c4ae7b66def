"""Where a simulation leaves what its physics holds for: one function for each condition, one sentence each.

A warning names the number and what it is held against, so that a result carries its own doubts. What has no
meaning at all (beads pressed into each other by their own radius, forces that are no numbers) is refused.
"""

from collections.abc import Mapping

import numpy as np

from sonicvacuum.physics import layer_law
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
# Fully plastic contacts bear 3 yield strengths in the mean, which is 4.5 at the centre of Hertz's pressure
# (Johnson, Sec. 6.3). Twice that: yield strengths in tables are of annealed bars, and beads are harder.
YIELD = 2.0 * 4.5
# A law that was fitted to data is warned of from so many times their largest compression and rate on.
FURTHER = 1.2
# Contact radius over thickness from which a coating is stiffer than a half-space by a third (docs/layer.md).
NARROW = 0.3
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
    found = [overlap(chain, history, depth), layer(chain, history, depth)]
    found += [
        coarse_step(chain, history, force, depth),
        energy(chain, history),
        pressure(chain, history, force, depth, yields or {}),
    ]
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


def _named(contact: int, chain: Chain) -> str:
    """A contact in words: by its number and by what touches there."""
    one = f"contact {contact}"
    if not chain.beads:
        return "the contact of ball and wall"
    if contact == 0:
        return f"{one} (striker and bead 1)"
    if contact == chain.beads:
        return f"{one} (bead {contact} and wall)"
    return f"{one} (beads {contact} and {contact + 1})"


def overlap(chain: Chain, history: History, depth: np.ndarray) -> str:
    """Beads pressed into each other beyond what contact laws hold for.

    Args:
        chain, history: see `warnings`.
        depth: (contacts, lanes) largest compression in m.

    Raises:
        MeaninglessError: from one effective radius on, where no contact law says anything.
    """
    share = depth / _radii(chain, history)
    contact, lane = np.unravel_index(np.argmax(share), share.shape)
    worst = share[contact, lane]
    if not worst > OVERLAP:
        return ""
    named, um = _named(history.contacts[contact], chain), depth[contact, lane] / _MICRO
    place = f"{named} is pressed by {um:.3g} um, "
    if worst >= 1.0:
        raise MeaninglessError(
            f"{place}{worst:.3g} times its effective radius: no contact law holds there; check modulus, mass "
            "and speed"
        )
    return f"{place}{worst:.2g} of its effective radius: contact laws hold for less than {OVERLAP:g}"


def layer(chain: Chain, history: History, depth: np.ndarray) -> str:
    """Coatings pressed through, or felt through: a contact that is not narrow beside its coating feels the
    core; arguments as in `overlap`.
    """
    coats = _sides(chain, history, [body.coating for body in chain.solids])
    there = np.where(np.isfinite(coats), coats, 0.0).sum(axis=0)
    worst = depth.max(axis=1)
    through = (there > 0.0) & (worst > there)
    if through.any():
        k = int(np.argmax(np.where(through, worst - there, -np.inf)))
        return (
            f"{_named(history.contacts[k], chain)} is pressed by {worst[k] / _MICRO:.3g} um, more than its "
            f"coatings of {there[k] / _MICRO:.3g} um together are thick: what lies under them bears the load"
        )
    if any(action.term.name == layer_law.NAME for action in chain.actions):
        return ""
    thin = coats.min(axis=0)
    wide = np.sqrt(_radii(chain, history) * depth).max(axis=1) / thin
    k = int(np.argmax(wide))
    if not wide[k] > NARROW:
        return ""
    return (
        f"{_named(history.contacts[k], chain)} reaches a radius of {wide[k]:.2g} times the thickness of its "
        f"coating ({thin[k] / _MICRO:.3g} um) and is taken for one of solid beads of the coating's material: "
        "on its core the coating is stiffer (coating-thickness)"
    )


def _sides(chain, history, values):
    """(2, contacts) values of the two bodies at each contact, of one for each of `chain.solids`."""
    touching = chain.touching(max(history.contacts) + 1)[:, list(history.contacts)]
    return np.array(values, dtype=float)[touching]


def _radii(chain, history):
    """(contacts, lanes) effective radii in m."""
    return chain.reduced_radii(max(history.contacts) + 1)[list(history.contacts)]


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
    """Contacts that would yield: the pressure at the centre against the softer body's yield strength."""
    strengths = [yields.get(body.surface.name) or np.inf for body in chain.solids]
    if np.isinf(strengths).all() or any(a.term.slot == "path" for a in chain.actions):
        return ""
    seen = [touched(chain, contact, depth[k][None]) for k, contact in enumerate(history.contacts)]
    radius, steeper = (np.concatenate(part) for part in zip(*seen, strict=True))
    with np.errstate(invalid="ignore", divide="ignore"):
        centre = np.where(depth > 0.0, steeper * force / (np.pi * radius**2), 0.0)
    softer = _sides(chain, history, strengths).min(axis=0)
    share = np.nanmax(centre, axis=1) / softer
    k = int(np.argmax(share))
    if not share[k] > YIELD:
        return ""
    return (
        f"the pressure of {_named(history.contacts[k], chain)} reaches {np.nanmax(centre[k]) / 1e9:.3g} GPa, "
        f"{share[k]:.3g} times the yield strength: contacts would yield, which elastic laws leave out"
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
