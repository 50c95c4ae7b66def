"""Piezo gauges discharge: readings sag and undershoot."""

import math
from dataclasses import replace

import numpy as np

from sonicvacuum.effects.base import MICRO, Effect, Parameter, Setup, change_sensors, no_gauges, plain


def change(setup: Setup, tau_us) -> Setup:
    """Set the discharge time of all sensors; where it is off the sensor keeps its own."""

    def sagging(index, sensor):
        own = math.inf if sensor.droop_s is None else sensor.droop_s
        time = np.where(np.isinf(tau_us), own, np.multiply(tau_us, MICRO))
        return replace(sensor, droop_s=plain(time))

    return change_sensors(setup, sagging)


EFFECT = Effect(
    id="sensor-droop",
    title="Sensor droop",
    missing="piezo discharge: readings sag and undershoot",
    equation="dy/dt + y/tau = dx/dt, all sensors",
    energy="none: the chain is not touched",
    reference="First-order RC circuit; Daraio & Nesterenko, Phys. Rev. E 73, 026612 (2006), Experiments: "
    "RC about 10^3 us",
    parameters=(
        Parameter(
            "tau_us",
            "us",
            math.inf,
            10.0,
            1e6,
            "log-uniform",
            1000.0,
            "discharge time RC",
            1e-3,
            electronic=True,
        ),
    ),
    signature="a negative tail after each pulse with the time tau, peaks a little low and early, long "
    "pulses most",
    when_to_use="gauges without charge amplifier; long pulses or trains; readings below zero",
    when_not="charge amplifiers with time constants far above the record",
    dissipative=False,
    change=change,
    lacks=no_gauges,
)
