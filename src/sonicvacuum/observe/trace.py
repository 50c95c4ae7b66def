"""One recorded signal, and the two local fits that read it between its samples.

Peaks: least squares of a sixth-degree polynomial over the top of the pulse. Crossings of a level: the cubic
through four samples. With samples 1/20 of the pulse's width at half height apart (1.7 µs for a coated chain's
34 µs), at any offset, of sech², cos⁴, cos⁶ and skewed pulses, the tests find errors below 2e-5 of that width
in the peak's time (0.6 ns), 3e-6 of the peak in its force, and 5e-5 of the width in crossings from 1 % to
half of the peak (1.5 ns). With 1/10: 2e-5, 6e-6 and 7e-4.
"""

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

DEGREE = 6
# How far down the top of a pulse reaches, as a fraction of its height: of a clean signal, and of a noisy one,
# where a wider top averages more, and the fit's own error (up to 3e-3 of the width) does not count.
TOP = 0.2
NOISY_TOP = 0.5
_NOISY_DIP = 6.0
# Of two humps of a top that are as high as each other but for so much, the first is the peak. Where a wave is
# hardly longer than a bead, a gauge inside one shows both of its contacts, and which is the higher is chance.
TIE = 0.01
# What is told of a beginning has ended so many samples before it does: crossings and filters look ahead.
AHEAD = 3


@dataclass(frozen=True)
class Measured:
    """A measured value, or the reason for its absence.

    Attributes:
        value: in SI units; NaN where the signal does not give it.
        reason: why the value is NaN; empty where it is not.
    """

    value: float
    reason: str = ""

    @property
    def known(self) -> bool:
        """Whether there is a value."""
        return not self.reason


class Unsettled(Exception):
    """What more of a record may change, asked of its beginning."""


def missing(reason: str) -> Measured:
    """No value, for this reason."""
    return Measured(float("nan"), reason)


@dataclass(frozen=True, eq=False)
class Trace:
    """One signal, checked.

    Attributes:
        start: time of the first sample in s.
        interval: time between samples in s.
        force: (S,) reading, change from rest: N, or the unit of the gauge that it comes from.
        noise: standard deviation of one sample in the same unit, 0 for a simulated signal.
        goes_on: whether this is the beginning of a signal: what more of it may change is `Unsettled`.
    """

    start: float
    interval: float
    force: np.ndarray
    noise: float = 0.0
    goes_on: bool = False

    @classmethod
    def of(cls, time: np.ndarray, force: np.ndarray, noise: float = 0.0) -> "Trace":
        """A signal from its times in s and forces in N, both (S,).

        Raises:
            ValueError: for shapes that differ, fewer than 5 samples, times that are not equidistant (by more
                than 1 % of the interval), or a value that is not finite.
        """
        time = np.asarray(time, dtype=float)
        force = np.asarray(force, dtype=float)
        if time.ndim != 1 or force.shape != time.shape:
            raise ValueError(f"time has shape {time.shape} and force {force.shape}; both must be (S,)")
        return cls(*grid(time), force, noise).checked()

    def checked(self) -> "Trace":
        """This trace; ValueError when its forces are not finite or its noise is not zero or more."""
        if not np.isfinite(self.force).all():
            where = int(np.argmin(np.isfinite(self.force)))
            raise ValueError(f"force[{where}] is {self.force[where]}; every sample must be finite")
        if not 0.0 <= self.noise < float("inf"):
            raise ValueError(f"noise is {self.noise}; it must be zero or more")
        return self

    def settled(self, samples: float) -> None:
        """Raise `Unsettled` where this is a beginning that ends less than `AHEAD` after so many samples."""
        if self.goes_on and not samples < len(self.force) - AHEAD:
            raise Unsettled

    def time(self, sample: float) -> float:
        """Time in s of a sample, also between samples."""
        return self.start + self.interval * sample


def grid(time: np.ndarray) -> tuple[float, float]:
    """First time and interval of equidistant times (S,).

    Raises:
        ValueError: fewer than 5 samples, or a time more than 1 % of the interval off the equidistant one
            (room for times rounded in a file).
    """
    if len(time) < 5:
        raise ValueError(f"time has {len(time)} samples; at least 5 are needed")
    start, interval = float(time[0]), float(time[-1] - time[0]) / (len(time) - 1)
    off = np.abs(time - (start + interval * np.arange(len(time))))
    if not (interval > 0.0 and off.max() <= 0.01 * interval):
        worst = int(np.argmax(off))
        raise ValueError(
            f"time[{worst}] is {time[worst]:g} s; times must increase in equal steps of {interval:g} s"
        )
    return start, interval


def top_of(trace: Trace, peak: int, height: float) -> tuple[int, int]:
    """First and last sample of the top of a pulse whose highest sample is `peak`.

    `height` is the pulse's height in N above its surroundings. The top reaches down by `TOP` of it, or
    `NOISY_TOP` (and by six standard deviations of the noise), and holds at least three samples either side
    where the record has them.
    """
    force = trace.force
    depth = max(NOISY_TOP * height, _NOISY_DIP * trace.noise) if trace.noise > 0.0 else TOP * height
    low = force < force[peak] - depth
    left, right = low[peak::-1], low[peak:]
    before = int(left.argmax()) - 1 if left.any() else peak
    after = int(right.argmax()) - 1 if right.any() else len(force) - 1 - peak
    return max(0, peak - max(before, 3)), min(len(force) - 1, peak + max(after, 3))


def maximum(force: np.ndarray, first: int, last: int, peak: int | None = None) -> tuple[float, float]:
    """Place (in samples) and value of the maximum of the polynomial fitted to samples `first` to `last`;
    `peak` as in `summit`.
    """
    c, start, lower, upper, first, last = summit(force, first, last, peak)
    place = newton(c, start, lower, upper)
    return first + 0.5 * (place + 1.0) * (last - first), value_at(c, place)


def summit(
    force: np.ndarray, first: int, last: int, peak: int | None = None
) -> tuple[list[float], float, float, float, int, int]:
    """The polynomial fitted to samples `first` to `last`, lowest power first, over [−1, 1]; where its largest
    value at a sample is, and the samples beside it; and the first and last sample of the fit.

    Where the top has several humps and the sample `peak` is given, the one that this belongs to is fitted
    alone, from dip to dip, or the first before it that is as high but for `TIE`.
    """
    x, powers, fit = _polynomial(last - first + 1)
    coefficients = fit @ force[first : last + 1]
    values = powers @ coefficients
    if peak is not None:
        left, right = _hump(values, peak - first)
        if DEGREE <= right - left < last - first:
            return summit(force, first + left, first + right)
    best = int(values.argmax())
    return coefficients.tolist(), x[best], x[max(best - 1, 0)], x[min(best + 1, len(x) - 1)], first, last


def _hump(values, at):
    """First and last of the places of a hump, dips to its sides or ends: of that which holds place `at`, or
    of the first before it that is as high but for `TIE`.
    """
    rises = values[1:] > values[:-1]
    if np.count_nonzero(rises[:-1] > rises[1:]) < 2:
        return 0, len(values) - 1
    dips = 1 + np.flatnonzero(rises[:-1] < rises[1:])
    bounds = [0, *dips.tolist(), len(values) - 1]
    humps = list(pairwise(bounds))
    heights = np.array([values[low : high + 1].max() for low, high in humps])
    own = next(k for k, (_, high) in enumerate(humps) if at <= high)
    return humps[int((heights[: own + 1] >= (1.0 - TIE) * heights[own]).argmax())]


def crossing(force: np.ndarray, before: int, level: float) -> float:
    """Place (in samples) between samples `before` and `before` + 1 where the force passes `level`."""
    first = min(max(before - 1, 0), len(force) - 4)
    lower = float(before - first)
    return first + root(cubic(*(force[first : first + 4] - level).tolist()), lower, lower + 1.0)


@lru_cache(maxsize=256)
def _polynomial(count):
    """Abscissae in [−1, 1], their powers (lowest first) and the least-squares matrix for `count` samples."""
    x = np.linspace(-1.0, 1.0, count)
    powers = np.vander(x, min(DEGREE, count - 1) + 1, increasing=True)
    return x.tolist(), powers, np.linalg.pinv(powers)


# What follows is plain enough to be compiled as it stands: `forward.together` does.


def cubic(f0, f1, f2, f3):
    """Coefficients, lowest power first, of the cubic through four values at 0, 1, 2 and 3."""
    return (
        6.0 * f0 / 6.0,
        (-11.0 * f0 + 18.0 * f1 - 9.0 * f2 + 2.0 * f3) / 6.0,
        (6.0 * f0 - 15.0 * f1 + 12.0 * f2 - 3.0 * f3) / 6.0,
        (-f0 + 3.0 * f1 - 3.0 * f2 + f3) / 6.0,
    )


def value_at(c, x):
    """Value of a polynomial, coefficients lowest power first."""
    value = 0.0
    for k in range(len(c) - 1, -1, -1):
        value = value * x + c[k]
    return value


def slope_and_curvature(c, x):
    """First and second derivative of a polynomial."""
    value = slope = curvature = 0.0
    for k in range(len(c) - 1, -1, -1):
        curvature = curvature * x + slope
        slope = slope * x + value
        value = value * x + c[k]
    return slope, 2.0 * curvature


def newton(c, x, lower, upper):
    """Maximum of a polynomial next to x, kept between two bounds."""
    for _ in range(8):
        slope, curvature = slope_and_curvature(c, x)
        if curvature >= 0.0:
            break
        new = min(max(x - slope / curvature, lower), upper)
        if abs(new - x) < 1e-14:
            return new
        x = new
    return x


def root(c, lower, upper):
    """Zero of a polynomial between two bounds, by Newton steps that bisection keeps inside."""
    rising = value_at(c, upper) >= value_at(c, lower)
    x = 0.5 * (lower + upper)
    for _ in range(60):
        value = slope = 0.0
        for k in range(len(c) - 1, -1, -1):
            slope = slope * x + value
            value = value * x + c[k]
        lower, upper = (lower, x) if (value > 0.0) == rising else (x, upper)
        new = x - value / slope if slope != 0.0 else lower
        new = new if lower < new < upper else 0.5 * (lower + upper)
        if abs(new - x) < 1e-13:
            return new
        x = new
    return x
