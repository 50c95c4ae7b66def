"""Force laws for hidden-effect data, one contact at a time, compiled.

All laws stand side by side and a number of zero leaves one out: one row of numbers for each contact
(`CONTACT` names the columns) and one for each bead (`BODY`). Composition, as for the catalogue: loading curve
(Hertz or a power) × layer correction, replaced by the unloading branch below the largest compression so far,
plus dissipative and relaxing parts; zero out of contact and never pulling, but for adhesion, which is not in
the catalogue.
"""

import math

import numpy as np
from numba import njit

CONTACT = (
    "hertz",  # K in N/m^{3/2}
    "power",  # constant of F = power × delta^exponent, used where exponent is not 3/2
    "exponent",
    "layer_1",  # coefficients of √delta … delta² of the layer correction
    "layer_2",
    "layer_3",
    "layer_4",
    "layer_slope",  # of the correction beyond √delta = layer_limit
    "layer_limit",
    "residual",  # residual over largest compression
    "dashpot",  # kg/s
    "viscoelastic",  # (3/2) A K
    "tsuji",  # α √(m K)
    "hunt_crossley",  # (3/2) c in s/m
    "power_damping",  # γ in N (s/m)^α
    "power_of_rate",  # α
    "relaxing",  # g
    "relaxation_rate",  # 1/τ in 1/s
    "adhesion",  # k in −k δ^{3/4}
    "log_rate",  # b in F (1 + b ln(1 + |v|/v_log))
    "log_speed",  # v_log in m/s
    "plain",  # 1 where only Hertz acts: the short way through
)
BODY = ("drag", "friction", "quadratic_drag")  # 1/s, m/s², 1/m
C = {name: k for k, name in enumerate(CONTACT)}
B = {name: k for k, name in enumerate(BODY)}
SLOW = 1e-3  # m/s; dry friction grows in proportion to velocity below it

_HERTZ, _POWER, _EXPONENT = C["hertz"], C["power"], C["exponent"]
_L1, _L2, _L3, _L4 = C["layer_1"], C["layer_2"], C["layer_3"], C["layer_4"]
_SLOPE, _LIMIT, _RESIDUAL = C["layer_slope"], C["layer_limit"], C["residual"]
_DASHPOT, _VISCO, _TSUJI, _HUNT = C["dashpot"], C["viscoelastic"], C["tsuji"], C["hunt_crossley"]
_GAMMA, _ALPHA = C["power_damping"], C["power_of_rate"]
_RELAXING, _RELAXATION = C["relaxing"], C["relaxation_rate"]
_ADHESION, _LOG, _LOG_SPEED, _PLAIN = C["adhesion"], C["log_rate"], C["log_speed"], C["plain"]
_SWITCHES = [
    C[n] for n in CONTACT if n not in ("hertz", "power", "exponent", "power_of_rate", "log_speed", "plain")
]
_DRAG, _FRICTION, _QUADRATIC = B["drag"], B["friction"], B["quadratic_drag"]


@njit(nogil=True, error_model="numpy")
def loading(delta, rows, c):
    """Loading force in N and its slope in N/m of contact c at compression delta > 0 (m)."""
    r = math.sqrt(delta)
    if rows[c, _EXPONENT] == 1.5:
        force = rows[c, _HERTZ] * delta * r
        slope = 1.5 * rows[c, _HERTZ] * r
    else:
        force = rows[c, _POWER] * delta ** rows[c, _EXPONENT]
        slope = force * rows[c, _EXPONENT] / delta
    if rows[c, _SLOPE] != 0.0:
        x = min(r, rows[c, _LIMIT])
        g = 1.0 + x * (rows[c, _L1] + x * (rows[c, _L2] + x * (rows[c, _L3] + x * rows[c, _L4])))
        dg = rows[c, _L1] + x * (2.0 * rows[c, _L2] + x * (3.0 * rows[c, _L3] + x * 4.0 * rows[c, _L4]))
        if r > rows[c, _LIMIT]:
            g += rows[c, _SLOPE] * (r - rows[c, _LIMIT])
            dg = rows[c, _SLOPE]
        slope = slope * g + force * dg / (2.0 * r)
        force *= g
    return force, slope


@njit(nogil=True, error_model="numpy")
def elastic(delta, largest, rows, c):
    """Force in N and slope in N/m, below the largest compression so far along the unloading branch.

    F_max ((δ − δ_res)/(δ_max − δ_res))^{3/2}, δ_res = ε δ_max (Walton & Braun, J. Rheol. 30, 949, 1986, with
    Hertzian branches).
    """
    if rows[c, _RESIDUAL] == 0.0 or delta >= largest:
        return loading(delta, rows, c)
    residual = rows[c, _RESIDUAL] * largest
    if delta <= residual:
        return 0.0, 0.0
    top, _ = loading(largest, rows, c)
    share = (delta - residual) / (largest - residual)
    return top * share * math.sqrt(share), 1.5 * top * math.sqrt(share) / (largest - residual)


@njit(nogil=True, error_model="numpy")
def contact(delta, rate, q, largest, rows, c):
    """Contact force in N and dq/dt in N/s of the relaxing part q (Zener's solid: q' + q/τ = g dF/dt).

    Args:
        delta, rate: compression in m and approach rate in m/s.
        q: relaxing part in N.
        largest: largest compression so far in m.
        rows: (contacts, columns) numbers, columns `CONTACT`.
        c: the contact.
    """
    if delta <= 0.0:
        return 0.0, 0.0
    if rows[c, _PLAIN] == 1.0:
        return rows[c, _HERTZ] * delta * math.sqrt(delta), 0.0
    spring, slope = elastic(delta, largest, rows, c)
    damping = rows[c, _DASHPOT] + rows[c, _HUNT] * spring
    if rows[c, _VISCO] != 0.0:
        damping += rows[c, _VISCO] * math.sqrt(delta)
    if rows[c, _TSUJI] != 0.0:
        damping += rows[c, _TSUJI] * delta**0.25
    force = spring + damping * rate
    if rows[c, _GAMMA] != 0.0:
        force += rows[c, _GAMMA] * math.copysign(abs(rate) ** rows[c, _ALPHA], rate)
    if rows[c, _LOG] != 0.0:
        force += spring * rows[c, _LOG] * math.log1p(abs(rate) / rows[c, _LOG_SPEED])
    growth = 0.0
    if rows[c, _RELAXING] != 0.0:
        force += q
        growth = rows[c, _RELAXING] * slope * rate - q * rows[c, _RELAXATION]
    return max(force, 0.0) - _pull(delta, rows, c), growth


@njit(nogil=True, error_model="numpy")
def _pull(delta, rows, c):
    """Adhesive pull in N, as a^{3/2} of the contact radius (Johnson, Kendall & Roberts 1971)."""
    return rows[c, _ADHESION] * delta**0.75 if rows[c, _ADHESION] != 0.0 else 0.0


@njit(nogil=True, error_model="numpy")
def deceleration(velocity, rows, c):
    """Deceleration in m/s² of a bead by medium and holder: linear, dry and quadratic drag."""
    dry = min(max(velocity / SLOW, -1.0), 1.0)
    return (
        rows[c, _DRAG] * velocity + rows[c, _FRICTION] * dry + rows[c, _QUADRATIC] * abs(velocity) * velocity
    )


def hertz_rows(stiffness: np.ndarray) -> np.ndarray:
    """(contacts, columns) numbers of plain Hertz contacts, `stiffness` in N/m^{3/2}."""
    rows = np.zeros((len(stiffness), len(CONTACT)))
    rows[:, _HERTZ] = stiffness
    rows[:, _EXPONENT] = 1.5
    rows[:, _ALPHA] = 1.0
    rows[:, _LOG_SPEED] = 1.0
    return rows


def marked(rows: np.ndarray) -> np.ndarray:
    """The same numbers with the plain contacts marked as such."""
    rows = rows.copy()
    rows[:, _PLAIN] = (rows[:, _EXPONENT] == 1.5) & np.all(rows[:, _SWITCHES] == 0.0, axis=1)
    return rows


@njit(nogil=True, error_model="numpy")
def force_at_rest(delta, rows, c):
    """Static force in N of contact c at compression delta (m), zero where it is open."""
    return loading(delta, rows, c)[0] - _pull(delta, rows, c) if delta > 0.0 else 0.0


@njit(nogil=True, error_model="numpy")
def compression_at_rest(load, rows):
    """(contacts,) compression in m at which contacts bear their load (contacts,) in N by the law in force."""
    rest = np.zeros(len(load))
    for c in range(len(load)):
        if load[c] <= 0.0 and rows[c, _ADHESION] == 0.0:
            continue
        high = 1e-9
        while force_at_rest(high, rows, c) < load[c] or high < (rows[c, _ADHESION] / rows[c, _HERTZ]) ** (
            4.0 / 3.0
        ):
            high *= 2.0
        low = 0.5 * high if load[c] > 0.0 and high > 1e-9 else 0.0
        for _ in range(200):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            if force_at_rest(middle, rows, c) < load[c]:
                low = middle
            else:
                high = middle
        rest[c] = high
    return rest
