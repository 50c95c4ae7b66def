"""Scales of a chain's impact: its force and contact time, how finely and for how long to look at it."""

import numpy as np

from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.contact import compression_at, contact_time
from sonicvacuum.physics.laws import HERTZ, elastic_at

# Time for the pulse to cross the chain, with room for softer contacts; and to come back.
CROSSINGS, COUNTING = 2.5, 5.0
# A solitary wave passes one bead in about this many contact times (m²/(K² v))^{1/5} of the impact.
_PASSAGE = 1.5
# Share of the impact's force that the weakest pulses still have that are looked at.
WEAK = 0.1
# A Hertz impact lasts 3.218 times (m²/(K² v))^{1/5} (Johnson, Contact Mechanics, 1985, Sec. 11.4), here
# without the third decimal: sampling intervals follow from it, and with them the last digits of verdicts.
_HERTZ = 3.21
# Speed of a striker by the peak force that it makes in a Hertz impact, and speed of a wave by its force, as
# powers (Nesterenko; Eq. (6) of Daraio & Nesterenko, PRE 73, 026612, 2006).
STRIKER_POWER, WAVE_POWER = 5.0 / 6.0, 1.0 / 6.0
# Roughly the share of the impact's force that a gauge inside a bead reads.
EMBEDDED_SHARE = 0.45
# Sampling interval of a simulation in contact times. The rebound of one ball follows from the sum of its
# force over samples, which is good to 1e-7 when so fine.
SAMPLING = 1.0 / 60.0
SAMPLING_BALL = 1.0 / 600.0


def impact_scales(chain: Chain) -> tuple[float, float]:
    """Force in N and contact time in s of the chain's impact, the largest and longest of lanes and contacts.

    Force: K (5 m v²/(4 K))^{3/5} of a Hertz impact, m the striker's mass, or v √(k m) where a static force
    makes the contacts stiff springs; time: 3.21 (m²/(K² v))^{1/5}
    (Johnson, Contact Mechanics, 1985, Sec. 11.4).
    """
    stiffness = chain.stiffness if chain.beads else chain.striker_stiffness
    softest = chain.softest if chain.beads else stiffness
    mass = chain.heaviest if chain.beads else chain.striker_mass
    energy = _largest(1.25 * chain.striker_mass * chain.speed**2)
    largest = map(_largest, (stiffness, chain.load, mass, chain.speed))
    return float(_impact_force(energy, *largest)), _HERTZ * _largest(contact_time(mass, softest, chain.speed))


def impact_forces(chain: Chain) -> np.ndarray:
    """(lanes,) force in N as in `impact_scales`, of each chain that has beads."""
    energy = 1.25 * chain.striker_mass * chain.speed**2
    return _impact_force(energy, chain.stiffness, chain.load, chain.heaviest, chain.speed)


def _impact_force(energy, stiffness, load, mass, speed):
    """The larger of the Hertz impact's force and of that of stiff springs, see `impact_scales`; `energy` is
    5 m v²/4 of the striker.
    """
    spring = 1.5 * stiffness ** (2.0 / 3.0) * load ** (1.0 / 3.0)
    return np.maximum(stiffness * (energy / stiffness) ** 0.6, speed * np.sqrt(spring * mass))


def sampling_of(chain: Chain) -> float:
    """Sampling interval in s that resolves the shortest pulse of a batch."""
    stiffness = chain.stiffness if chain.beads else chain.striker_stiffness
    mass = chain.lightest if chain.beads else chain.striker_mass
    fraction = SAMPLING if chain.beads else SAMPLING_BALL
    return fraction * _HERTZ * float(contact_time(mass, stiffness, chain.speed).min())


def passage_of(chain: Chain, crossings: float = COUNTING) -> float:
    """Time in s in which the slowest pulse crosses the chain so many times; COUNTING for one ball.

    A wall softer than the beads holds the pulse for its own contact time.
    """
    contact = impact_scales(chain)[1]
    if chain.beads == 0:
        return COUNTING * contact
    quicker = _quicker(chain)
    contact = quicker * contact
    heavy = max(1.0, float((chain.striker_mass / chain.heaviest).max()))
    wall = quicker * _HERTZ * _largest(contact_time(chain.heaviest, chain.wall_stiffness, chain.speed))
    crossing = crossings * (_PASSAGE / _HERTZ * chain.beads + 2.0 * heavy) * contact
    return crossing + crossings * max(0.0, wall - contact)


def _quicker(chain: Chain) -> float:
    """Contact time by the law in force over that of Hertz contacts, 1 at most, of the slowest contact.

    A coated bead is as soft as its coating only where it is touched lightly. The time goes as K^{−2/5}, K of
    the Hertz contact that bears as much at the compression of a WEAK share of the impact's force.
    """
    laws, bodies = chain.laws(), chain.beads + 1
    if not laws.in_slot("factor") or HERTZ not in laws.in_slot("elastic"):
        return 1.0
    force = WEAK * impact_scales(chain)[0]
    depth = compression_at(force, chain.stiffnesses(bodies)[1:])
    stiffer = elastic_at(laws, chain.coefficients(laws, bodies)[1:], depth) / force
    return min(1.0, float(stiffer.min()) ** -0.4)


def _largest(values) -> float:
    return float(values.max())
