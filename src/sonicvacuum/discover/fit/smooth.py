"""What is left, modelled: a smooth discrepancy between any model and the data, as more noise.

Kennedy & O'Hagan (J. R. Stat. Soc. B 63, 425, 2001): data = model + discrepancy + noise, the discrepancy a
Gaussian process in time and speed, of each gauge its own. Its standard deviation is a share of each trace's
peak, from the arrival on; its correlation time is a share of the pulse's width, time counting from the first
pulse in such widths; and part of it is alike in runs of like speeds (`discrepancy`). The covariance of all
whitened traces of a gauge together is 1 + U Λ Uᵀ with a few orthonormal columns U, and its inverse root
1 − U (1 − (1 + Λ)^−½) Uᵀ. Applied to data, predictions and slopes alike (`Experiment.divided`), it is seen by
every step: screen, fit, evidence, held-out runs and limits.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.discrepancy import KERNELS, STATED, Kernel, Shapes
from sonicvacuum.discover.fit.normal import from_slopes
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.experiment import Experiment, Part, Smooth
from sonicvacuum.discover.model.forward import Forward


def with_size(
    experiment: Experiment,
    size: float,
    known: Shapes | None = None,
    excess: float = 1.0,
    kernel: Kernel = STATED,
) -> Experiment:
    """The experiment with a smooth discrepancy of `size` (share of the peak) in its noise, and the noise of
    single samples `excess` times as large; `known` are its `Shapes`, where at hand.
    """
    white = replace(experiment, smooth=None)
    if not size:
        return white
    smooth = Smooth(size, (size / excess) ** 2, (known or Shapes(white)).parts(kernel))
    return replace(white, sigma=excess * white.sigma, smooth=smooth)


@dataclass(frozen=True)
class Size:
    """The likeliest smooth discrepancy at a fitted model.

    Attributes:
        size: share of the peak; 0 where none is likelier.
        drop: by how much −2 log evidence is lower than without any, 0 or more.
        excess: noise of single samples over what it is, 1 or more: what is rougher than the discrepancy.
        rough: by how much −2 log evidence is lower for that alone, 0 or more.
        kernel: how it is correlated.
        rest: χ² per datum, over the noise as it is, of what it does not take up; infinite without any.
    """

    size: float
    drop: float
    excess: float = 1.0
    rough: float = 0.0
    kernel: Kernel = KERNELS[0]
    rest: float = math.inf

    @property
    def log_bayes(self) -> float:
        """Log of the posterior odds that there is a smooth misfit, prior odds and Occam factor included."""
        return 0.5 * self.drop + policy.SMOOTH_LOG_PRIOR

    @property
    def log_odds(self) -> float:
        """Log of the posterior odds of smooth misfit and rough one together, 0 where there is none."""
        return max(0.0, self.log_bayes) + 0.5 * self.rough

    def same(self, other: "Size") -> bool:
        """Whether both are the same noise."""
        own, others = ((one.size, one.excess, one.kernel if one.size else None) for one in (self, other))
        return own == others

    @property
    def found(self) -> bool:
        """Whether a smooth misfit is likelier than none."""
        return self.log_bayes > 0.0


def infer(forward: Forward, fit: Fit, known: Shapes) -> Size:
    """The likeliest smooth discrepancy at a model, whose parameters and nuisances follow linearly.

    `forward` has no discrepancy of its own, `known` are its `Shapes`. The evidence is marginal over
    parameters and nuisances. The discrepancy is part of the residual, so that it can hardly be larger
    (`_largest`): what is rougher than its kernel would ask for any size.
    """
    if not any(len(part.variances) for part in known.parts(KERNELS[0])):
        return Size(0.0, 0.0)
    model = _Model(forward, fit)
    sizes = np.geomspace(policy.SMOOTH_LEAST, policy.SMOOTH_MOST, policy.SMOOTH_SIZES)
    sizes = sizes[sizes <= max(sizes[0], _largest(forward, model.columns))]
    first = _Marginal(model, known.parts(KERNELS[0]))
    excess = first.excess(sizes)
    nothing = first(0.0, excess)
    rough = max(0.0, float(first(0.0, 1.0) - nothing))

    def likeliest(marginal, sizes, kernel):
        drop = [nothing - marginal(size, excess) for size in sizes]
        best = int(np.argmax(drop))
        size, rest = float(sizes[best]), marginal.rest(sizes[best], excess)
        return Size(size, max(0.0, float(drop[best])), excess, rough, kernel, rest)

    seen = likeliest(first, sizes, KERNELS[0])
    if not seen.found:
        return seen if seen.drop > 0.0 else Size(0.0, 0.0)
    near = sizes[np.abs(np.log(sizes / seen.size)) < np.log(policy.SMOOTH_NEAR)]
    others = (likeliest(_Marginal(model, known.parts(k)), near, k) for k in known.kernels[1:])
    return max([seen, *others], key=lambda one: one.drop)


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


class _Model:
    """A fitted model as the evidence of a discrepancy beside it needs it."""

    def __init__(self, forward, fit):
        self.forward = forward
        self.columns = forward.columns(fit.hypothesis, fit.u[None], fit.nu[None])
        self.normal = from_slopes(forward, fit.normal.free, fit.u[None], fit.nu[None], self.columns)
        # What moves nothing, as an effect that has died out does, follows nothing either.
        moves = np.diag(self.normal.hessian.sum(axis=0)[0])[: len(fit.u)] > 0.0
        self.free = np.concatenate([~fit.at_bound() & moves, np.ones(len(fit.nu), dtype=bool)])
        self._whole = [self._of_run(run, columns[0]) for run, columns in enumerate(self.columns)]

    def _of_run(self, run, columns):
        """(1 + unknowns, M) residual of a run and its columns of all unknowns."""
        free = self.normal.free
        whole = np.zeros((1 + self.normal.gradient.shape[2], columns.shape[1]))
        whole[0] = self.forward.data(run) - columns[0]
        whole[1 : 1 + free] = columns[1 : 1 + free]
        whole[1 + free + self.forward.local(run)] = columns[1 + free :]
        return whole

    def along(self, parts: Iterable[Part]) -> np.ndarray:
        """(n, 1 + unknowns) residual and columns of the unknowns along what a discrepancy may be."""
        times, rows = [len(run.time) for run in self.forward.experiment.runs], []
        for s, part in enumerate(parts):
            traces = [w[:, s * n : (s + 1) * n] for w, n in zip(self._whole, times, strict=True)]
            rows.append(part.along(traces).T)
        return np.concatenate(rows)[:, np.concatenate([[True], self.free])]


class _Marginal:
    """−2 log evidence, up to a constant of the data, of a discrepancy of some size and of noise some times as
    large, beside a linearised model.
    """

    def __init__(self, model: _Model, parts: tuple[Part, ...]):
        normal, free = model.normal, model.free
        experiment = model.forward.experiment
        self.parts, self.variances = model.along(parts), np.concatenate([p.variances for p in parts])
        self.data = sum(experiment.size(run) for run in range(len(normal.chi2)))
        self.chi2, self.nu = float(normal.chi2.sum()), np.zeros(int(free.sum()))
        self.gradient = normal.gradient.sum(axis=0)[0][free]
        self.hessian = normal.hessian.sum(axis=0)[0][np.ix_(free, free)]
        unknowns = len(self.nu) - normal.nu.shape[1]
        self.nu[unknowns:] = normal.nu[0]
        self.prior = np.diag((np.arange(len(self.nu)) >= unknowns).astype(float))

    def __call__(self, size: float, excess: float) -> float:
        misfit, volume = self._told(size, excess)
        return self.chi2 / excess**2 + misfit + 2.0 * self.data * math.log(excess) + volume

    def rest(self, size: float, excess: float) -> float:
        """χ² per datum, over the noise as it is, that is left beside the discrepancy."""
        misfit, _ = self._told(size, excess)
        return (self.chi2 + excess**2 * misfit) / self.data

    def _told(self, size, excess):
        gradient = self.gradient / excess**2 - self.nu
        hessian = self.hessian / excess**2 + self.prior
        variances = self.variances * (size / excess) ** 2
        return _evidence(self.parts / excess, variances, gradient, hessian)

    def excess(self, sizes) -> float:
        """Noise over what it is that is likeliest with any of some sizes; 1 where it is not surely larger."""
        most = max(1.0, math.sqrt(self.chi2 / self.data))
        tried = policy.EXCESS_STEP ** np.arange(1 + int(math.log(most) / math.log(policy.EXCESS_STEP)))
        best = [min(self(size, one) for size in (0.0, *sizes)) for one in tried]
        return float(tried[int(np.argmin(best))])


def _evidence(parts, variances, gradient, hessian):
    """−2 log evidence up to a constant of the data: of the misfit, and of the volume that is left open."""
    taken = variances / (1.0 + variances)
    left = parts * taken[:, None]
    lost = left.T @ parts
    g, h = gradient - lost[0, 1:], hessian - lost[1:, 1:]
    h = h + 1e-9 * np.diag(np.diag(hessian))
    solved = np.linalg.solve(h, g)
    volume = np.log1p(variances).sum() + np.linalg.slogdet(h)[1]
    return -lost[0, 0] - g @ solved, volume
