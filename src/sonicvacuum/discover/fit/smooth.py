"""What is left, modelled: a smooth discrepancy between any model and the data, as more noise.

Kennedy & O'Hagan (J. R. Stat. Soc. B 63, 425, 2001): data = model + discrepancy + noise, the discrepancy a
Gaussian process in time and speed, of each gauge its own. Its standard deviation is a share of each trace's
peak, from the arrival on; its correlation time is a share of the pulse's width, time counting from the first
pulse in such widths; and part of it is alike in runs of like speeds. In time it is a sum of bumps with
independent weights (process convolution: Higdon, in Quantitative Methods for Current Environmental Issues,
Springer 2002, 37), so that the covariance of all whitened traces of a gauge together is 1 + U Λ Uᵀ with a few
orthonormal columns U, and its inverse root 1 − U (1 − (1 + Λ)^−½) Uᵀ. Applied to data, predictions and
slopes alike (`Experiment.divided`), it is seen by every step: screen, fit, evidence, held-out runs and
limits.
"""

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.normal import from_slopes
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.experiment import Experiment, Part, Smooth
from sonicvacuum.discover.model.forward import Forward

# Distance of bumps in their length.
_APART = 0.75
# Kernels that are tried however long a record is: with and without something alike in all runs.
FEWEST = 2


class Kernel(NamedTuple):
    """What a discrepancy is like, times in widths of the pulse.

    Attributes:
        onset: when it begins, from the peak, and for how long it rises.
        length: its correlation time.
        shared: share of its variance that is alike in runs of like speeds.
    """

    onset: tuple[float, float]
    length: float
    shared: float


# The first is what is looked for; where it is found, the others are tried.
KERNELS = tuple(
    itertools.starmap(
        Kernel, itertools.product(policy.SMOOTH_ONSETS, policy.SMOOTH_LENGTHS, policy.SMOOTH_ALIKE)
    )
)
# Of one whose size a record states: nothing is asked of the data, and half of it is taken as common.
STATED = Kernel(policy.SMOOTH_ONSETS[-1], policy.SMOOTH_LENGTHS[0], policy.SMOOTH_SHARED)


class Shapes:
    """What a smooth discrepancy of an experiment may be, kernel by kernel; each is worked out once.

    Attributes:
        kernels: those that are tried; of long records fewer, to bound the memory.
    """

    def __init__(self, experiment: Experiment):
        self.experiment = replace(experiment, smooth=None)
        self._parts: dict[Kernel, tuple[Part, ...]] = {}
        samples = sum(len(run.time) for run in experiment.runs)
        each = 8 * max(1, samples * len(experiment.gauges) * policy.SMOOTH_KNOTS)
        self.kernels = KERNELS[: max(FEWEST, policy.SMOOTH_BYTES // each)]

    def parts(self, kernel: Kernel) -> tuple[Part, ...]:
        """Of each gauge."""
        if kernel not in self._parts:
            gauges = range(len(self.experiment.gauges))
            self._parts[kernel] = tuple(_part(self.experiment, s, kernel) for s in gauges)
        return self._parts[kernel]


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


def _part(experiment, s, kernel):
    """What a discrepancy may do to the readings of one gauge."""
    found = [_Trace(experiment, run, s) for run in range(len(experiment.runs))]
    length = max([kernel.length, *(one.shortest for one in found if one.loud)])
    directions, factors = zip(*(one.split(kernel.onset, length) for one in found), strict=True)
    if not kernel.shared:
        variances = np.concatenate([np.square(f).sum(axis=1) for f in factors])
        return Part(directions, np.eye(len(variances)), variances)
    alike = _alike(experiment, kernel.shared)
    variances, mixing = np.linalg.eigh(np.block([_crossed(factors, alike, run) for run in range(len(found))]))
    kept = variances > policy.SMOOTH_FAINT * variances.max(initial=0.0)
    return Part(directions, mixing[:, kept], variances[kept])


def _crossed(factors, alike, run):
    """Covariances of the weights of one run's directions with those of all runs, for a size of one peak."""
    row = []
    for other, factor in enumerate(factors):
        bumps = min(factors[run].shape[1], factor.shape[1])
        row.append(alike[run, other] * factors[run][:, :bumps] @ factor[:, :bumps].T)
    return row


def _alike(experiment, shared):
    """(R, R) correlation of the discrepancies of runs."""
    speed = np.ones(len(experiment.runs))
    for batch in experiment.batches:
        speed[list(batch.runs)] = batch.chain.speed
    apart = np.subtract.outer(np.log(speed), np.log(speed)) / policy.SMOOTH_SPEEDS
    return shared * np.exp(-0.5 * np.square(apart)) + (1.0 - shared) * np.eye(len(speed))


class _Trace:
    """One gauge's trace of one run, as far as a discrepancy goes with it."""

    def __init__(self, experiment, run, s):
        self.experiment, self.run, self.s = experiment, run, s
        data = experiment.runs[run]
        self.samples = len(data.time)
        trace = np.abs(np.nan_to_num(data.readings[s])) if self.samples else np.zeros(1)
        self.height = float(trace.max())
        self.loud = self.samples >= 8 and self.height > 0.0
        self.peak, self.wide = first_pulse(trace) if self.loud else (0, 1)

    @property
    def shortest(self) -> float:
        """Correlation time in widths below which too many bumps would be needed."""
        first = max(0.0, self.peak - 1.5 * self.wide)
        return (self.samples - first) / (_APART * policy.SMOOTH_KNOTS) / self.wide

    def split(self, onset: tuple[float, float], length: float) -> tuple[np.ndarray, np.ndarray]:
        """Orthonormal directions (T, r) of the whitened trace, and (r, K) what each bump has along them."""
        if not self.loud:
            return np.zeros((self.samples, 0)), np.zeros((0, 0))
        e, bumps = self.experiment, self.height * self._bumps(*onset, length)
        alone = np.zeros((bumps.shape[1], len(e.gauges), self.samples))
        alone[:, self.s] = bumps.T
        nothing = np.zeros((len(alone), len(e.runs[self.run].scalars)))
        own = slice(self.s * self.samples, (self.s + 1) * self.samples)
        white = e.whiten(self.run, alone, nothing)[:, own]
        u, values, shares = np.linalg.svd(white.T, full_matrices=False)
        kept = values > 1e-3 * values.max()
        return u[:, kept], values[kept, None] * shares[kept]

    def _bumps(self, begins, rises, length):
        """(T, K) bumps whose squares add up to 1 once the pulse is there, each at its time from the peak."""
        time = (np.arange(self.samples)[:, None] - self.peak) / self.wide
        knots = np.arange(begins - 2.0 * length, time[-1, 0] + 2.0 * length, _APART * length)
        bumps = np.exp(-np.square((time - knots) / length))
        risen = 0.5 - 0.5 * np.cos(np.pi * np.clip((time - begins) / rises, 0.0, 1.0))
        return risen * bumps / np.sqrt(np.square(bumps).sum(axis=1, keepdims=True).clip(1e-300))


def first_pulse(trace: np.ndarray) -> tuple[int, int]:
    """Peak and width in samples of the first pulse of a trace (T,) that comes to half of the highest: what is
    reflected may be higher than what arrives.
    """
    loud = trace >= 0.5 * trace.max()
    first = int(loud.argmax())
    after = np.flatnonzero(~loud[first:])
    peak = first + int(trace[first : first + int(after[0]) if len(after) else None].argmax())
    return peak, _width_at(trace, peak)


def width(trace: np.ndarray) -> int:
    """Samples for which the main pulse of a trace (T,) exceeds half its peak, 3 at least."""
    return _width_at(trace, int(trace.argmax()))


def _width_at(trace, peak):
    low = np.flatnonzero(trace < 0.5 * trace[peak])
    before, after = low[low < peak], low[low > peak]
    first = before[-1] if len(before) else 0
    last = after[0] if len(after) else len(trace)
    return max(3, int(last - first - 1))


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
        self.free = np.concatenate([~fit.at_bound(), np.ones(len(fit.nu), dtype=bool)])

    def along(self, parts: Iterable[Part]) -> np.ndarray:
        """(n, 1 + unknowns) residual and columns of the unknowns along what a discrepancy may be."""
        e, free = self.forward.experiment, self.normal.free
        unknowns = self.normal.gradient.shape[2]
        wide = []
        for run, columns in enumerate(self.columns):
            own = np.zeros((1 + unknowns, columns.shape[2]))
            own[: 1 + free] = columns[0, : 1 + free]
            own[1 + free + self.forward.local(run)] = columns[0, 1 + free :]
            own[0] = self.forward.data(run) - own[0]
            wide.append(own)
        rows = []
        for s, part in enumerate(parts):
            times = (len(run.time) for run in e.runs)
            own = [all_[:, s * n : (s + 1) * n] for all_, n in zip(wide, times, strict=True)]
            rows.append(part.along(own).T)
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
