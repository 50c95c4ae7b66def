"""What many runs of one card give together: speed against amplitude."""

import math

import numpy as np

from sonicvacuum.observe.sweep import loglog_slope
from sonicvacuum.observe.trace import Measured, missing
from sonicvacuum.physics import theory
from sonicvacuum_paper import contacts, gauges
from sonicvacuum_paper.one_run import OneRun
from sonicvacuum_paper.printed import PRINTED

# Amplitudes in N that the paper's Fig. 4(a) spans; of the steel chain every run counts.
COATED_RANGE = (0.25, 3.0)


def speed_slope(runs: list[OneRun]) -> Measured:
    """Slope of ln speed on ln amplitude, mean of the embedded gauges, by least squares."""
    if runs[0].span is None:
        return runs[0].speed()
    low, high = COATED_RANGE if runs[0].card.bead.coating_m is not None else (0.0, math.inf)
    force = np.array([_reading(r) for r in runs])
    speed = np.array([r.speed().value for r in runs])
    inside = (force >= low) & (force <= high)
    slope = loglog_slope(force[inside], speed[inside])
    return Measured(slope.value, slope.reason)


def theory_deviation(runs: list[OneRun]) -> Measured:
    """Root mean square of speed/(Eq. 7) − 1 over the runs; F_m, F_0 of the contacts between the gauges."""
    if runs[0].span is None:
        return runs[0].speed()
    return _scatter([_speed_over_theory(run) for run in runs])


def curve_deviation(runs: list[OneRun]) -> Measured:
    """Root mean square of speed/(Eq. 7) − 1 from 0.25 to 3 N, read as the paper does.

    F_m is the gauges' mean reading plus the static force, E the 15 GPa of its Fig. 4(a).
    """
    if runs[0].span is None:
        return runs[0].speed()
    low, high = COATED_RANGE
    ratios = []
    for run in runs:
        reading, speed = _reading(run), run.speed().value
        if low <= reading <= high and math.isfinite(speed):
            static = float(np.mean([run.static_force(c) for c in run.contacts_between_gauges()]))
            ratios.append(speed / _eq7(run, reading + static, static, PRINTED.modulus_matched))
    return _scatter(ratios)


def _speed_over_theory(run):
    peak, speed = contacts.heaviest(run).force, run.speed().value
    if not (math.isfinite(peak) and math.isfinite(speed)):
        return math.nan
    static = float(np.mean([run.static_force(c) for c in run.contacts_between_gauges()]))
    return float(speed / _eq7(run, peak, static, run.card.bead.surface.modulus_Pa))


def _eq7(run, peak, static, modulus):
    bead = run.card.bead
    return theory.speed_with_precompression(
        peak, static, modulus, bead.surface.poisson, bead.diameter_m, bead.mass_kg
    )


def _reading(run):
    return float(np.mean([gauges.amplitude(run, s).value for s in run.span]))


def _scatter(ratios):
    """Root mean square deviation from 1 of those that are known."""
    known = [r for r in ratios if math.isfinite(r)]
    return (
        Measured(float(np.sqrt(np.mean(np.square(np.array(known) - 1.0))))) if known else missing("no pulses")
    )


OVER_RUNS = {
    "speed_slope": speed_slope,
    "theory_deviation": theory_deviation,
    "curve_deviation": curve_deviation,
}
