"""Speed of waves in one chain over their amplitude: a smooth curve through what single strikes show.

All in natural logarithms. The slope of such a curve changes by a sixth at most (a static force: from sound to
solitary waves; Nesterenko, Dynamics of Heterogeneous Materials, 2001, Ch. 1), and takes an e-fold or more for
it, so that a cubic through points a factor of two to four apart errs by a few parts in 1e4 at most.
"""

import math

from sonicvacuum.physics.scales import STRIKER_POWER, WAVE_POWER

# The curve is known this near to one of two points, and between two that are so near; where there are more,
# between neighbours so near, and so far beyond two that are.
NEAR, BETWEEN, AMONG, BEYOND = 0.03, 0.25, 1.4, 0.1
# Points that are nearer than this to one that tells more add rounding errors rather than knowledge; two so
# near show no slope.
CROWDED, SAME = 0.1, 1e-4
# A cubic.
POINTS = 4
# Steps in the logarithm of the striker's speed go no further than this, and follow an exponent within these.
STRIDE, LEAST, MOST = math.log(4.0), 0.4, 1.6


class Curve:
    """What is known of one chain.

    Attributes:
        silent: whether no strike made a pulse at the gauge.
    """

    def __init__(self):
        self.silent = True
        self._points: list[tuple[float, float, float]] = []

    @property
    def empty(self) -> bool:
        """Whether no strike showed both an amplitude and a speed."""
        return not self._points

    def add(self, strike: float, amplitude: float, speed: float) -> None:
        """A strike at a striker's speed: what amplitude and speed the wave had, NaN where there was none."""
        if math.isfinite(amplitude):
            self.silent = False
            if math.isfinite(speed):
                self._points.append((amplitude, strike, speed))
                self._points.sort()

    def tells(self, amplitude: float) -> bool:
        """Whether the speed at an amplitude is known."""
        off = sorted((point[0] - amplitude for point in self._points), key=abs)
        if len(off) < 2:
            return False
        several = len(off) > 2
        other = next((d for d in off if d * off[0] <= 0.0 and d != off[0]), math.inf)
        if abs(other - off[0]) <= (AMONG if several else BETWEEN):
            return True
        beside = several and abs(off[1]) <= AMONG
        return abs(off[0]) <= (BEYOND if beside else NEAR)

    def strike_for(self, amplitude: float) -> float:
        """Speed of a striker that should make a wave of an amplitude; of a curve that is not empty."""
        at, strike, _ = min(self._points, key=lambda point: abs(point[0] - amplitude))
        across = [p for p in self._points if (p[0] - amplitude) * (at - amplitude) < 0.0]
        others = [p for p in across or self._points if abs(p[0] - at) > SAME]
        power = STRIKER_POWER
        if others:
            other = min(others, key=lambda point: abs(point[0] - amplitude))
            power = min(max((other[1] - strike) / (other[0] - at), LEAST), MOST)
        return strike + min(max(power * (amplitude - at), -STRIDE), STRIDE)

    def speed(self, amplitude: float) -> float:
        """Speed of the wave of an amplitude; of a curve that is not empty."""
        near = sorted(self._points, key=lambda point: abs(point[0] - amplitude))
        chosen = near[:1]
        for apart, enough in ((CROWDED, POINTS), (SAME, 2)):
            for point in near:
                if len(chosen) < enough and all(abs(point[0] - one[0]) > apart for one in chosen):
                    chosen.append(point)
        if len(chosen) < 2:
            return chosen[0][2] + WAVE_POWER * (amplitude - chosen[0][0])
        return _through([c[0] for c in chosen], [c[2] for c in chosen], amplitude)


def _through(at, values, wanted):
    """Lagrange's polynomial through values at a few places."""
    total = 0.0
    for k, (place, value) in enumerate(zip(at, values, strict=True)):
        others = at[:k] + at[k + 1 :]
        total += value * math.prod((wanted - o) / (place - o) for o in others)
    return total
