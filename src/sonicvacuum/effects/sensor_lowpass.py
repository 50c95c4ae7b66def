"""Gauges or electronics have a finite bandwidth."""

from dataclasses import replace

import numpy as np

from sonicvacuum.effects.base import MICRO, Effect, Parameter, Setup, change_sensors, no_gauges, plain


def change(setup: Setup, tau_us) -> Setup:
    """Set the low-pass time of all sensors; where it is off the sensor keeps its own."""

    def slower(index, sensor):
        time = np.where(np.equal(tau_us, 0.0), sensor.lowpass_s, np.multiply(tau_us, MICRO))
        return replace(sensor, lowpass_s=plain(time))

    return change_sensors(setup, slower)


EFFECT = Effect(
    id="sensor-lowpass",
    title="Sensor bandwidth",
    missing="finite bandwidth of gauges or electronics",
    equation="tau dy/dt + y = x, all sensors",
    energy="none: the chain is not touched",
    reference="First-order RC circuit; no particular source",
    parameters=(
        Parameter(
            "tau_us",
            "us",
            0.0,
            0.05,
            300.0,
            "log-uniform",
            2.0,
            "time constant",
            0.0,
            electronic=True,
            tried_at_once=True,
        ),
    ),
    signature="readings later by tau, lower and longer, narrow pulses most; area and decay along the "
    "chain kept",
    when_to_use="short pulses (steel, strong strikers) read too low; the same delay at all sensors",
    when_not="widening that grows along the chain: dashpots",
    dissipative=False,
    change=change,
    lacks=no_gauges,
)
