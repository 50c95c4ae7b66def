"""From evidence to probabilities that come true as often as they say.

Laplace's approximation, priors and the bound for `unknown` are a little over- or underconfident. A tempering
of all log weights, one shift for `none`, and shift and slope of the log odds of `unknown` mend that (Platt
scaling with several classes: Guo et al., Proc. Mach. Learn. Res. 70, 1321, 2017). What is said of `unknown`
comes from hidden-effect data of a study of its own (`sonicvacuum blind calibrate`). The tempering and the
shift of `none` are those under which the names given in 3680 records (docs/study.md and the seventh sample of
docs/again.md) came true most likely: 1.35 and 1.0, for 1.49 and 0.97 before. All are in `calibration.json`.

Two effects together imitate what lies outside the catalogue far more often than one does. Of 108 sets that
five fresh samples named, and that left nothing, 79 were right and 7 stood for something else (docs/again.md),
of the last 56, whose sets had been held against more, 45 and one; the four numbers say one in a thousand.
`unknown_set` adds odds between those of all and those of the last.
"""

import math
from collections.abc import Mapping
from functools import cache
from importlib import resources

import msgspec
import numpy as np
from msgspec import Struct


class Calibration(Struct, frozen=True, forbid_unknown_fields=True):
    """How weights become probabilities.

    Attributes:
        temper: factor of all log weights; below 1 where evidence is overconfident.
        none: shift of the log weight of `none`.
        unknown, unknown_slope: log odds of `unknown` against the best of the rest are shift + slope × those
            of the evidence.
        cases: on how many cases the numbers above were found.
        unknown_set: added to the odds of `unknown` where the best of the rest is a set of effects.
    """

    temper: float = 1.0
    none: float = 0.0
    unknown: float = 0.0
    unknown_slope: float = 1.0
    cases: int = 0
    unknown_set: float = 0.0

    def probabilities(
        self, logs: Mapping[str, float], unknown: float, of_set: bool = False
    ) -> dict[str, float]:
        """Probabilities of the keys of `logs` (natural log weights, `none` among them) and of `unknown`.

        `unknown` are its log odds against the best of the rest, which is a set of effects where `of_set`.
        """
        tempered = {name: self.temper * value for name, value in logs.items()}
        tempered["none"] += self.none
        odds = self.unknown + self.unknown_slope * unknown
        if of_set and self.unknown_set > 0.0:
            odds = float(np.logaddexp(odds, math.log(self.unknown_set)))
        tempered["unknown"] = max(tempered.values()) + odds
        top = max(tempered.values())
        weights = {name: math.exp(value - top) for name, value in tempered.items()}
        total = sum(weights.values())
        return {name: weight / total for name, weight in weights.items()}


@cache
def of_package() -> Calibration:
    """The calibration that comes with the package."""
    text = resources.files(__package__).joinpath("calibration.json").read_bytes()
    return msgspec.json.decode(text, type=Calibration)
