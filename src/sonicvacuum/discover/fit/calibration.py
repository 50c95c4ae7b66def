"""From evidence to probabilities that come true as often as they say.

Laplace's approximation, priors and the bound for `unknown` are a little over- or underconfident. A tempering
of all log weights, one shift for `none`, and shift and slope of the log odds of `unknown` mend that (Platt
scaling with several classes: Guo et al., Proc. Mach. Learn. Res. 70, 1321, 2017). The four numbers come from
hidden-effect data of a study of its own (`sonicvacuum blind calibrate`) and are kept in `calibration.json`.
"""

import math
from collections.abc import Mapping
from functools import cache
from importlib import resources

import msgspec
from msgspec import Struct


class Calibration(Struct, frozen=True, forbid_unknown_fields=True):
    """How weights become probabilities.

    Attributes:
        temper: factor of all log weights; below 1 where evidence is overconfident.
        none: shift of the log weight of `none`.
        unknown, unknown_slope: log odds of `unknown` against the best of the rest are shift + slope × those
            of the evidence.
        cases: on how many cases the numbers were found.
    """

    temper: float = 1.0
    none: float = 0.0
    unknown: float = 0.0
    unknown_slope: float = 1.0
    cases: int = 0

    def probabilities(self, logs: Mapping[str, float], unknown: float) -> dict[str, float]:
        """Probabilities of the keys of `logs` (natural log weights, `none` among them) and of `unknown`.

        `unknown` are its log odds against the best of the rest.
        """
        tempered = {name: self.temper * value for name, value in logs.items()}
        tempered["none"] += self.none
        tempered["unknown"] = max(tempered.values()) + self.unknown + self.unknown_slope * unknown
        top = max(tempered.values())
        weights = {name: math.exp(value - top) for name, value in tempered.items()}
        total = sum(weights.values())
        return {name: weight / total for name, weight in weights.items()}


@cache
def of_package() -> Calibration:
    """The calibration that comes with the package."""
    text = resources.files(__package__).joinpath("calibration.json").read_bytes()
    return msgspec.json.decode(text, type=Calibration)
