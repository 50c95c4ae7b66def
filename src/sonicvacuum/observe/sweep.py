"""Speed against amplitude over many runs: the exponent of the law, and the speed at a given amplitude.

In a sonic vacuum log V grows as one sixth of log F, Eq. (6) of Daraio & Nesterenko, PRE 73, 026612 (2006).
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from sonicvacuum.observe.trace import Measured, missing


@dataclass(frozen=True)
class Slope:
    """Exponent of a power law.

    Attributes:
        value: d log V / d log F; NaN where it cannot be fitted.
        sigma: its standard error from the scatter about the line.
        reason: why the value is NaN; empty where it is not.
    """

    value: float
    sigma: float
    reason: str = ""


def loglog_slope(force: ArrayLike, speed: ArrayLike) -> Slope:
    """Least-squares slope of log speed (m/s) on log force (N), both (n,), all points alike.

    Pairs with a NaN (a pulse that was not there) are left out; at least three must remain.

    Raises:
        ValueError: for shapes that differ or a number that is not positive.
    """
    x, y = _logs(force, speed)
    if len(x) < 3 or np.ptp(x) == 0.0:
        return Slope(
            math.nan, math.nan, f"too few: {len(x)} points, at least 3 of different force are needed"
        )
    dx, dy = x - x.mean(), y - y.mean()
    spread = dx @ dx
    slope = dx @ dy / spread
    scatter = dy - slope * dx
    return Slope(float(slope), float(math.sqrt(scatter @ scatter / (len(x) - 2) / spread)))


def speed_at_amplitude(amplitude: float, amplitudes: ArrayLike, speeds: ArrayLike) -> Measured:
    """Speed in m/s of a wave of this amplitude (N), between the runs of a sweep.

    Monotone (PCHIP) interpolation of log speed in log amplitude, with no extrapolation: NaN outside the range
    of `amplitudes` (n,). Pairs with a NaN are left out; the order does not matter.

    Raises:
        ValueError: for shapes that differ, a number that is not positive, or an amplitude given twice.
    """
    from scipy.interpolate import PchipInterpolator

    if not amplitude > 0.0:
        raise ValueError(f"amplitude is {amplitude} N; it must be positive")
    x, y = _logs(amplitudes, speeds)
    if len(x) < 2:
        return missing(f"too few: {len(x)} runs with a pulse, at least 2 are needed")
    order = np.argsort(x)
    x, y = x[order], y[order]
    if np.any(np.diff(x) == 0.0):
        raise ValueError(
            f"amplitude {math.exp(x[int(np.argmin(np.diff(x)))]):g} N is given twice; each may occur once"
        )
    target, room = math.log(amplitude), 1e-12
    if not x[0] - room <= target <= x[-1] + room:
        low, high = np.exp(x[[0, -1]])
        return missing(f"outside: {amplitude:g} N is not between {low:g} and {high:g} N")
    return Measured(float(np.exp(PchipInterpolator(x, y)(min(max(target, x[0]), x[-1])))))


def _logs(force, speed):
    force, speed = np.asarray(force, dtype=float), np.asarray(speed, dtype=float)
    if force.ndim != 1 or force.shape != speed.shape:
        raise ValueError(f"force has shape {force.shape} and speed {speed.shape}; both must be (n,)")
    known = ~(np.isnan(force) | np.isnan(speed))
    force, speed = force[known], speed[known]
    for name, values in (("force", force), ("speed", speed)):
        if np.any(values <= 0.0):
            raise ValueError(f"{name} {values.min():g} is not positive")
    return np.log(force), np.log(speed)
