"""One data set as the inference sees it: samples and scalars with their noise, chains that were struck,
gauges.

Signals of a run are whitened once: divided by the gauge's noise and, where samples at rest foretell the next
one, less what they foretell (`whitening`). A smooth discrepancy joins the runs, so that it is divided out of
all of them at once (`divided`).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from sonicvacuum.discover.model.autoregression import Autoregression
from sonicvacuum.discover.model.nuisances import Shared
from sonicvacuum.discover.model.whitening import whitened
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.effects.whereabouts import materials_of
from sonicvacuum.gauges import Gauge
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.physics.chain import Chain


@dataclass(frozen=True)
class Scalar:
    """One observable of a run: SI value and standard error; `options` as `observe.quantities` takes them.

    `bound` and `shared` are those of `records.record.Observable`.
    """

    quantity: str
    value: float
    sigma: float
    options: Mapping[str, object] = field(default_factory=dict)
    bound: str | None = None
    shared: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class RunData:
    """What was measured in one run.

    Attributes:
        id: name of the run.
        time: (T,) equidistant recorded times in s; empty without signals.
        readings: (S, T) in the order and the units of the experiment's gauges; finite everywhere.
        scalars: observables.
        speed_rel_sigma: standard error of the striker's speed, relative.
        present: (S, T) which readings count; None: all. A gauge that this run lacks, a sample that was lost
            or must not be believed is False: it contributes to no sum and to no count.
        shift: s, about which the trigger shift is searched; 0 but where time zero is not known.
    """

    id: str
    time: np.ndarray
    readings: np.ndarray
    scalars: tuple[Scalar, ...] = ()
    speed_rel_sigma: float = 0.0
    present: np.ndarray | None = None
    shift: float = 0.0

    @property
    def samples(self) -> int:
        """Number of readings that count."""
        return self.readings.size if self.present is None else int(np.count_nonzero(self.present))

    @property
    def has_signals(self) -> bool:
        """Whether traces were recorded."""
        return len(self.time) > 0

    @property
    def interval(self) -> float:
        """Time between samples in s; NaN without signals."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1) if self.has_signals else math.nan


@dataclass(frozen=True)
class Batch:
    """Runs that are simulated together: chains that differ only in numbers, one lane for each run.

    Attributes:
        chain: nominal chains, lane k being run `runs[k]`.
        runs: indices of the runs.
        interval: time between simulated samples in s, a whole fraction of the runs' own.
        duration: simulated time in s.
        gauges: where the gauges sat in these runs; None: as everywhere.
        settled_s: what is simulated at first where that may be enough (`beginnings`).
    """

    chain: Chain
    runs: tuple[int, ...]
    interval: float
    duration: float
    gauges: tuple[Gauge, ...] | None = None
    settled_s: float = math.inf

    @property
    def first_s(self) -> float:
        """What is simulated at first in s."""
        return min(self.settled_s, self.duration)


@dataclass(frozen=True)
class Slow:
    """Baselines and drifts, which count as noise (`slow`).

    Attributes:
        blocks: for each run and gauge, orthonormal directions (T, r) of the whitened trace and the variances
            (r,) of their weights.
    """

    blocks: tuple

    def whiten(self, run: int, white: np.ndarray) -> np.ndarray:
        """(L, S, T) traces of a run, noise white, with baselines and drifts divided out as well."""
        result = white.copy()
        for s, (directions, variances) in enumerate(self.blocks[run]):
            result[:, s] -= ((white[:, s] @ directions) * _taken_up(variances)) @ directions.T
        return result


def _taken_up(variances):
    """By how much the inverse root of 1 + variances is below 1."""
    return 1.0 - 1.0 / np.sqrt(1.0 + variances)


@dataclass(frozen=True)
class Part:
    """What a smooth discrepancy may do to the readings of one gauge in all R runs together.

    Attributes:
        directions: (T, r) orthonormal columns of the whitened trace of each run.
        mixing: (Σ r, n) orthonormal, over the directions of all runs: what varies independently.
        variances: (n,) of these, for a discrepancy of one peak.
    """

    directions: tuple[np.ndarray, ...]
    mixing: np.ndarray
    variances: np.ndarray

    def along(self, traces: Sequence[np.ndarray]) -> np.ndarray:
        """(L, n) of (L, T) whitened traces of each run."""
        seen = [trace @ own for trace, own in zip(traces, self.directions, strict=True)]
        return np.concatenate(seen, axis=1) @ self.mixing

    def traces(self, along: np.ndarray) -> list[np.ndarray]:
        """(L, T) of each run: those that lie so far (L, n) along."""
        own = along @ self.mixing.T
        ends = np.cumsum([d.shape[1] for d in self.directions])[:-1]
        return [part @ d.T for part, d in zip(np.split(own, ends, axis=1), self.directions, strict=True)]


@dataclass(frozen=True)
class Smooth:
    """A discrepancy between model and data that varies slowly with time and speed, and counts as noise
    (`fit.smooth`). What it has in common in several runs makes their data depend on one another.

    Attributes:
        size: its standard deviation as a share of each trace's peak.
        variance: the same in the units of single samples' noise, squared.
        parts: of each gauge.
    """

    size: float
    variance: float
    parts: tuple[Part, ...]

    def divided(self, values: Sequence[np.ndarray]) -> list[np.ndarray]:
        """(L, M) data of every run, noise white, with the discrepancy divided out as well."""
        result = [value.copy() for value in values]
        for s, part in enumerate(self.parts):
            own = [slice(s * len(d), (s + 1) * len(d)) for d in part.directions]
            along = part.along([value[:, at] for value, at in zip(values, own, strict=True)])
            taken = part.traces(along * _taken_up(self.variance * part.variances))
            for value, at, less in zip(result, own, taken, strict=True):
                value[:, at] -= less
        return result


@dataclass(frozen=True)
class Experiment:
    """A data set.

    Attributes:
        name: of the record.
        runs: the runs.
        batches: how they are simulated; every run is in one batch.
        gauges: nominal gauges.
        sigma: (S,) standard deviation of one sample in the unit of its gauge.
        correlation: (S,) correlation of the noise of neighbouring samples, 0 where white.
        gain_rel_sigma: (S,) standard error of the logarithm of the gains.
        trigger_sigma: s, of the common time zero of a run.
        modulus_rel_sigma: of the bead material, relative.
        diameter: of a bead in m, or of each of them.
        record: the record it was made from, None in tests.
        catalogue: the effects that may be missing.
        excluded: ids of effects that these data cannot be asked about.
        prior_odds: id → odds against the catalogue's usual prior, as the record states them; 1 where missing.
        present: id → parameter → value of effects that the record says act; the chains have them already, and
            the catalogue does not try them.
        integrated: compare running integrals of the traces instead: a coarse view in which a late pulse is
            still felt, for searches that start far from the data.
        smooth: the smooth discrepancy that counts as noise; None: none.
        model_floor_rel: its size as the record states it; None: to be inferred.
        shared: nuisances that all runs share, besides the modulus of the beads and the gains.
        slow: baselines and drifts that count as noise; None: none.
        notes: what was left out of the data, one line each.
        approximate: whether what a model leaves hides small errors of its simulation, see `accuracy.cut`.
        colours: noise of the gauges whose samples remember more than their neighbours, None of the others;
            empty where there are none such.
    """

    name: str
    runs: tuple[RunData, ...]
    batches: tuple[Batch, ...]
    gauges: tuple[Gauge, ...]
    sigma: np.ndarray
    correlation: np.ndarray
    gain_rel_sigma: np.ndarray
    trigger_sigma: float
    modulus_rel_sigma: float
    diameter: Bodies | float
    record: object = None
    catalogue: Catalogue = CATALOGUE
    excluded: tuple[str, ...] = ()
    prior_odds: Mapping[str, float] = field(default_factory=dict)
    present: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    integrated: bool = False
    smooth: Smooth | None = None
    model_floor_rel: float | None = None
    shared: tuple[Shared, ...] = ()
    slow: Slow | None = None
    notes: tuple[str, ...] = ()
    approximate: bool = False
    colours: tuple[Autoregression | None, ...] = ()

    @property
    def beads(self) -> int:
        """Number of beads."""
        return self.batches[0].chain.beads

    @cached_property
    def materials(self) -> tuple[str, ...]:
        """Contact materials of the beads, the first bead's first."""
        return materials_of(self.batches[0].chain)

    @property
    def coupled(self) -> bool:
        """Whether the data of all runs depend on one another."""
        return self.smooth is not None and not self.integrated

    def divided(self, values: Sequence[np.ndarray]) -> Sequence[np.ndarray]:
        """(L, M) numbers of every run over their noise, with what couples the runs divided out; linear."""
        return self.smooth.divided(values) if self.coupled else values

    def whitened(self, run: int) -> np.ndarray:
        """(M,) data of a run over their noise: gauge after gauge, then the scalars; not `divided`."""
        data = self.runs[run]
        values = np.array([s.value for s in data.scalars])
        return self.whiten(run, data.readings[None], values[None])[0]

    def whiten(self, run: int, readings: np.ndarray, scalars: np.ndarray) -> np.ndarray:
        """(L, M) readings (L, S, T) and scalars (L, n) of a run over their noise, not `divided`; linear."""
        return self.whitened_on(run, self.noise_whitened(run, readings / self.sigma[:, None]), scalars)

    def whitened_on(self, run: int, white: np.ndarray, scalars: np.ndarray) -> np.ndarray:
        """The same, of readings that `noise_whitened` has made."""
        data = self.runs[run]
        lanes = len(white)
        if not data.has_signals:
            return scalars / np.array([s.sigma for s in data.scalars])
        if self.slow:
            white = self.slow.whiten(run, white)
        if self.integrated:
            white = np.cumsum(white, axis=-1) / math.sqrt(white.shape[-1])
            white = white if data.present is None else white * data.present
        white = white.reshape(lanes, -1)
        if not data.scalars:
            return white
        return np.concatenate([white, scalars / np.array([s.sigma for s in data.scalars])], axis=1)

    def noise_whitened(self, run: int, readings: np.ndarray) -> np.ndarray:
        """(…, S, T) independent numbers from readings of a run over the noise of single samples, `sigma`."""
        return whitened(readings, self.correlation, self.runs[run].present, self.colours)

    def remembered(self, s: int) -> int:
        """From how many samples before it one of a gauge is foretold, 1 where its noise is white as well."""
        colour = self.colours[s] if self.colours else None
        return max(1, colour.free) if colour else 1

    @property
    def innovation(self) -> np.ndarray:
        """(S,) variance of what the samples before one do not foretell."""
        left = 1.0 - self.correlation**2
        for s, colour in enumerate(self.colours):
            left[s] = colour.scale**2 * colour.innovations[-1] if colour else left[s]
        return self.sigma**2 * left

    @property
    def uncoloured(self) -> "Experiment":
        """The same with readings over their noise as they are, samples not whitened."""
        return replace(self, correlation=np.zeros(len(self.gauges)), colours=())

    def length(self, run: int) -> int:
        """Length of a run's whitened data: a place for every sample, counting or not, and every scalar."""
        data = self.runs[run]
        return len(self.gauges) * len(data.time) + len(data.scalars)

    def counts(self, run: int) -> np.ndarray:
        """Places of the data of a run that are whole numbers."""
        scalars = self.runs[run].scalars
        first = self.length(run) - len(scalars)
        own = [first + k for k, one in enumerate(scalars) if one.quantity == "pulse_count"]
        return np.array(own, dtype=int)

    def size(self, run: int) -> int:
        """Number of data of a run: samples that count, and scalars."""
        data = self.runs[run]
        return data.samples + len(data.scalars)
