"""The ideal rule: how often even a rule that knows every signature names rightly what is hidden in a record.

The rule takes effects as equally likely, whatever number of places, signs and shapes each has; pairs, where
two are hidden, as likely as single effects, and each pair as any other. An effect's mass is shared equally
among its places and signs; its strength is log-uniform over `RANGE` of d′, its shape normal over the shapes
that the catalogue knows. Each hypothesis is fitted to the noise-free data through the integrator, strengths,
shapes and the modulus free (`scipy.optimize.least_squares`), so that curvature is in it; the truth's own
signature is never handed over. Around the fit a hypothesis is linear, and its evidence follows in closed form
(Laplace) for as many noises as are drawn. Evidence that differs by less than `TIE` decides nothing: then
chance does.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy

from sonicvacuum.blas import one_thread
from sonicvacuum_blind.catalogue import BY_ID, hidden
from sonicvacuum_blind.hide import Laboratory, Spec, laboratory, stream
from sonicvacuum_blind.integrate import NoSolution
from sonicvacuum_blind.prediction import TOLERANCE, Errors, predict
from sonicvacuum_blind.signature import Frame
from sonicvacuum_blind.strength import DRAWS, TIE, Rival, ceiling, rivals

# From this d′ on noise alone is no rival, and hypotheses are fitted; below, strengths act linearly.
FITTED = 8.0
RANGE = (1.0, 1000.0)
# Fitted are hypotheses that leave less than NEAR + FAR × d′ in the linear approximation; LEAST to MOST.
NEAR, FAR, LEAST, MOST = 6.0, 0.25, 12, 24
# Beyond this d′ that approximation may be far off, and of every effect one hypothesis is fitted.
CURVED = 40.0
# A start that misses more than this many d′ has pulses elsewhere; then each parameter in turn is tried so far
# away: the modulus and shapes in standard deviations, strengths in their logarithm.
ELSEWHERE = 1.5
AWAY = np.linspace(-3.0, 3.0, 41)
# Of the integrator there: a start need not be exact.
COARSE = 1e-5
# Forward differences: of ln strength, of the modulus and of shapes in standard deviations.
STEP = 0.02
SMALLEST = 1e-5  # share of an effect's largest strength
FOUND = 1.5  # standard deviations that the fit of what is hidden may miss
EVALUATIONS = 8  # of one fit, beside those of its slopes


@dataclass(frozen=True)
class Hypothesis:
    """An explanation fitted to noise-free data, linear from there.

    Attributes:
        name: of the effects, joined by `+`.
        mass: ln of its prior probability.
        missed: (data,) what the fit misses, in standard deviations.
        slopes: (data, parameters) of it.
        held: the same two of the priors on shapes: (priors,) and (priors, parameters), without noise.
    """

    name: str
    mass: float
    missed: np.ndarray
    slopes: np.ndarray
    held: tuple[np.ndarray, np.ndarray]


def share(own: Laboratory, spec: Spec, random: np.random.Generator) -> float:
    """Share of data sets of a record, differing in their noise, in which the ideal rule names what is hidden.

    NaN where the fit of what is hidden fails.

    Args:
        own: the record's laboratory, with one or two effects of the catalogue hidden.
        spec: the case.
        random: for noise and ties.
    """
    frame, effects = own.case.frame, own.case.hidden
    seen = sum(h.seen for h in effects)
    directions = rivals(frame, spec.d_prime)
    if len(effects) == 1 and np.linalg.norm(seen) < FITTED:
        return ceiling(directions, seen, random).get(spec.effects[0], 0.0)
    truth = frame.whiten.vector(predict(frame.design, own.case.change))
    found = [
        _fitted(frame, truth, seen, parts, _mass(directions, parts, len(effects)))
        for parts in _near(directions, seen, len(effects))
    ]
    own_name = "+".join(sorted(spec.effects))
    nearest = min((np.linalg.norm(h.missed) for h in found if h and h.name == own_name), default=math.inf)
    # A fit that does not find what is there says nothing of what could be found.
    if nearest > FOUND:
        return math.nan
    return shares([h for h in found if h is not None], random)[own_name]


def shares(hypotheses: list[Hypothesis], random: np.random.Generator, draws: int = DRAWS) -> dict[str, float]:
    """Name → share of data sets in which its evidence is the largest, chance deciding between equals."""
    if not hypotheses:
        return {}
    blocks = [(_basis(h), h) for h in hypotheses]
    vectors = np.concatenate([np.vstack([h.missed, q[: len(h.missed)].T]) for q, h in blocks])
    values, turned = np.linalg.eigh(vectors @ vectors.T)
    noise = (random.standard_normal((draws, len(vectors))) * np.sqrt(np.maximum(values, 0.0))) @ turned.T
    evidence, at = [], 0
    for basis, h in blocks:
        own = noise[:, at : at + 1 + basis.shape[1]]
        evidence.append(_log_evidence(basis, h, own[:, 0], own[:, 1:]))
        at += 1 + basis.shape[1]
    names = sorted({h.name for h in hypotheses})
    total = np.stack(
        [
            scipy.special.logsumexp(
                [e for e, h in zip(evidence, hypotheses, strict=True) if h.name == n], axis=0
            )
            for n in names
        ]
    )
    winner = np.argmax(total + TIE * random.random(total.shape), axis=0)
    return {name: float(np.mean(winner == k)) for k, name in enumerate(names)}


def _basis(h):
    """(data + priors, parameters) orthonormal basis of what the parameters can do."""
    return np.linalg.qr(np.vstack([h.slopes, h.held[1]]))[0]


def _log_evidence(basis, h, along, inside):
    """(draws,) ln ∫ exp(−|noise − missed − slopes δ|²/2) dδ + |noise|²/2.

    Args:
        basis: as `_basis` makes it.
        h: the hypothesis.
        along, inside: (draws,) and (draws, parameters) of the noise, along `missed` and the basis.
    """
    slopes, missed = np.vstack([h.slopes, h.held[1]]), np.concatenate([h.missed, h.held[0]])
    explained = inside - missed @ basis
    volume = 0.5 * slopes.shape[1] * math.log(2.0 * math.pi) - 0.5 * np.linalg.slogdet(slopes.T @ slopes)[1]
    return h.mass + volume + along - 0.5 * missed @ missed + 0.5 * (explained**2).sum(axis=1)


def _near(directions: list[Rival], seen: np.ndarray, most: int) -> Iterable[tuple[Rival, ...]]:
    """Explanations by up to `most` effects that leave least of a signature, one for each place and sign."""
    z = np.array([d.direction @ seen for d in directions])
    size = float(seen @ seen)
    found = [(size - max(a, 0.0) ** 2, (d,)) for a, d in zip(z, directions, strict=True)]
    if most == 2:
        found += _pairs(directions, z, size)
    reach, kept, ids = (NEAR + FAR * math.sqrt(size)) ** 2, {}, set()
    for left, parts in sorted(found, key=lambda one: one[0]):
        names = tuple(d.id for d in parts)
        first = most == 1 and size > CURVED**2 and names not in ids
        if first or len(kept) < (MOST if left < reach else LEAST):
            kept.setdefault(tuple(d.kind for d in parts), parts)
            ids.add(names)
    return kept.values()


def _pairs(directions, z, size):
    """(left, two directions of two effects) of all pairs whose strengths are positive."""
    basis = np.stack([d.direction for d in directions])
    cosine = basis @ basis.T
    ids = np.array([d.id for d in directions])
    i, j = np.nonzero(np.triu(ids[:, None] != ids[None]))
    c = cosine[i, j]
    apart = np.maximum(1.0 - c**2, 1e-6)
    one, other = (z[i] - c * z[j]) / apart, (z[j] - c * z[i]) / apart
    left = size - (z[i] * one + z[j] * other)
    able = np.flatnonzero((one > 0.0) & (other > 0.0))
    for k in able[np.argsort(left[able])[: 50 * MOST]]:
        yield left[k], (directions[i[k]], directions[j[k]])


def _mass(directions, parts, most):
    """ln prior: of the number of effects, of these among all, and of their places and signs."""
    ids = {d.id for d in directions}
    shares = [len({d.kind for d in directions if d.id == part.id}) for part in parts]
    return -math.log(most) - math.log(math.comb(len(ids), len(parts))) - sum(map(math.log, shares))


def _fitted(frame: Frame, truth, seen, parts: tuple[Rival, ...], mass: float) -> Hypothesis | None:
    """The hypothesis nearest to noise-free data, None where it has no solution.

    Args:
        frame: the record.
        truth: (data,) whitened.
        seen: (data + errors,) signature of what is hidden.
        parts: of the hypothesis.
        mass: ln prior of them.
    """
    sizes = np.linalg.lstsq(np.stack([p.direction for p in parts], axis=1), seen)[0]
    shapes = [_shape(frame, p, np.clip(s / p.size, 0.1, 10.0)) for p, s in zip(parts, sizes, strict=True)]
    start = np.concatenate([[0.0], *(s.start for s in shapes)])
    low = np.concatenate([[-6.0], *(s.low for s in shapes)])
    high = np.concatenate([[6.0], *(s.high for s in shapes)])
    whole = partial(_missed, frame, truth, shapes)

    def slopes(x):
        here, columns = whole(x), []
        for k in range(len(x)):
            step = np.zeros(len(x))
            step[k] = STEP if x[k] + STEP < high[k] else -STEP
            columns.append((whole(x + step) - here) / step[k])
        return np.stack(columns, axis=1)

    try:
        start = np.clip(start, low + 1e-9, high - 1e-9)
        if np.linalg.norm(whole(start)) > ELSEWHERE * np.linalg.norm(seen):
            coarse = partial(_missed, frame, truth, shapes, tolerance=COARSE)
            start = _elsewhere(coarse, start, low, high)
        fit = scipy.optimize.least_squares(
            whole,
            np.clip(start, low + 1e-9, high - 1e-9),
            slopes,
            bounds=(low, high),
            x_scale="jac",
            ftol=1e-2,
            xtol=1e-4,
            gtol=None,
            max_nfev=EVALUATIONS,
        )
        jacobian = slopes(fit.x)
    except (NoSolution, ValueError):
        return None
    data = len(truth) + frame.slopes.shape[1]
    held = fit.fun[data:], jacobian[data:]
    mass -= len(parts) * math.log(math.log(RANGE[1] / RANGE[0]))
    return Hypothesis("+".join(sorted(p.id for p in parts)), mass, fit.fun[:data], jacobian[:data], held)


def _elsewhere(whole, start, low, high):
    """Parameters from which pulses are where they should be: the best of each in turn."""
    for k in [*range(1, len(start)), 0]:
        tried = np.tile(start, (len(AWAY), 1))
        tried[:, k] = np.clip(start[k] + AWAY, low[k] + 1e-9, high[k] - 1e-9)
        start = min(tried, key=lambda x: np.linalg.norm(whole(x)))
    return start


@dataclass(frozen=True)
class Shape:
    """Free parameters of one effect: ln strength and, where it is a number, ln shape in standard deviations.

    Attributes:
        start, low, high: of them.
        change: parameters → the effect.
    """

    start: np.ndarray
    low: np.ndarray
    high: np.ndarray
    change: object


def _shape(frame, part, factor):
    entry, reference = BY_ID[part.id], frame.design.reference
    most, grid = math.log(entry.most), entry.shapes(reference)
    start = min(math.log(part.strength * factor), most)
    if not isinstance(part.shape, float):

        def change(x):
            return hidden(entry, part.sign * math.exp(x[0]), part.shape, part.place, reference)

        return Shape(*np.array([[start], [most + math.log(SMALLEST)], [most]]), change)
    logs = np.log(grid)
    middle, spread = logs.mean(), logs.std()
    low, at, high = (np.array([logs[0], math.log(part.shape), logs[-1]]) - middle) / spread

    def shaped(x):
        shape = math.exp(middle + spread * x[1])
        return hidden(entry, part.sign * math.exp(x[0]), shape, part.place, reference)

    ends = np.array([[start, at], [most + math.log(SMALLEST), low], [most, high]])
    return Shape(*ends, shaped)


def _missed(frame, truth, shapes, x, tolerance=TOLERANCE):
    """(data + errors + priors,) what effects with parameters x miss; all errors but the modulus act linearly.

    x: the modulus in standard deviations, then the parameters of each effect; tolerance: of the integrator.
    """
    parts, at = [], 1
    for shape in shapes:
        parts.append((shape, x[at : at + len(shape.start)]))
        at += len(shape.start)

    def change(plan):
        for shape, own in parts:
            plan = shape.change(own)(plan)
        return plan

    design, modulus = frame.design, len(frame.design.runs)
    vector = np.zeros(frame.slopes.shape[1])
    vector[modulus] = x[0]
    vector = frame.bounded(vector)
    missed = frame.whiten.vector(predict(design, change, Errors.of(design, vector), tolerance)) - truth
    if not np.isfinite(missed).all():
        raise NoSolution("readings that are no numbers")
    slopes, solve = frame.but_modulus
    errors = solve @ missed
    priors = [own[1] for _, own in parts if len(own) > 1]
    rest = missed - slopes @ errors
    return np.concatenate([rest, -errors, [vector[modulus]], priors])


@dataclass(frozen=True)
class IdealLine:
    """What of a case is known before any verdict.

    Attributes:
        id: of the case.
        ideal: share of the ideal rule; NaN where none is worked out (nothing, three or more effects, or one
            from outside the catalogue).
        before: root mean square, in standard deviations, by which what is hidden moves the record's errors
            (speeds, modulus, gains, triggers) that a model without it would fit.
        cells: run/gauge (run/quantity of scalars) → d′ of what such a model leaves there, as `r1/g1=3.2 …`.
    """

    id: str
    ideal: float
    before: float
    cells: str


@one_thread
def line(spec: Spec) -> IdealLine:
    """The line of a case; ValueError where no drawn design lets its effects act."""
    own = laboratory(spec)
    ideal = share(own, spec, stream(spec, "rule")) if spec.kind in ("single", "pair") else math.nan
    frame = own.case.frame
    seen = sum((h.seen for h in own.case.hidden), np.zeros(len(frame.base) + frame.slopes.shape[1]))
    errors = seen[len(frame.base) :]
    before = float(np.sqrt(np.mean(errors**2)))
    cells = " ".join(f"{name}={size:.4g}" for name, size in _cells(frame, seen[: len(frame.base)]).items())
    return IdealLine(spec.id, ideal, before, cells)


def _cells(frame, rest):
    """run/gauge or run/quantity → d′ of what is left (data,)."""
    design, found = frame.design, {}
    runs, gauges = len(design.runs), len(design.reference.gauges)
    traces = len(rest) - len(design.scalars)
    if traces:
        sizes = np.linalg.norm(rest[:traces].reshape(runs, gauges, -1), axis=2)
        for (run, gauge), size in np.ndenumerate(sizes):
            found[f"r{run + 1}/{design.reference.gauges[gauge].id}"] = float(size)
    for scalar, left in zip(design.scalars, rest[traces:], strict=True):
        name = f"r{scalar.run + 1}/{scalar.quantity}"
        found[name] = math.hypot(found.get(name, 0.0), left)
    return found
