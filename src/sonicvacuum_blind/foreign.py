"""Effects outside the catalogue, to test whether `discover` says unknown rather than give a wrong name.

Each is a map of plans with one strength that grows from 0, made like `catalogue.Entry`.
"""

from dataclasses import replace

from sonicvacuum_blind.catalogue import Entry
from sonicvacuum_blind.plan import Plan


def _graded(plan, place, contrast):
    """Contact stiffness that changes evenly from striker to wall, the mean kept."""
    steps = [(c, 1.0 + contrast * (2.0 * c / plan.beads - 1.0)) for c in range(1, plan.beads)]
    return replace(plan, stiffness_ratios=tuple(steps))


def _dimer(plan, place, contrast):
    """Beads alternately heavier and lighter."""
    steps = [(b, 1.0 + contrast * (-1) ** b) for b in range(1, plan.beads + 1)]
    return replace(plan, mass_ratios=tuple(steps))


def _two_defects(plan, place, contrast):
    """A heavy and a light bead."""
    first, second = plan.beads // 3, 2 * plan.beads // 3
    return replace(plan, mass_ratios=((first, 1.0 + contrast), (second, 1.0 / (1.0 + contrast))))


def _resonant_wall(plan, place, compliance):
    """The wall is a mass of five beads on a spring; compliance is relative to the chain's."""
    mass = 5.0 * plan.bead_mass
    stiffness = plan.force_scale / (plan.contact_time * plan.speed) / compliance
    damping = 0.1 * (mass * stiffness) ** 0.5
    return plan.with_law(wall_mass=mass, wall_stiffness=stiffness, wall_damping=damping)


def _double_hit(plan, place, force):
    """A second, lighter knock on bead 1 while the wave is on its way."""
    return plan.with_law(push=(force * plan.force_scale, 2.5 * plan.contact_time, 4.0 * plan.contact_time))


def _adhesion(plan, place, share):
    """Contacts stick: an attraction k δ^{3/4}, `share` of the elastic force at the impact's own depth."""
    depth = plan.contact_time * plan.speed
    return plan.with_law(adhesion=share * plan.force_scale / depth**0.75)


def _log_rate(plan, place, slope):
    """The contact stiffens with the logarithm of the approach rate."""
    return plan.with_law(log_rate=slope, log_speed=1e-2)


def _damping(depth, rate):
    """Strength and change of a damping β δ^depth |v|^rate sign v; a strength of 1 is as large as the elastic
    force at the impact's depth and speed.
    """

    def values(s, plan, shape):
        return {"beta_SI": s * plan.force_scale / (_depth(plan) ** depth * plan.speed**rate)}

    def put(plan, place, beta_SI):
        return plan.with_law(mixed=beta_SI, mixed_depth=depth, mixed_rate=rate)

    return values, put


def _depth(plan):
    """Compression in m of the impact, roughly."""
    return plan.contact_time * plan.speed


def _saturating(plan, place, inverse_limit):
    return plan.with_electronics(inverse_limit=inverse_limit)


def _bent(plan, place, per_N):
    return plan.with_electronics(bend=per_N)


def _lagging(plan, place, share, width_N):
    return plan.with_electronics(lag_share=share, play=width_N)


def _strength(name, unit=lambda plan: 1.0):
    return lambda s, plan, shape: {name: s * unit(plan)}


def _inverse_force(plan: Plan) -> float:
    return 1.0 / plan.force_scale


def _entry(name, values, put, start, most):
    return Entry(name, values, put, start, most, fits=lambda plan: plan.beads > 5)


ENTRIES = (
    _entry("graded-modulus", _strength("contrast"), _graded, 0.05, 0.8),
    _entry(
        "quadratic-drag",
        _strength("per_m", lambda p: 1.0 / (p.speed * p.contact_time)),
        lambda plan, place, per_m: plan.with_law(quadratic_drag=per_m),
        1e-3,
        1.0,
    ),
    _entry("adhesion", _strength("share"), _adhesion, 1e-3, 0.3),
    _entry("dimer", _strength("contrast"), _dimer, 0.05, 0.7),
    _entry("log-rate-stiffening", _strength("slope"), _log_rate, 0.01, 1.0),
    _entry("sensor-saturation", _strength("inverse_limit", _inverse_force), _saturating, 0.1, 5.0),
    _entry("sensor-nonlinearity", _strength("per_N", _inverse_force), _bent, 0.02, 1.0),
    _entry("resonant-wall", _strength("compliance"), _resonant_wall, 0.1, 30.0),
    _entry("two-defects", _strength("contrast"), _two_defects, 0.05, 2.0),
    _entry(
        "piezo-hysteresis",
        lambda s, plan, shape: {"share": s, "width_N": 0.1 * plan.force_scale},
        _lagging,
        0.1,
        0.9,
    ),
    _entry("double-hit", _strength("force"), _double_hit, 0.01, 1.0),
    _entry(
        "sensor-crosstalk",
        _strength("share"),
        lambda plan, place, share: plan.with_electronics(crosstalk=share),
        0.01,
        0.5,
    ),
    _entry(
        "hardening",
        _strength("per_m", lambda p: 1.0 / _depth(p)),
        lambda plan, place, per_m: plan.with_law(hardening=per_m),
        0.01,
        2.0,
    ),
    _entry("depth-damping", *_damping(1.0, 1.0), 0.01, 2.0),
    _entry("root-rate-damping", *_damping(0.5, 0.5), 0.01, 2.0),
    _entry("square-rate-damping", *_damping(1.5, 2.0), 0.01, 2.0),
    _entry(
        "baseline-drift",
        _strength("N_per_s", lambda p: p.force_scale / p.contact_time),
        lambda plan, place, N_per_s: plan.with_electronics(drift=N_per_s),
        1e-4,
        0.05,
    ),
)
BY_ID = {e.id: e for e in ENTRIES}
# What the studies hide, in the order in which their cases were drawn.
STUDIED = (
    "graded-modulus",
    "quadratic-drag",
    "adhesion",
    "dimer",
    "log-rate-stiffening",
    "sensor-saturation",
    "sensor-nonlinearity",
    "resonant-wall",
    "two-defects",
    "piezo-hysteresis",
    "double-hit",
    "sensor-crosstalk",
    "baseline-drift",
)
# Contact laws among them that only push, which a law of no particular form may stand for. (Adhesion pulls.)
LAWS = (
    "log-rate-stiffening",
    "hardening",
    "depth-damping",
    "root-rate-damping",
    "square-rate-damping",
)
