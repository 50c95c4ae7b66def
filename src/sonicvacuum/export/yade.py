"""YADE: Hertz–Mindlin contact with a damping ratio, or with a restitution that falls with speed.

At a wall, YADE takes the ball's own radius for the wall's (`Ig2_Wall_Sphere_ScGeom`, unless `hertzian`), so
that R* is half the radius; Young's modulus is written √2 larger to keep the contact's K. The force is cut at
zero. The restitution `en` is turned into β_n by a fit, and in older versions by another formula: β_n itself
is written.
"""

import math

from sonicvacuum.export.base import MOTION, Ball, Law, Number, Simulator, Written, shown
from sonicvacuum.physics.impact import viscoelastic_number, viscoelastic_restitution

WALL = math.sqrt(2.0)
NOTES = (
    "young is for a Wall or Facet with the default radius of Ig2_Wall_Sphere_ScGeom (R* is half the ball's): "
    "divide it by 2^{1/2} with hertzian walls, and for two balls",
    "NewtonIntegrator(damping=0): its default is a numerical damping besides the contact's",
)


def _written(ball, numbers):
    young = WALL * ball.modulus
    given = ", ".join(f"{n.name}={shown(n.value)}" for n in numbers)
    material = f"young={shown(young)}, poisson={shown(ball.poisson)}, density={shown(ball.density)}"
    lines = (
        f"O.materials.append(FrictMat({material}, frictionAngle=0))",
        "InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],",
        f"    [Ip2_FrictMat_FrictMat_MindlinPhys({given})], [Law2_ScGeom_MindlinPhys_Mindlin()])",
        "NewtonIntegrator(damping=0)",
    )
    return Written(
        (Number("young", young, "Pa"), Number("poisson", ball.poisson, "1"), *numbers),
        lines,
        NOTES,
    )


def ratio(ball: Ball, parameters: dict[str, float]) -> Written:
    """Damping c_n = 2 β_n √(m k_n) with the tangent k_n = (3/2) K √δ, hence β_n = α/√6."""
    return _written(ball, (Number("betan", parameters["alpha"] / math.sqrt(6.0), "1"),))


def falling(ball: Ball, parameters: dict[str, float]) -> Written:
    """The restitution `en` at the speed `vn` from which YADE finds A; ValueError without damping.

    YADE inverts the approximant that is evaluated here, so that its A is the effect's.
    """
    if not parameters["time_us"] > 0.0:
        return ratio(ball, {"alpha": 0.0})
    time = parameters["time_us"] * 1e-6
    x = viscoelastic_number(time, ball.stiffness, ball.mass, ball.speed)
    en = float(viscoelastic_restitution(x))
    return _written(ball, (Number("en", en, "1"), Number("vn", ball.speed, "m/s")))


SIMULATOR = Simulator(
    id="yade",
    title="YADE",
    reference="yade-dem.org/doc: Ip2_FrictMat_FrictMat_MindlinPhys, Law2_ScGeom_MindlinPhys_Mindlin",
    read="yade-dev/trunk: pkg/dem/HertzMindlin.cpp and the class documentation in HertzMindlin.hpp, with vn; "
    "Ig2_Wall_Sphere_ScGeom in pkg/dem, as stored in public mirrors",
    laws=(
        Law(
            "tsuji",
            "Law2_ScGeom_MindlinPhys_Mindlin, betan",
            "F = (4/3) E* R*^{1/2} u^{3/2} + 2 betan (m k_n)^{1/2} v, k_n = 2 E* (R* u)^{1/2}, cut at zero",
            MOTION,
            ratio,
        ),
        Law(
            "kuwabara-kono",
            "Law2_ScGeom_MindlinPhys_Mindlin, en at vn",
            "F = K u^{3/2} + A k_n v, k_n = (3/2) K u^{1/2}, A = (2/3) s^2 vn^{-1/5} (K/m)^{-2/5}, en the "
            "Padé approximant of Müller (2011) at s, cut at zero",
            MOTION,
            falling,
        ),
    ),
    lacks="a dashpot on a Hertz spring, damping in proportion to the elastic force, a power of velocity, "
    "relaxation",
)
