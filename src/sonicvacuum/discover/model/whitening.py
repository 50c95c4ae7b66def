"""Samples of a record's traces made independent: each less what those before it foretell."""

from collections.abc import Sequence

import numpy as np

from sonicvacuum.discover.model.autoregression import Autoregression


def whitened(
    noise: np.ndarray,
    correlation: np.ndarray,
    present: np.ndarray | None,
    colours: Sequence[Autoregression | None] = (),
) -> np.ndarray:
    """(…, S, T) independent numbers of unit variance from samples over their standard deviation.

    Args:
        noise: (…, S, T) samples.
        correlation: (S,) of neighbouring samples.
        present: (S, T) samples that count, or None for all.
        colours: of noise that remembers more than one sample, None where it does not; empty for none.
    """
    white = whitened_gaps(noise, correlation, present)
    if not any(colours):
        return white
    white = white.copy() if white is noise else white
    for s, colour in enumerate(colours):
        if colour and (present is None or present[s].all()):
            white[..., s, :] = colour.whitened(noise[..., s, :])
        elif colour and present is not None:
            at = np.flatnonzero(present[s])
            white[..., s, at] = colour.whitened(noise[..., s, at], at)
    return white


def whitened_gaps(noise: np.ndarray, correlation: np.ndarray, present: np.ndarray | None) -> np.ndarray:
    """Independent numbers of unit variance from samples of a stationary first-order autoregression.

    Args:
        noise: (…, S, T) samples over their standard deviation.
        correlation: (S,) of neighbouring samples.
        present: (S, T) samples that count, or None for all.

    Returns:
        (…, S, T); 0 where a sample does not count. A sample whose last counting neighbour is k samples back
        is predicted by ρ^k of that one, with the variance 1 − ρ^{2k}: what a Kalman filter makes of a gap
        (Jones, Technometrics 22, 389, 1980).
    """
    if present is None:
        if not np.any(correlation):
            return noise
        rho = correlation[:, None]
        root, white = np.sqrt(1.0 - rho**2), np.empty_like(noise)
        white[..., :1] = noise[..., :1]
        np.multiply(noise[..., :-1], -rho / root, out=white[..., 1:])
        white[..., 1:] += noise[..., 1:] / root
        return white
    white = np.zeros_like(noise)
    for s, rho in enumerate(correlation):
        at = np.flatnonzero(present[s])
        kept = noise[..., s, at]
        far = rho ** np.diff(at)
        white[..., s, at[:1]] = kept[..., :1]
        white[..., s, at[1:]] = (kept[..., 1:] - far * kept[..., :-1]) / np.sqrt(1.0 - far**2)
    return white


def lag_one(noise: np.ndarray) -> float:
    """Correlation of neighbouring samples of (S,) noise, its mean removed."""
    centred = noise - noise.mean()
    power = centred @ centred
    return float(centred[1:] @ centred[:-1] / power) if power > 0.0 else 0.0
