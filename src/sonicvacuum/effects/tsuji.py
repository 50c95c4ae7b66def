"""Contact damping that gives a restitution independent of speed."""

import numpy as np

from sonicvacuum.effects.base import Effect, Parameter, Setup, add_term, reduced_mass
from sonicvacuum.physics.lanes import root
from sonicvacuum.physics.laws import Term


def tsuji_force(delta, rate, elastic, damping):
    """Force damping × delta^{1/4} × rate in N."""
    return damping * root(root(delta)) * rate


TERM = Term("tsuji", "force", tsuji_force, 1)


def coefficients(chain, stiffness, mass, alpha):
    """alpha sqrt(m_eff K) of each contact; m_eff is the bead's mass at the wall."""
    return [alpha * np.sqrt(reduced_mass(chain, mass) * stiffness)]


def change(setup: Setup, alpha) -> Setup:
    """Add the damping force to all contacts."""
    return add_term(setup, TERM, coefficients, alpha=alpha)


EFFECT = Effect(
    id="tsuji",
    title="Damping with constant restitution",
    missing="contact damping with a restitution that does not depend on speed",
    equation="F = K delta^{3/2} + alpha sqrt(m_eff K) delta^{1/4} v in contact, cut at zero; 1/m_eff = "
    "1/m_i + 1/m_{i+1}",
    energy="takes alpha sqrt(m_eff K) delta^{1/4} v^2 per time and contact",
    reference="Tsuji, Tanaka & Ishida, Powder Technol. 71, 239 (1992), Eq. 14; exact restitution: "
    "Antypov & Elliott, EPL 94, 50004 (2011)",
    parameters=(Parameter("alpha", "1", 0.0, 1e-4, 2.0, "log-uniform", 0.05, "damping number", 0.0),),
    signature="pulses decay exponentially along the chain, the same for every amplitude; restitution "
    "the same at every speed",
    when_to_use="restitution measured as constant over speeds",
    when_not="in a chain hardly to be told from viscous-drag at one amplitude; loss varying with "
    "amplitude: the other dashpots",
    dissipative=True,
    change=change,
    of_material=True,
)
