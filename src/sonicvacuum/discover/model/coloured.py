"""Noise whose neighbouring samples are alike: how much less a stretch of it tells than as many free samples.

A stretch that wanders looks as if it drifted, rested elsewhere or held a slow line. It is taken for a process
of first order, x_t = ρ x_{t−1} + noise, whose ρ is that of the stretch itself once what is looked for is off.
"""

import math
from collections.abc import Sequence

import numpy as np

from sonicvacuum.discover.model.whitening import lag_one

# Correlations below so many standard errors (1/√n) are those of white noise.
_SEEN = 2.0
# As correlated as noise may be taken for: beyond, a stretch is a drift and no noise.
_MOST = 0.98
# A line takes no more of the power of a stretch than leaves this share.
_LEAST = 0.1
# Correlations tried where none is told surely.
# Powers of time beside which a stretch is judged: those of a line, and of a foot that rises from rest.
LINE, FOOT = (0, 1), (1,)
TRIED = np.linspace(0.0, _MOST, 50)


def correlation(left: np.ndarray) -> float:
    """Correlation of neighbours in (n,) what a straight line leaves; 0 where they may be free.

    Its bias −(2 + 4ρ)/n is taken off (Kendall, Biometrika 41, 403, 1954, for a mean; twice that for a line),
    and a standard error √((1 − ρ²)/n) is put on, lest short stretches pass for white ones.
    """
    n = len(left)
    seen = lag_one(left)
    rho = min(seen + (2.0 + 4.0 * seen) / n, _MOST)
    if rho < _SEEN / math.sqrt(n):
        return 0.0
    return min(rho + math.sqrt((1.0 - rho**2) / n), _MOST)


def wider(left: np.ndarray) -> float:
    """Error of a mean or of a slope over that in white noise: √((1 + ρ)/(1 − ρ)) (Bartlett, J. R. Stat. Soc.
    Suppl. 8, 27, 1946, for many samples).
    """
    rho = correlation(left)
    return math.sqrt((1.0 + rho) / (1.0 - rho))


def loss_of_size(left: np.ndarray) -> float:
    """By how much the logarithm of a standard deviation about a line falls short.

    The line takes two of the n (1 − ρ)/(1 + ρ) samples that are free for a mean; two of n are counted.
    """
    return -0.5 * math.log(max(1.0 - 2.0 * (wider(left) ** 2 - 1.0) / len(left), _LEAST))


def error_of_size(left: np.ndarray) -> float:
    """Standard error of the logarithm of the standard deviation of (n,) samples: √((κ − 1)/m)/2.

    κ is the samples' own kurtosis where it exceeds a Gaussian's 3, as it does where few of them leave the
    step of a digitiser on which the others rest; m = n (1 − ρ²)/(1 + ρ²) (Bayley & Hammersley, J. R. Stat.
    Soc. Suppl. 8, 184, 1946).
    """
    rho, square = correlation(left), np.square(left - left.mean())
    kurtosis = float(np.square(square).mean() / max(float(square.mean()) ** 2, 1e-300))
    free = len(left) * (1.0 - rho**2) / (1.0 + rho**2)
    return 0.5 * math.sqrt((max(kurtosis, 3.0) - 1.0) / free)


def gain(without: np.ndarray, beside: np.ndarray) -> float:
    """Δ(−2 log likelihood) that taking something off a stretch brings, the noise being of first order.

    Args:
        without: (n,) stretch as it is.
        beside: (n,) what is left of it.
    """
    before, after = (_innovation(part) for part in (without, beside))
    return len(without) * math.log(before / after) if before > 0.0 and after > 0.0 else 0.0


def _innovation(left):
    """Variance of what the preceding sample does not foretell."""
    rho = float(left[1:] @ left[:-1]) / max(float(left[:-1] @ left[:-1]), 1e-300)
    return float(np.square(left[1:] - rho * left[:-1]).mean())


def misfit_of_size(stretches: Sequence[np.ndarray], sigma: float) -> float:
    """Δ(−2 log likelihood) that noise of any size gains over noise of size `sigma`, each with the correlation
    that suits it best, 0 to 0.98, in (n,) stretches about a line each.

    A line takes nearly all of a stretch that is hardly longer than its noise remembers, and leaves something
    that looks white.
    """
    stated, own = _likelihoods(stretches, sigma, LINE)
    return float(stated.min() - own.min())


def misfit(stretches: Sequence[np.ndarray], sigma: float, rho: float, beside: Sequence[int]) -> float:
    """The same that noise of any size and correlation gains over noise of these, beside powers of time."""
    stated, own = _likelihoods(stretches, sigma, beside)
    return float(np.interp(rho, TRIED, stated) - own.min())


def told(stretches: Sequence[np.ndarray], sizes: np.ndarray) -> tuple[float, float]:
    """Correlation of neighbours in (n,) stretches beside the foot of a pulse, and how many samples of white
    noise would tell it as well, or tell it as surely from none.

    (R,) `sizes` are those of the noise for every correlation in `TRIED`, of which any is as probable
    beforehand.
    """
    found, _ = _likelihoods(stretches, sizes, FOOT)
    weights = np.exp(-0.5 * (found - found.min()))
    mean = float(np.average(TRIED, weights=weights))
    variance = max(float(np.average((TRIED - mean) ** 2, weights=weights)), 1e-6)
    return mean, max(1.0 / variance, float(found[0] - found.min()) / max(mean, 0.1) ** 2)


def _likelihoods(stretches, sigma, beside):
    """(R,) −2 log likelihood of noise of size `sigma`, one or (R,), and of that of any size, for every
    correlation tried.

    Beside powers of time it is the restricted one (Patterson & Thompson, Biometrika 58, 545, 1971), of what
    these do not change.
    """
    root = np.sqrt(1.0 - TRIED**2)
    squares, penalty, free = np.zeros(len(root)), np.zeros(len(root)), 0
    for stretch in stretches:
        n = len(stretch)
        table = np.stack([*(((np.arange(n) + 1.0) / n) ** power for power in beside), stretch])
        ahead = (table[:, 1:] - TRIED[:, None, None] * table[:, :-1]) / root[:, None, None]
        first = np.broadcast_to(table[:, :1], (len(root), len(table), 1))
        white = np.concatenate([first, ahead], axis=2)
        products = white @ np.swapaxes(white, 1, 2)
        taken = np.linalg.det(products[:, :-1, :-1])
        squares += np.linalg.det(products) / taken
        penalty += 2.0 * (n - 1) * np.log(root) + np.log(taken)
        free += n - len(table) + 1
    own = free * (np.log(np.maximum(squares, 1e-300) / free) + 1.0)
    return free * np.log(sigma**2) + squares / sigma**2 + penalty, own + penalty
