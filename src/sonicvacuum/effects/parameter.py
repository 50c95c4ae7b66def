"""One number that says how strong an effect is, or what shape it has: where it is off, where it is searched,
and what is refused.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from sonicvacuum.numerals import number_cure

if TYPE_CHECKING:
    from sonicvacuum.effects.base import Setup

PRIORS = ("log-uniform", "uniform", "log-normal", "normal")
# What is smaller, in any unit, has powers that are no numbers.
FAINTEST = 1e-100
# So many times the bounds of a search nothing has a meaning: steps become too many, or numbers overflow. Fits
# that run into a bound are followed for half of it (`discover.fit.bounds`).
FAR = 2e4
# What a record states with an error, and a parameter may do as well.
NUISANCES = (None, "modulus", "speed", "gain")


@dataclass(frozen=True)
class Parameter:
    """One continuous parameter of an effect, in the unit that its name ends with.

    Attributes:
        name: key in records, verdicts and calls.
        unit: of the values.
        off: value at which the parameter leaves the nominal model as it is, `math.inf` where the effect fades
            as the value grows; a function of the setup where the record says it; None for a parameter that
            only shapes an effect which another parameter switches on.
        low, high: bounds of the search.
        prior: one of `PRIORS`; "normal" and "log-normal" are centred at `off` with the width `scale`
            (relative for "log-normal"), the others lie between low and high.
        scale: typical deviation from `off`; typical value where `off` is None or infinite.
        help: one line.
        least, most: values outside [least, most] have no meaning and are refused, as are those beyond `FAR`
            times the bounds of the search, unless the effect fades there.
        acts_like: the nuisance of a record that this parameter, a ratio, moves exactly as: "modulus" of the
            beads' material, "speed" of the striker, "gain" of the gauge where the effect sits; None for none.
        least_strength: deviation over `scale` below which the effect is not what it is called (a gap opens at
            once), so that slopes are taken from there on; 0 where it sets in smoothly.
        tried_at_once: whether slopes at off mislead, so that finite values are tried as well; so it always is
            for effects at one bead or contact.
        bends: whether slopes at off tell little of finite values: where contacts bear next to nothing,
            a wave's speed goes as the sixth root of what they bear.
        linear: whether a positive parameter that is off at 0 is searched evenly, not by its logarithm.
        known: value, and its relative standard error, that a record states: where the effect acts the value
            lies within two of them. None: anything between low and high.
        scatters: whether beads that differ in mass do the same, each within what the record allows.
        electronic: whether it is of the electronics, whose times do not go with those of the impact.
    """

    name: str
    unit: str
    off: float | Callable[[Setup], np.ndarray] | None
    low: float
    high: float
    prior: str
    scale: float
    help: str
    least: float = -math.inf
    most: float = math.inf
    acts_like: str | None = None
    least_strength: float = 0.0
    tried_at_once: bool = False
    bends: bool = False
    linear: bool = False
    known: tuple[float, float] | None = None
    scatters: bool = False
    electronic: bool = False

    @property
    def switches(self) -> bool:
        """Whether the parameter has an off value."""
        return self.off is not None

    def off_in(self, setup: Setup):
        """Off value for a setup, a float or (lanes,) array; None for a parameter that only shapes."""
        return self.off(setup) if callable(self.off) else self.off

    def at(self, strength: float, setup: Setup):
        """Value at `strength` times the typical deviation: 0 is off, 1 is typical; linear near off.

        Where the effect fades as the value grows, the value is scale / strength. A parameter that only shapes
        stays at its typical value, one that cannot exceed `high` departs downwards.
        """
        off = self.off_in(setup)
        if off is None:
            return self.scale
        if np.all(np.isinf(off)):
            return self.scale / strength if strength else math.inf
        towards = np.where(off + self.scale > self.high, -1.0, 1.0)
        return off + towards * strength * self.scale

    @property
    def limits(self) -> tuple[float, float]:
        """The least and the largest value that is taken, both included, in the parameter's unit."""
        far = FAR * max(abs(self.low), abs(self.high))
        return max(self.least, -far), self.most if self.off == math.inf else min(self.most, far)

    def refused(self, value) -> str | None:
        """Why a number or (lanes,) numbers are not taken, with the cure, in a few words; None where they are.

        Infinity has a meaning only where the effect fades as the value grows.
        """
        if isinstance(value, str | bool):
            return f"is {value!r}, not a number{number_cure(value)}"
        values, (least, most) = np.asarray(value, dtype=float), self.limits
        bad = ~((values >= least) & (values <= most))
        faint = (values != 0.0) & (np.abs(values) < FAINTEST)
        if not np.any(bad | faint):
            return None
        told = f"is {values[bad | faint].flat[0]:g}; use a value from {least:g} to {most:g}"
        return told if np.any(bad) else f"{told}, none but 0 closer to 0 than {FAINTEST:g}"

    def check(self, value, effect: str):
        """Raise ValueError for a value that has no meaning: no number, none at all, or outside the limits."""
        if told := self.refused(value):
            raise ValueError(f"effect {effect}: {self.name} {told}")
