"""Goodness of fit: does what a model leaves look like noise, whatever its shape may be?

The test of shapes (`unknown`) looks along chosen directions. Here nothing is chosen: for each run and gauge
the whitened residual is asked for its total χ², its whiteness, outliers, and for oscillations of any
frequency that set in anywhere and die away at any rate, or not at all (a bank of damped sinusoids; the same
summed over the runs of a gauge, setting in with the pulse). The smallest p counts, times the number of
independent tests.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import smooth, tails
from sonicvacuum.discover.fit.discrepancy import width
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.noise import rounded, stepped

LAGS = 20
# Decay times of the bank, in widths of the pulse, and how often in one of them an oscillation may set in.
DECAYS, STARTS = (0.5, 1.0, 2.0, 4.0), 2
# Where an oscillation that all runs share sets in, in widths from the peak.
TOGETHER = (-1.0, 0.0, 1.0)
# So many independent tests per sample is the bank of one trace, at most: by the largest value in simulated
# noise it is 6 to 10, for 240 to 900 samples and pulses of 15 to 60.
TRIALS = 10.0
# Sine and cosine of an oscillation are told apart where the determinant of their products is this share of
# the largest possible.
_APART = 0.2
_FAR = 4.0
# A smooth misfit that the record states may be there or not: shares of it beside which noise may be white.
LESS = (0.0, 0.05, 0.2, 0.5)


@dataclass(frozen=True)
class Cell:
    """Residual of one run at one gauge: χ² per datum, its p, p of the whiteness."""

    run: str
    sensor: str
    chi2: float
    p: float
    whiteness: float


@dataclass(frozen=True)
class Goodness:
    """What a model leaves.

    Attributes:
        cells: by run and gauge.
        tests: name of a test → p over all runs and gauges.
        p: of the whole.
        worst: the test of the smallest p.
    """

    cells: tuple[Cell, ...]
    tests: dict[str, float]
    p: float
    worst: str

    @property
    def failed(self) -> bool:
        """Whether a real misfit is left."""
        return self.p < policy.MISFIT


def goodness(forward: Forward, fit: Fit) -> Goodness:
    """All tests of a fitted model's residual."""
    return forward.memory.recalled(fit.hypothesis, fit.u, fit.nu, "goodness", lambda: _tested(forward, fit))


def _tested(forward, fit):
    left = residuals(forward, fit)
    less = _with_less(forward, fit)
    found: dict[str, list[float]] = {"chi2": [], "whiteness": [], "outliers": [], "oscillation": []}
    cells = []
    for run, s, r in left:
        data = forward.experiment.runs[run]
        own = r if data.present is None else r[data.present[s]]
        uneven = _stepped(forward, run, s)
        views = (own, *less.get((run, s), ()))
        known = forward.experiment.remembered(s)
        chi2, white = _chi2(own), 1.0 if uneven else max(_whiteness(view, known) for view in views)
        cells.append(Cell(data.id, forward.experiment.gauges[s].id, float(own @ own) / len(own), chi2, white))
        wide = width(_size(data, s))
        ringing = 1.0 if uneven else _oscillation(r, wide)
        for name, p in zip(found, (chi2, white, outliers(own), ringing), strict=True):
            found[name].append(p)
    total = sum(r @ r for *_, r in left) + _scalars(forward, fit)
    size = sum(forward.experiment.size(k) for k in range(len(forward.experiment.runs)))
    tests = {name: min(1.0, len(ps) * min(ps)) for name, ps in found.items() if ps}
    tests["total"] = _chi2_of(float(total), size - fit.normal.free)
    tests |= _shared(forward, fit, left)
    worst = min(tests, key=tests.get)
    return Goodness(tuple(cells), tests, min(1.0, len(tests) * tests[worst]), worst)


def residuals(forward: Forward, fit: Fit) -> list[tuple[int, int, np.ndarray]]:
    """(run, gauge, (T,) whitened residual) of every trace."""
    found = forward.sampled(fit.hypothesis, fit.u[None], fit.nu[None])
    result = []
    for run, value in enumerate(found):
        samples = len(forward.experiment.runs[run].time)
        left = forward.data(run) - value[0]
        for s in range(len(forward.experiment.gauges) if samples else 0):
            part = left[s * samples : (s + 1) * samples]
            if np.any(part):
                result.append((run, s, part))
    return result


def _stepped(forward, run, s):
    """Whether rounding errors follow the pulse: tests of whiteness and oscillations take them for noise."""
    experiment = forward.experiment
    known = rounded(experiment.record, experiment.gauges[s].id) if experiment.record else 0.0
    return stepped(experiment.runs[run].readings[s], experiment.sigma[s], known)


def _with_less(forward, fit):
    """(run, gauge) → residuals whitened by less of the smooth misfit that the record states: by more than
    there is, what is slow comes out too small, which looks no longer white.
    """
    e, found = forward.experiment, {}
    for share in LESS if e.model_floor_rel and e.smooth else ():
        less = smooth.with_size(e, share * e.model_floor_rel)
        for run, s, r in residuals(forward.of(less), fit):
            there = e.runs[run].present
            found.setdefault((run, s), []).append(r if there is None else r[there[s]])
    return found


def _size(data, s):
    """(T,) magnitude of a measured trace, 0 where samples are missing."""
    return np.abs(np.nan_to_num(data.readings[s]))


def _scalars(forward, fit):
    """χ² of all scalars."""
    found = forward.sampled(fit.hypothesis, fit.u[None], fit.nu[None])
    total = 0.0
    for run, value in enumerate(found):
        count = len(forward.experiment.runs[run].scalars)
        if count:
            total += float(np.square(forward.data(run) - value[0])[-count:].sum())
    return total


def _chi2(r):
    return _chi2_of(float(r @ r), len(r))


def _chi2_of(value, size):
    """p of a χ² of so many data, the noise's standard deviation known to `policy.SIGMA_REL`."""
    size = max(size, 1)
    # By the spread of both: a χ² of fewer degrees of freedom that varies as much.
    spread = 1.0 / (1.0 + 2.0 * policy.SIGMA_REL**2 * size)
    return tails.chi_squared(value * spread, size * spread)


def _whiteness(r, known=1):
    """p of white noise, or of an autoregression of the `known` order, against one of higher order.

    The likelihood ratio by Burg's recursion (J. P. Burg, Maximum Entropy Spectral Analysis, Stanford 1975).
    Reflection coefficients of white noise are independent, so that the tail of the ratio is that of χ² down
    to 60 samples, where the sum of squared autocorrelations of Ljung and Box has six times too many p below
    1e-4.
    """
    count, lags = len(r), min(LAGS + known - 1, len(r) // 4)
    if lags < known + 2:
        return 1.0
    forward = backward = r - r.mean()
    ratio = 0.0
    for lag in range(1, lags + 1):
        ahead, behind = forward[1:], backward[:-1]
        power = ahead @ ahead + behind @ behind
        reflection = 2.0 * (ahead @ behind) / power if power > 0.0 else 0.0
        forward, backward = ahead - reflection * behind, behind - reflection * ahead
        if lag > known:
            ratio -= (count - lag - 1) * np.log1p(-(reflection**2))
    return tails.chi_squared(ratio, lags - known)


def outliers(r):
    """p of the largest sample and of the number of large ones."""
    largest = -np.expm1(len(r) * np.log1p(-2.0 * tails.normal(np.abs(r).max())))
    expected = len(r) * 2.0 * tails.normal(_FAR)
    many = tails.poisson(int(np.count_nonzero(np.abs(r) > _FAR)), expected)
    return float(min(1.0, 2.0 * min(largest, many)))


def _oscillation(r, wide):
    """p of the best damped or lasting sinusoid in one trace."""
    windows, products = _windows(len(r), wide)
    highest = float(_squares(r * windows, products).max())
    return float(-np.expm1(TRIALS * len(r) * np.log1p(-np.exp(-0.5 * highest))))


def _plan(samples, wide):
    """(start, decay) of every window of the bank, in samples; a decay of infinity is the whole trace."""
    windows = [(0, np.inf)]
    for decay in DECAYS:
        length = decay * wide
        windows += [(int(t), length) for t in np.arange(0.0, samples - length, length / STARTS)]
    return windows


@lru_cache(maxsize=32)
def _windows(samples, wide):
    """(W, T) all windows of a trace, and their products; kept, as one record's traces are asked again."""
    starts, decays = np.array(_plan(samples, wide)).T[..., None]
    windows = _window(samples, starts, decays)
    return windows, _products(windows)


@lru_cache(maxsize=128)
def _common_windows(samples, starts, wide):
    """The same of oscillations that all runs share, setting in at `starts` of one run."""
    decays = np.array((*DECAYS, np.inf)) * wide
    windows = _window(samples, np.repeat(starts, len(decays))[:, None], np.tile(decays, len(starts))[:, None])
    return windows, _products(windows)


def _squares(r, products):
    """(…, F) χ² of oscillations in (…, T) residuals times a window."""
    cosine, sine, both, inverse = products
    transformed = np.fft.rfft(r, axis=-1)[..., 1:]
    b, c = transformed.real, -transformed.imag
    return (sine * b**2 - 2.0 * both * b * c + cosine * c**2) * inverse


def _window(samples, start, decay):
    """(…, T) decay from a start on; both may be (…, 1)."""
    time = np.arange(samples) - start
    return np.where(time >= 0, np.exp(-np.maximum(time, 0) / decay), 0.0)


def _products(window):
    """(…, F) products of cosine with itself, sine with itself and both under (…, T) windows, and the inverse
    determinant of the three: 0 where they cannot be told apart.
    """
    square, samples = window**2, window.shape[-1]
    doubled = np.fft.fft(square, axis=-1)[..., 2 * np.arange(1, samples // 2 + 1) % samples]
    whole = square.sum(axis=-1, keepdims=True)
    cosine, sine, both = 0.5 * (whole + doubled.real), 0.5 * (whole - doubled.real), -0.5 * doubled.imag
    determinant = cosine * sine - both**2
    good = determinant > _APART * 0.25 * whole**2
    return cosine, sine, both, np.where(good, 1.0 / np.where(good, determinant, 1.0), 0.0)


def _shared(forward, fit, left):
    """p of oscillations that all runs of a gauge share, setting in with the pulse: gauge by gauge."""
    result, found = [], forward.sampled(fit.hypothesis, fit.u[None], fit.nu[None])
    for s in range(len(forward.experiment.gauges)):
        own = [
            (forward.experiment.runs[run], r, found[run][0, s * len(r) : (s + 1) * len(r)])
            for run, g, r in left
            if g == s and not _stepped(forward, run, s)
        ]
        lengths = {(len(r), round(data.interval, 12)) for data, r, _ in own}
        if len(own) > 1 and len(lengths) == 1:
            result.append(_together(own, s))
    return {"oscillation of a gauge": min(1.0, len(result) * min(result))} if result else {}


def _together(own, s):
    """p of the best oscillation of one gauge's runs, their χ² added."""
    wide = int(np.median([width(_size(data, s)) for data, *_ in own]))
    total = 0.0
    for _, r, predicted in own:
        # By the model's own peak: that of a weak pulse as measured is where the noise is largest.
        peak = int(np.abs(predicted).argmax())
        starts = tuple(max(0, int(peak + after * wide)) for after in TOGETHER)
        windows, products = _common_windows(len(r), starts, wide)
        total = total + _squares(r * windows, products)
    # Neighbouring members of the bank are alike; counting each errs on the safe side.
    return float(min(1.0, total.size * tails.chi_squared(float(total.max()), 2 * len(own))))
