"""The striker is faster, slower, heavier or lighter than recorded, in all runs, beyond the stated error."""

from dataclasses import replace

from sonicvacuum.effects.base import Effect, Parameter, Setup


def change(setup: Setup, speed_ratio, mass_ratio) -> Setup:
    """Scale speed and mass of the striker; its weight follows the mass."""
    chain = setup.chain
    striker = {"speed": chain.speed * speed_ratio, "striker_mass": chain.striker_mass * mass_ratio}
    return replace(setup, chain=replace(chain, **striker))


EFFECT = Effect(
    id="striker-error",
    title="Striker error",
    missing="the striker is faster, slower, heavier or lighter than recorded, in all runs, beyond the "
    "stated error",
    equation="v -> r_v v, m_striker -> r_m m_striker (and its weight)",
    energy="the impact energy goes as r_m r_v^2",
    reference="Conservation of momentum; no particular source",
    parameters=(
        Parameter(
            "speed_ratio",
            "1",
            1.0,
            0.3,
            3.0,
            "log-uniform",
            0.05,
            "speed over the recorded one",
            1e-3,
            acts_like="speed",
        ),
        Parameter(
            "mass_ratio",
            "1",
            1.0,
            0.2,
            5.0,
            "log-uniform",
            0.1,
            "mass over the recorded one",
            1e-3,
            tried_at_once=True,
        ),
    ),
    signature="speed: all forces as v^{6/5}, all times as v^{-1/5}; mass: number and weight of the "
    "pulses in the train",
    when_to_use="drop heights or gates not calibrated; a train longer or shorter than the mass says",
    when_not="within the stated error it is a nuisance, not an effect; one sensor only: sensor-gain",
    dissipative=False,
    change=change,
)
