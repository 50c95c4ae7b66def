"""Deviations of stiffness or mass along the whole chain: the simplest shapes outside the catalogue.

They are screened like effects, and where a misfit is large fitted like them: an explanation out of the
catalogue that gains less than one such shape is not the simplest.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.search.directions import Direction, Family
from sonicvacuum.effects import Effect, Parameter
from sonicvacuum.physics.beyond import Defect

# Deviations along the chain, x from −1 at the striker to 1 at the wall, k counted from there.
PROFILES = {
    "linear": lambda x, k: x,
    "quadratic": lambda x, k: x**2 - 1.0 / 3.0,
    "alternating": lambda x, k: 1.0 - 2.0 * (k % 2),
}


def family() -> Family:
    """Slopes to all profiles: the logarithm of the ratio at one end of the chain."""
    kinds = [(what, name) for what in ("stiffness", "mass") for name in PROFILES]
    directions = tuple(Direction("profile", f"{what} {name}", two_sided=True) for what, name in kinds)

    def change(setup, index, strengths):
        beads, changed = setup.chain.beads, []
        for at in range(beads + 1):
            x = 2.0 * at / max(1, beads) - 1.0
            size = np.array([PROFILES[name](x, at) for _, name in kinds])[index]
            ratio = np.exp(np.clip(strengths * size, -1.0, 1.0))
            stiff = np.array([what == "stiffness" for what, _ in kinds])[index]
            changed.append(Defect("stiffness", at, np.where(stiff, ratio, 1.0)))
            if at:
                changed.append(Defect("mass", at, np.where(stiff, 1.0, ratio)))
        return with_defects(setup, changed)

    return Family(directions, change, 0.5)


def with_defects(setup, defects):
    """A setup with these deviations as well."""
    chain = setup.chain
    return replace(setup, chain=replace(chain, defects=(*chain.defects, *defects)))


def effects() -> tuple[Effect, ...]:
    """The profiles as effects, so that they can be fitted like those of the catalogue."""
    return tuple(_profile(what, name) for what in ("stiffness", "mass") for name in PROFILES)


def _profile(what, name) -> Effect:
    ratio = Parameter(
        "ratio", "1", 1.0, 0.3, 3.0, "log-uniform", 0.1, f"{what} at one end over its mean", 1e-3
    )

    def change(setup, ratio):
        beads = setup.chain.beads
        at = range(what == "mass", beads + 1)
        sizes = [PROFILES[name](2.0 * k / max(1, beads) - 1.0, k) for k in at]
        ratio = np.asarray(ratio)
        return with_defects(setup, [Defect(what, k, ratio**size) for k, size in zip(at, sizes, strict=True)])

    return Effect(
        id=f"{what} {name}",
        title=f"{what.capitalize()} {name}",
        missing=f"a {what} {name} profile along the chain",
        equation="k_j -> r^p(x_j) k_j" if what == "stiffness" else "m_j -> r^p(x_j) m_j",
        energy="",
        reference="a shape outside the catalogue",
        parameters=(ratio,),
        places=None,
        choices=None,
        signature="",
        when_to_use="",
        when_not="",
        dissipative=False,
        change=change,
    )
