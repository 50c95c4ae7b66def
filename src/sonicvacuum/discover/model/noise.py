"""Noise of a record's traces: what is stated, held against what they show.

The noise that a record states is compared with what its traces show before the pulse arrives. Where that is
larger, or correlated from sample to sample, it is taken instead; how it is correlated, the differences of all
samples show as well. Spikes and samples that were cut off are left out (`masks`).
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from sonicvacuum.discover.model import coloured
from sonicvacuum.discover.model.masks import cut, spikes
from sonicvacuum.discover.model.ripples import AGREE, of_all, ripple, swing
from sonicvacuum.discover.model.spectrum import off_its_line
from sonicvacuum.discover.model.weak import wanders, weak
from sonicvacuum.discover.model.whitening import lag_one
from sonicvacuum.gauges import Gauge
from sonicvacuum.records.record import Record

# Smooth error of the simulation and of the interpolation, relative to the largest reading of a gauge.
MODEL_FLOOR = 1e-4
# The quiet stretch ends well before the first sample that exceeds so many standard errors, and this share of
# the peak.
QUIET_SIGMAS, QUIET_PEAK, QUIET_SHARE = 6.0, 0.03, 0.7
_FEWEST, _LEAST = 40, 12
# A weak pulse shows in means over this part of a record, which last about as long as a pulse: they stand out
# by so many of their own standard errors where it begins.
_PART = 20
# Samples count as that much noisier than stated only from this factor on: flicker itself errs by a tenth.
_NOISIER = 1.3
# Rounding errors of neighbours, σ of the noise beside them, are alike by exp(−4π²σ²/step²) at most: by a
# hundredth at 0.35 steps, where rounding is this share of all noise. Of less noise they follow the pulse.
STEPPED = 0.64
# Deviations from the stated white noise count from so many standard errors on.
_SURE = 4.0
# Those that few samples at rest show by so many are asked of all samples.
_LOOKS = 2.0
# Noise is there from the first sample to the last: its first half shows this share of it (in logarithms).
_BEGUN = 0.5
# What differences show and the quiet stretch agree within `AGREE` standard errors, or the likelihood of the
# stretch (χ² of two degrees of freedom, exceeded at 0.003).
_LIKELY = 11.8
# A recorder's rounding, over the noise, from which on third differences are those of its steps.
_COARSE = 0.2


def believed(trace: np.ndarray, sigma: float) -> np.ndarray:
    """(T,) whether a sample counts: it is neither a spike nor cut off."""
    return _believed(np.asarray(trace, dtype=float).tobytes(), float(sigma))


@lru_cache(maxsize=512)
def _believed(samples: bytes, sigma):
    """The same, remembered: each hypothesis of a slip asks again of traces that it leaves as they are."""
    found = ~np.logical_or(*doubtful(samples, sigma))
    found.flags.writeable = False
    return found


@lru_cache(maxsize=512)
def doubtful(samples: bytes, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """(T,) which samples of a trace, given as the bytes of its floats, are spikes, and which are cut off."""
    trace = np.frombuffer(samples)
    noise_ = audible(trace, sigma)
    return spikes(trace, noise_), cut(trace, noise_)


def audible(trace: np.ndarray, sigma: float) -> float:
    """What a single sample has to stand out of: the stated noise, or more that the trace shows."""
    return max(sigma, flicker(trace), rounding(trace))


def stepped(trace: np.ndarray, sigma: float, known: float = 0.0) -> bool:
    """Whether the recorder's steps outweigh the noise of a trace, `sigma` with its rounding: rounding errors
    follow the pulse then, and are no white noise. `known`: the rounding, where the trace was changed.
    """
    return max(known, rounding(trace)) > STEPPED * sigma


def rounded(record: Record, gauge: str) -> float:
    """Standard deviation of the rounding of a gauge's traces, where it is known of the record."""
    return record.steps.get(gauge, 0.0) / math.sqrt(12.0)


def as_recorded(record: Record) -> Record:
    """The record with the steps of recorders whose steps outweigh the noise; itself where none is."""
    sigma, _ = noise((record,))
    steps = {}
    for gauge, size in zip(record.gauges, sigma, strict=True):
        found = max(map(rounding, traces_of((record,), gauge)), default=0.0)
        if found > STEPPED * size:
            steps[gauge.id] = found * math.sqrt(12.0)
    return replace(record, steps=steps) if steps else record


def noise(records: Sequence[Record]) -> tuple[np.ndarray, np.ndarray]:
    """(S,) standard deviation of one sample and correlation of its neighbours, stated or seen."""
    gauges = records[0].gauges
    known = [max(rounded(record, g.id) for record in records) for g in gauges]
    seen = [
        _of_gauge(tuple(t.tobytes() for t in traces_of(records, g)), g, steps)
        for g, steps in zip(gauges, known, strict=True)
    ]
    sigma, own, weights, rests = np.reshape(seen, (-1, 4)).T
    rho = _correlations(own, weights)
    if not rests.any():
        # A standard error more, lest what swings slowly pass for a misfit: few samples tell it all.
        rho = np.where(rho > 0.0, np.minimum(rho + max(weights.sum(), 1.0) ** -0.5, 0.99), 0.0)
    for s in np.flatnonzero(np.isfinite(rests) & (rho > 0.0)):
        found = float(swing(traces_of(records, gauges[s]), rho[s]))
        error = math.sqrt((1.0 + rho[s] ** 2) / (1.0 - rho[s] ** 2) / (2.0 * max(rests[s], 0.5)))
        # What samples flicker by is less than they swing by, and all of them know this better than few.
        if not rests[s]:
            sigma[s] = max(sigma[s], found)
        elif abs(found / sigma[s] - 1.0) < AGREE * error:
            sigma[s] = found
    return sigma, rho


@lru_cache(maxsize=256)
def _of_gauge(samples: tuple[bytes, ...], gauge, steps: float) -> tuple[float, float, float, float]:
    """Standard deviation, correlation of neighbours and what this is worth, and how many samples at rest tell
    the first: infinite where it is stated, or a recorder's steps are seen.

    Remembered, as each hypothesis of a slip asks again of gauges that it leaves as they are.
    """
    traces = [np.frombuffer(one) for one in samples]
    quiet = quiet_of(traces, gauge)
    sigma = _sigma(traces, gauge, quiet, max([steps, *map(rounding, traces)]))
    if gauge.sigma or not traces or coarse(traces, sigma):
        return sigma, *_neighbours(traces, gauge, quiet, sigma), math.inf
    rest = sum(map(len, quiet))
    return sigma, *(_neighbours(traces, gauge, quiet, sigma) if rest else _of_short_rests(traces)), rest


def _of_short_rests(traces):
    """Correlation of neighbours, and the number of samples that it is worth, of the few that precede pulses.

    Differences of all samples tell the size of the noise for each correlation, so that few are enough: the
    more they swing beyond what they flicker by, the more neighbours are alike.
    """
    level = QUIET_SIGMAS * max(map(flicker, traces))
    rests = [q for q in (t[: before(t, level)] for t in traces) if len(q) > 1]
    sizes = swing(traces, coloured.TRIED)
    return coloured.told(rests, sizes) if rests and sizes.all() else (0.0, 0.0)


def coarse(traces: Sequence[np.ndarray], sigma: float) -> bool:
    """Whether differences of traces are those of a recorder's steps."""
    return max(map(rounding, traces), default=0.0) > _COARSE * sigma


def traces_of(records: Sequence[Record], gauge: Gauge) -> list[np.ndarray]:
    """(T,) traces of a gauge, what is not believed left out; none of one that is stuck: nothing is left."""
    found = []
    for record in records:
        least = max(gauge.sigma, rounded(record, gauge.id))
        read = [s.readings[gauge.id] for s in record.signals.values() if gauge.id in s.readings]
        found += [t[believed(t, least)] for t in (np.asarray(one, dtype=float) for one in read)]
    return [t for t in found if len(t)]


def quiet_of(traces: Sequence[np.ndarray], gauge: Gauge) -> list[np.ndarray]:
    """(n,) quiet stretches of a gauge that are long enough.

    The weaker a pulse, the later it comes: where it hardly stands out of the noise, no more is believed to be
    rest than before one that does.
    """
    sigma = gauge.sigma or max(map(flicker, traces), default=0.0)
    found = [_quiet(t, sigma) for t in traces]
    clear = max((len(q) for q, faint in found if not faint), default=None)
    quiet = [even(q[:clear]) if faint else q for q, faint in found]
    quiet = [q for q in quiet if len(q) >= _LEAST]
    if _open(gauge):
        # Where level and slope are open, noise is what is left of both.
        quiet = [off_its_line(q) for q in quiet]
    quiet = [_unrisen(q, sigma) for q in quiet]
    return quiet if sum(map(len, quiet)) >= _FEWEST else []


def _open(gauge):
    """Whether a gauge's level or slope is open, so that stretches of it are without their lines."""
    return bool(gauge.baseline_sigma or gauge.drift_sigma)


def _unrisen(stretch, sigma):
    """A stretch, or its first half, quarter and so on: what is surely louder than stated, or than samples
    flicker, while the first half shows less than half of that (in logarithms), is the foot of a pulse.
    """
    while sigma and len(stretch) >= 2 * _LEAST:
        half = stretch[: len(stretch) // 2]
        whole, begun = (0.5 * math.log(max(q @ q / len(q), 1e-300) / sigma**2) for q in (stretch, half))
        if whole < math.log1p(_SURE / math.sqrt(len(stretch))) or begun > _BEGUN * whole:
            break
        stretch = half
    return stretch


def _sigma(traces, gauge, quiet, steps):
    """What the record states, or more where the quiet stretches are surely louder."""
    peak = max((float(np.abs(t).max()) for t in traces), default=0.0)
    known = (gauge.sigma, 1.0) if gauge.sigma else (_estimated(traces, quiet), STEPPED)
    level = _with_steps(*known, steps)
    floor = max(math.hypot(level, MODEL_FLOOR * peak), 1e-12)
    if not quiet:
        return floor
    count = sum(len(q) for q in quiet)
    seen = math.sqrt(sum(q @ q for q in quiet) / count)
    if seen > floor * (1.0 + _SURE / math.sqrt(count)):
        return seen
    if coarse(traces, floor) or not seen > floor * (1.0 + _LOOKS / math.sqrt(count)):
        return floor
    level, count = of_all(traces, quiet, _correlation(quiet))
    return level if level > floor * (1.0 + _SURE / math.sqrt(count)) else floor


def _estimated(traces, quiet):
    """Noise that nobody stated: of the quiet stretches, and of what makes the other samples flicker."""
    return of_all(traces, quiet, _correlation(quiet))[0] if quiet else max(map(flicker, traces), default=0.0)


def _with_steps(level, most, steps):
    """A noise, with the rounding of the recorder's steps where this is more than a share that tells that the
    noise does not hold it.
    """
    return math.hypot(level, steps) if steps > most * level else level


def flicker(trace: np.ndarray) -> float:
    """Noise of one sample from third differences, which a smooth pulse hardly moves; white noise assumed.

    The median of their absolute values over 0.6745 √20: third differences of white noise have the variance
    1 + 9 + 9 + 1 = 20.
    """
    return float(np.median(np.abs(np.diff(trace, 3)))) / (0.6745 * math.sqrt(20.0)) if len(trace) > 3 else 0.0


def rounding(trace: np.ndarray) -> float:
    """Standard deviation of the rounding of a trace whose values repeat: its smallest step over √12."""
    values = np.unique(trace)
    if len(values) < 2 or len(values) > len(trace) / 2:
        return 0.0
    return float(np.diff(values).min()) / math.sqrt(12.0)


def _correlations(own, weights):
    """(S,) correlation of neighbours: one for all gauges, or each its own where they surely differ; 0 where
    none is sure. Of what each gauge shows, and the number of samples that this is worth.
    """
    if not weights.any():
        return np.zeros(len(own))
    shared = float(np.average(own, weights=weights))
    if shared <= _SURE / math.sqrt(weights.sum()):
        # One gauge alone may still be correlated.
        return np.where(own > _SURE / np.sqrt(np.maximum(weights, 1.0)), np.minimum(own, 0.99), 0.0)
    error = np.sqrt((1.0 - shared**2) / np.maximum(weights, 1.0))
    differs = (np.abs(own - shared) > _SURE * error) & (weights > 0.0)
    return np.clip(np.where(differs, own, shared), 0.0, 0.99)


def _neighbours(traces, gauge, quiet, sigma) -> tuple[float, float]:
    """Correlation of neighbours at a gauge, and the number of samples that it is worth.

    The few samples at rest say little of it, and tests of what a fit leaves would take that for a misfit:
    differences of all samples, which smooth signals hardly move, say more where the noise is known and not
    rounded. Where both disagree, as for noise of another kind, only those at rest count; short stretches look
    less correlated than they are, and their likelihood is asked as well.
    """
    own, count = _correlation(quiet), sum(map(len, quiet))
    stated = bool(gauge.sigma)
    if not count or coarse(traces, sigma) or (stated and sigma > 1.001 * gauge.sigma):
        return own, count
    seen, variance = ripple(traces, sigma, 0.0 if stated else 2.0 / count)
    error = max(1.0 - own**2, 0.01) / count
    apart = abs(seen - own) > AGREE * math.sqrt(variance + error)
    if math.isinf(variance) or (
        apart and coloured.misfit(quiet, sigma, seen, coloured.LINE if _open(gauge) else ()) > _LIKELY
    ):
        return own, count
    both = (seen / variance + own / error) / (1.0 / variance + 1.0 / error)
    return both, max(1.0 - both**2, 0.01) * (1.0 / variance + 1.0 / error)


def _correlation(stretches):
    """Lag-one correlation, its bias −(1 + 3ρ)/n removed (Marriott & Pope, Biometrika 41, 390, 1954)."""
    if not stretches:
        return 0.0
    seen = [(lag_one(q), len(q)) for q in stretches]
    return float(np.average([r + (1.0 + 3.0 * r) / n for r, n in seen], weights=[n for _, n in seen]))


def _quiet(trace, sigma):
    """The samples before the pulse arrives, or none, and whether that is a weak one."""
    peak = float(np.abs(trace).max())
    level = max(QUIET_SIGMAS * loudness(trace, sigma), QUIET_PEAK * peak)
    return trace[: before(trace, level)], weak(trace, level)


def even(stretch: np.ndarray) -> np.ndarray:
    """A stretch that may hold a weak pulse, or its first half, quarter and so on: what nothing slow is in."""
    while wanders(stretch):
        stretch = stretch[: len(stretch) // 2]
    return stretch


def before(trace: np.ndarray, level: float) -> int:
    """Samples that surely precede the first one above a level, and a pulse that hardly gets above it."""
    size = np.abs(trace)
    first = int((size > level).argmax()) if size.max() > level else len(trace)
    return int(QUIET_SHARE * (min(first, _risen(trace)) if weak(trace, level) else first))


def _risen(trace):
    """Where a trace begins to stand out in running means, of which most are of its rest; its length where it
    does not.
    """
    width = max(_LEAST, len(trace) // _PART)
    if len(trace) < 2 * width:
        return len(trace)
    sums = np.concatenate([[0.0], np.cumsum(trace)])
    means = (sums[width:] - sums[:-width]) / width
    off = np.abs(means - np.median(means))
    # Means of steps of a recorder are known no better than by their rounding.
    spread = max(float(np.median(off)) / 0.6745, rounding(trace) / math.sqrt(width))
    out = off > QUIET_SIGMAS * spread
    return int(out.argmax()) if out.any() else len(trace)


def loudness(trace: np.ndarray, sigma: float) -> float:
    """The stated noise of a sample, or what makes the samples up to the highest flicker where that is surely
    more: noise of several times the stated one is no pulse.
    """
    own = flicker(trace[: int(np.abs(trace).argmax())])
    return own if own > _NOISIER * sigma else sigma
