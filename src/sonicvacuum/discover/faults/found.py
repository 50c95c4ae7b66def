"""A slip that was found, and the record as it is put right."""

from dataclasses import dataclass, field, replace

import numpy as np

from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.slow import slow
from sonicvacuum.records import Record


@dataclass(frozen=True)
class Finding:
    """One slip.

    Attributes:
        fault: key of `table.FAULTS`.
        run: id of the run (several joined by "and"), None where it concerns all.
        sensor: id of the gauge, ids where it concerns several, None where it concerns none.
        value: in the fault's unit, None where there is none.
        probability: that the slip was made.
        corrected: whether the rest of the verdict is of the record without it.
        quantity: of a table, where it concerns one, or all rows of some runs (`tables.ALL`).
    """

    fault: str
    run: str | None = None
    sensor: str | tuple[str, ...] | None = None
    value: float | None = None
    probability: float = 1.0
    corrected: bool = False
    quantity: str | None = None


@dataclass(frozen=True)
class Bench:
    """A record as far as it was put right.

    Attributes:
        record: changed where a slip was found.
        lost: (run id, gauge id) → (T,) samples that must not be believed.
        lines: (run id, gauge id) → amplitude and frequency in Hz of pick-up that was taken off.
    """

    record: Record
    lost: dict[tuple[str, str], np.ndarray] = field(default_factory=dict)
    lines: dict[tuple[str, str], tuple[float, float]] = field(default_factory=dict)

    def masked(self, experiment: Experiment) -> Experiment:
        """A data set in which samples that are lost do not count, and the rest of pick-up counts as noise."""
        runs = tuple(self._masked(run, experiment.gauges) for run in experiment.runs)
        changed = replace(experiment, runs=runs)
        return replace(changed, slow=slow(changed, self.lines)) if self.lines else changed

    def _masked(self, run, gauges):
        rows = {s: self.lost[run.id, g.id] for s, g in enumerate(gauges) if (run.id, g.id) in self.lost}
        if not rows:
            return run
        present = np.ones(run.readings.shape, dtype=bool) if run.present is None else run.present.copy()
        for s, lost in rows.items():
            present[s] &= ~lost
        return replace(run, present=present)
