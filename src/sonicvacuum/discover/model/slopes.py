"""How the data change with nuisances: the columns of a linear model that stand for them.

Speeds, moduli and masses take a simulation each; times, gains and shared errors act on readings alone.
"""

from functools import cached_property

import numpy as np

from sonicvacuum.discover.model import scalars
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.nuisances import Layout


class Slopes:
    """Slopes of the data of an experiment to its nuisances.

    Args:
        experiment: whose data these are.
        layout: where the nuisances stand.
        sigma: (q,) their standard errors, see `Forward.nuisance_sigma`.
    """

    def __init__(self, experiment: Experiment, layout: Layout, sigma: np.ndarray):
        self.experiment, self.layout, self.sigma = experiment, layout, sigma

    @property
    def simulated(self):
        """For each simulation that slopes to nuisances take, their places and standard errors."""
        layout, sigma = self.layout, self.sigma
        speeds = layout.other("speed-common") or range(len(self.experiment.runs))
        groups = [*([place] for place in layout.simulated), list(speeds)]
        return [[(place, sigma[place]) for place in group] for group in groups]

    def columns(self, hypothesis, run, places, base, slopes, timing, held):
        """(L, c, M) columns of one run from its prediction (L, 1, M), slopes of simulations (L, ·, M) and to
        times; `held` are columns to its nuisances.
        """
        p, local = len(hypothesis.coordinates), self.layout.local(run).tolist()
        columns = np.empty((len(base), 1 + p + len(local), base.shape[2]))
        columns[:, :1], own, nuisances = base, columns[:, 1 : 1 + p], columns[:, 1 + p :]
        own[:] = slopes[:, :p]
        speeds = (self.layout.speed(run), *self.layout.other("speed-common"))
        changes = self._on_readings(run, base[:, 0], timing)
        if held is None:
            changes |= {place: slopes[:, p + k] for k, place in enumerate(self.layout.simulated)}
            changes |= dict.fromkeys(speeds, slopes[:, -1])
        changes |= dict.fromkeys(self.layout.empty, np.zeros(()))
        for k, place in enumerate(local):
            if held is not None and (place in self.layout.simulated or place in speeds):
                nuisances[:, k] = held[:, k]
            else:
                np.multiply(changes[place], self.sigma[place], out=nuisances[:, k])
        self._like_nuisances(hypothesis, run, places, own, nuisances)
        return columns

    def _on_readings(self, run, value, timing):
        """Place → (L, M) changes of the data of a run with what acts on readings alone.

        Args:
            run: index of the run.
            value: (L, M) predictions.
            timing: (L, 1 + clock + delays, M) slopes to time zero, clock and delays.
        """
        layout = self.layout
        gains = scalars.gain_columns(self.experiment, run, value)
        own = {layout.trigger(run): timing[:, 0]}
        own |= {place: gains[:, s] for s, place in enumerate(layout.gains.tolist())}
        for place in layout.other("gain-common"):
            own[place] = gains.sum(axis=1)
        timed = [*layout.other("clock"), *layout.other("delay")]
        own |= {place: timing[:, 1 + k] for k, place in enumerate(timed)}
        for place in layout.other("shared"):
            own[place] = scalars.shared_column(self.experiment, run, value, layout.named(place))
        return own

    def nuisance_column(self, acts_like: str, run: int, place):
        """The nuisance that a ratio acts like, and its standard error.

        Args:
            acts_like: see `effects.Parameter`.
            run: index of the run.
            place: (n,) gauges or materials where the effect sits; of no account for speeds.

        Returns:
            (n,) places in the layout and (n, 1) standard errors, relative; None where the nuisance is known
            exactly, or one of those that these places ask for.
        """
        sigma = self.sigma
        if acts_like == "modulus":
            own = self._moduli[place]
            errors = np.where(own < 0, 0.0, sigma[own])
            return (own, errors[:, None]) if np.all(errors > 0.0) else None
        if acts_like == "gain":
            errors = sigma[self.layout.gains]
            return (self.layout.gains[place], errors[place][:, None]) if np.all(errors > 0.0) else None
        common = self.layout.other("speed-common")
        own = next((k for k in (self.layout.speed(run), *common) if sigma[k]), None)
        if own is None:
            return None
        return np.full(len(place), own), np.full((len(place), 1), sigma[own])

    @cached_property
    def _moduli(self) -> np.ndarray:
        """(materials,) places in the layout of the moduli of the beads' materials, -1 of what is exact."""
        known = {self.layout.named(k): k for k in self.layout.other("modulus")}
        others = [known.get(name, -1) for name in self.experiment.materials[1:]]
        return np.array([self.layout.modulus, *others])

    def _like_nuisances(self, hypothesis, run, places, slopes, nuisances):
        """Take the slopes of parameters that act exactly as a nuisance does from its column.

        Differences of simulations would hide that the two are one direction.
        """
        lanes, local = np.arange(len(slopes)), self.layout.local(run)
        for k, (component, own) in enumerate(zip(hypothesis.components, hypothesis.columns, strict=True)):
            place = np.full(len(slopes), component.place or 0) if places is None else places[:, k]
            for column, c in enumerate(component.free, start=own.start):
                like = c.parameter.acts_like
                for at in np.unique(place) if like else ():
                    own = lanes[place == at]
                    if found := self.nuisance_column(like, run, place[own]):
                        slopes[own, column] = nuisances[own, among(local, found[0])] / found[1]


def among(places: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Where some numbers stand among others."""
    order = np.argsort(places)
    return order[np.searchsorted(places, wanted, sorter=order)]
