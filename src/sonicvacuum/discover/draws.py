"""Weighted draws of a verdict's parameters: quantiles, what they are worth, how far to trust them.

The draws stand in `posterior.csv` beside the verdict, one row for each draw and parameter; all that is told
of them is worked out of that table.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sonicvacuum.tables import read_csv, write_csv

FILE = "posterior.csv"
HEADER = ("effect", "parameter", "how", "value", "weight")
SAMPLED, VALLEY, PROFILE = "sampled", "valley", "profile"
LINEAR, AVERAGED = "linearised", "averaged"
PLACES = "places"
# Above this the weights have tails too heavy for an average over them (Vehtari et al., J. Mach. Learn. Res.
# 25(72), 2024, section 3).
TRUSTED = 0.7
# Shares of a Gaussian that lie below one standard deviation to either side.
MIDDLE = (0.158655, 0.841345)


@dataclass(frozen=True)
class Draws:
    """What the data say of one parameter.

    Attributes:
        effect, parameter: whose.
        how: "sampled": draws that all parameters have in common; "valley": a grid of values, weighed by the
            misfit along the valley that two parameters leave; "profile": such a grid, each value weighed by
            the best that all else can do there; "linearised": weighed by the Gaussian of the fit; "averaged":
            the values of one of these, once for each explanation that has the parameter, put where that one's
            fit has it and weighed by its probability; "places": where the effect may sit.
        value: (n,) in the unit of the catalogue; beads, contacts, and gauges in the record's order from 0.
        weight: (n,) summing to 1.
    """

    effect: str
    parameter: str
    how: str
    value: np.ndarray
    weight: np.ndarray

    def quantile(self, share: float) -> float:
        """The value below which this share of the weight lies, linear between the draws."""
        order = np.argsort(self.value, kind="stable")
        weight = self.weight[order]
        return float(np.interp(share, np.cumsum(weight) - 0.5 * weight, self.value[order]))

    @property
    def error(self) -> float:
        """Half of what holds the middle 68 % of the weight: of a Gaussian its standard deviation."""
        return 0.5 * (self.quantile(MIDDLE[1]) - self.quantile(MIDDLE[0]))

    @property
    def effective(self) -> float:
        """Number of equally weighted draws that say as much (Kish)."""
        return effective(self.weight)


def effective(weight: np.ndarray) -> float:
    """(Σw)² / Σw² of weights (n,), between 1 and n."""
    return float(weight.sum() ** 2 / np.square(weight).sum())


def pareto_k(weight: np.ndarray) -> float:
    """Shape of the generalised Pareto distribution of the largest weights; infinite where they are too few,
    and minus infinity where nearly all of them are equal: nothing has a thinner tail.

    The estimator of Zhang & Stephens, Technometrics 51, 316 (2009), on as many as Vehtari et al. (J. Mach.
    Learn. Res. 25(72), 2024) take: min(n / 5, 3 √n). Draws are to be trusted below `TRUSTED`.
    """
    ordered = np.sort(weight[weight > 0.0])
    tail = math.ceil(min(0.2 * len(ordered), 3.0 * math.sqrt(len(ordered))))
    if tail < 5:
        return math.inf
    excess = ordered[-tail:] - ordered[-tail - 1]
    excess = excess[excess > 0.0]
    tail = len(excess)
    if tail < 5:
        return -math.inf
    # Theirs, equations (4) to (8): b = k / scale weighed over a grid by its profile likelihood.
    grid = 30 + int(math.sqrt(tail))
    quarter = excess[int(tail / 4 + 0.5) - 1]
    b = 1.0 / excess[-1] + (1.0 - np.sqrt(grid / (np.arange(grid) + 0.5))) / (3.0 * quarter)
    k = np.log1p(-b[:, None] * excess).mean(axis=1)
    likelihood = tail * (np.log(-b / k) - k - 1.0)
    share = 1.0 / np.exp(likelihood - likelihood[:, None]).sum(axis=1)
    return float(np.log1p(-(share @ b) * excess).mean())


def write(folder: Path, draws: Sequence[Draws]) -> None:
    """Write `posterior.csv`; nothing where there are no draws."""
    if draws:
        write_csv(folder / FILE, HEADER, _rows(draws))


def _rows(draws) -> Iterator[tuple[str, ...]]:
    for one in draws:
        for value, weight in zip(one.value, one.weight, strict=True):
            yield one.effect, one.parameter, one.how, f"{value:.7g}", f"{weight:.7g}"


def read(folder: Path) -> dict[tuple[str, str], Draws]:
    """(effect, parameter) → its draws; {} for a folder without `posterior.csv`."""
    path = Path(folder) / FILE
    rows: dict[tuple[str, str, str], list[tuple[str, str]]] = {}
    for r in read_csv(path, "run sonicvacuum discover again") if path.exists() else ():
        rows.setdefault((r["effect"], r["parameter"], r["how"]), []).append((r["value"], r["weight"]))
    found = {}
    for (effect, parameter, how), pairs in rows.items():
        value, weight = np.array(pairs, dtype=float).T
        found[effect, parameter] = Draws(effect, parameter, how, value, weight / weight.sum())
    return found
