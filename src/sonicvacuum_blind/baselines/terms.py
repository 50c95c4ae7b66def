"""Candidate terms of a bead's equation of motion, from the full motion: the catalogue's force laws at first
order in their strengths.

m u_i'' = F_{i−1} − F_i + body forces, with F = K δ^{3/2} + Σ c_k f_k(δ, δ'); the coefficients c_k are the
same in all contacts and beads. Effects of gauges, of the striker, of the wall, of one bead or of the state at
rest have no term here.
"""

import numpy as np
from scipy import signal

from sonicvacuum.laboratory.specimen import GRAVITY
from sonicvacuum_blind.baselines.motion import Motion
from sonicvacuum_blind.plan import REFERENCE

SLOW = 1e-3  # m/s; dry friction grows in proportion to velocity below it
POWER = 1.75  # of the relative velocity, the catalogue's middle
# Relaxation times over the contact time.
RELAXATION = (0.5, 3.0, 20.0)
HERTZ = "hertz"
# Term → effect that it stands for; the Hertz term's deviation from 1 is the modulus.
EFFECTS = {
    HERTZ: "dynamic-modulus",
    "exponent": "contact-exponent",
    "layer": "coating-thickness",
    "plastic": "plastic-contact",
    "dashpot": "linear-dashpot",
    "viscoelastic": "kuwabara-kono",
    "tsuji": "tsuji",
    "hunt": "hunt-crossley",
    "power": "velocity-power",
    **{f"relaxing {k}": "relaxing-contact" for k in range(len(RELAXATION))},
    "drag": "viscous-drag",
    "friction": "guide-friction",
    "weight": "gravity",
}
EXPRESSIBLE = tuple(dict.fromkeys(EFFECTS.values()))


def contact_terms(delta: np.ndarray, rate: np.ndarray, motion: Motion) -> np.ndarray:
    """(samples, contacts, terms) forces in N, up to scale, of compressions in m and their rates in m/s."""
    plan = motion.plan
    stiffness = plan.stiffness()
    closed = delta > 0.0
    d, v = np.maximum(delta, 0.0), np.where(closed, rate, 0.0)
    root = np.sqrt(d)
    force = stiffness * d * root
    largest = np.maximum.accumulate(d, axis=0)
    terms = [
        force,
        force * np.log(np.maximum(d, 1e-3 * REFERENCE) / REFERENCE),
        force * root,
        stiffness * root * (d - largest),
        v,
        root * v,
        np.sqrt(root) * v,
        force * v,
        np.sign(v) * np.abs(v) ** POWER,
        *(np.where(closed, _relaxing(force, motion, k * plan.contact_time), 0.0) for k in RELAXATION),
    ]
    return np.stack(terms, axis=-1)


def _relaxing(force, motion, tau):
    """q with q' + q/τ = F', by a first-order hold."""
    step = motion.time[1] - motion.time[0]
    numerator, denominator, _ = signal.cont2discrete(([tau, 0.0], [tau, 1.0]), step, method="foh")
    return signal.lfilter(numerator.ravel(), denominator, force - force[0], axis=0)


def bead_terms(delta, rate, velocity, motion: Motion) -> np.ndarray:
    """(samples, beads, terms) accelerations in m/s² of the beads whose two contacts are both with beads.

    Args:
        delta, rate: (samples, contacts) of all contacts, as measured.
        velocity: (samples, bodies) as measured, the striker first.
        motion: the run, for its times and nominal plan.
    """
    forces = contact_terms(delta, rate, motion)
    inner = slice(2, motion.plan.beads)
    contacts = (forces[:, 1:-2] - forces[:, 2:-1]) / motion.plan.bead_mass
    v = velocity[:, inner]
    bodies = np.stack([-v, -np.clip(v / SLOW, -1.0, 1.0), np.full_like(v, GRAVITY)], axis=-1)
    return np.concatenate([contacts, bodies], axis=-1)
