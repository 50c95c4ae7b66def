"""One bead, say one with a gauge in it, is heavier or lighter than the others."""

from sonicvacuum.effects.base import Effect, Parameter, Setup, beads_of, depart_at


def change(setup: Setup, mass_ratio, bead) -> Setup:
    """Scale the mass of one bead."""
    return depart_at(setup, "mass", bead, mass_ratio, 1.0)


EFFECT = Effect(
    id="mass-defect",
    title="Mass defect",
    missing="one bead, often that of a gauge, is heavier or lighter than the others",
    equation="m_j -> r m_j",
    energy="(r - 1) m u'^2/2 of kinetic energy",
    reference="Sen, Hong, Bang, Avalos & Doney, Phys. Rep. 462, 21 (2008), Sec. 4",
    parameters=(
        Parameter(
            "mass_ratio",
            "1",
            1.0,
            0.2,
            5.0,
            "log-uniform",
            0.1,
            "mass over that of the others",
            1e-3,
            scatters=True,
        ),
    ),
    places="bead",
    choices=beads_of,
    signature="a small reflected pulse from that bead (heavier) or a train behind it (lighter); a "
    "lower transmitted peak",
    when_to_use="beads cut and glued around a gauge; an extra pulse at one place",
    when_not="a lower reading without reflection: sensor-gain",
    dissipative=False,
    change=change,
)
