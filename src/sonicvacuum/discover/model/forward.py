"""The simulator as a function of parameters: predictions of all data of an experiment, lane by lane, with
their slopes.

A *lane* is one complete experiment with its own parameters; every run of it is one chain of the stepper.
Nuisances (`nuisances`) stand in units of their standard errors; times and gains act on readings without
further simulation.
"""

from collections.abc import Iterable
from copy import copy
from dataclasses import replace
from functools import cached_property
from time import perf_counter

import numpy as np

from sonicvacuum.discover.model import accuracy, differences, gauges, scalars
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.memory import Learned, Memory
from sonicvacuum.discover.model.nuisances import Layout
from sonicvacuum.discover.model.slopes import Slopes
from sonicvacuum.effects import Setup
from sonicvacuum.forward import Seen, see, virtual
from sonicvacuum.physics.chain import Chain

# Chains simulated at once, to bound the memory; however many processors there are, since a chain depends on
# those beside it where these have other laws (by 1e-6 of the peak, see `physics.run.simulate`).
CHUNK = 256
# Natural logarithm of a ratio at which a chain is none that a laboratory has: a speed, a modulus or a mass a
# thousand times what was stated. A step that runs away to there would ask for steps without end.
NO_CHAIN = 7.0


class Forward:
    """Predictions of an experiment.

    Attributes:
        simulations: chains simulated so far.
        strengths: directions of a family → strengths at which its slopes were taken last.
        memory: columns, slopes and tests at the points asked for last.
        calls, seconds: predictions asked for at once, and the time that they took.
    """

    def __init__(self, experiment: Experiment, threads: int = 1, cut: float | None = None):
        self.experiment, self.threads, self.simulations = experiment, threads, 0
        self.layout = Layout(len(experiment.runs), len(experiment.gauges), experiment.shared)
        self.strengths: dict[tuple, np.ndarray] = {}
        self.memory = Memory()
        self._coarse = None
        self._tiled: dict[tuple, Chain] = {}
        self._alike: dict[tuple, list[list[int]]] = {}
        self.calls, self.seconds = 0, 0.0
        self._cut = cut
        self._finer = 1.0

    def of(self, experiment: Experiment) -> "Forward":
        """A predictor of other data of much the same chains, whose steps need not be held against shorter
        ones again.
        """
        return Forward(experiment, self.threads, self.cut)

    def branch(self, beside: int = 1) -> "Forward":
        """The same predictor for one of several hypotheses, with a memory of its own that begins as it is;
        `beside`: among how many at a time threads are shared out.
        """
        other = copy(self)
        other.threads = max(1, self.threads // beside)
        other.simulations, other.calls, other.seconds = 0, 0, 0.0
        other.strengths, other.memory = dict(self.strengths), self.memory.copy()
        other._coarse = self._coarse.branch(beside) if self._coarse else None
        return other

    def finely(self) -> "Forward":
        """The same predictor with slopes over shorter steps, see `accuracy.FINER`."""
        other = self.of(self.experiment)
        other._finer = accuracy.FINER
        return other

    def learned(self, branch: "Forward") -> Learned:
        """What a branch of this predictor, which has not changed since, counted and came to know."""
        return Learned(
            branch.simulations,
            branch.calls,
            branch.seconds,
            {family: s for family, s in branch.strengths.items() if s is not self.strengths.get(family)},
            branch.memory.since(self.memory),
            self.coarse.learned(branch._coarse) if branch._coarse else None,
        )

    def join(self, learned: Iterable[Learned]) -> None:
        """Take over what branches counted and, in their order, what they know and which strengths serve."""
        before = self.memory.copy()
        for one in learned:
            self.simulations += one.simulations
            self.calls, self.seconds = self.calls + one.calls, self.seconds + one.seconds
            self.memory.add(one.memory, before)
            self.strengths.update(one.strengths)
            if one.coarse:
                self.coarse.join([one.coarse])

    @property
    def seconds_of_call(self) -> float:
        """How long a call takes, on average."""
        return self.seconds / max(1, self.calls)

    @property
    def coarse(self) -> "Forward":
        """The same predictor of running integrals of the traces."""
        if self._coarse is None:
            self._coarse = Forward(replace(self.experiment, integrated=True), self.threads, 1.0)
        return self._coarse

    @property
    def chains(self) -> int:
        """Chains simulated so far, the coarse view's included."""
        return self.simulations + (self._coarse.simulations if self._coarse else 0)

    def data(self, run: int) -> np.ndarray:
        """(M,) whitened data of a run."""
        return self._whitened[run]

    @cached_property
    def norm(self) -> float:
        """Length of all data together, in standard errors."""
        return float(np.sqrt(sum(float(d @ d) for d in self._whitened)))

    @cached_property
    def _refine(self) -> float:
        """What divides the steps of simulations."""
        return accuracy.refinement(self.norm, self.experiment.integrated) * self.cut

    @property
    def cut(self) -> float:
        """By how much steps are shorter than noise asks for, as these chains err."""
        if self._cut is None:
            self._cut = accuracy.cut(self)
        return self._cut

    @cached_property
    def _whitened(self):
        own = [self.experiment.whitened(run)[None] for run in range(len(self.experiment.runs))]
        return [data[0] for data in self.experiment.divided(own)]

    def local(self, run: int) -> np.ndarray:
        """Places of the nuisances that move the data of a run, as their columns stand."""
        return np.arange(self.layout.size) if self.experiment.coupled else self.layout.local(run)

    def counts(self, run: int) -> np.ndarray:
        """Places of the data of a run that are whole numbers: they jump, and have no slopes."""
        return self._counts[run]

    @cached_property
    def _counts(self) -> list[np.ndarray]:
        """The same of all runs."""
        return [self.experiment.counts(run) for run in range(len(self.experiment.runs))]

    @cached_property
    def nuisance_sigma(self) -> np.ndarray:
        """(q,) standard errors: of logarithms of ratios, of times in s; 0: known exactly."""
        e = self.experiment
        speeds = [r.speed_rel_sigma for r in e.runs]
        triggers = [e.trigger_sigma if r.has_signals else 0.0 for r in e.runs]
        others = [one.sigma for one in e.shared]
        return np.array([*speeds, *triggers, *e.gain_rel_sigma, e.modulus_rel_sigma, *others])

    @cached_property
    def slopes(self) -> Slopes:
        """How the data change with nuisances."""
        return Slopes(self.experiment, self.layout, self.nuisance_sigma)

    def columns(
        self,
        hypothesis: Hypothesis,
        u: np.ndarray,
        nu: np.ndarray,
        places: np.ndarray | None = None,
        precise: bool = False,
        steps: np.ndarray | None = None,
        held: list[np.ndarray] | None = None,
    ) -> list[np.ndarray]:
        """Whitened predictions and their derivatives.

        Args:
            hypothesis: the effects in force.
            u: (L, p) coordinates of their free parameters.
            nu: (L, q) nuisances over their standard errors.
            places: (L, components) where they sit; None: as the hypothesis says.
            steps: (L, p) finite-difference steps of the coordinates; None: their default.
            precise: slopes to second order (twice the simulations), so that collinear ones come out
                collinear.
            held: columns of these lanes from nearby, whose slopes to what takes a simulation of its own
                (speeds, moduli, masses) are taken as they are; None: simulated.

        Returns:
            For each run (L, c, M): prediction, p derivatives to u, those to nuisances as in `local`.
        """
        u, nu = np.atleast_2d(u), np.atleast_2d(nu)
        if len(u) == 1 and steps is None and places is None and held is None:
            return self.memory.recalled(
                hypothesis,
                u,
                nu,
                ("columns", precise),
                lambda: self._taken(hypothesis, u, nu, precise=precise),
            )
        return self._taken(hypothesis, u, nu, places, precise, steps, held)

    def _taken(self, hypothesis, u, nu, places=None, precise=False, steps=None, held=None):
        """The columns, taken afresh; slopes of runs that are coupled are not those from nearby."""
        lanes, p = u.shape
        held = None if self.experiment.coupled else held
        if steps is None:
            steps = np.broadcast_to([c.step for c in hypothesis.coordinates], u.shape)
        orders = (1.0, 2.0) if precise else (1.0,)
        h, steps = accuracy.difference(self.norm) / self._finer, steps / self._finer
        where = () if held else self.slopes.simulated
        many_u, many_nu, sets = differences.displaced(hypothesis, u, nu, steps, orders, where, h)
        many_places = None if places is None else np.repeat(places, sets, axis=0)
        found = self._sampled(hypothesis, many_u, many_nu, many_places, sets)
        each = (sets - 1) // len(orders)
        size = differences.sizes(u, many_u, orders, each, h)
        result = []
        for run, (value, timing) in enumerate(found):
            value = value.reshape(lanes, sets, -1)
            slopes = differences.slopes(value, size, each, len(self.experiment.runs[run].scalars))
            kept = None if held is None else held[run][:, 1 + p :]
            columns = self.slopes.columns(hypothesis, run, places, value[:, :1], slopes, timing, kept)
            columns[:, 1:, self.counts(run)] = 0.0
            result.append(columns)
        return self._joined(result, p) if self.experiment.coupled else result

    def _joined(self, columns, p):
        """The columns of coupled runs: each run's data move with the nuisances of all."""
        lanes, whole = len(columns[0]), 1 + p + self.layout.size
        every = []
        for run, own in enumerate(columns):
            wide = np.zeros((lanes, whole, own.shape[2]))
            wide[:, : 1 + p] = own[:, : 1 + p]
            wide[:, 1 + p + self.layout.local(run)] = own[:, 1 + p :]
            every.append(wide.reshape(lanes * whole, -1))
        return [v.reshape(lanes, whole, -1) for v in self.experiment.divided(every)]

    def sampled(self, hypothesis, u, nu, places=None, change=None):
        """For each run whitened predictions (L, M)."""
        values = [value for value, _ in self._sampled(hypothesis, u, nu, places, change=change)]
        return self.experiment.divided(values)

    def _sampled(self, hypothesis, u, nu, places=None, rate_of: int = 0, change=None):
        """For each run whitened predictions (L, M), not divided, and, for every `rate_of`-th lane, slopes
        (·, n, M) to time zero, clock and delays.
        """
        begun, change = perf_counter(), change or hypothesis.change(u, places)
        runs = len(self.experiment.runs)
        values = [[] for _ in range(runs)]
        rates = [[] for _ in range(runs)]
        per_call = max(rate_of or 1, CHUNK // max(1, runs))
        per_call -= per_call % (rate_of or 1)
        for first in range(0, len(nu), per_call):
            part = np.arange(first, min(first + per_call, len(nu)))
            for batch in self.experiment.batches:
                for run, value, rate in self._batch(batch, change, nu, part, rate_of):
                    values[run].append(value)
                    rates[run].append(rate)
        self.calls, self.seconds = self.calls + 1, self.seconds + perf_counter() - begun
        return [(np.concatenate(v), np.concatenate(r)) for v, r in zip(values, rates, strict=True)]

    def _batch(self, batch, change, nu, part, rate_of):
        """Run, predictions and rates of a batch for the lanes `part`; no numbers where there is no chain."""
        nu, e, own = nu[part], self.experiment, self.layout.of_chain
        lost = ~(np.abs(nu[:, own] * self.nuisance_sigma[own]) < NO_CHAIN).all(axis=1)
        nu = np.where(lost[:, None], 0.0, nu)
        setup = change(self.nominal(batch, nu), np.repeat(part, len(batch.runs)))
        seen, gain = self.simulate(batch, setup, self._lasting(batch, nu)), self._gain(nu)
        traces = {}
        for places in self._recorded_alike(batch):
            read = (self.layout, self.nuisance_sigma, batch, places, seen.readings, gain, nu)
            traces |= gauges.traces(e, *read, rate_of or len(nu))

        def again(lanes, duration):
            return self.simulate(batch, setup.take(lanes), duration)

        observed = scalars.of_batch(e, self.layout, batch, seen, gain, nu, again, self._refine)
        for run, measured in zip(batch.runs, observed, strict=True):
            value, timing = traces[run]
            flat = e.whitened_on(run, value, measured)
            flat[lost] = np.nan
            rated, times, *shape = timing.shape
            rates = timing.reshape(rated * times, *shape)
            rates = e.whitened_on(run, rates, np.zeros((len(rates), measured.shape[1])))
            yield run, flat, rates.reshape(rated, times, rates.shape[1])

    def _lasting(self, batch, nu) -> float:
        """Time in s to simulate: what is read of traces, wherever time zero is; numbers may need all."""
        if any(self.experiment.runs[run].scalars for run in batch.runs):
            return batch.first_s
        read = gauges.last_read(self.experiment, self.layout, self.nuisance_sigma, batch, nu)
        return min(batch.first_s, read)

    def _recorded_alike(self, batch) -> list[list[int]]:
        """Places of the batch's runs, those together whose samples were taken, and count, alike."""
        if batch.runs not in self._alike:
            found: dict[tuple, list[int]] = {}
            for k, run in enumerate(batch.runs):
                data = self.experiment.runs[run]
                counting = None if data.present is None else data.present.tobytes()
                found.setdefault((data.time.tobytes(), counting), []).append(k)
            self._alike[batch.runs] = list(found.values())
        return self._alike[batch.runs]

    def _gain(self, nu):
        """(L, S) gains of the gauges over the nominal ones."""
        sigma, layout = self.nuisance_sigma, self.layout
        common = sum((nu[:, k] * sigma[k] for k in layout.other("gain-common")), start=np.zeros(len(nu)))
        return np.exp(nu[:, layout.gains] * sigma[layout.gains] + common[:, None])

    def nominal(self, batch, nu) -> Setup:
        """Setup of all lanes of a batch (lane-major, run-minor) with the nuisances in force."""
        sigma, runs, layout = self.nuisance_sigma, np.array(batch.runs), self.layout
        lanes = len(nu)
        chain = self._repeated(batch, lanes)
        speed = chain.speed * np.exp(nu[:, runs] * sigma[runs]).ravel()
        stiffer = np.repeat(np.exp(nu[:, layout.modulus] * sigma[layout.modulus]), len(runs))
        chain = chain.struck_at(speed).stiffened(chain.first.surface.name, stiffer)
        for place, one in enumerate(layout.others, start=layout.modulus + 1):
            chain = one.change(chain, np.repeat(np.exp(nu[:, place] * sigma[place]), len(runs)))
        return Setup(chain, batch.gauges or self.experiment.gauges, self.experiment.catalogue)

    def _repeated(self, batch, lanes):
        """The nominal chains of a batch, all runs for each lane; kept: few numbers of lanes are asked for."""
        key = (batch.runs, lanes)
        if key not in self._tiled:
            self._tiled[key] = batch.chain.take(np.tile(np.arange(len(batch.runs)), lanes))
        return self._tiled[key]

    def simulate(self, batch, setup: Setup, duration: float | None = None) -> Seen:
        """What a batch shows in so many seconds (None: all of them), with what the scalars need besides."""
        self.simulations += setup.chain.lanes
        asked = any(run.scalars for run in self.experiment.runs)
        return see(
            setup,
            batch.duration if duration is None else duration,
            batch.interval,
            besides=virtual(self.experiment.gauges, setup.chain.beads) if asked else (),
            striker=asked,
            refine=self._refine,
            threads=self.threads,
            forgiving=True,
        )
