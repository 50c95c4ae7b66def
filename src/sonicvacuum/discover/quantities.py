"""Each measured quantity beside what both models give for it, and what the fit would say without it.

A model that was fitted to a number is not tested by it. Here every quantity is left out once: in the
linearised model at the fit its share is taken out of the normal equations, and what the others leave predicts
it. A quantity without which a parameter would be free is no prediction, and none is given.
"""

import math
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.records.record import in_words

FILE = "quantities.csv"
HEADER = ("run", "quantity", "bound", "unit", "measured", "sigma", "nominal", "extended", "held_out")
# A quantity that holds this share of its own prediction is what the fit rests on.
ALONE = 0.9
_UNITS = {"speed": "m/s", "speed_at_amplitude": "m/s", "width": "diameters"}
_TIMES = ("duration", "contact_duration", "echo_delay")


def rows(null: tuple[Forward, Fit], extended: tuple[Forward, Fit]) -> list[tuple]:
    """One row of `HEADER` for each observable of a data set, NaN where there is no prediction.

    Args:
        null: the nominal model with its fit.
        extended: the same of the model that the verdict stands on.
    """
    before, after, shares = _shown(*null), _shown(*extended), _shares(*extended)
    experiment, found = null[0].experiment, []
    for k, run in enumerate(experiment.runs):
        for j, one in enumerate(run.scalars):
            scale, unit = _unit(experiment, one)
            share, fitted = shares[k][j], after[k][j]
            # Without it the prediction moves by share/(1 − share) of what the fit leaves.
            moved = (one.value - fitted) * share / (1.0 - share) if share < ALONE else math.nan
            numbers = (one.value, one.sigma, before[k][j], fitted, fitted - moved)
            label = in_words(one.quantity, one.options)
            found.append((run.id, label, one.bound or "", unit, *(n * scale for n in numbers)))
    return found


def _unit(experiment, one):
    """What SI values are multiplied by to be told, and the unit then."""
    if one.quantity in _TIMES:
        return 1e6, "us"
    gauge = next((g for g in experiment.gauges if g.id == one.options.get("sensor")), None)
    return 1.0, gauge.unit if one.quantity == "amplitude" and gauge else _UNITS.get(one.quantity, "1")


def _unbounded(forward):
    """A predictor of the same data that follows observables beyond their bounds."""
    e = forward.experiment
    runs = (replace(r, scalars=tuple(replace(one, bound=None) for one in r.scalars)) for r in e.runs)
    return forward.of(replace(e, runs=tuple(runs)))


def _shown(forward, fit):
    """(n,) values in SI of the observables of each run, bounds or not."""
    free = _unbounded(forward)
    found = free.sampled(fit.hypothesis, fit.u[None], fit.nu[None])
    result = []
    for run, value in zip(free.experiment.runs, found, strict=True):
        sigma = np.array([one.sigma for one in run.scalars])
        result.append(value[0, value.shape[1] - len(sigma) :] * sigma)
    return result


def _shares(forward, fit):
    """(n,) share that each observable of each run has in its own fitted value (leverage)."""
    _, hessian = fit.normal.total()
    known = [c.parameter.known for c in fit.hypothesis.coordinates]
    prior = [1.0 / k[1] ** 2 if k else 0.0 for k in known]
    covariance = np.linalg.pinv(hessian[0] + np.diag([*prior, *np.zeros(len(fit.nu))]), hermitian=True)
    columns = forward.columns(fit.hypothesis, fit.u[None], fit.nu[None])
    result = []
    for run, found in enumerate(columns):
        count = len(forward.experiment.runs[run].scalars)
        slopes = found[0, 1:, found.shape[2] - count :]
        own = np.array([*range(len(fit.u)), *(len(fit.u) + forward.local(run))])
        result.append(np.einsum("in,ij,jn->n", slopes, covariance[np.ix_(own, own)], slopes))
    return result
