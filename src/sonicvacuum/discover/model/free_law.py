"""A contact law of no particular form in an experiment: its coefficients, held by a prior, like nuisances.

Regularised least squares is what the inference does with nuisances anyway: each has a Gaussian prior of a
stated width, all runs share it, and its slopes come from simulations of its own.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.flexible import scales
from sonicvacuum.discover.model.nuisances import Shared
from sonicvacuum.effects.base import MICRO, Setup
from sonicvacuum.effects.free_form import COEFFICIENTS, change


@dataclass(frozen=True)
class Scales:
    """What the law's arguments are measured in: m, m/s and N of a typical impact of the experiment."""

    depth: float
    speed: float
    force: float

    @property
    def parameters(self) -> dict[str, float]:
        """As the effect takes them."""
        return {"depth_um": self.depth / MICRO, "speed_m_s": self.speed, "force_N": self.force}


def scales_of(experiment: Experiment) -> Scales:
    """Those of the mean impact of all runs."""
    each = [scales(b.chain) for b in experiment.batches]
    depth, pace, force = (np.concatenate([np.ravel(part[k]) for part in each]).mean() for k in range(3))
    return Scales(float(depth), float(1.0 / pace), float(force))


def with_law(
    experiment: Experiment, coefficients: Iterable[str], width: float, typical: Scales
) -> Experiment:
    """The experiment in which the contact law is free to depart, `coefficients` by `width` each."""
    none = dict.fromkeys(COEFFICIENTS, 0.0)
    batches = tuple(
        replace(b, chain=change(Setup(b.chain), **typical.parameters, **none).chain)
        for b in experiment.batches
    )
    own = tuple(Shared("law", width, name) for name in coefficients)
    return replace(experiment, batches=batches, shared=(*experiment.shared, *own))


def of_some(experiment: Experiment, runs: Iterable[int]) -> Experiment:
    """The experiment in which only the traces of some runs count; scalars of the others are left out."""
    kept = set(runs)
    shown = tuple(
        run if k in kept else replace(run, scalars=(), present=np.zeros(run.readings.shape, dtype=bool))
        for k, run in enumerate(experiment.runs)
    )
    return replace(experiment, runs=shown)
