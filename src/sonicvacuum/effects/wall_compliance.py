"""The wall contact is softer or stiffer than its material."""

from sonicvacuum.effects.base import Effect, Parameter, Setup, depart_at


def change(setup: Setup, stiffness_ratio) -> Setup:
    """Scale the Hertz constant of the last contact."""
    return depart_at(setup, "stiffness", setup.chain.beads, stiffness_ratio, 1.0)


EFFECT = Effect(
    id="wall-compliance",
    title="Wall compliance",
    missing="the wall contact is softer or stiffer than its material",
    equation="K_wall -> r K_wall",
    energy="stores (2/5) r K_wall delta^{5/2} in the wall contact",
    reference="Job, Melo, Sokolow & Sen, Phys. Rev. Lett. 94, 178002 (2005)",
    parameters=(
        Parameter(
            "stiffness_ratio", "1", 1.0, 0.02, 50.0, "log-uniform", 0.5, "wall stiffness over nominal", 1e-6
        ),
    ),
    signature="wall reading lower and longer, reflection later (softer) or the reverse; nothing before "
    "the wave reaches the wall",
    when_to_use="walls with a gauge, a bond or a thin plate in them",
    when_not="a wall sensor that only reads too little: sensor-gain",
    dissipative=False,
    change=change,
)
