"""LAMMPS: granular wall and pair styles, Hertz with four kinds of damping.

At a wall, m_eff is the ball's mass and R_eff its radius (fix wall/gran). The law `tsuji` is written with
`damping coeff_restitution`, whose formula is exact and the same in every version; the polynomial of `damping
tsuji` lacked a factor √2 before the version of 2 September 2026, so that one input means two laws.
"""

from sonicvacuum.export.base import MOTION, Ball, Law, Number, Simulator, Written, shown
from sonicvacuum.physics.impact import tsuji_ratio, uncut_restitution

PER_MASS = "eta_n0 is multiplied by m_eff: for balls of another mass, or two balls, work it out anew"


def _lines(ball, coefficient, damping):
    """A ball on the plane z = 0; `limit_damping` keeps the contact from pulling."""
    normal = f"hertz {shown(ball.stiffness / ball.radius**0.5)} {shown(coefficient)}"
    law = f"{normal} tangential linear_nohistory 0.0 0.0 damping {damping} limit_damping"
    return ("units si", "atom_style sphere", f"fix wall all wall/gran granular {law} zplane 0.0 NULL")


def _stiffness(ball):
    return Number("k_n", ball.stiffness / ball.radius**0.5, "Pa")


def tsuji(ball: Ball, parameters: dict[str, float]) -> Written:
    """`damping coeff_restitution`: the e that has the effect's α; ValueError from critical damping on."""
    e = uncut_restitution(tsuji_ratio(parameters["alpha"]))
    note = (
        "e is the restitution of a contact that may pull at its end; with limit_damping the ball keeps more"
    )
    return Written(
        (_stiffness(ball), Number("e", e, "1")),
        _lines(ball, e, "coeff_restitution"),
        (note,),
    )


def viscoelastic(ball: Ball, parameters: dict[str, float]) -> Written:
    """`damping viscoelastic`: η = η_n0 a m_eff with a = √(R δ), hence η_n0 = (3/2) A K/(√R m)."""
    eta = 1.5e-6 * parameters["time_us"] * ball.stiffness / (ball.radius**0.5 * ball.mass)
    older = (
        f"hertz/history {shown(ball.stiffness / ball.radius**0.5)} NULL {shown(eta)} NULL 0.0 0 limit_damping"
    )
    same = f"the same in the older style: fix wall all wall/gran {older} zplane 0.0 NULL"
    return Written(
        (_stiffness(ball), Number("eta_n0", eta, "1/(m s)")),
        _lines(ball, eta, "viscoelastic"),
        (PER_MASS, same),
    )


def dashpot(ball: Ball, parameters: dict[str, float]) -> Written:
    """`damping velocity`: η = η_n0."""
    eta = parameters["damping_kg_s"]
    return Written((_stiffness(ball), Number("eta_n0", eta, "kg/s")), _lines(ball, eta, "velocity"))


SIMULATOR = Simulator(
    id="lammps",
    title="LAMMPS",
    reference="docs.lammps.org: pair_style granular and its page on damping models, "
    "pair_style gran/hertz/history, fix wall/gran",
    read="lammps/lammps: doc/src/fix_wall_gran.rst (0136c2b6), pair_gran.rst (13be68ae), pair_granular.rst "
    "(02dde6e3), the page on granular damping models of September 2026; "
    "src/GRANULAR/gran_sub_mod_damping.cpp and gran_sub_mod_damping_kernel.h (07b704ca)",
    laws=(
        Law(
            "tsuji",
            "granular hertz, damping coeff_restitution",
            "F = k_n R^{1/2} delta^{3/2} - 2 (5/6)^{1/2} ln e/(pi^2 + ln^2 e)^{1/2} ((3/2) k m_eff)^{1/2} v, "
            "k = k_n (R delta)^{1/2}, cut at zero",
            MOTION,
            tsuji,
        ),
        Law(
            "kuwabara-kono",
            "granular hertz, damping viscoelastic",
            "F = k_n R^{1/2} delta^{3/2} + eta_n0 (R delta)^{1/2} m_eff v, cut at zero",
            MOTION,
            viscoelastic,
        ),
        Law(
            "linear-dashpot",
            "granular hertz, damping velocity",
            "F = k_n R^{1/2} delta^{3/2} + eta_n0 v, cut at zero",
            MOTION,
            dashpot,
        ),
    ),
    lacks="damping in proportion to the elastic force, a power of velocity, relaxation; its plastic model "
    "(mdr) is another than plastic-contact",
)
