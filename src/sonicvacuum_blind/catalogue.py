"""The catalogue's effects a second time, as changes of a `Plan`, each with a strength that grows from 0.

Formulas and parameter names are those of the public catalogue (ids, units in the names); nothing is imported
from its code. `Entry.values` maps a strength in the effect's natural unit for that impact to parameters, so
that a root search can scale any effect to a wanted signal-to-noise ratio.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.laboratory.specimen import GRAVITY
from sonicvacuum_blind.plan import Plan

MICRO = 1e-6


@dataclass(frozen=True)
class Entry:
    """One effect.

    Attributes:
        id: as in the catalogue.
        values: (strength, plan, shape) → parameters; strength is signed where `signs` has both signs.
        put: (plan, place, **parameters) → plan.
        start: strength that changes the readings by very roughly a per cent.
        most: largest strength.
        signs: (1,) or (1, -1).
        shapes: values of what only shapes the effect, at which rivals are tried; None for nothing to shape.
        draw: (random generator, plan) → one shape.
        places: None, "bead", "contact" or "sensor".
        fits: plan → whether it can act there.
        gauges: kinds of gauges at which it can sit.
        coated: whether it acts on coated beads alone.
    """

    id: str
    values: Callable[[float, Plan, float | None], dict[str, float]]
    put: Callable[..., Plan]
    start: float
    most: float
    signs: tuple[int, ...] = (1,)
    shapes: Callable[[Plan], tuple] = lambda plan: (None,)
    draw: Callable[[np.random.Generator, Plan], float | None] = lambda random, plan: None
    places: str | None = None
    fits: Callable[[Plan], bool] = lambda plan: True
    gauges: tuple[str, ...] = ("embedded", "wall")
    coated: bool = False

    def where(self, plan: Plan) -> tuple:
        """Places at which the effect can sit."""
        if self.places == "sensor":
            return tuple(g.id for g in plan.gauges if g.kind in self.gauges)
        return tuple(range(1, plan.beads + 1)) if self.places else (None,)

    def acts(self, plan: Plan, coated: bool) -> bool:
        """Whether it can act there; `coated`: whether the laboratory states a coating of its beads."""
        return (coated or not self.coated) and self.fits(plan) and bool(self.where(plan))


def _law(name, key=None, unit=1.0):
    """`put` of an effect that is one number of the force law."""
    return lambda plan, place, **p: plan.with_law(**{name: p[key] * unit})


def _one(key, unit=lambda plan: 1.0):
    return lambda s, plan, shape: {key: s * unit(plan)}


def _ratio(key):
    return lambda s, plan, shape: {key: math.exp(s)}


def _dashpot_unit(plan):
    return plan.bead_mass / plan.contact_time


def _gauge(plan, place, **changes):
    """The plan with numbers of the gauge `place` changed."""
    return replace(plan, gauges=tuple(replace(g, **changes) if g.id == place else g for g in plan.gauges))


def _gain_of(plan, place):
    return next(g.gain for g in plan.gauges if g.id == place)


def _velocity_power(s, plan, alpha):
    # As large as a dashpot at the striker's speed.
    return {"gamma": s * _dashpot_unit(plan) * plan.speed ** (1.0 - alpha), "alpha": alpha}


def _striker(s, plan, which):
    return {"speed_ratio": 1.0, "mass_ratio": 1.0, which: math.exp(s)}


def _gravity(s, plan, shape):
    return {"fraction": 1.0 - s if plan.gravity else s}


def _loose(plan):
    return plan.gravity == 0.0 and plan.static_force == 0.0


def _chained(plan):
    return plan.beads > 0


ENTRIES = (
    Entry(
        "dynamic-modulus",
        _ratio("modulus_ratio"),
        lambda plan, place, modulus_ratio: replace(plan, modulus_ratio=plan.modulus_ratio * modulus_ratio),
        0.03,
        2.3,
        (1, -1),
    ),
    Entry(
        "contact-exponent",
        lambda s, plan, shape: {"exponent": 1.5 + s},
        _law("exponent", "exponent"),
        0.01,
        0.35,
        (1, -1),
    ),
    Entry(
        "coating-thickness",
        lambda s, plan, shape: {"layer_thickness_um": 1.0 / s},
        lambda plan, place, layer_thickness_um: plan.with_law(
            inverse_layer=1.0 / (layer_thickness_um * MICRO)
        ),
        1e-4,
        0.2,
        coated=True,
    ),
    Entry("plastic-contact", _one("residual_fraction"), _law("residual", "residual_fraction"), 0.005, 0.8),
    Entry("linear-dashpot", _one("damping_kg_s", _dashpot_unit), _law("dashpot", "damping_kg_s"), 0.003, 1.0),
    Entry(
        "kuwabara-kono",
        _one("time_us", lambda plan: plan.contact_time / MICRO),
        _law("viscous_time", "time_us", MICRO),
        0.003,
        1.0,
    ),
    Entry("tsuji", _one("alpha"), _law("tsuji", "alpha"), 0.003, 1.5),
    Entry(
        "hunt-crossley",
        _one("damping_s_per_m", lambda plan: 1.0 / plan.speed),
        _law("hunt_crossley", "damping_s_per_m"),
        0.005,
        1.0,
    ),
    Entry(
        "velocity-power",
        _velocity_power,
        lambda plan, place, gamma, alpha: plan.with_law(power_damping=gamma, power_of_rate=alpha),
        0.005,
        2.0,
        shapes=lambda plan: (1.2, 1.35, 1.5, 1.65, 1.8, 1.95, 2.1, 2.2, 2.3, 2.4, 2.5),
        draw=lambda random, plan: random.uniform(1.3, 2.4),
    ),
    Entry(
        "relaxing-contact",
        lambda s, plan, tau: {"strength": s, "tau_us": tau},
        lambda plan, place, strength, tau_us: plan.with_law(
            relaxing=strength, relaxation_rate=1.0 / (tau_us * MICRO)
        ),
        0.02,
        5.0,
        shapes=lambda plan: tuple(plan.contact_time / MICRO * f for f in np.geomspace(0.3, 45.0, 12)),
        draw=lambda random, plan: plan.contact_time / MICRO * math.exp(random.uniform(*np.log([0.5, 20.0]))),
    ),
    Entry(
        "viscous-drag",
        _one("rate_per_s", lambda plan: 1.0 / plan.contact_time),
        _law("drag", "rate_per_s"),
        5e-4,
        0.1,
        fits=_chained,
    ),
    Entry(
        "guide-friction",
        _one("force_N", lambda plan: plan.force_scale),
        _law("friction", "force_N"),
        5e-4,
        0.1,
        fits=_chained,
    ),
    Entry(
        "static-preload",
        _one("force_N", lambda plan: plan.force_scale),
        lambda plan, place, force_N: replace(plan, static_force=plan.static_force + force_N),
        1e-3,
        1.0,
        fits=_chained,
    ),
    Entry(
        "gravity",
        _gravity,
        lambda plan, place, fraction: replace(plan, gravity=GRAVITY * fraction),
        0.3,
        1.0,
        fits=_chained,
    ),
    Entry(
        "contact-gap",
        _one("gap_um", lambda plan: plan.contact_time * plan.speed / MICRO),
        lambda plan, place, gap_um: replace(plan, gaps=((place, gap_um * MICRO),)),
        0.02,
        5.0,
        places="contact",
        fits=_loose,
    ),
    Entry(
        "mass-defect",
        _ratio("mass_ratio"),
        lambda plan, place, mass_ratio: replace(plan, mass_ratios=((place, mass_ratio),)),
        0.05,
        1.1,
        (1, -1),
        places="bead",
    ),
    Entry(
        "wall-compliance",
        _ratio("stiffness_ratio"),
        lambda plan, place, stiffness_ratio: replace(plan, stiffness_ratios=((plan.beads, stiffness_ratio),)),
        0.05,
        3.0,
        (1, -1),
    ),
    Entry(
        "striker-error",
        _striker,
        lambda plan, place, speed_ratio, mass_ratio: replace(
            plan, speed=plan.speed * speed_ratio, striker_mass=plan.striker_mass * mass_ratio
        ),
        0.02,
        0.6,
        (1, -1),
        shapes=lambda plan: ("speed_ratio", "mass_ratio"),
        draw=lambda random, plan: str(random.choice(["speed_ratio", "mass_ratio"])),
    ),
    Entry(
        "sensor-lowpass",
        _one("tau_us", lambda plan: plan.contact_time / MICRO),
        lambda plan, place, tau_us: plan.with_electronics(lowpass=tau_us * MICRO),
        0.02,
        3.0,
        fits=_chained,
    ),
    Entry(
        "sensor-droop",
        lambda s, plan, shape: {"tau_us": plan.contact_time / MICRO / s},
        lambda plan, place, tau_us: plan.with_electronics(inverse_droop=1.0 / (tau_us * MICRO)),
        2e-3,
        0.5,
        fits=_chained,
    ),
    Entry(
        "sensor-gain",
        _ratio("gain_ratio"),
        lambda plan, place, gain_ratio: _gauge(plan, place, gain=_gain_of(plan, place) * gain_ratio),
        0.02,
        1.4,
        (1, -1),
        places="sensor",
    ),
    Entry(
        "sensor-offset",
        lambda s, plan, shape: {"offset_fraction": s},
        lambda plan, place, offset_fraction: _gauge(plan, place, offset=offset_fraction),
        0.02,
        0.48,
        (1, -1),
        places="sensor",
        gauges=("embedded",),
    ),
)
BY_ID = {e.id: e for e in ENTRIES}
# What the studies hide and hold a hidden effect against, in the order in which their cases were drawn: a
# further entry is another study.
STUDIED = (
    "dynamic-modulus",
    "contact-exponent",
    "coating-thickness",
    "plastic-contact",
    "linear-dashpot",
    "kuwabara-kono",
    "tsuji",
    "hunt-crossley",
    "velocity-power",
    "relaxing-contact",
    "viscous-drag",
    "guide-friction",
    "static-preload",
    "gravity",
    "contact-gap",
    "mass-defect",
    "wall-compliance",
    "striker-error",
    "sensor-lowpass",
    "sensor-droop",
    "sensor-gain",
    "sensor-offset",
)


def hidden(entry: Entry, strength: float, shape, place, reference: Plan) -> Callable[[Plan], Plan]:
    """The effect as a map of plans; natural units are those of the `reference` impact."""
    parameters = entry.values(strength, reference, shape)
    return lambda plan: entry.put(plan, place, **parameters)
