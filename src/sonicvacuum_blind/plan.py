"""One impact as hidden-effect data sees it: bodies, contacts, gauges, and everything that may be wrong with
them.

A `Plan` holds plain numbers in SI units; `problem` turns it into what the integrator takes. Bodies count from
the striker (0), contact c joins body c and c + 1, the last contact is the wall. With `beads` 0 the striker is
a ball that hits the wall.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from sonicvacuum_blind.integrate import Problem
from sonicvacuum_blind.laws import B, C, compression_at_rest, hertz_rows
from sonicvacuum_blind.layer import DEGREE, polynomial

REFERENCE = 1e-6  # m; compression at which all powers of the contact law give the Hertz force


@dataclass(frozen=True)
class Solid:
    """What a body is made of where it touches: Young's modulus in Pa, Poisson's ratio."""

    name: str
    modulus: float
    poisson: float


@dataclass(frozen=True)
class Gauge:
    """A gauge, "embedded" in a bead or at the "wall"; `offset` is ε of (½ + ε) F_before + (½ − ε) F_after."""

    id: str
    kind: str
    bead: int | None = None
    gain: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Plan:
    """One impact.

    Attributes:
        beads: number of beads.
        bead, striker, wall: what they are made of.
        bead_radius, striker_radius: m; `math.inf` for a flat striker.
        bead_mass, striker_mass: kg.
        speed: m/s of the striker.
        gravity: m/s² towards the wall.
        static_force: preload on bead 1 in N.
        core: what lies under the beads' coating; None for solid beads, or a rigid one.
        gauges: what reads it.
        modulus_ratio: on the modulus of every body made of the beads' material.
        mass_ratios, stiffness_ratios: (body, factor) and (contact, factor).
        gaps: (contact, opening in m).
        law: deviations of contact and bead laws from Hertz, keys in `problem`; and `push` (N, s, s),
            `wall_mass` kg with `wall_stiffness` N/m and `wall_damping` kg/s.
        electronics: deviations of all gauges from ideal ones, keys in `gauges.read`.
    """

    beads: int
    bead: Solid
    striker: Solid
    wall: Solid
    bead_radius: float
    striker_radius: float
    bead_mass: float
    striker_mass: float
    speed: float
    gravity: float = 0.0
    static_force: float = 0.0
    core: Solid | None = None
    gauges: tuple[Gauge, ...] = ()
    modulus_ratio: float = 1.0
    mass_ratios: tuple[tuple[int, float], ...] = ()
    stiffness_ratios: tuple[tuple[int, float], ...] = ()
    gaps: tuple[tuple[int, float], ...] = ()
    law: Mapping[str, float] = field(default_factory=dict, hash=False)
    electronics: Mapping[str, float] = field(default_factory=dict, hash=False)

    def with_law(self, **numbers) -> "Plan":
        """The plan with more deviations of the force laws."""
        return replace(self, law={**self.law, **numbers})

    def with_electronics(self, **numbers) -> "Plan":
        """The plan with more deviations of the gauges."""
        return replace(self, electronics={**self.electronics, **numbers})

    def modulus(self, solid: Solid) -> float:
        """Plane-strain modulus E/(1 − ν²) in Pa."""
        ratio = self.modulus_ratio if solid.name == self.bead.name else 1.0
        return ratio * solid.modulus / (1.0 - solid.poisson**2)

    def radii(self) -> np.ndarray:
        """(contacts,) effective radius in m: 1/R = 1/R_1 + 1/R_2."""
        curvature = [1.0 / self.striker_radius, *[1.0 / self.bead_radius] * self.beads, 0.0]
        return 1.0 / (np.array(curvature[:-1]) + np.array(curvature[1:]))

    def stiffness(self) -> np.ndarray:
        """(contacts,) Hertz constant (4/3) E* √R in N/m^{3/2} (Johnson, Contact Mechanics, Eq. 4.23)."""
        moduli = [self.modulus(s) for s in (self.striker, *[self.bead] * self.beads, self.wall)]
        compliance = 1.0 / np.array(moduli)
        constant = 4.0 / 3.0 / (compliance[:-1] + compliance[1:]) * np.sqrt(self.radii())
        for contact, factor in self.stiffness_ratios:
            constant[contact] *= factor
        return constant

    def masses(self) -> np.ndarray:
        """(bodies,) kg."""
        mass = np.array([self.striker_mass, *[self.bead_mass] * self.beads])
        for body, factor in self.mass_ratios:
            mass[body] *= factor
        return mass

    @property
    def contact_time(self) -> float:
        """(m²/(K² v))^{1/5} in s, a third of the time that a Hertz impact lasts."""
        mass = self.bead_mass if self.beads else self.striker_mass
        return (mass**2 / (self.stiffness()[self.beads // 2] ** 2 * self.speed)) ** 0.2

    @property
    def force_scale(self) -> float:
        """m v / contact time in N, the order of the forces."""
        return (self.bead_mass if self.beads else self.striker_mass) * self.speed / self.contact_time


def problem(plan: Plan) -> Problem:
    """What the integrator takes, the chain at rest under its loads with the law in force."""
    rows, mass = contact_rows(plan), plan.masses()
    load = mass * plan.gravity
    if plan.beads:
        load[1] += plan.static_force
    borne = np.concatenate([[0.0], np.cumsum(load[1:])])
    opening = np.zeros(len(rows))
    for contact, gap in plan.gaps:
        # A bead above a gap is held by its support; the contacts below bear only what lies below.
        opening[contact] = gap
        load[contact] -= borne[contact]
        borne[contact:] -= borne[contact]
    rest = compression_at_rest(borne, rows)
    rest[0] = 0.0
    drag = body_rows(plan, mass)
    law = plan.law
    wall = (law.get("wall_stiffness", 0.0), law.get("wall_damping", 0.0))
    if "wall_mass" in law:
        mass = np.append(mass, law["wall_mass"])
        load = np.append(load, -borne[-1])
        drag = np.vstack([drag, np.zeros((1, drag.shape[1]))])
    return Problem(mass, load, rest - opening, rows, drag, plan.speed, law.get("push", (0.0, 0.0, 0.0)), wall)


def contact_rows(plan: Plan) -> np.ndarray:
    """(contacts, columns) numbers of the contact laws."""
    law, stiffness, mass = plan.law, plan.stiffness(), plan.masses()
    rows = hertz_rows(stiffness)
    exponent = law.get("exponent", 1.5)
    rows[:, C["exponent"]] = exponent
    rows[:, C["power"]] = stiffness * REFERENCE ** (1.5 - exponent)
    for name in (
        "residual",
        "dashpot",
        "power_damping",
        "relaxing",
        "relaxation_rate",
        "adhesion",
        "log_rate",
        "hardening",
        "mixed",
        "mixed_depth",
        "mixed_rate",
    ):
        rows[:, C[name]] = law.get(name, 0.0)
    rows[:, C["power_of_rate"]] = law.get("power_of_rate", 1.0)
    rows[:, C["log_speed"]] = law.get("log_speed", 1.0)
    rows[:, C["viscoelastic"]] = 1.5 * law.get("viscous_time", 0.0) * stiffness
    rows[:, C["hunt_crossley"]] = 1.5 * law.get("hunt_crossley", 0.0)
    inverse = np.append(1.0 / mass, 0.0)
    rows[:, C["tsuji"]] = law.get("tsuji", 0.0) * np.sqrt(stiffness / (inverse[:-1] + inverse[1:]))
    if law.get("inverse_layer", 0.0) > 0.0:
        rows[:, C["layer_width"] : C["layer_0"] + DEGREE + 1] = layer_columns(plan)
    return rows


def layer_columns(plan: Plan) -> np.ndarray:
    """(contacts, DEGREE + 2) numbers of the layer of thickness 1/`inverse_layer` on the beads' core.

    χ = √(R δ)/h between two beads as well, each layer taking half of δ on the radius 2R. The elasticity of
    striker and wall is in series at equal χ: Hertz force over force becomes (… + e)/(1 + e), e being the
    plane-strain modulus of the layer over that of the other body.
    """
    soft, core = plan.modulus(plan.bead), plan.core
    share = soft / (core.modulus / (1.0 - core.poisson**2)) if core else 0.0
    inverse = polynomial(plan.bead.poisson, share, core.poisson if core else plan.bead.poisson)
    facing = np.zeros(plan.beads + 1)
    facing[0] = soft / plan.modulus(plan.striker if plan.beads else plan.wall)
    facing[-1] = soft / plan.modulus(plan.wall)
    columns = np.tile(inverse, (len(facing), 1)) + facing[:, None] * np.eye(len(inverse))[0]
    width = np.sqrt(plan.radii()) * plan.law["inverse_layer"]
    return np.column_stack([width, columns / (1.0 + facing)[:, None]])


def body_rows(plan: Plan, mass: np.ndarray) -> np.ndarray:
    """(bodies, columns) numbers of drag and friction; the striker is free of both."""
    rows = np.zeros((len(mass), len(B)))
    rows[1:, B["drag"]] = plan.law.get("drag", 0.0)
    rows[1:, B["friction"]] = plan.law.get("friction", 0.0) / mass[1:]
    rows[1:, B["quadratic_drag"]] = plan.law.get("quadratic_drag", 0.0)
    return rows
