"""Force laws for hidden-effect data, all contacts of a chain at once, compiled.

All laws stand side by side and a number of zero leaves one out: one row of numbers for each contact
(`CONTACT` names the columns) and one for each bead (`BODY`), gathered by `numbers` into one table with a row
for each name, so that loops over a chain run along memory. Composition, as for the catalogue: loading curve
(Hertz or a power) × layer correction, replaced by the unloading branch below the largest compression so far,
plus dissipative and relaxing parts; zero out of contact and never pulling, but for adhesion. Not in the
catalogue are adhesion, stiffening with rate or depth, and damping as any powers of depth and rate.
"""

import math
from collections import namedtuple
from pathlib import Path

import numpy as np
from numba import njit

from sonicvacuum.physics.dispatchers import cached, prepare
from sonicvacuum_blind import layer
from sonicvacuum_blind.layer import DEGREE

# What compiled code is made of here; it is kept from process to process, as compiling takes longer than most
# data.
SOURCES = (Path(__file__), Path(layer.__file__))

CONTACT = (
    "hertz",  # K in N/m^{3/2}
    "power",  # constant of F = power × delta^exponent, used where exponent is not 3/2
    "exponent",
    "layer_width",  # χ/√δ = √R over thickness of the layer, in m^{-1/2}; 0 for none
    *(f"layer_{k}" for k in range(DEGREE + 1)),  # Hertz force over force in powers of u = 1/(1 + χ)
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
    "hardening",  # h in F (1 + h δ), 1/m
    "mixed",  # β in β δ^p |v|^q sign v, SI
    "mixed_depth",  # p
    "mixed_rate",  # q
)
BODY = ("drag", "friction", "quadratic_drag")  # 1/s, m/s², 1/m
C = {name: k for k, name in enumerate(CONTACT)}
B = {name: k for k, name in enumerate(BODY)}
# Further rows of the numbers of a chain, one column for each body and its contact with the next.
REST, LOAD, INVERSE, DRAG, FRICTION, QUADRATIC = range(len(CONTACT), len(CONTACT) + 3 + len(BODY))
# Rows of the room for intermediate results: force on each body from the one before; compression in m (0
# where open), its root, elastic force in N and its slope in N/m of each contact; largest compression so far;
# elastic force at that.
FORCE, DELTA, ROOT, SPRING, RISE, LARGEST, TOP = range(7)
SLOW = 1e-3  # m/s; dry friction grows in proportion to velocity below it

_HERTZ, _POWER, _EXPONENT = C["hertz"], C["power"], C["exponent"]
_WIDTH, _LAYER, _RESIDUAL = C["layer_width"], C["layer_0"], C["residual"]
_DASHPOT, _VISCO, _TSUJI, _HUNT = C["dashpot"], C["viscoelastic"], C["tsuji"], C["hunt_crossley"]
_GAMMA, _ALPHA = C["power_damping"], C["power_of_rate"]
_RELAXING, _RELAXATION = C["relaxing"], C["relaxation_rate"]
_ADHESION, _LOG, _LOG_SPEED = C["adhesion"], C["log_rate"], C["log_speed"]
_HARDENING, _MIXED, _MIXED_DEPTH, _MIXED_RATE = (
    C[name] for name in ("hardening", "mixed", "mixed_depth", "mixed_rate")
)

# Which laws act anywhere in a chain; `plain`: Hertz alone.
Acting = namedtuple("Acting", "plain power layer hardening residual viscous rate relaxing adhesion drag")


def hertz_rows(stiffness: np.ndarray) -> np.ndarray:
    """(contacts, columns) numbers of plain Hertz contacts, `stiffness` in N/m^{3/2}."""
    rows = np.zeros((len(stiffness), len(CONTACT)))
    rows[:, _HERTZ] = stiffness
    rows[:, _EXPONENT] = 1.5
    rows[:, _ALPHA] = 1.0
    rows[:, _LOG_SPEED] = 1.0
    rows[:, _LAYER] = 1.0
    return rows


def numbers(rows: np.ndarray, rest: np.ndarray, load: np.ndarray, mass: np.ndarray, drag: np.ndarray):
    """(rows, bodies + 1) table of a chain: contact laws, then rest, load, 1/mass and drag.

    Bodies without a contact behind them (a wall with a mass of its own) get one that never closes; the last
    column is the fixed wall.
    """
    table = np.zeros((len(CONTACT) + 3 + len(BODY), len(mass) + 1))
    table[: len(CONTACT)] = hertz_rows(np.zeros(len(mass) + 1)).T
    table[: len(CONTACT), : len(rows)] = rows.T
    table[REST] = -1.0
    table[REST, : len(rest)] = rest
    table[LOAD, :-1], table[INVERSE, :-1], table[DRAG:, :-1] = load, 1.0 / mass, drag.T
    return table


def acting(table: np.ndarray) -> Acting:
    """Which laws act in a chain with these `numbers`."""
    some = (table != 0.0).any(axis=1)
    power, viscous = bool((table[_EXPONENT] != 1.5).any()), bool(some[_DASHPOT : _HUNT + 1].any())
    rate = bool(some[_GAMMA] or some[_LOG] or some[_MIXED])
    others = [power, bool(some[_WIDTH]), bool(some[_HARDENING]), bool(some[_RESIDUAL]), viscous, rate]
    others += [bool(some[_RELAXING]), bool(some[_ADHESION])]
    return Acting(not any(others), *others, bool(some[DRAG:].any()))


@njit(nogil=True, error_model="numpy")
def load(n, table, uses, room, depth, spring):
    """Loading force and its slope at the compressions in row `depth` of `room` into rows `spring`, RISE."""
    for c in range(n):
        root = math.sqrt(room[depth, c])
        room[ROOT, c] = root
        room[RISE, c] = 1.5 * table[_HERTZ, c] * root
        room[spring, c] = table[_HERTZ, c] * room[depth, c] * root
    if uses.power:
        for c in range(n):
            delta = room[depth, c]
            if table[_EXPONENT, c] != 1.5 and delta > 0.0:
                room[spring, c] = table[_POWER, c] * delta ** table[_EXPONENT, c]
                room[RISE, c] = room[spring, c] * table[_EXPONENT, c] / delta
    if uses.layer:
        _layer(n, table, room, spring)
    if uses.hardening:
        for c in range(n):
            harder = 1.0 + table[_HARDENING, c] * room[depth, c]
            room[RISE, c] = room[RISE, c] * harder + room[spring, c] * table[_HARDENING, c]
            room[spring, c] *= harder


@njit(nogil=True, error_model="numpy")
def _layer(n, table, room, spring):
    """Layer on a core: Hertz force over a polynomial of u = 1/(1 + χ), with its slope by Horner's rule."""
    for c in range(n):
        u = 1.0 / (1.0 + table[_WIDTH, c] * room[ROOT, c])
        inverse, slope = table[_LAYER + DEGREE, c], 0.0
        for k in range(DEGREE - 1, -1, -1):
            slope = slope * u + inverse
            inverse = inverse * u + table[_LAYER + k, c]
        # d(1/inverse)/dδ, where √δ changes by 1/(2 √δ) and u by −width u².
        rise = 0.5 * slope * table[_WIDTH, c] * u * u / (inverse * inverse)
        if room[ROOT, c] > 0.0:
            room[RISE, c] = room[RISE, c] / inverse + room[spring, c] * rise / room[ROOT, c]
        room[spring, c] /= inverse


@njit(nogil=True, error_model="numpy")
def _unload(n, table, uses, room):
    """Below the largest compression so far the unloading branch.

    F_max ((δ − δ_res)/(δ_max − δ_res))^{3/2}, δ_res = ε δ_max (Walton & Braun, J. Rheol. 30, 949, 1986, with
    Hertzian branches).
    """
    load(n, table, uses, room, LARGEST, TOP)
    load(n, table, uses, room, DELTA, SPRING)
    for c in range(n):
        largest = room[LARGEST, c]
        if table[_RESIDUAL, c] != 0.0 and room[DELTA, c] < largest:
            residual = table[_RESIDUAL, c] * largest
            share = max(room[DELTA, c] - residual, 0.0) / (largest - residual)
            room[SPRING, c] = room[TOP, c] * share * math.sqrt(share)
            room[RISE, c] = 1.5 * room[TOP, c] * math.sqrt(share) / (largest - residual)


@njit(nogil=True, error_model="numpy")
def forces(y, at, slopes, s, table, uses, room):
    """Contact forces in N into `room`; dq/dt in N/s of the relaxing parts q into `slopes`.

    Zener's solid: q' + q/τ = g dF/dt.

    Args:
        y: (states, 2 or 3 times bodies + 1): displacements in m, velocities in m/s, relaxing parts in N.
        at: the state.
        slopes, s: (stages, as states) and the stage.
        table: `numbers` of the chain.
        uses: `acting(table)`.
        room: rows FORCE and so on, (rows, bodies + 1).
    """
    n = table.shape[1] - 1
    if uses.plain:
        for c in range(n):
            delta = max(table[REST, c] + y[at, c] - y[at, c + 1], 0.0)
            room[FORCE, c + 1] = table[_HERTZ, c] * delta * math.sqrt(delta)
        return
    for c in range(n):
        room[DELTA, c] = max(table[REST, c] + y[at, c] - y[at, c + 1], 0.0)
    if uses.residual:
        _unload(n, table, uses, room)
    else:
        load(n, table, uses, room, DELTA, SPRING)
    for c in range(n):
        room[FORCE, c + 1] = room[SPRING, c]
    if uses.viscous:
        _damp(n, y, at, table, room)
    if uses.rate:
        _resist(n, y, at, table, room)
    if uses.relaxing:
        _relax(n, y, at, slopes, s, table, room)
    for c in range(n):
        room[FORCE, c + 1] = max(room[FORCE, c + 1], 0.0) if room[DELTA, c] > 0.0 else 0.0
    if uses.adhesion:
        _stick(n, table, room)


@njit(nogil=True, error_model="numpy")
def _damp(n, y, at, table, room):
    """Dissipative parts in proportion to the approach rate."""
    for c in range(n):
        root = room[ROOT, c]
        damping = table[_DASHPOT, c] + table[_HUNT, c] * room[SPRING, c]
        damping += table[_VISCO, c] * root + table[_TSUJI, c] * math.sqrt(root)
        room[FORCE, c + 1] += damping * (y[at, n + 1 + c] - y[at, n + 2 + c])


@njit(nogil=True, error_model="numpy")
def _resist(n, y, at, table, room):
    """Dissipative part as a power of rate, or of depth and rate; stiffening with the rate's logarithm."""
    for c in range(n):
        rate = y[at, n + 1 + c] - y[at, n + 2 + c]
        if room[DELTA, c] > 0.0 and rate != 0.0:
            if table[_GAMMA, c] != 0.0:
                room[FORCE, c + 1] += table[_GAMMA, c] * math.copysign(abs(rate) ** table[_ALPHA, c], rate)
            if table[_LOG, c] != 0.0:
                stiffer = table[_LOG, c] * math.log1p(abs(rate) / table[_LOG_SPEED, c])
                room[FORCE, c + 1] += room[SPRING, c] * stiffer
            if table[_MIXED, c] != 0.0:
                size = room[DELTA, c] ** table[_MIXED_DEPTH, c] * abs(rate) ** table[_MIXED_RATE, c]
                room[FORCE, c + 1] += table[_MIXED, c] * math.copysign(size, rate)


@njit(nogil=True, error_model="numpy")
def _relax(n, y, at, slopes, s, table, room):
    """Relaxing part; none out of contact."""
    w = n + 1
    for c in range(n):
        touching = 1.0 if room[DELTA, c] > 0.0 else 0.0
        growth = table[_RELAXING, c] * room[RISE, c] * (y[at, w + c] - y[at, w + c + 1])
        slopes[s, 2 * w + c] = touching * (growth - y[at, 2 * w + c] * table[_RELAXATION, c])
        room[FORCE, c + 1] += touching * y[at, 2 * w + c]


@njit(nogil=True, error_model="numpy")
def _stick(n, table, room):
    """Adhesion, an attraction as a^{3/2} of the contact radius (Johnson, Kendall & Roberts 1971)."""
    for c in range(n):
        room[FORCE, c + 1] -= table[_ADHESION, c] * room[ROOT, c] * math.sqrt(room[ROOT, c])


@njit(nogil=True, error_model="numpy")
def decelerate(y, at, slopes, s, table):
    """Subtract the decelerations in m/s² of beads by medium and holder: linear, dry and quadratic drag."""
    w = table.shape[1]
    for i in range(w - 1):
        v = y[at, w + i]
        dry = min(max(v / SLOW, -1.0), 1.0)
        slopes[s, w + i] -= table[DRAG, i] * v + table[FRICTION, i] * dry + table[QUADRATIC, i] * abs(v) * v


@njit(nogil=True, error_model="numpy")
def _borne(delta, table, uses, room):
    """(contacts,) static forces in N at compressions (contacts,) in m, 0 or more."""
    n = len(delta)
    borne = np.empty(n)
    for c in range(n):
        room[DELTA, c] = delta[c]
    load(n, table, uses, room, DELTA, SPRING)
    for c in range(n):
        room[FORCE, c + 1] = room[SPRING, c]
    _stick(n, table, room)
    for c in range(n):
        borne[c] = room[FORCE, c + 1]
    return borne


def static_forces(rest: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(contacts,) static forces in N at compressions (contacts,) in m; zero where a contact is open."""
    if not np.any(rest > 0.0):
        return np.zeros(len(rest))
    table, uses, room = _alone(rows)
    return _at_once(_borne, np.maximum(rest, 0.0), table, uses, room)


def compression_at_rest(weight: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(contacts,) compression in m at which contacts bear their load (contacts,) in N by the law in force."""
    if not (np.any(weight > 0.0) or np.any(rows[:, _ADHESION])):
        return np.zeros(len(weight))
    table, uses, room = _alone(rows)
    if not (uses.power or uses.layer or uses.hardening or uses.adhesion):
        return (np.maximum(weight, 0.0) / rows[:, _HERTZ]) ** (2.0 / 3.0)
    return _at_once(_sink, weight, table, uses, room)


def _at_once(function, *arguments):
    """The result of a function that an earlier process may have compiled."""
    prepare(function, function.__name__, arguments)
    return function(*arguments)


def _alone(rows):
    """Numbers, laws and room of contacts without a chain."""
    none, ones = np.zeros(len(rows)), np.ones(len(rows))
    table = numbers(rows, none, none, ones, np.zeros((len(rows), len(BODY))))
    return table, acting(table), np.zeros((7, len(rows) + 1))


@njit(nogil=True, error_model="numpy")
def _sink(weight, table, uses, room):
    """Compressions in m at which contacts bear `weight`; in loops, which compile in half the time."""
    n = len(weight)
    low, high, middle = np.zeros(n), np.full(n, 1e-9), np.zeros(n)
    short = True
    while short:
        borne = _borne(high, table, uses, room)
        short = False
        for c in range(n):
            sticks = (table[_ADHESION, c] / table[_HERTZ, c]) ** (4.0 / 3.0)
            bears = weight[c] > 0.0 or table[_ADHESION, c] != 0.0
            if bears and (borne[c] < weight[c] or high[c] < sticks):
                high[c] *= 2.0
                short = True
    for c in range(n):
        if weight[c] > 0.0 and high[c] > 1e-9:
            low[c] = 0.5 * high[c]
    for _ in range(200):
        apart = False
        for c in range(n):
            middle[c] = 0.5 * (low[c] + high[c])
            apart = apart or (middle[c] != low[c] and middle[c] != high[c])
        if not apart:
            break
        borne = _borne(middle, table, uses, room)
        for c in range(n):
            if borne[c] < weight[c]:
                low[c] = middle[c]
            else:
                high[c] = middle[c]
    for c in range(n):
        if not (weight[c] > 0.0 or table[_ADHESION, c] != 0.0):
            high[c] = 0.0
    return high


for one in (_borne, _sink):
    cached(one, SOURCES)
