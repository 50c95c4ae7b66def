"""A contact law and a drag of no particular form: small additions spanned by a few smooth functions.

F_Hertz (1 + Σ a_ij B_i(δ) C_j(v)) with B = 1, √δ, δ and C = 1, v, |v|, four more of B = 1, √δ and C = |v|^½,
|v|^½ sgn v, and two dampings that do not vanish with the Hertz force: the fifteen of `free_form.SHAPES`; and
three drags of a bead. They stand for what no effect of the catalogue says, and bound what any such law can
close.
"""

import numpy as np

from sonicvacuum.effects import Setup
from sonicvacuum.effects.base import add_term
from sonicvacuum.effects.free_form import COEFFICIENTS, free_force
from sonicvacuum.physics.contact import contact_time
from sonicvacuum.physics.lanes import absolute
from sonicvacuum.physics.laws import Term

CONTACT, DRAG = len(COEFFICIENTS), 3
# The third drag is the same at all velocities above this one, relative to the scale, and fades below it: a
# friction that turns over at once at rest would be integrated less accurately than noise asks for.
SLOW = 0.1


def flexible_drag(velocity, pace, a, b, c):
    """Additional acceleration in m/s²; pace scales velocities to order 1."""
    w = velocity * pace
    s = absolute(w)
    return -w * (a + b * s + c / (s + SLOW))


CONTACT_TERM = Term("flexible-contact", "force", free_force, CONTACT + 3)
DRAG_TERM = Term("flexible-drag", "body", flexible_drag, DRAG + 1)
_NAMES = COEFFICIENTS
_DRAGS = tuple(f"b{n}" for n in range(DRAG))


def _contact(chain, stiffness, mass, **a):
    """Scales of the impact, then the coefficients."""
    depth, pace, load = scales(chain)
    return [1.0 / depth, pace, load, *(a[n] for n in _NAMES)]


def _drag(chain, stiffness, mass, **b):
    """Scale of the velocity, then accelerations in units of speed over contact time."""
    time = contact_time(chain.first.mass, _stiffness(chain), chain.speed)
    unit = chain.speed / time / max(1, chain.beads)
    return [scales(chain)[1], *(b[n] * unit for n in _DRAGS)]


def _stiffness(chain):
    return chain.stiffness if chain.beads else chain.striker_stiffness


def scales(chain) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(lanes,) compression in m, 1/speed in s/m and force in N of the lanes' impacts, alike for all speeds.

    The mean speed of the lanes is used, so that one coefficient means one law.
    """
    speed = float(np.mean(chain.speed))
    depth = speed * contact_time(chain.first.mass, _stiffness(chain), speed)
    return depth, np.full(chain.lanes, 1.0 / speed), _stiffness(chain) * depth**1.5


def add(setup: Setup, contact: dict[str, np.ndarray] | None = None, drag: dict | None = None) -> Setup:
    """The setup with both terms; coefficients that are not given are zero."""
    contact = {n: 0.0 for n in _NAMES} | (contact or {})
    drag = {n: 0.0 for n in _DRAGS} | (drag or {})
    return add_term(add_term(setup, CONTACT_TERM, _contact, **contact), DRAG_TERM, _drag, **drag)


def changes(index: np.ndarray, strengths: np.ndarray) -> tuple[dict, dict]:
    """Coefficients of lanes that depart in direction `index` (contact laws first, then drags)."""
    contact = {n: np.where(index == k, strengths, 0.0) for k, n in enumerate(_NAMES)}
    drag = {n: np.where(index == CONTACT + k, strengths, 0.0) for k, n in enumerate(_DRAGS)}
    return contact, drag
