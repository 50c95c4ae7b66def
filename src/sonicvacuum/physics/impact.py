"""Exact solutions of one ball on a wall: restitution and duration of an impact by law of damping.

The contact ends when its force is zero, as nothing pulls; that is a little before the ball has left its dent.
Units are SI, arrays of any shape unless stated otherwise.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

# Padé approximant of the viscoelastic restitution in the root of x: Müller & Pöschel, Phys. Rev. E 84, 021302
# (2011), in powers 0, 1, 2 …
_NUMERATOR = (1.0, 1.07232, 0.574198, 0.141552)
_DENOMINATOR = (1.0, 1.07232, 1.72765, 1.37842, 1.19449, 0.467273, 0.235585)


def oscillator_duration(ratio: float) -> float:
    """Time for which a linear spring and dashpot that does not pull bears force, over √(m/k).

    π without damping. The ball keeps exp(−ratio × this) of its speed: Schwager & Pöschel, Granular Matter 9,
    465 (2007), Eqs. 20 to 22.

    Args:
        ratio: damping over critical damping, 0 or more; beyond 1 the ball creeps out.
    """
    if abs(ratio - 1.0) < 1e-9:
        return 2.0
    if ratio > 1.0:
        root = math.sqrt(ratio**2 - 1.0)
        return math.log((ratio + root) / (ratio - root)) / root
    root = math.sqrt(1.0 - ratio**2)
    return (math.pi - math.atan2(2.0 * ratio * root, root**2 - ratio**2)) / root


def uncut_restitution(ratio: float) -> float:
    """Restitution of the oscillator whose dashpot may pull until the dent is closed: exp(−π r/√(1 − r²)).

    It is not that of a ball; simulators take it as the name of a damping ratio. ValueError from 1 on.
    """
    if not 0.0 <= ratio < 1.0:
        raise ValueError(f"damping is {ratio:g} times critical; a restitution names only ratios below 1")
    return math.exp(-math.pi * ratio / math.sqrt(1.0 - ratio**2))


def tsuji_ratio(alpha: float) -> float:
    """Damping ratio of the oscillator into which a Tsuji contact turns in a stretched time: α/√5.

    Antypov & Elliott, EPL 94, 50004 (2011).
    """
    return alpha / math.sqrt(5.0)


def hunt_crossley_duration(number: float, exponent: float) -> float:
    """Duration of an impact on ξ^n (1 + number ξ') from ξ = 0, ξ' = 1; π for n = 1, number 0.

    Lengths are in (m v²/k)^{1/(n+1)} for f = k δ^n, times in that over v; integrated to 1e-10.
    """
    from scipy.integrate import solve_ivp  # long to load

    def motion(_, state):
        depth, rate = max(state[0], 0.0), state[1]
        return rate, -(depth**exponent) * max(0.0, 1.0 + number * rate)

    def out(time, state):
        return state[0] if time > 0.0 else 1.0

    out.terminal, out.direction = True, -1.0
    end = 1e3 * (1.0 + number)
    return float(solve_ivp(motion, (0.0, end), (0.0, 1.0), events=out, rtol=1e-10, atol=1e-12).t[-1])


def viscoelastic_number(
    time: ArrayLike, stiffness: ArrayLike, mass: ArrayLike, speed: ArrayLike
) -> np.ndarray:
    """x = (3/2) A (K/m)^{2/5} v^{1/5}, on which alone viscoelastic restitution depends.

    Args:
        time: A in s of the force K δ^{3/2} + (3/2) A K δ^{1/2} v.
        stiffness: K in N/m^{3/2}.
        mass: in kg.
        speed: at impact in m/s.
    """
    ratio = np.asarray(stiffness, dtype=float) / np.asarray(mass, dtype=float)
    return 1.5 * np.asarray(time, dtype=float) * ratio**0.4 * np.asarray(speed, dtype=float) ** 0.2


def viscoelastic_restitution(number: ArrayLike) -> np.ndarray:
    """Restitution for any x = `viscoelastic_number`: the Padé approximant of Müller & Pöschel (2011)."""
    root = np.sqrt(np.asarray(number, dtype=float))
    return np.polyval(_NUMERATOR[::-1], root) / np.polyval(_DENOMINATOR[::-1], root)
