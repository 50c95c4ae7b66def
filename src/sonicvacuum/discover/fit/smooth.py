"""What is left, modelled: a smooth discrepancy between any model and the data, as more noise.

Kennedy & O'Hagan (J. R. Stat. Soc. B 63, 425, 2001): data = model + discrepancy + noise, the discrepancy a
Gaussian process in time. Here its standard deviation is a share of each trace's peak, from the arrival on,
and its correlation time a share of the pulse's width. It is written as a sum of bumps with independent
weights (process convolution: Higdon, in Quantitative Methods for Current Environmental Issues, Springer
2002, 37), so that the covariance of a whitened trace is 1 + U Λ Uᵀ with a few orthonormal columns U, and
its inverse root 1 − U (1 − (1 + Λ)^−½) Uᵀ. Applied to data, predictions and slopes alike
(`Experiment.whiten`), it is seen by every step: screen, fit, evidence, held-out runs and limits.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.normal import from_slopes
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.experiment import Experiment, Smooth
from sonicvacuum.discover.model.forward import Forward

# It begins so many widths before the peak, with the pulse itself.
_BEFORE = 1.5


def with_size(experiment: Experiment, size: float, known=None, excess: float = 1.0) -> Experiment:
    """The experiment with a smooth discrepancy of `size` (share of the peak) in its noise, and the noise of
    single samples `excess` times as large.

    The part that is common to all runs does not average away over them; as runs are whitened one by one, the
    variance of each is enlarged by as much. `known` are its `blocks`, where at hand.
    """
    white = replace(experiment, smooth=None)
    if not size:
        return white
    runs = sum(r.has_signals for r in experiment.runs)
    factor = 1.0 + policy.SMOOTH_SHARED * max(0, runs - 1)
    smooth = Smooth(size, factor * size**2 / excess**2, known or blocks(white))
    return replace(white, sigma=excess * white.sigma, smooth=smooth)


def blocks(experiment: Experiment):
    """For each run and gauge, orthonormal columns (T, r) of a smooth discrepancy in the whitened trace, and
    their variances (r,) for a size of one peak.
    """
    return tuple(
        tuple(_block(experiment, run, s) for s in range(len(experiment.gauges)))
        for run in range(len(experiment.runs))
    )


def _block(experiment, run, s):
    data = experiment.runs[run]
    samples = len(data.time)
    trace = np.abs(np.nan_to_num(data.readings[s])) if samples else np.zeros(0)
    if samples < 8 or not trace.max() > 0.0:
        return np.zeros((samples, 0)), np.zeros(0)
    bumps = trace.max() * _bumps(samples, int(trace.argmax()), width(trace))
    alone = np.zeros((bumps.shape[1], len(experiment.gauges), samples))
    alone[:, s] = bumps.T
    nothing = np.zeros((len(alone), len(data.scalars)))
    white = experiment.whiten(run, alone, nothing)[:, s * samples : (s + 1) * samples]
    u, values, _ = np.linalg.svd(white.T, full_matrices=False)
    kept = values > 1e-3 * values.max()
    return u[:, kept], np.square(values[kept])


def width(trace: np.ndarray) -> int:
    """Samples for which the main pulse of a trace (T,) exceeds half its peak, 3 at least."""
    peak = int(trace.argmax())
    low = np.flatnonzero(trace < 0.5 * trace[peak])
    before, after = low[low < peak], low[low > peak]
    first = before[-1] if len(before) else 0
    last = after[0] if len(after) else len(trace)
    return max(3, int(last - first - 1))


def _bumps(samples, peak, wide):
    """(T, K) bumps whose squares add up to 1 from the arrival on."""
    first = max(0.0, peak - _BEFORE * wide)
    length = max(policy.SMOOTH_LENGTH * wide, (samples - first) / (0.75 * policy.SMOOTH_KNOTS))
    knots = np.arange(first, samples + 0.5 * length, 0.75 * length)
    time = np.arange(samples)[:, None]
    bumps = np.exp(-np.square((time - knots) / length))
    whole = np.sqrt(np.square(bumps).sum(axis=1, keepdims=True))
    middle = whole[min(samples - 1, int(first + 2.0 * length))]
    return bumps / np.maximum(whole, middle)


@dataclass(frozen=True)
class Size:
    """The likeliest smooth discrepancy at a fitted model.

    Attributes:
        size: share of the peak; 0 where none is likelier.
        drop: by how much −2 log evidence is lower than without any, 0 or more.
        excess: noise of single samples over what it is, 1 or more: what is rougher than the discrepancy.
        rough: by how much −2 log evidence is lower for that alone, 0 or more.
    """

    size: float
    drop: float
    excess: float = 1.0
    rough: float = 0.0

    @property
    def log_bayes(self) -> float:
        """Log of the posterior odds that there is a smooth misfit, prior odds and Occam factor included."""
        return 0.5 * self.drop + policy.SMOOTH_LOG_PRIOR

    @property
    def log_odds(self) -> float:
        """Log of the posterior odds of smooth misfit and rough one together, 0 where there is none."""
        return max(0.0, self.log_bayes) + 0.5 * self.rough

    @property
    def found(self) -> bool:
        """Whether a smooth misfit is likelier than none."""
        return self.log_bayes > 0.0


def infer(forward: Forward, fit: Fit, known) -> Size:
    """The size of the smooth discrepancy at a model, whose parameters and nuisances follow linearly.

    `forward` has no discrepancy of its own, `known` are its `blocks`. The evidence is marginal over
    parameters and nuisances. The discrepancy is part of the residual, so that it can hardly be larger
    (`_largest`): what is rougher than its kernel would ask for any size.
    """
    if not sum(len(v) for part in known for _, v in part):
        return Size(0.0, 0.0)
    columns = forward.columns(fit.hypothesis, fit.u[None], fit.nu[None])
    normal = from_slopes(forward, fit.normal.free, fit.u[None], fit.nu[None], columns)
    free = np.concatenate([~fit.at_bound(), np.ones(len(fit.nu), dtype=bool)])
    parts, variances = _projected(forward, fit, columns, known)
    parts = parts[:, np.concatenate([[True], free])]
    sizes = np.geomspace(policy.SMOOTH_LEAST, policy.SMOOTH_MOST, policy.SMOOTH_SIZES)
    sizes = sizes[sizes <= max(sizes[0], _largest(forward, columns))]
    marginal = _Marginal(forward, normal, free, parts, variances)
    excess = marginal.excess(sizes)
    values = np.array([marginal(size, excess) for size in (0.0, *sizes)])
    rough = marginal(0.0, 1.0) - values[0]
    drop = values[0] - values[1:]
    best = int(drop.argmax())
    if not drop[best] > 0.0:
        return Size(0.0, 0.0)
    return Size(float(sizes[best]), float(drop[best]), excess, max(0.0, float(rough)))


def _largest(forward, columns):
    """Root mean square of the residual as a share of the peak, the largest over traces, and what nuisances
    may have taken up of it.
    """
    e, largest = forward.experiment, 0.0
    for run, part in enumerate(columns):
        left, samples = forward.data(run) - part[0, 0], len(e.runs[run].time)
        for s in range(len(e.gauges) if samples else 0):
            peak = float(np.abs(np.nan_to_num(e.runs[run].readings[s])).max()) / e.sigma[s]
            own = left[s * samples : (s + 1) * samples]
            largest = max(largest, math.sqrt(float(own @ own) / samples) / peak if peak > 0.0 else 0.0)
    return policy.SMOOTH_TAKEN_UP * largest


def _projected(forward, fit, columns, known):
    """(ranks, 1 + n) residual and columns along the discrepancy's directions, and (ranks,) variances."""
    free, unknowns = fit.normal.free, fit.normal.gradient.shape[2]
    rows, variances = [], []
    for run, part in enumerate(columns):
        stack = part[0].copy()
        stack[0] = forward.data(run) - stack[0]
        where = np.concatenate([[0], 1 + np.arange(free), 1 + free + forward.layout.local(run)])
        samples = len(forward.experiment.runs[run].time)
        for s, (u, variance) in enumerate(known[run]):
            row = np.zeros((len(variance), 1 + unknowns))
            row[:, where] = (stack[:, s * samples : (s + 1) * samples] @ u).T
            rows.append(row)
            variances.append(variance)
    return np.concatenate(rows), np.concatenate(variances)


class _Marginal:
    """−2 log evidence, up to a constant of the data, of a discrepancy of some size and of noise some times as
    large, beside a linearised model.
    """

    def __init__(self, forward, normal, free, parts, variances):
        self.parts, self.variances = parts, variances
        self.data = sum(forward.experiment.size(run) for run in range(len(normal.chi2)))
        self.chi2, self.nu = float(normal.chi2.sum()), np.zeros(int(free.sum()))
        self.gradient = normal.gradient.sum(axis=0)[0][free]
        self.hessian = normal.hessian.sum(axis=0)[0][np.ix_(free, free)]
        unknowns = len(self.nu) - normal.nu.shape[1]
        self.nu[unknowns:] = normal.nu[0]
        self.prior = np.diag((np.arange(len(self.nu)) >= unknowns).astype(float))

    def __call__(self, size: float, excess: float) -> float:
        gradient = self.gradient / excess**2 - self.nu
        hessian = self.hessian / excess**2 + self.prior
        variances = self.variances * (size / excess) ** 2
        own = self.chi2 / excess**2 + 2.0 * self.data * math.log(excess)
        return own + _evidence(self.parts / excess, variances, gradient, hessian)

    def excess(self, sizes) -> float:
        """Noise over what it is that is likeliest with any of some sizes; 1 where it is not surely larger."""
        most = max(1.0, math.sqrt(self.chi2 / self.data))
        tried = policy.EXCESS_STEP ** np.arange(1 + int(math.log(most) / math.log(policy.EXCESS_STEP)))
        best = [min(self(size, one) for size in (0.0, *sizes)) for one in tried]
        return float(tried[int(np.argmin(best))])


def _evidence(parts, variances, gradient, hessian):
    """−2 log evidence up to a constant of the data."""
    taken = variances / (1.0 + variances)
    left = parts * taken[:, None]
    lost = left.T @ parts
    g, h = gradient - lost[0, 1:], hessian - lost[1:, 1:]
    h = h + 1e-9 * np.diag(np.diag(hessian))
    solved = np.linalg.solve(h, g)
    return -lost[0, 0] - g @ solved + np.log1p(variances).sum() + np.linalg.slogdet(h)[1]
