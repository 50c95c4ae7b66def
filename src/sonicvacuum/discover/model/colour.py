"""What noise a record's traces have, of any colour: white, of first order, or of a spectrum that needs more.

`noise` tells the first two. Where stretches at rest surely remember more than one sample, an autoregression
takes their place (`spectrum`). Its size is told by what it does not foretell: in the stretches, and in
differences of all samples where both agree; over what `noise` has it, which stays what single samples are
measured by.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from sonicvacuum.discover.model import spectrum
from sonicvacuum.discover.model.autoregression import Autoregression
from sonicvacuum.discover.model.noise import coarse, quiet_of, rounded, traces_of
from sonicvacuum.discover.model.ripples import AGREE, CLEAR, differenced
from sonicvacuum.records.record import Record

# Lags up to which samples of differences are alike, at most.
_FAR = 400
# Noise of the spectrum of others is stated, or seen, up to so many times larger or smaller.
_ALIKE = 2.0

Colours = tuple[Autoregression | None, ...]


def colours(records: Sequence[Record], sigma: np.ndarray) -> Colours:
    """The noise of the gauges that needs more than the first order, None of the others; empty where there are
    none. Its scale is over (S,) `sigma`, what `noise` tells of the size of single samples.
    """
    gauges = records[0].gauges
    traces = [tuple(t.tobytes() for t in traces_of(records, gauge)) for gauge in gauges]
    steps = [max(rounded(record, gauge.id) for record in records) for gauge in gauges]
    found = _of_gauges(tuple(traces), gauges, tuple(steps), tuple(map(float, sigma)))
    return found if any(found) else ()


@lru_cache(maxsize=256)
def _of_gauges(samples, gauges, steps, sigma):
    """The noise of each gauge, None where no more than the first order is told.

    Remembered, as each hypothesis of a slip asks again of traces that it leaves as they are.
    """
    traces = [[np.frombuffer(one) for one in own] for own in samples]
    # Rounded noise that rests on few steps has no spectrum of its own.
    fine = [t and not step and not coarse(t, s) for t, step, s in zip(traces, steps, sigma, strict=True)]
    quiet = [quiet_of(t, g) if ok else [] for t, g, ok in zip(traces, gauges, fine, strict=True)]
    quiet = [spectrum.audible(q, size) for q, size in zip(quiet, sigma, strict=True)]
    told = spectrum.together(quiet)
    every = zip(told, traces, quiet, sigma, fine, strict=True)
    return tuple(_sized(own, t, q, s) if own and ok else None for own, t, q, s, ok in every)


def _sized(own, traces, quiet, sigma):
    """Noise of a spectrum in units of `sigma`; None of one that is not this gauge's."""
    count = sum(map(len, quiet))
    at_rest = spectrum.sized(own, quiet).scale ** 2
    seen, worth = _differenced(own, traces)
    if not count:
        size = math.sqrt(seen) if worth >= 1.0 else 0.0
        return replace(own, scale=size / sigma) if sigma / _ALIKE < size < sigma * _ALIKE else None
    error = math.sqrt(2.0 / max(worth, 1e-9) + 2.0 / count)
    if worth >= 1.0 and abs(math.log(seen / at_rest)) < AGREE * error:
        at_rest = (worth * seen + count * at_rest) / (worth + count)
    return replace(own, scale=math.sqrt(at_rest) / sigma)


def _differenced(own, traces):
    """Variance of a sample that differences of all samples show, and of how many independent ones."""
    differences = np.concatenate([np.diff(t, CLEAR) for t in traces])
    expected = differenced(own.correlations(_FAR), CLEAR)
    worth = len(differences) / (1.0 + 2.0 * float(np.square(expected[1:] / expected[0]).sum()))
    if not worth:
        return 0.0, 0.0
    return float(differences @ differences) / len(differences) / float(expected[0]), worth
