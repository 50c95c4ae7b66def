"""One contact is open at rest."""

import numpy as np

from sonicvacuum.effects.base import MICRO, Effect, Parameter, Setup, beads_of, depart_at


def change(setup: Setup, gap_um, contact) -> Setup:
    """Open one contact; it bears no static force."""
    return depart_at(setup, "gap", contact, np.multiply(gap_um, MICRO), 0.0)


EFFECT = Effect(
    id="contact-gap",
    title="Gap in the chain",
    missing="one contact is open at rest",
    equation="delta_j -> delta_j - gap at contact j, which bears no load at rest",
    energy="none of its own",
    reference="Lydon, Jayaprakash, Ngo, Starosvetsky, Vakakis & Daraio, Phys. Rev. E 88, 012206 (2013)",
    parameters=(
        Parameter(
            "gap_um", "um", 0.0, 1e-2, 100.0, "log-uniform", 1.0, "opening at rest", 0.0, least_strength=1e-2
        ),
    ),
    places="contact",
    choices=beads_of,
    signature="everything behind the gap comes later by gap over bead speed; a reflected pulse in "
    "front of it, the main pulse split or sharpened behind it",
    when_to_use="horizontal chains without preload; a delay at one place that depends on the speed",
    when_not="the same delay at all speeds; chains under preload",
    dissipative=False,
    unloaded=True,
    change=change,
)
