"""Starts for fits in which something is hardly known: a wall's modulus, the speed of the shots.

Where an echo of the simulation does not overlap the measured one, χ² has no slope towards it, so that a fit
from the middle of a wide prior ends in the nearest of several minima. Fits start all over the prior instead,
each with its pulses put where the measured ones are and as high, where time zero and gain are not known:
another speed would else be judged by when its pulse arrives.
"""

import math
from dataclasses import replace
from itertools import product

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.correlation import correlated
from sonicvacuum.discover.fit import unequal
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit, fit, polish, simulated
from sonicvacuum.discover.model import accuracy
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.nuisances import SCATTER

# Known no better than this, a modulus or a speed may put an echo beside the measured one.
WIDE = 0.1
# Distance of starts in the logarithm; how far they go, in standard errors and at most.
STEP, REACH, MOST = 0.5, 3.0, 1.5
# A gain's logarithm with such an error is one that nobody knows; pulses are looked for within so many widths.
UNKNOWN, ALONG = 1.0, 2
# Starts that are followed to their minimum; steps of all before these are chosen; minima that the fits of
# effects start from.
FOLLOWED, FIRST, MINIMA = 8, 8, 3
# Logarithms of moduli of the beads that are tried where nominal pulses may miss the measured ones: up to a
# factor of five.
QUICKER = (0.4, 0.8, 1.2, 1.6)
# Steps on running integrals, where a fit of nuisances alone starts once more from these.
COARSE = 6
# How often a nominal fit that has run out of steps is followed on, while that gains so much in χ².
LONGER, GAINED = 6, 1.0


def starts(forward: Forward) -> np.ndarray:
    """(L, q) nuisances over the priors of the wide ones, speeds of all runs together, their own ones and what
    they have in common; the middle first.
    """
    layout, sigma = forward.layout, forward.nuisance_sigma
    axes = [(k, _offsets(sigma[k])) for k in layout.simulated if sigma[k] > WIDE]
    speeds = [layout.speed(run) for run in range(layout.runs)]
    together = [at for at in (speeds, layout.other("speed-common")) if min(sigma[at], default=0.0) > WIDE]
    axes += [(at, _of_speeds(float(min(sigma[at])))) for at in together]
    rows = []
    for offsets in product(*(values for _, values in axes)):
        row = np.zeros(layout.size)
        for (at, _), offset in zip(axes, offsets, strict=True):
            row[at] = offset / sigma[at]
        rows.append(row)
    return np.array(rows)


def _of_speeds(sigma):
    """The same of speeds, all of which move together."""
    several = [0.0, -sigma, sigma, -REACH * sigma, REACH * sigma]
    return several if REACH * sigma < MOST else _offsets(sigma)


def _offsets(sigma):
    reach = int(min(REACH * sigma, MOST) / STEP)
    return sorted((STEP * k for k in range(-reach, reach + 1)), key=abs)


def aligned(forward: Forward, hypothesis: Hypothesis, u: np.ndarray, nu: np.ndarray) -> np.ndarray:
    """(L, q) nuisances with time zeros and gains that nobody knows as the data ask for, the rest as it is.

    Args:
        forward: the predictor.
        hypothesis: with (L, p) coordinates `u`.
        u: see there.
        nu: (L, q) nuisances.
    """
    layout, sigma, runs = forward.layout, forward.nuisance_sigma, forward.experiment.runs
    traced = [k for k, one in enumerate(runs) if one.has_signals]
    shifted = [k for k in traced if sigma[layout.trigger(k)] > runs[k].interval]
    open_ = np.flatnonzero(sigma[layout.gains] > UNKNOWN)
    if not shifted and not len(open_):
        return nu
    result, found = nu.copy(), forward.sampled(hypothesis, u, nu)
    product, power = np.zeros((2, len(nu), layout.gauges))
    for run in traced:
        samples = len(runs[run].time)
        data = forward.data(run)[: layout.gauges * samples].reshape(layout.gauges, samples)
        for lane, value in enumerate(found[run]):
            model = value[: data.size].reshape(data.shape)
            if not np.isfinite(model).all():
                continue
            alike = np.array([correlated(*pair) for pair in zip(data, model, strict=True)])
            at = _near(alike.sum(axis=0), model) if run in shifted else samples - 1
            if run in shifted:
                late = (at - (samples - 1)) * runs[run].interval
                result[lane, layout.trigger(run)] += late / sigma[layout.trigger(run)]
            product[lane] += alike[:, at]
            power[lane] += np.square(model).sum(axis=1)
    ratio = np.where((product > 0.0) & (power > 0.0), product / np.maximum(power, 1e-300), 1.0)
    result[:, layout.gains[open_]] += np.log(ratio[:, open_]) / sigma[layout.gains[open_]]
    return result


def _near(alike, model):
    """Place of the shift at which (S, T) readings are most alike, within some widths of their pulse."""
    size = np.abs(model).max(axis=0)
    room = ALONG * max(1, int(np.count_nonzero(size > 0.5 * size.max(initial=0.0))))
    first = max(0, model.shape[1] - 1 - room)
    return first + int(np.argmax(alike[first : first + 2 * room + 1]))


def wide(forward: Forward) -> bool:
    """Whether anything is known so roughly that fits need several starts."""
    return len(starts(forward)) > 1


def values(forward: Forward, one: Fit) -> list[tuple[str, float]]:
    """Name and ratio to the stated one of what the runs share and nobody knows well, as a fit has it."""
    sigma, first = forward.nuisance_sigma, forward.layout.modulus + 1
    own = [
        (k, other) for k, other in enumerate(forward.layout.others, first) if k in forward.layout.simulated
    ]
    return [
        (f"{o.kind} {o.of}".strip(), float(np.exp(one.nu[k] * sigma[k]))) for k, o in own if sigma[k] > WIDE
    ]


def minima(forward: Forward, null: Fit) -> np.ndarray:
    """(L, q) nuisances of the nominal fit and of its next best minima, where fits need several starts; else
    the middle of their priors.
    """
    if not wide(forward):
        return np.zeros((1, forward.layout.size))
    others = null.elsewhere if null.elsewhere is not None else np.zeros((0, forward.layout.size))
    return np.concatenate([null.nu[None], others[: MINIMA - 1]])


def nominal(forward: Forward, held: Hypothesis | None = None) -> Fit:
    """The nominal model, or one with effects as they are held, with its nuisances fitted.

    Where much is left, fits start once more from running integrals, from beads that weigh alike, and from all
    over the priors of what is hardly known, or else with other moduli of the beads.
    """
    held = held or Hypothesis()
    start = np.zeros((1, forward.layout.size))
    direct = _at_rest(forward, fit(forward, held, np.zeros((1, 0)), start))
    if forward.layout.scattered:
        direct = min((direct, _of_equal_beads(forward, held)), key=lambda f: f.objective)
    direct = unequal.lower(forward, direct, noise(forward))
    if not leaves_much(forward, direct.objective):
        return direct
    tried = [direct, fit(forward, held, np.zeros((1, 0)), start, coarse=COARSE)]
    if direct.objective > 2.0 * data(forward) and wide(forward):
        rows = starts(forward)
        u = np.zeros((len(rows), 0))
        rows = aligned(forward, held, u, rows)
        tried.append(fit(forward, held, u, rows, keep=FOLLOWED, halved=FIRST))
    elif direct.objective > policy.GROSS * data(forward):
        rows = _quicker(forward, held, min(tried, key=lambda f: f.objective))
        tried += [fit(forward, held, np.zeros((len(rows), 0)), rows)] if len(rows) else []
    best = min(tried, key=lambda f: f.objective)
    best = best if best.objective < direct.objective - policy.SAME_MINIMUM else direct
    return replace(best, elsewhere=tried[-1].elsewhere)


def _of_equal_beads(forward: Forward, held: Hypothesis) -> Fit:
    """A fit from where beads that weigh alike come nearest the data.

    Pulses that come too early or late are not those of single beads, which may all the same make up for it.
    """
    e = forward.experiment
    alike = tuple(replace(one, sigma=0.0) if one.kind == SCATTER else one for one in e.shared)
    alone = Forward(replace(e, shared=alike), forward.threads)
    equal = _at_rest(alone, fit(alone, held, np.zeros((1, 0)), np.zeros((1, forward.layout.size))))
    return _at_rest(forward, fit(forward, held, np.zeros((1, 0)), equal.nu[None]))


def _at_rest(forward: Forward, one: Fit) -> Fit:
    """A fit followed to its minimum: where masses, sizes and moduli are all open, of which each nearly makes
    up for the others, it goes there by small steps, and its nuisances are far off where they run out.
    """
    for _ in range(LONGER):
        if one.settled:
            break
        before, one = one.objective, polish(forward, one)
        if before - one.objective < GAINED:
            break
    return one


def _quicker(forward: Forward, held: Hypothesis, one: Fit) -> np.ndarray:
    """(L, q) nuisances of a fit with other moduli of the beads, as far as that explains more as it stands.

    Pulses that come a width too early or late have no slope to where they belong.
    """
    at = forward.layout.modulus
    sigma = forward.nuisance_sigma[at]
    if not sigma > 0.0:
        return np.zeros((0, forward.layout.size))
    rows = np.repeat(one.nu[None], 2 * len(QUICKER), axis=0)
    rows[:, at] = np.array([*QUICKER, *(-step for step in QUICKER)]) / sigma
    left = simulated(forward, held, np.zeros((len(rows), 0)), rows)
    return rows[left + np.square(rows).sum(axis=1) < one.objective]


def noise(forward: Forward) -> float:
    """χ² that noise may leave, whatever its shape."""
    size = data(forward)
    return size + policy.MINIMA * math.sqrt(2.0 * size)


def leaves_much(forward: Forward, objective: float) -> bool:
    """Whether a fit of this objective leaves more than noise does."""
    return objective >= noise(forward)


def far(forward: Forward, one: Fit) -> bool:
    """Whether a fit in which something is hardly known leaves so much that simulations need not be as
    accurate as noise asks for.
    """
    return one.objective > accuracy.HIDES * data(forward) and wide(forward)


def again(forward: Forward, one: Fit, more: np.ndarray | None = None, finish: bool = True) -> Fit:
    """The better of a fit and of one from all over the priors, with the effects as they are there; from
    `more` (L, q) nuisances as well. Without `finish` its last steps are left to `refit.finished`.
    """
    rows = starts(forward) if more is None else np.concatenate([starts(forward), more])
    u = np.repeat(one.u[None], len(rows), axis=0)
    rows = aligned(forward, one.hypothesis, u, rows)
    followed = {"keep": FOLLOWED, "halved": FIRST, "reach": one.objective, "finish": finish}
    other = fit(forward, one.hypothesis, u, rows, **followed)
    return min((one, other), key=lambda f: f.objective)
