"""What a model leaves, asked three ways: along chosen shapes, in any shape, and as a smooth discrepancy."""

import math
from dataclasses import dataclass

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import goodness, smooth, tails
from sonicvacuum.discover.fit.goodness import Goodness
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import screen, unknown
from sonicvacuum.discover.search.unknown import ShapeTest


@dataclass(frozen=True)
class Left:
    """What a model leaves.

    Attributes:
        shapes: the test along chosen shapes.
        fit: in any shape.
        size: the smooth discrepancy.
        behind: Δχ² by which the model falls short of one shape outside the catalogue.
    """

    shapes: ShapeTest
    fit: Goodness
    size: smooth.Size
    behind: float = 0.0

    @property
    def failed(self) -> bool:
        """Whether a real misfit is left."""
        return self.shapes.failed or self.fit.failed or self.size.found or self.behind > 0.0

    @property
    def p(self) -> float:
        """p-value of what is left; goodness of fit, which asks for more, counts only where it fails."""
        found = [self.shapes.p, math.exp(-0.5 * self.behind)]
        found += [self.fit.p] if self.fit.failed else []
        found += [0.5 * tails.chi_squared(self.size.drop, 1)] if self.size.found else []
        return min(found)

    @property
    def where(self) -> str:
        """In words."""
        if self.size.found:
            return f"a smooth misfit of {100.0 * self.size.size:.2g} % of the peak"
        if self.fit.failed and self.fit.p < self.shapes.p:
            return _WORDS.get(self.fit.worst, self.fit.worst)
        return self.shapes.misfit


_WORDS = {
    "chi2": "more scatter in a trace than its noise",
    "total": "more scatter than the noise",
    "whiteness": "a residual that is correlated from sample to sample",
    "outliers": "scatter far beyond the noise in single samples",
    "oscillation": "an oscillation in a trace",
    "oscillation of a gauge": "an oscillation in all runs of a gauge",
}


def left(forward: Forward, fit: Fit, known, scores: screen.Screen | None = None, behind: float = 0.0) -> Left:
    """All three.

    `known` are the `discrepancy.Shapes`, None where none is to be inferred; `scores` is the catalogue's
    screen at the fit, where at hand.
    """
    size = smooth.Size(0.0, 0.0) if known is None else smooth.infer(forward, fit, known)
    return Left(unknown.shape_test(forward, fit, scores), goodness.goodness(forward, fit), size, behind)


def short(gain: float, most: float) -> float:
    """By how much an explanation's Δχ² falls short of that of the simplest shape outside the catalogue."""
    return max(0.0, most - gain - policy.MARGIN - policy.SHARE * gain)


def sure(found: Left) -> bool:
    """Whether the nominal model leaves a misfit beyond doubt: nothing is named then but that."""
    return found.p < policy.NULL_MISFIT
