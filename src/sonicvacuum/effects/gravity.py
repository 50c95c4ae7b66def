"""The chain is not inclined as the record says."""

from dataclasses import replace

import numpy as np

from sonicvacuum.effects.base import Effect, Parameter, Setup
from sonicvacuum.laboratory.specimen import GRAVITY


def recorded(setup: Setup):
    """Fraction that the record gives, 1 vertical, 0 horizontal; (lanes,) where chains differ."""
    fraction = setup.chain.gravity / GRAVITY
    return float(fraction[0]) if np.all(fraction == fraction[0]) else fraction


def change(setup: Setup, fraction) -> Setup:
    """Set the gravity along the chain."""
    weight = np.where(
        np.equal(fraction, recorded(setup)), setup.chain.gravity, np.multiply(GRAVITY, fraction)
    )
    return replace(setup, chain=replace(setup.chain, gravity=weight))


EFFECT = Effect(
    id="gravity",
    title="Gravity along the chain",
    missing="the record says horizontal and the chain is not, or the reverse",
    equation=f"g -> {GRAVITY:g} m/s^2 x fraction along the chain, on beads and striker; the chain starts in "
    "equilibrium",
    energy="potential energy m g u towards the wall of every body",
    reference="Daraio & Nesterenko, Phys. Rev. E 73, 026612 (2006), Eq. (7)",
    parameters=(
        Parameter(
            "fraction",
            "1",
            recorded,
            0.0,
            1.0,
            "uniform",
            1.0,
            "cosine of the inclination to the vertical",
            0.0,
            # A finite difference at the upright chain may step a little beyond it.
            1.1,
            bends=True,
            linear=True,
        ),
    ),
    signature="weak pulses speed up towards the bottom and are followed by ripples",
    when_to_use="soft or heavy beads, weak strikers, long chains",
    when_not="a preload that is the same everywhere: static-preload",
    dissipative=False,
    change=change,
    depends_on_orientation=True,
)
