"""The simulator as a function of parameters: predictions of all data of an experiment, lane by lane, with
their slopes.

A *lane* is one complete experiment with its own parameters; every run of it is one chain of the stepper.
Nuisances (`nuisances`) stand in units of their standard errors; times and gains act on readings without
further simulation.
"""

from dataclasses import replace
from functools import cached_property

import numpy as np

from sonicvacuum.discover.model import gauges, scalars
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.nuisances import Layout
from sonicvacuum.effects import Setup
from sonicvacuum.forward import Seen, see, virtual
from sonicvacuum.physics.chain import Chain

# Largest steps of speed and modulus for finite differences, relative; smaller where the data are precise, so
# that all data together change by about this many standard errors, and collinear columns come out collinear.
LARGEST_STEP, STEP_AIM = 3e-3, 10.0
# Error of a simulation at full accuracy as a share of the data's norm, and what is allowed of it, in standard
# errors over all data together; it grows as the fourth power of the step. Beyond LONGEST_STEP steps the laws
# that remember are no longer followed.
ERROR, ERROR_AIM, LONGEST_STEP = 1e-6, 0.05, 2.5
CHUNK = 512  # chains simulated in one call, to bound the memory


class Forward:
    """Predictions of an experiment.

    Attributes:
        simulations: chains simulated so far.
        strengths: directions of a family → strengths at which its slopes were taken last.
    """

    def __init__(self, experiment: Experiment, threads: int = 1):
        self.experiment, self.threads, self.simulations = experiment, threads, 0
        self.layout = Layout(len(experiment.runs), len(experiment.gauges), experiment.shared)
        self.strengths: dict[tuple, np.ndarray] = {}
        self._coarse = None
        self._tiled: dict[tuple, Chain] = {}

    @property
    def coarse(self) -> "Forward":
        """The same predictor of running integrals of the traces."""
        if self._coarse is None:
            self._coarse = Forward(replace(self.experiment, integrated=True), self.threads)
        return self._coarse

    @property
    def chains(self) -> int:
        """Chains simulated so far, the coarse view's included."""
        return self.simulations + (self._coarse.simulations if self._coarse else 0)

    def data(self, run: int) -> np.ndarray:
        """(M,) whitened data of a run."""
        return self._whitened[run]

    @cached_property
    def step(self) -> float:
        """Relative step of speeds and modulus for finite differences."""
        size = np.sqrt(sum(float(d @ d) for d in self._whitened))
        return float(np.clip(STEP_AIM / max(size, 1e-9), 1e-5, LARGEST_STEP))

    @cached_property
    def refine(self) -> float:
        """By what the stepper's full accuracy is refined: below 1, as far as the noise leaves it unseen."""
        size = np.sqrt(sum(float(d @ d) for d in self._whitened))
        return float(np.clip((ERROR * size / ERROR_AIM) ** 0.25, 1.0 / LONGEST_STEP, 1.0))

    @cached_property
    def _whitened(self):
        return [self.experiment.whitened(run) for run in range(len(self.experiment.runs))]

    def counts(self, run: int) -> np.ndarray:
        """Places of the data of a run that are whole numbers: they jump, and have no slopes."""
        scalars_ = self.experiment.runs[run].scalars
        first = self.experiment.length(run) - len(scalars_)
        return np.array([first + k for k, s in enumerate(scalars_) if s.quantity == "pulse_count"], dtype=int)

    @cached_property
    def nuisance_sigma(self) -> np.ndarray:
        """(q,) standard errors: of logarithms of ratios, of times in s; 0: known exactly."""
        e = self.experiment
        speeds = [r.speed_rel_sigma for r in e.runs]
        triggers = [e.trigger_sigma if r.has_signals else 0.0 for r in e.runs]
        others = [one.sigma for one in e.shared]
        return np.array([*speeds, *triggers, *e.gain_rel_sigma, e.modulus_rel_sigma, *others])

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
            For each run (L, c, M): prediction, p derivatives to u, those to nuisances as in `Layout.local`.
        """
        u, nu = np.atleast_2d(u), np.atleast_2d(nu)
        once = self._assemble(hypothesis, u, nu, places, 1.0, steps, held)
        if not precise:
            return once
        twice = self._assemble(hypothesis, u, nu, places, 2.0, steps, held)
        for one, two in zip(once, twice, strict=True):
            one[:, 1:] = 2.0 * one[:, 1:] - two[:, 1:]
        return once

    def _assemble(self, hypothesis, u, nu, places, stretch, steps, held):
        """Stack base, parameter, nuisance and speed lanes, simulate them at once, take differences."""
        lanes, p = u.shape
        sets = p + 1 + (0 if held else 1 + len(self.layout.simulated))
        many_u, many_nu = np.repeat(u, sets, axis=0), np.repeat(nu, sets, axis=0)
        if steps is None:
            steps = np.broadcast_to([c.step for c in hypothesis.coordinates], u.shape)
        steps = stretch * steps
        for k in range(p):
            towards = np.where(u[:, k] + steps[:, k] > hypothesis.coordinates[k].high, -1.0, 1.0)
            many_u[1 + k :: sets, k] += steps[:, k] * towards
        h = stretch * self.step
        if not held:
            self._displace(many_nu, p, sets, h)
        many_places = None if places is None else np.repeat(places, sets, axis=0)
        found = self.sampled(hypothesis, many_u, many_nu, many_places, rate_of=sets)
        divide = many_u.reshape(lanes, sets, p)[:, 1 : 1 + p] - u[:, None]
        divide = np.einsum("lkk->lk", divide) if p else np.zeros((lanes, 0))
        result = []
        for run, (value, timing) in enumerate(found):
            value = value.reshape(lanes, sets, -1)
            base = value[:, :1]
            slopes = (value[:, 1 : 1 + p] - base) / divide[..., None]
            departures = None if held else (value[:, 1 + p :] - base) / h
            nuisances = self._nuisance_columns(run, base[:, 0], departures, timing)
            if held:
                kept = self._kept(run)
                nuisances[:, kept] = held[run][:, 1 + p + kept]
            self._like_nuisances(hypothesis, run, places, slopes, nuisances)
            columns = np.concatenate([base, slopes, nuisances], axis=1)
            columns[:, 1:, self.counts(run)] = 0.0
            result.append(columns)
        return result

    def _displace(self, many_nu, p, sets, h):
        """Move the simulated nuisances and, in the last lane of a set, the speeds by the relative step h."""
        sigma, runs = self.nuisance_sigma, len(self.experiment.runs)
        for k, place in enumerate(self.layout.simulated):
            many_nu[1 + p + k :: sets, place] += h / sigma[place] if sigma[place] else 0.0
        for place in self.layout.other("speed-common") or range(runs):
            many_nu[sets - 1 :: sets, place] += h / sigma[place] if sigma[place] else 0.0

    def _nuisance_columns(self, run, value, departures, timing):
        """(L, S + 3 + others, M) changes of the data of a run with its nuisances, as in `Layout.local`.

        Args:
            run: index of the run.
            value: (L, M) predictions.
            departures: (L, simulated + 1, M) slopes to the simulated ones, relative, and to the speeds; None
                leaves their columns at zero.
            timing: (L, 1 + clock + delays, M) slopes to time zero, clock and delays.
        """
        layout, sigma = self.layout, self.nuisance_sigma
        gains = self._gain_columns(run, value)
        if departures is None:
            departures = np.zeros((len(value), 1 + len(layout.simulated), 1))
        own = {place: departures[:, k] for k, place in enumerate(layout.simulated)}
        own |= {layout.speed(run): departures[:, -1], layout.trigger(run): timing[:, 0]}
        own |= {place: gains[:, s] for s, place in enumerate(layout.gains)}
        own |= dict.fromkeys(layout.other("speed-common"), departures[:, -1])
        own |= dict.fromkeys(layout.other("gain-common"), gains.sum(axis=1))
        timed = [*layout.other("clock"), *layout.other("delay")]
        own |= {place: timing[:, 1 + k] for k, place in enumerate(timed)}
        places = layout.local(run)
        result = np.empty((len(value), len(places), value.shape[1]))
        for k, place in enumerate(places):
            result[:, k] = own[place] * sigma[place]
        return result

    def _kept(self, run) -> np.ndarray:
        """Which of the columns to the nuisances of a run, as in `Layout.local`, take simulations."""
        layout = self.layout
        own = {*layout.simulated, layout.speed(run), *layout.other("speed-common")}
        return np.flatnonzero([place in own for place in layout.local(run)])

    def nuisance_column(self, acts_like: str, run: int, place):
        """Where the nuisance stands that a ratio acts like, and its standard error.

        Args:
            acts_like: see `effects.Parameter`.
            run: index of the run.
            place: (n,) gauges where the effect sits; of no account but for gains.

        Returns:
            (n,) places in the order of `Layout.local` and (n, 1) standard errors, relative; None where the
            nuisance is known exactly.
        """
        sigma = self.nuisance_sigma
        if acts_like == "gain":
            errors = sigma[self.layout.gains]
            return (3 + place, errors[place][:, None]) if np.all(errors > 0.0) else None
        common = self.layout.other("speed-common")
        known = {"modulus": [self.layout.modulus], "speed": [self.layout.speed(run), *common]}[acts_like]
        own = next((k for k in known if sigma[k]), None)
        if own is None:
            return None
        at = int(np.flatnonzero(self.layout.local(run) == own)[0])
        return np.full(len(place), at), np.full((len(place), 1), sigma[own])

    def _like_nuisances(self, hypothesis, run, places, slopes, nuisances):
        """Take the slopes of parameters that act exactly as a nuisance does from its column.

        Differences of simulations would hide that the two are one direction.
        """
        lanes = np.arange(len(slopes))
        for k, (component, own) in enumerate(zip(hypothesis.components, hypothesis.columns, strict=True)):
            place = np.full(len(slopes), component.place or 0) if places is None else places[:, k]
            for column, c in enumerate(component.free, start=own.start):
                like = c.parameter.acts_like
                if like and (found := self.nuisance_column(like, run, place)):
                    slopes[:, column] = nuisances[lanes, found[0]] / found[1]

    def _gain_columns(self, run, value):
        """(L, S, M) change of the data of a run with the logarithm of the gain of each gauge."""
        e, data = self.experiment, self.experiment.runs[run]
        gauges_, samples = len(e.gauges), len(data.time)
        columns = np.zeros((len(value), gauges_, value.shape[1]))
        for s in range(gauges_):
            columns[:, s, s * samples : (s + 1) * samples] = value[:, s * samples : (s + 1) * samples]
            for k, one in enumerate(data.scalars):
                at = gauges_ * samples + k
                columns[:, s, at] = value[:, at] * scalars.gain_power(one, e.gauges[s].id)
        return columns

    def sampled(self, hypothesis, u, nu, places=None, rate_of: int = 0, change=None):
        """For each run whitened predictions (L, M) and, for every `rate_of`-th lane, slopes (·, n, M) to time
        zero, clock and delays.
        """
        change = change or hypothesis.change(u, places)
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
        return [(np.concatenate(v), np.concatenate(r)) for v, r in zip(values, rates, strict=True)]

    def _batch(self, batch, change, nu, part, rate_of):
        """Run, predictions and rates of one batch for the lanes `part`."""
        runs = len(batch.runs)
        index = np.repeat(part, runs)
        setup = change(self.nominal(batch, nu[part]), index)
        seen = self.simulate(batch, setup)
        for k, run in enumerate(batch.runs):
            yield run, *self._data(batch, run, k, runs, seen, nu[part], rate_of)

    def _data(self, batch, run, k, runs, seen, nu, rate_of):
        e, data, layout = self.experiment, self.experiment.runs[run], self.layout
        signals = seen.readings[k::runs] * self._gain(nu)[..., None]
        measured = scalars.predict(e, run, slice(k, None, runs), seen, signals)
        lanes, sigma = len(nu), self.nuisance_sigma
        value = np.zeros((lanes, len(e.gauges), 0))
        times = 1 + len(layout.other("clock")) + len(layout.other("delay"))
        timing = np.zeros((len(value[:: rate_of or lanes]), times, *value.shape[1:]))
        if data.has_signals:
            shift = data.shift + nu[:, layout.trigger(run)] * sigma[layout.trigger(run)]
            value, timing = self._at_record(batch, data, signals, shift, nu, rate_of or lanes)
        flat = e.whiten(run, value, measured)
        parts = timing.reshape(len(timing) * times, *value.shape[1:])
        rates = e.whiten(run, parts, np.zeros((len(parts), measured.shape[1])))
        return flat, rates.reshape(len(timing), times, rates.shape[1])

    def _gain(self, nu):
        """(L, S) gains of the gauges over the nominal ones."""
        sigma, layout = self.nuisance_sigma, self.layout
        common = sum((nu[:, k] * sigma[k] for k in layout.other("gain-common")), start=np.zeros(len(nu)))
        return np.exp(nu[:, layout.gains] * sigma[layout.gains] + common[:, None])

    def _at_record(self, batch, data, signals, shift, nu, rate_of):
        """(L, S, T) readings at recorded times and (·, n, S, T) slopes to time zero, clock and delays.

        The clock's error is taken to first order: it moves no sample by more than a part of a pulse.
        """
        layout, sigma = self.layout, self.nuisance_sigma
        clock, delays = layout.other("clock"), layout.other("delay")
        late = np.zeros((len(nu), signals.shape[1]))
        gauges_ = [layout.others[k - layout.modulus - 1].gauge for k in delays]
        late[:, gauges_] = nu[:, delays] * sigma[delays]
        parts = [
            gauges.shifted(signals[:, own], batch.interval, data.time, shift + delay, 1 if clock else rate_of)
            for own, delay in ([(slice(None), late[:, 0])] if not delays else _by_gauge(late))
        ]
        value, rate = (np.concatenate(p, axis=1) for p in zip(*parts, strict=True))
        slopes = [-rate]
        for k in clock:
            slopes.append(-rate * (data.time - shift[:, None])[:, None])
            value = value + (nu[:, k] * sigma[k])[:, None, None] * slopes[1]
            slopes = [s[::rate_of] for s in slopes]
        slopes += [slopes[0] * (np.arange(signals.shape[1]) == s)[:, None] for s in gauges_]
        return value, np.stack(slopes, axis=1)

    def nominal(self, batch, nu) -> Setup:
        """Setup of all lanes of a batch (lane-major, run-minor) with the nuisances in force."""
        sigma, runs, layout = self.nuisance_sigma, np.array(batch.runs), self.layout
        lanes = len(nu)
        chain = self._repeated(batch, lanes)
        speed = chain.speed * np.exp(nu[:, runs] * sigma[runs]).ravel()
        stiffer = np.repeat(np.exp(nu[:, layout.modulus] * sigma[layout.modulus]), len(runs))
        chain = replace(chain, speed=speed).stiffened(chain.first.surface.name, stiffer)
        for place, one in enumerate(layout.others, start=layout.modulus + 1):
            chain = one.change(chain, np.repeat(np.exp(nu[:, place] * sigma[place]), len(runs)))
        return Setup(chain, batch.gauges or self.experiment.gauges, self.experiment.catalogue)

    def _repeated(self, batch, lanes):
        """The nominal chains of a batch, all runs for each lane; kept, as few numbers of lanes are asked for."""
        key = (batch.runs, lanes)
        if key not in self._tiled:
            self._tiled[key] = batch.chain.take(np.tile(np.arange(len(batch.runs)), lanes))
        return self._tiled[key]

    def simulate(self, batch, setup: Setup) -> Seen:
        """What a batch shows, with what the scalars need besides."""
        self.simulations += setup.chain.lanes
        asked = any(run.scalars for run in self.experiment.runs)
        return see(
            setup,
            batch.duration,
            batch.interval,
            besides=virtual(self.experiment.gauges, setup.chain.beads) if asked else (),
            striker=asked,
            refine=self.refine,
            threads=self.threads,
            forgiving=True,
        )


def _by_gauge(late):
    """(slice, (L,) delay) of each gauge."""
    return [(slice(s, s + 1), late[:, s]) for s in range(late.shape[1])]
