"""Ranges of parameters in units of a record's own impact, for chains unlike those of the catalogue.

The numbers of the catalogue (bounds, typical deviations) are those of beads of some millimetres that a
laboratory strikes. What a parameter does depends on its ratio to the impact's force, time and speed; where
one of these units is more than `FAR` times off the catalogue's own, a ball of half a kilogramme or a grain,
bounds and typical deviations are taken along with it, so that the same experiment at another size is searched
in the same way. Time constants of the electronics have no such unit, and stay.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from sonicvacuum.physics.scales import impact_scales

if TYPE_CHECKING:
    from sonicvacuum.effects.base import Effect, Parameter
    from sonicvacuum.physics.chain import Chain

# Force in N, contact time in s and speed in m/s in the middle of the chains that the catalogue was written
# for: steel, polymer and coated beads of 4 to 10 mm at 0.2 to 2 m/s (1 to 400 N, 20 to 200 us).
FORCE, TIME, SPEED = 30.0, 70e-6, 0.6
# Ranges of the catalogue span four decades and more: half of that is no reason to leave them.
FAR = 100.0


def _units(force: float, time: float, speed: float) -> dict[str, float]:
    """Unit of a parameter → size that goes with an impact; powers of speed as in the catalogue's middle."""
    return {
        "N": force,
        "us": time,
        "1/s": 1.0 / time,
        "um": speed * time,
        "s/m": 1.0 / speed,
        "kg/s": force / speed,
        "N (s/m)^alpha": force / speed**1.75,
    }


def ratios_of(chain: Chain) -> dict[str, float]:
    """Unit of a parameter → size of a record's impact over that of the catalogue's, where it is far off."""
    force, time = impact_scales(chain)
    own = _units(force, time, float(chain.speed.max()))
    usual = _units(FORCE, TIME, SPEED)
    ratios = {unit: own[unit] / usual[unit] for unit in own}
    return {unit: ratio for unit, ratio in ratios.items() if abs(math.log(ratio)) >= math.log(FAR)}


def sized(effect: Effect, ratios: Mapping[str, float]) -> Effect:
    """The effect with ranges that suit a record's nominal chains; the same where the catalogue's do.

    `ratios` are those of `ratios_of` these chains.
    """
    if not any(p.unit in ratios for p in effect.parameters):
        return effect
    parameters = tuple(_moved(p, ratios[p.unit]) if p.unit in ratios else p for p in effect.parameters)
    return effect if parameters == effect.parameters else replace(effect, parameters=parameters)


def _moved(parameter: Parameter, ratio: float) -> Parameter:
    """A parameter with its bounds and its typical deviation so many times as large."""
    if parameter.known or parameter.electronic:
        return parameter
    low, high = (
        min(max(ratio * x, parameter.least), parameter.most) for x in (parameter.low, parameter.high)
    )
    return replace(parameter, low=low, high=high, scale=ratio * parameter.scale)
