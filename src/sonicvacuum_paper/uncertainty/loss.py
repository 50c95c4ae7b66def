"""The one number of the loss, calibrated in each draw as for the ladder: on the printed duration at g9."""

import numpy as np

from sonicvacuum.card import Card
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.uncertainty.batch import LOSS, Batch, Draws, set_up
from sonicvacuum_paper.uncertainty.reading import of_lanes

# Shares of the ladder's own time; then parts of the gap between the two that enclose the duration.
FACTORS = (0.3, 0.6, 0.9, 1.2, 1.6)
PARTS = (0.25, 0.5, 0.75)
DURATION = ("duration_02", "g9")


def calibrated(card: Card, draws: Draws, lasting: float) -> np.ndarray:
    """(draws,) time of the loss in us at which the pulse of `card` lasts as long as the paper prints.

    Each draw has its own base level and its own error of reading. A tail that no longer falls to the level
    counts as longer than any duration. Beyond the times tried the nearest of them is taken.
    """
    tried = np.outer(np.array(FACTORS), np.full(len(draws["level"]), card.effects[LOSS]["time_us"]))
    durations = _durations(card, draws, tried, lasting)
    low, high = _enclosing(tried, durations)
    finer = low + np.outer(np.array(PARTS), high - low)
    tried = np.concatenate([tried, finer])
    durations = np.concatenate([durations, _durations(card, draws, finer, lasting)])
    order = tried.argsort(axis=0, kind="stable")
    tried, durations = (np.take_along_axis(a, order, axis=0) for a in (tried, durations))
    return _between(tried, durations)


def _durations(card, draws, times, lasting):
    """(times, draws) durations in us, infinite where the tail stays above the level."""
    many = {name: np.tile(values, len(times)) for name, values in draws.items()}
    batch = Batch.of(card, set_up(card, many, loss_us=times.ravel()), lasting)
    found = of_lanes(batch, (DURATION,), many)[DURATION].reshape(times.shape)
    return np.where(np.isfinite(found), found, np.inf)


def _enclosing(times, durations):
    """The last time before the duration exceeds the printed one, and the next; both (draws,)."""
    longer = durations > 1e6 * PRINTED.duration_coated
    first = np.where(longer.any(axis=0), longer.argmax(axis=0), len(times) - 1)
    draws = np.arange(times.shape[1])
    return times[np.maximum(first - 1, 0), draws], times[first, draws]


def _between(times, durations):
    """The time at which the duration is the printed one, on the line through the two that enclose it."""
    low, high = _enclosing(times, durations)
    wanted, draws = 1e6 * PRINTED.duration_coated, np.arange(times.shape[1])
    short, long = (durations[(times == t).argmax(axis=0), draws] for t in (low, high))
    rising = np.isfinite(long) & (long > short)
    part = np.where(rising, (wanted - short) / np.where(rising, long - short, 1.0), 0.5)
    return low + np.clip(part, 0.0, 1.0) * (high - low)
