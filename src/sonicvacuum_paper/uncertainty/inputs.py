"""What the paper leaves open of its own experiment, and how far each of it is drawn.

A printed bound or rounding is taken as such; what the paper does not state has the spread written here, with
its reason. All numbers of one draw belong together: one chain, one set of gauges, one reader of the traces.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sonicvacuum_paper.printed import PRINTED

SEED = 20060226  # the paper's article number and year
DRAWS = 192


@dataclass(frozen=True)
class Input:
    """One thing that is drawn.

    Attributes:
        name: in the draws.
        title: in words.
        draw: (generator, number of draws) → values.
        spread: in words.
        reason: where the spread is from.
    """

    name: str
    title: str
    draw: Callable[[np.random.Generator, int], np.ndarray]
    spread: str
    reason: str


def _normal(width):
    return lambda random, count: random.normal(0.0, width, count)


def _uniform(low, high):
    return lambda random, count: random.uniform(low, high, count)


def _factor(width):
    return lambda random, count: np.exp(random.normal(0.0, width, count))


def _apart(random, count):
    """Relative error of the distance between two gauges, each within the printed bound of its place."""
    apart = (PRINTED.gauge_upper - PRINTED.gauge_lower) * PRINTED.bead_diameter
    return random.uniform(-PRINTED.gauge_offset, PRINTED.gauge_offset, (2, count)).sum(axis=0) / apart


INPUTS = (
    Input(
        "apart",
        "distance between the gauges, coated chain",
        _apart,
        "±1 mm each, uniform",
        "printed; one error for all speeds of the chain",
    ),
    Input("apart_bare", "the same, bare steel chain", _apart, "±1 mm each, uniform", "printed; other beads"),
    Input(
        "level",
        "level at which durations are read",
        lambda random, count: np.exp(random.uniform(np.log(0.01), np.log(0.05), count)),
        "log-uniform, 1 to 5 % of the peak",
        "not stated; lower drowns in a drawn line, higher is no base",
    ),
    Input(
        "gain", "calibration of all gauges", _factor(0.05), "5 %", "not stated; from one impact on the wall"
    ),
    Input("gain_g9", "that of g9 against the wall", _factor(0.03), "3 %", "not stated; from comparison"),
    Input("gain_g5", "that of g5 against the wall", _factor(0.03), "3 %", "not stated; from comparison"),
    Input("droop", "discharge time of the gauges", _factor(0.3), "30 % of 1000 µs", 'printed as "~10³"'),
    Input(
        "weight",
        "share of the weight that the contacts bear",
        _uniform(0.8, 1.0),
        "uniform, 0.8 to 1",
        "not stated; the holder may carry some by friction",
    ),
    Input("bead_mass", "mass of the beads", _normal(0.29), "rounding of 0.01 g", "printed digits"),
    Input(
        "striker_mass", "mass of the striker", _normal(0.29), "rounding of its last digit", "printed digits"
    ),
    Input("speed", "speed of the striker", _factor(0.01), "1 %", "rounding of 0.44 m/s, and its guide"),
    Input(
        "parylene-c",
        "modulus of the coating",
        _factor(0.05),
        "5 % of each model's",
        "handbooks; as in the record",
    ),
    Input("stainless-steel", "modulus of the steel", _factor(0.05), "5 %", "bearing steels, 193 to 210 GPa"),
    Input("alumina", "modulus of the striker", _factor(0.1), "10 %", "sintered alumina, 300 to 400 GPa"),
    Input("thickness", "thickness of the coating", _factor(0.1), "10 %", "not stated; usual for such films"),
    Input("reading", "reading of a duration off a trace", _normal(0.05), "5 %", 'printed as "about 130"'),
)


def draws(count: int = DRAWS, seed: int = SEED) -> dict[str, np.ndarray]:
    """Input → (count,) values; each input has a random stream of its own."""
    streams = np.random.SeedSequence(seed).spawn(len(INPUTS))
    return {
        one.name: one.draw(np.random.default_rng(stream), count)
        for one, stream in zip(INPUTS, streams, strict=True)
    }


def neutral(count: int = 1) -> dict[str, np.ndarray]:
    """Draws in which everything is as printed, or as the ladder takes it."""
    factors = {one.name: np.ones(count) for one in INPUTS}
    shifts = ("apart", "apart_bare", "bead_mass", "striker_mass", "reading")
    return factors | {name: np.zeros(count) for name in shifts} | {"level": np.full(count, 0.02)}
