"""An axial preload that nobody wrote down."""

from dataclasses import replace

from sonicvacuum.effects.base import Effect, Parameter, Setup, no_beads


def change(setup: Setup, force_N) -> Setup:
    """Add the force to the preload on bead 1."""
    chain = setup.chain
    return replace(setup, chain=replace(chain, static_force=chain.static_force + force_N))


EFFECT = Effect(
    id="static-preload",
    title="Static preload",
    missing="an axial preload that nobody wrote down",
    equation="F0 -> F0 + f, a constant force on bead 1 borne by all contacts down to the wall",
    energy="the constant force does the work f u on bead 1",
    reference="Daraio, Nesterenko, Herbold & Jin, Phys. Rev. E 73, 026610 (2006)",
    parameters=(
        Parameter(
            "force_N",
            "N",
            0.0,
            1e-4,
            100.0,
            "log-uniform",
            0.1,
            "preload besides the recorded one",
            0.0,
            bends=True,
        ),
    ),
    signature="weak pulses travel faster (sound speed as F0^{1/6}), amplitudes grow a little, the "
    "front has a longer foot; strong pulses hardly change",
    when_to_use="clamped chains, springs, magnets, a load cell at rest above zero",
    when_not="preload that grows along the chain: gravity",
    dissipative=False,
    change=change,
    lacks=no_beads,
)
