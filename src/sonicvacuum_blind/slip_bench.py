"""A record as it lies on the bench, and what slips change of it: traces, instants, words on gauges."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import msgspec
import numpy as np

from sonicvacuum.records import Record, Signals


@dataclass(frozen=True)
class Bench:
    """A record as it lies on the bench, with what making a slip needs.

    Attributes:
        record: the sound one.
        pulse_us: length of a pulse.
        random: source of all choices.
    """

    record: Record
    pulse_us: float
    random: np.random.Generator

    @property
    def gauges(self) -> list[str]:
        """Ids of all gauges."""
        return [s.id for s in self.record.block.sensors]

    @property
    def runs(self) -> list[str]:
        """Ids of all runs."""
        return [r.id for r in self.record.block.runs]

    def drawn(self, of: list[str], count: int = 1) -> list[str]:
        """So many of a list."""
        return [str(x) for x in self.random.choice(of, count, replace=False)]

    def sigma(self, gauge: str) -> float:
        """Noise of one sample of a gauge in N."""
        return next(s.sigma_N for s in self.record.block.sensors if s.id == gauge)


@dataclass(frozen=True)
class Place:
    """Where a slip was made: run and gauges, None for all of them."""

    run: str | None = None
    sensor: tuple[str, ...] | None = None


Trace = Callable[[np.ndarray], np.ndarray]


def traces_of(record: Record, change: Callable[[str, str, np.ndarray], np.ndarray]) -> Record:
    """The record with each trace passed through (run, gauge, trace) → trace."""
    signals = {
        run: Signals(s.time_us, {g: change(run, g, v) for g, v in s.readings.items()})
        for run, s in record.signals.items()
    }
    return replace(record, signals=signals)


def of_gauge(record: Record, gauge: str, change: Trace) -> Record:
    """The record with each trace of one gauge changed."""
    return traces_of(record, lambda _, g, v: change(v) if g == gauge else v)


def times_of(record: Record, change: Callable[[Signals], np.ndarray]) -> Record:
    """The record with the instants of each run changed."""
    return replace(record, signals={k: Signals(change(s), s.readings) for k, s in record.signals.items()})


def sensors_of(record: Record, change: Callable) -> Record:
    """The record with each gauge's block changed."""
    block = msgspec.structs.replace(record.block, sensors=[change(s) for s in record.block.sensors])
    return replace(record, block=block)
