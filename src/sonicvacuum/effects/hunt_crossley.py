"""Contact damping in proportion to the elastic force."""

from sonicvacuum.effects.base import Effect, Parameter, Setup, add_term
from sonicvacuum.physics.laws import Term


def hunt_crossley_force(delta, rate, elastic, damping):
    """Force (3/2) c × elastic × rate in N."""
    return 1.5 * damping * elastic * rate


TERM = Term("hunt-crossley", "force", hunt_crossley_force, 1)


def coefficients(chain, stiffness, mass, damping):
    """c in s/m, the same in all contacts."""
    return [damping]


def change(setup: Setup, damping_s_per_m) -> Setup:
    """Multiply the elastic force of all contacts by 1 + (3/2) c v."""
    return add_term(setup, TERM, coefficients, damping=damping_s_per_m)


EFFECT = Effect(
    id="hunt-crossley",
    title="Damping in proportion to the force",
    missing="contact damping in proportion to the elastic force",
    equation="F = K delta^{3/2} (1 + (3/2) c v) in contact, cut at zero",
    energy="takes (3/2) c K delta^{3/2} v^2 per time and contact",
    reference="Hunt & Crossley, J. Appl. Mech. 42, 440 (1975)",
    parameters=(
        Parameter(
            "damping_s_per_m", "s/m", 0.0, 1e-4, 10.0, "log-uniform", 0.1, "c of the restitution 1 - c v", 0.0
        ),
    ),
    signature="loss in proportion to amplitude: strong pulses decay fast, weak ones hardly; "
    "restitution 1 - c v",
    when_to_use="restitution that falls in proportion to impact speed",
    when_not="restitution or decay that depends little on speed: tsuji, kuwabara-kono",
    dissipative=True,
    change=change,
    of_material=True,
)
