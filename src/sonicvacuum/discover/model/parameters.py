"""Parameters of effects as the search sees them: coordinates without units, zero or minus infinity at off.

Strengths that may only be positive are searched by their logarithm, ratios by the logarithm about 1, the rest
linearly; bounds are those of the catalogue.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from sonicvacuum.effects import Effect, Parameter, Setup

# Strength below which an effect counts as off, and the fraction of it at which slopes at off are taken.
SMALL = 1e-3
# A value that the record states is searched within so many of its standard errors.
WITHIN = 2.0
# A bound towards off bounds nothing: precise data see an effect that is weaker by as much.
TOWARDS_OFF = 100.0


@dataclass(frozen=True)
class Coordinate:
    """One searched parameter.

    Attributes:
        parameter: of the effect.
        kind: "log" (value = unit e^u), "inverse" (value = unit e^-u), "ratio" (value = unit e^u, off at 0),
            "linear" (value = off + unit u).
        unit: see kind.
        off: value at which it is off (`linear` only).
        low, high: bounds of u.
        two_sided: whether the parameter may depart from off in both directions.
    """

    parameter: Parameter
    kind: str
    unit: float
    off: float
    low: float
    high: float
    two_sided: bool

    @property
    def endless(self) -> bool:
        """Whether off lies at minus infinity: one unit of u is then a strength over its error of one."""
        return self.kind in ("log", "inverse")

    def value(self, u):
        """The parameter's value at u (any shape)."""
        if self.kind == "inverse":
            return self.unit * np.exp(-np.asarray(u))
        if self.kind == "linear":
            return self.off + self.unit * np.asarray(u)
        return self.unit * np.exp(np.asarray(u))

    def inverse(self, value: float) -> float:
        """u of a value."""
        if self.kind == "linear":
            return (value - self.off) / self.unit
        sign = -1.0 if self.kind == "inverse" else 1.0
        return sign * math.log(value / self.unit)

    def slope(self, u) -> np.ndarray:
        """|d value / d u|."""
        return np.abs(self.unit) if self.kind == "linear" else np.abs(self.value(u))

    @property
    def step(self) -> float:
        """Finite-difference step in u."""
        return 0.01

    def starts(self) -> np.ndarray:
        """Values of u at which a search may start, over the whole range but its ends."""
        if self.parameter.known:  # evenly over what the record allows
            return np.linspace(self.low, self.high, 5)[1:-1]
        if self.endless:
            # Evenly in the logarithm, from the catalogue's bound on: what is weaker is reached from there.
            weakest = self.low + (math.log(TOWARDS_OFF) if self.parameter.switches else 0.0)
            return np.linspace(weakest, self.high, 14)[1:-1]
        if self.kind == "ratio":
            # Logarithms of ratios, from 3 % to a factor of 16 to either side: the smaller, the denser.
            sizes = np.array([0.03, 0.1, 0.25, 0.45, 0.7, 1.0, 1.35, 1.75, 2.2, 2.8])
            return np.array([s for s in np.concatenate([-sizes, sizes]) if self.low < s < self.high])
        if not self.two_sided:  # evenly
            return np.linspace(self.low, self.high, 9)[1:-1]
        # Shares of the way from off to either bound, denser towards off.
        return np.array([s * b for b in (self.low, self.high) for s in (0.05, 0.15, 0.3, 0.5, 0.75)])

    def closely(self) -> np.ndarray:
        """Values of u all over the range, so near to one another that one of them is in each minimum: where
        beads part and meet again, those of a force are a fifth of it wide.
        """
        if self.endless:
            return np.arange(self.low, self.high, 0.15)[1:]
        return np.linspace(self.low, self.high, 41)[1:-1]


def coordinate(parameter: Parameter, setup: Setup) -> Coordinate:
    """How a parameter is searched in this setup."""
    off = parameter.off_in(setup)
    low, high, scale = parameter.low, parameter.high, parameter.scale
    if off is None:
        return _shape(parameter)
    off = float(np.ravel(off)[0])
    if parameter.known:
        value, error = parameter.known
        return Coordinate(parameter, "inverse", value, off, -WITHIN * error, WITHIN * error, False)
    if math.isinf(off):
        weakest, strongest = math.log(scale / high / TOWARDS_OFF), math.log(scale / low)
        return Coordinate(parameter, "inverse", scale, off, weakest, strongest, False)
    if off == 0.0 and low >= 0.0 and not parameter.linear:
        least = low / TOWARDS_OFF if low > 0.0 else SMALL * scale
        bounds = (math.log(least / scale), math.log(high / scale))
        return Coordinate(parameter, "log", scale, off, *bounds, False)
    if off > 0.0 and low > 0.0 and parameter.prior.startswith("log"):
        return Coordinate(parameter, "ratio", off, off, math.log(low / off), math.log(high / off), True)
    bounds = ((low - off) / scale, (high - off) / scale)
    return Coordinate(parameter, "linear", scale, off, *bounds, bounds[0] < 0.0 < bounds[1])


def _shape(parameter):
    low, high = parameter.low, parameter.high
    if parameter.prior.startswith("log"):
        unit = parameter.scale
        return Coordinate(
            parameter, "log", unit, math.nan, math.log(low / unit), math.log(high / unit), False
        )
    return Coordinate(parameter, "linear", 1.0, 0.0, low, high, False)


def shape_grid(effect: Effect) -> tuple[dict[str, float], ...]:
    """Values of the parameters that only shape an effect at which it is screened; one empty dict without
    any.
    """
    shapes = [p for p in effect.parameters if not p.switches]
    if not shapes:
        return ({},)
    (one,) = shapes
    return tuple({one.name: value} for value in _grid(one))


@lru_cache
def _grid(shape: Parameter) -> tuple[float, ...]:
    """Values of one parameter that only shapes; kept, as every screen asks again."""
    low, high = (max(shape.low, shape.scale / 30.0), min(shape.high, shape.scale * 30.0))
    spread = np.geomspace(low, high, 5) if shape.prior.startswith("log") else np.linspace(low, high, 3)
    return tuple(spread.tolist())
