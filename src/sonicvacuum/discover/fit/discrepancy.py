"""What a smooth discrepancy may be: its kernels, and what each may do to the whitened data of all runs.

In time the process is a sum of bumps with independent weights (process convolution: Higdon, in Quantitative
Methods for Current Environmental Issues, Springer 2002, 37), times a rise with the pulse. The bumps of all
runs of a gauge stand at the same times from its first pulse, in widths of it, so that weights that are alike
in runs of like speeds make the process alike.
"""

import itertools
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.model.experiment import Experiment, Part

# Distance of bumps in their length.
_APART = 0.75
# Directions that bumps hardly take, as a share of what they do along the first, do not count.
FAINT = 1e-3
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
        runs, gauges = range(len(experiment.runs)), range(len(experiment.gauges))
        self._traces = [[_Trace(self.experiment, run, s) for run in runs] for s in gauges]
        self._splits: dict[tuple, tuple] = {}
        samples = sum(len(run.time) for run in experiment.runs)
        each = 8 * max(1, samples * len(experiment.gauges) * policy.SMOOTH_KNOTS)
        self.kernels = KERNELS[: max(FEWEST, policy.SMOOTH_BYTES // each)]

    def parts(self, kernel: Kernel) -> tuple[Part, ...]:
        """Of each gauge."""
        if kernel not in self._parts:
            self._parts[kernel] = tuple(self._part(s, kernel) for s in range(len(self._traces)))
        return self._parts[kernel]

    def _part(self, s, kernel):
        """What a discrepancy may do to the readings of one gauge."""
        directions, factors = self._split(s, kernel.onset, kernel.length)
        if not kernel.shared:
            variances = np.concatenate([np.square(f).sum(axis=1) for f in factors])
            return Part(directions, np.eye(len(variances)), variances)
        alike = _alike(self.experiment, kernel.shared)
        crossed = np.block([_crossed(factors, alike, run) for run in range(len(factors))])
        variances, mixing = np.linalg.eigh(crossed)
        kept = variances > policy.SMOOTH_FAINT * variances.max(initial=0.0)
        return Part(directions, mixing[:, kept], variances[kept])

    def _split(self, s, onset, length):
        """Directions of all runs of a gauge and what bumps have along them, whatever runs have in common."""
        key = (s, onset, length)
        if key not in self._splits:
            own = self._traces[s]
            enough = max([length, *(one.shortest for one in own if one.loud)])
            self._splits[key] = tuple(zip(*(one.split(onset, enough) for one in own), strict=True))
        return self._splits[key]


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
        first = max(0.0, self.peak + policy.SMOOTH_ONSETS[0][0] * self.wide)
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
        # By their products, in half the time: rounding is far below the squares of what is kept.
        squares, axes = np.linalg.eigh(white @ white.T)
        kept = squares > FAINT**2 * squares.max()
        size, axes = np.sqrt(squares[kept]), axes[:, kept]
        return white.T @ (axes / size), (axes * size).T

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
    first = before[-1] if len(before) else -1  # the sample before the trace: as `last`, not one of the pulse
    last = after[0] if len(after) else len(trace)
    return max(3, int(last - first - 1))
