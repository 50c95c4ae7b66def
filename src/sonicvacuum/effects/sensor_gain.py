"""One sensor is miscalibrated beyond its stated error."""

from dataclasses import replace

import numpy as np

from sonicvacuum.effects.base import Effect, Parameter, Setup, change_sensors, plain


def change(setup: Setup, gain_ratio, sensor) -> Setup:
    """Scale the gain of one sensor."""

    def scaled(index, one):
        return replace(one, gain=plain(one.gain * np.where(np.equal(sensor, index), gain_ratio, 1.0)))

    return change_sensors(setup, scaled)


def all_sensors(setup: Setup) -> tuple[int, ...]:
    """Every sensor."""
    return tuple(range(len(setup.sensors)))


EFFECT = Effect(
    id="sensor-gain",
    title="Sensor gain",
    missing="one sensor is miscalibrated beyond its stated error",
    equation="y -> r y, one sensor",
    energy="none: the chain is not touched",
    reference="Calibration; no particular source",
    parameters=(
        Parameter(
            "gain_ratio",
            "1",
            1.0,
            0.2,
            5.0,
            "log-uniform",
            0.1,
            "gain over the stated one",
            1e-6,
            acts_like="gain",
        ),
    ),
    places="sensor",
    choices=all_sensors,
    signature="one sensor reads too much or too little in every run by the same factor; times unchanged",
    when_to_use="gauges calibrated one by one",
    when_not="within the stated error it is a nuisance, not an effect; a factor that varies with "
    "amplitude: contact laws",
    dissipative=False,
    change=change,
)
