"""Samples that must not be believed: spikes of the recorder, and readings cut off at the end of its range.

Both are seen in the trace itself, before anything is simulated. A pulse is smooth over a few samples; a spike
is not. Where the recorder's steps outweigh the noise, readings that rest on one of them count once. What is
masked contributes to no sum and no count (`RunData.present`).
"""

import numpy as np

# A spike stands out from the cubic through its four neighbours by so many standard deviations ...
SPIKE_SIGMAS = 7.0
# ... and by more than the neighbours differ among themselves: a steep or narrow pulse is no spike.
SPIKE_RANGE = 1.0
# What is rough for so many samples on one side, as echoes that are sampled too coarsely are, has no spikes
# but those that stand out of that as well.
AROUND = 12
# By chance, and with the spike in the cubics of its neighbours, so few samples of white noise look up to so
# many times as rough as it is: half of all spikes of 16 standard deviations were left for that.
ROUGHER = 3.0
# The cubic's value is (−a + 4 b + 4 c − d)/6; with the sample's own noise its variance is 1 + 34/36.
_SPREAD = np.sqrt(1.0 + 34.0 / 36.0)
# A pair of spikes side by side is found in two passes.
PASSES = 3
# Traces shorter than this are left as they are.
FEWEST_WITH_SPIKES = 8
# Fewest equal samples at an extreme that are taken for a cut.
FEWEST_CUT = 3
# So many equal readings in a row at an extreme are no peak where noise exceeds a step of the recorder: two
# neighbours are then equal with a chance of 0.4 at most, which makes 2e-4 of ten.
FEWEST_FLAT = 10
# Where the recorder's steps outweigh the noise, so many readings on one of them are one reading: medians of
# so many samples tell those that rest there.
FEWEST_RESTING, CALM = 3, 5
# A cut hides a peak that overshoots it by more than so many steps of the recorder, or standard deviations; a
# smooth peak of few steps does not.
CUT_STEPS, CUT_SIGMAS = 5.0, 6.0


def spikes(trace: np.ndarray, sigma: float) -> np.ndarray:
    """(T,) whether each sample of a trace (T,) is a spike, the noise of a sample being sigma."""
    found = np.zeros(len(trace), dtype=bool)
    for _ in range(PASSES):
        kept = np.flatnonzero(~found)
        if len(kept) < FEWEST_WITH_SPIKES:
            break
        new = kept[_standing_out(trace[kept], sigma)]
        if not len(new):
            break
        found[new] = True
    return found


def _standing_out(trace, sigma):
    """Places where a trace departs from its neighbours."""
    far = _off_the_cubic(trace)
    last = len(trace) - 1 - _at_start(trace[::-1], max(sigma, _roughness(far[-AROUND:])))
    first = _at_start(trace, max(sigma, _roughness(far[:AROUND])))
    return np.unique(np.concatenate([first, _within(trace, far, sigma), last]))


def _off_the_cubic(trace):
    """(T − 4,) distance of samples with two neighbours on either side from the cubic through these."""
    one, two, three, four = trace[:-4], trace[1:-3], trace[3:-1], trace[4:]
    return np.abs(trace[2:-2] - (4.0 * (two + three) - one - four) / 6.0)


def _roughness(far):
    """Standard deviation of white noise as rough as a stretch of such distances: most of them are no spikes,
    and 0.6745 is the median of a standard normal number's size.
    """
    return float(np.median(far)) / (0.6745 * _SPREAD)


def _rough_beside(far, k):
    """Roughness on the rougher side of a place: where a trace begins to be rough, one is."""
    sides = [far[max(0, k - AROUND) : k + 1], far[k : k + AROUND + 1]]
    whole = [side for side in sides if len(side) > AROUND] or [far[max(0, k - AROUND) : k + AROUND + 1]]
    return max(map(_roughness, whole))


def _at_start(trace, sigma):
    """The first sample or the second, where it departs from the line through the two after it, or from the
    parabola through its neighbours: a cubic has too few there.
    """
    first = abs(trace[0] - 2.0 * trace[1] + trace[2])
    second = abs(trace[1] - trace[2] - (trace[0] - trace[3]) / 3.0)
    spread = SPIKE_SIGMAS * sigma
    if first > np.sqrt(6.0) * spread + 2.0 * SPIKE_RANGE * np.ptp(trace[1:5]):
        return np.array([0])
    around = np.ptp(trace[[0, 2, 3, 4]])
    return np.flatnonzero([False, second > np.sqrt(20.0 / 9.0) * spread + SPIKE_RANGE * around])


def _within(trace, far, sigma):
    """Places with two neighbours on either side, the farthest of any that touch."""
    around = np.stack([trace[:-4], trace[1:-3], trace[3:-1], trace[4:]])
    room = SPIKE_SIGMAS * _SPREAD * sigma + SPIKE_RANGE * (around.max(axis=0) - around.min(axis=0))
    excess = np.pad(np.where(far > room, far, 0.0), 2)
    highest = np.max([excess[:-4], excess[1:-3], excess[3:-1], excess[4:]], axis=0)
    found = np.flatnonzero((excess[2:-2] > 0.0) & (excess[2:-2] >= highest))
    rough = np.array([_rough_beside(far, k) for k in found])
    rough[rough < ROUGHER * sigma] = 0.0
    return 2 + found[far[found] > SPIKE_SIGMAS * _SPREAD * rough]


def repeated(trace: np.ndarray, step: float = 0.0) -> np.ndarray:
    """(T,) whether each sample only repeats a reading: of those that rest on a step of the recorder the
    middle one does not. Samples that noise lifts to the next step and back rest where their neighbours do.
    Of a changed trace readings within the same `step` of the recorder are equal.
    """
    trace = np.round(trace / step) if step else trace
    found = np.zeros(len(trace), dtype=bool)
    if len(trace) < FEWEST_WITH_SPIKES:
        return found
    calm = np.pad(trace, CALM // 2, mode="edge")
    calm = np.median(np.lib.stride_tricks.sliding_window_view(calm, CALM), axis=1)
    first = np.flatnonzero(np.diff(calm, prepend=np.nan) != 0.0)
    for begin, end in zip(first, np.append(first[1:], len(trace)), strict=True):
        if end - begin >= FEWEST_RESTING:
            alike = begin + np.flatnonzero(trace[begin:end] == calm[begin])
            found[begin:end] = True
            found[alike[len(alike) // 2]] = False
    return found


def stuck(trace: np.ndarray) -> bool:
    """Whether a trace stands at one level, another than 0: none of its samples counts."""
    return bool(trace.any() and np.ptp(trace) == 0.0)


def cut(trace: np.ndarray, sigma: float) -> np.ndarray:
    """(T,) whether each sample of a trace (T,) is cut off at its largest or smallest reading."""
    return _cut_above(trace, sigma) | _cut_above(-trace, sigma)


def _cut_above(trace, sigma):
    found = np.zeros(len(trace), dtype=bool)
    if len(trace) < 8 or not trace.max() > CUT_SIGMAS * sigma:
        return found
    top = trace == trace.max()
    edges = np.flatnonzero(np.diff(np.concatenate([[0], top.astype(int), [0]])))
    step = float(np.diff(np.unique(trace)).min()) if len(np.unique(trace)) > 1 else 0.0
    if np.diff(edges)[::2].max() >= FEWEST_FLAT and min(sigma, _own_noise(trace)) >= step:
        # Every reading at that level is one of the end of the range.
        return top
    for first, end in edges.reshape(-1, 2):
        if end - first >= FEWEST_CUT and _hidden(trace, first, end) > max(
            CUT_STEPS * step, CUT_SIGMAS * sigma
        ):
            found[first:end] = True
    return found


def _own_noise(trace):
    """White noise that second differences of a trace show, most of which lie off its pulses."""
    return float(np.median(np.abs(np.diff(trace, 2)))) / (0.6745 * np.sqrt(6.0))


def _hidden(trace, first, end):
    """By how much a parabola with the slopes on both sides of a plateau overshoots it."""
    count = end - first
    before, after = max(0, first - count), min(len(trace), end + count) - 1
    if before >= first or after < end:
        return 0.0
    rise = (trace[first] - trace[before]) / (first - before)
    fall = (trace[end - 1] - trace[after]) / (after - end + 1)
    return 0.25 * count * min(rise, fall) if min(rise, fall) > 0.0 else 0.0
