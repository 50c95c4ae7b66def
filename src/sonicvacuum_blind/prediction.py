"""What a design's gauges show without noise, with errors of speed, modulus, gain and trigger, and in units of
its noise.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum_blind.design import Design
from sonicvacuum_blind.gauges import bounce, read, scalar
from sonicvacuum_blind.plan import Plan

# Error of the integrator for signatures: 1e-5 of a peak, against changes of the order of 1e-2.
TOLERANCE = 1e-7

Change = Callable[[Plan], Plan]


def nothing(plan: Plan) -> Plan:
    """The nominal plan."""
    return plan


@dataclass(frozen=True)
class Errors:
    """What is off within a record's stated errors, in units of these.

    Attributes:
        speeds, triggers: (runs,).
        gains: (gauges,).
        modulus: a number.
    """

    speeds: np.ndarray
    modulus: float
    gains: np.ndarray
    triggers: np.ndarray

    @classmethod
    def of(cls, design: Design, vector=None) -> "Errors":
        """Errors from one vector (speeds, modulus, gains, triggers); none without it."""
        runs, gauges = len(design.runs), len(design.reference.gauges)
        vector = np.zeros(2 * runs + gauges + 1) if vector is None else np.asarray(vector)
        return cls(
            vector[:runs],
            float(vector[runs]),
            vector[runs + 1 : runs + 1 + gauges],
            vector[runs + 1 + gauges :],
        )

    @property
    def vector(self) -> np.ndarray:
        """All in one."""
        return np.concatenate([self.speeds, [self.modulus], self.gains, self.triggers])


@dataclass(frozen=True)
class Prediction:
    """What a design's gauges show without noise.

    Attributes:
        traces: (runs, gauges, samples) N, also where the record holds scalars only.
        scalars: (scalars,) SI units.
    """

    traces: np.ndarray
    scalars: np.ndarray


def predict(
    design: Design,
    change: Change = nothing,
    errors: Errors | None = None,
    tolerance: float = TOLERANCE,
) -> Prediction:
    """Noise-free readings of all runs, with errors, each plan passed through `change`."""
    errors = errors or Errors.of(design)
    stiffness = 1.0 + design.modulus_sigma * errors.modulus
    plans = [
        change(replace(p, speed=p.speed * (1.0 + design.speed_sigma * e), modulus_ratio=stiffness))
        for p, e in zip(design.runs, errors.speeds, strict=True)
    ]
    if design.kind == "ball":
        found = [bounce(p, tolerance) for p in plans]
        values = np.array([found[s.run][s.quantity] for s in design.scalars])
        return Prediction(np.zeros((len(plans), 0, 0)), values)
    shifts = design.trigger_sigma * errors.triggers
    traces = np.stack([read(p, design.times(t), tolerance) for p, t in zip(plans, shifts, strict=True)])
    traces *= 1.0 + design.gain_sigma * errors.gains[:, None]
    return read_again(design, traces)


def read_again(design: Design, traces: np.ndarray) -> Prediction:
    """A prediction from (runs, gauges, samples) traces, its scalars read off them."""
    values = [
        scalar(design.runs[s.run], traces[s.run], design.times(), s.quantity, s.options)
        for s in design.scalars
    ]
    return Prediction(traces, np.array(values))


@dataclass(frozen=True)
class Whitener:
    """Divides by the noise; `correlation` is that of neighbouring samples (AR(1)), of variance sigma²."""

    design: Design
    correlation: float = 0.0

    def vector(self, prediction: Prediction) -> np.ndarray:
        """One vector in units of standard deviations."""
        scalars = prediction.scalars / np.array([s.sigma for s in self.design.scalars], dtype=float)
        if not self.design.samples:
            return scalars
        scaled = prediction.traces / np.array(self.design.sigma)[None, :, None]
        if self.correlation:
            fresh = (scaled[..., 1:] - self.correlation * scaled[..., :-1]) / np.sqrt(
                1.0 - self.correlation**2
            )
            scaled = np.concatenate([scaled[..., :1], fresh], axis=-1)
        return np.concatenate([scaled.ravel(), scalars])
