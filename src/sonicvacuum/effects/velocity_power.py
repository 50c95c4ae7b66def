"""Contact dissipation as a power of the relative velocity of neighbouring beads."""

from sonicvacuum.effects.base import Effect, Parameter, Setup, add_term
from sonicvacuum.physics.lanes import absolute, power
from sonicvacuum.physics.laws import Term


def velocity_power_force(delta, rate, elastic, gamma, excess):
    """Force gamma × |rate|^excess × rate in N, smooth where the rate changes sign."""
    return gamma * rate * power(absolute(rate), excess)


TERM = Term("velocity-power", "force", velocity_power_force, 2)


def coefficients(chain, stiffness, mass, gamma, alpha):
    """gamma and alpha − 1."""
    return [gamma, alpha - 1.0]


def change(setup: Setup, gamma, alpha) -> Setup:
    """Add the dissipative force to all contacts."""
    return add_term(setup, TERM, coefficients, gamma=gamma, alpha=alpha)


EFFECT = Effect(
    id="velocity-power",
    title="Damping by a power of velocity",
    missing="dissipation as a power of relative velocity",
    equation="F = K delta^{3/2} + gamma sgn(v) |v|^alpha in contact, cut at zero",
    energy="takes gamma |v|^{alpha+1} per time and contact",
    reference="Carretero-González, Khatri, Porter, Kevrekidis & Daraio, Phys. Rev. Lett. 102, 024102 "
    "(2009), alpha = 1.75; chosen here: velocities in m/s",
    parameters=(
        Parameter("gamma", "N (s/m)^alpha", 0.0, 1e-3, 100.0, "log-uniform", 0.5, "force at 1 m/s", 0.0),
        Parameter("alpha", "1", None, 1.2, 2.5, "uniform", 1.75, "power of the velocity", 1.01, 6.0),
    ),
    signature="pulses decay along the chain, the lost fraction growing as u^{alpha-6/5} with "
    "amplitude; tails appear",
    when_to_use="chains of metal or PTFE beads whose decay grows with amplitude",
    when_not="few amplitudes: alpha is then free and linear-dashpot, kuwabara-kono explain the same",
    dissipative=True,
    change=change,
    of_material=True,
)
