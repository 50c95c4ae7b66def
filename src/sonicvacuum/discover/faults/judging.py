"""How much better a model fits the record when a slip is put right: a linear look, then a fit (`judged`)."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.judged import Judged, Model, excess, noise_volume, occam
from sonicvacuum.discover.faults.slips import Slip
from sonicvacuum.discover.faults.table import FAULTS
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit, finished, fit
from sonicvacuum.discover.fit.worth import PATIENCE
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import error
from sonicvacuum.records import Record
from sonicvacuum.records.blocks import RunBlock
from sonicvacuum.records.record import observable

# Steps of the search for a size, and the Δχ² below which a step is the last.
STEPS, LAST = 6, 0.3
# The same as a share of what is left beyond the noise, where that is more.
ROUGH = 1e-3
# A step by slopes is made longer by no more than this.
FARTHER = 8.0
# Calls of the predictor that a look takes, about.
LOOK = 5
# Farthest size from where the search starts, in prior widths; of masses, which slopes lead to from none, in
# its logarithm: another material, a hollow bead, the weight of two for one.
LONGEST, MASSES = 5.0, math.log(2.0)


class Judge:
    """Judges slips of one record beside one model of it.

    Attributes:
        model: of the record as it is.
        make: record → data set; masks included.
        least: gain that counts, where one is known: slips that do not come to it are not followed to the end.
    """

    def __init__(
        self,
        model: Model,
        make: Callable[[Bench], Experiment],
        threads: int | None = None,
        least: float | None = None,
    ):
        self.model, self.make, self.threads = model, make, threads or model.forward.threads
        self.least = least
        self.simulations = 0
        self._columns = None
        self._own = self._residuals(model.bench.record)

    def _bench(self, record: Record) -> Bench:
        return replace(self.model.bench, record=record)

    def _forward(self, record):
        return Forward(self.make(self._bench(record)), self.threads, self.model.forward.cut)

    def _nuisances(self, slip: Slip) -> np.ndarray:
        """(q,) nuisances of the model without what has stood in for a slip that is far off."""
        nu, forward = self.model.fit.nu.copy(), self.model.forward
        if slip.far:
            run = [r.id for r in forward.experiment.runs].index(slip.run)
            nu[getattr(forward.layout, slip.instead)(run)] = 0.0
        return nu

    def _units(self, forward: Forward) -> np.ndarray:
        """(q,) what the model's nuisances are multiplied by for a changed record: they count standard errors,
        and a slip may be that these are larger than stated.
        """
        before, now = self.model.forward.nuisance_sigma, forward.nuisance_sigma
        return np.divide(before, now, out=np.ones_like(now), where=(now > 0.0) & (before > 0.0))

    def _residuals(self, record, slip=None, near=False):
        """`_linearised` at the model's parameters; with a `slip` at its `_nuisances` and at none."""
        one = self.model.fit
        starts = one.nu[None] if slip is None else np.stack([self._nuisances(slip), 0.0 * one.nu])
        return self._linearised(record, starts, near)

    def _linearised(self, record, starts, near=False):
        """Residuals and slopes of every run for a changed record, with (L, q) nuisances, (L, runs), and its
        Σ log σ².

        Where the record is `near` the one as it is, slopes that take a simulation each are those of that one.
        """
        forward, one = self._forward(record), self.model.fit
        starts = starts * self._units(forward)
        many_u, held = np.repeat(one.u[None], len(starts), axis=0), self._columns if near else None
        # Nuisances take up nearly all of what a slip of time or speed changes: the slopes that all sizes are
        # held against must not err by as much as is left.
        first = self._columns is None
        columns = forward.columns(one.hypothesis, many_u, starts, precise=first, held=held)
        self._columns = self._columns or columns
        self.simulations += forward.chains
        found = []
        for lane, nu in enumerate(starts):
            parts = [c[lane].copy() for c in columns]
            for run, part in enumerate(parts):
                part[0] = forward.data(run) - part[0]
            found.append((parts, nu))
        return found, noise_volume(forward.experiment)

    @cached_property
    def _before(self) -> float:
        """−2 log L of the record as it is in the linearised model."""
        (own,), volume = self._own
        return self._least(*own) + volume

    @cached_property
    def _as_it_is(self):
        """Of a table: residuals and slopes of every run at the model's nuisances and at none, with these, and
        every run's values and errors; what slips of values change.
        """
        record, one = self.model.bench.record, self.model.fit
        both, _ = self._linearised(record, np.stack([one.nu, 0.0 * one.nu]))
        return both, [_numbers(run) for run in record.block.runs]

    def _look_at_values(self, slip: Slip) -> Judged:
        """The same of a slip that changes values and errors of a table only: nothing is simulated for it."""
        both, stated = self._as_it_is
        old, new = self.model.bench.record, slip.change(self.model.bench.record, 0.0)
        # Runs that a slip leaves alone are the same objects.
        runs = zip(old.block.runs, new.block.runs, stated, strict=True)
        numbers = [own if now is run else _numbers(now) for run, now, own in runs]
        after = np.inf
        for parts, nu in both:
            moved = []
            for part, own, given in zip(parts, stated, numbers, strict=True):
                if given is not own:
                    part = part * (own[1] / given[1])
                    part[0] += (given[0] - own[0]) / given[1]
                moved.append(part)
            after = min(after, self._least(moved, nu))
        after += sum(2.0 * float(np.log(error).sum()) for _, error in numbers)
        gain = self._before - after
        return Judged(slip, 0.0, gain, 0.5 * gain + occam(slip, 0.0, gain))

    def look(self, slip: Slip) -> Judged:
        """Gain as the slopes have it: one simulated experiment or two, no fit."""
        if slip.of_values:
            return self._look_at_values(slip)
        (own,), volume = self._own
        record, size = self.model.bench.record, slip.start
        if slip.continuous and not size:
            after, size = self._with_size(own, self._slope(slip), slip)
            after += volume
        else:
            changed, own_volume = self._residuals(slip.change(record, size), slip)
            after = min(self._least(*one) for one in changed)
            after += volume if slip.continuous else own_volume
        gain = self._before - after
        return Judged(slip, size, gain, 0.5 * gain + occam(slip, size, gain))

    def look_at(self, slips: Sequence[Slip]) -> list[Judged]:
        """`look` at all of them, side by side; what all have in common first, and once."""
        if any(s.of_values for s in slips):
            _ = self._as_it_is
        if slips:
            _ = self._before

        def seen(slip):
            one = self.look(slip)
            return one.size, one.gain, one.log_bayes

        return [Judged(s, *found) for s, found in zip(slips, self._abreast(seen, slips, LOOK), strict=True)]

    def follow_all(self, looked: Sequence[Judged]) -> list[Judged]:
        """`follow` all of them, side by side."""

        def fitted(judged):
            one = self.follow(judged)
            return one.size, one.model.fit

        found = self._abreast(fitted, looked, abreast.FIT)
        return [
            self._judged(j.slip, size, Model(*self._put_right(j.slip, size), one))
            for j, (size, one) in zip(looked, found, strict=True)
        ]

    def _abreast(self, work, items, calls):
        """`work(item)` for each, none asking for another; their simulations are counted."""
        threads, before = self.threads, self.simulations

        def alone(branch, item):
            self.threads, self.simulations = branch.threads, 0
            return work(item), self.simulations

        found = abreast.each(self.model.forward, alone, items, calls=calls)
        self.threads, self.simulations = threads, before + sum(count for _, count in found)
        return [result for result, _ in found]

    def _normal(self, parts, nu, extra=None):
        """Gradient, Hessian and χ² over all runs; the size of a slip is the last unknown."""
        one, forward = self.model.fit, self.model.forward
        p, q = len(one.u), forward.layout.size
        n = p + q + (extra is not None)
        gradient, hessian, chi2 = np.zeros(n), np.zeros((n, n)), 0.0
        for run, part in enumerate(parts):
            rows = part[1:] if extra is None else np.vstack([part[1:], extra[run]])
            where = np.concatenate([np.arange(p), p + forward.local(run), np.arange(p + q, n)])
            gradient[where] += rows @ part[0]
            hessian[np.ix_(where, where)] += rows @ rows.T
            chi2 += float(part[0] @ part[0])
        at = np.arange(p, p + q)
        gradient[at] -= nu
        hessian[at, at] += 1.0
        return gradient, hessian, chi2 + float(nu @ nu)

    def _least(self, parts, nu):
        """Least χ² in the linearised model."""
        gradient, hessian, value = self._normal(parts, nu)
        return value - float(gradient @ np.linalg.solve(_ridged(hessian), gradient))

    def _with_size(self, own, extra, slip):
        """Least χ² with the size of a slip free, and the step to it."""
        gradient, hessian, value = self._normal(*own, extra)
        hessian[-1, -1] += (2.0 * slip.width) ** -2.0
        step = np.linalg.solve(_ridged(hessian), gradient)
        return value - float(gradient @ step), float(step[-1])

    def follow(self, judged: Judged) -> Judged:
        """The slip fitted: its size with all else, the record changed with it."""
        slip = judged.slip
        size, model = (judged.size, judged.model) if judged.model else self._fitted(slip, judged.size)
        before = None
        for _ in range(STEPS if slip.continuous else 0):
            inner = Judge(model, self.make, self.threads)
            step = inner._step(slip)
            self.simulations += inner.simulations
            new_size, new = self._fitted(slip, size + _farther(before, size, step), model.fit)
            gained, before = self._value(slip, model) - self._value(slip, new), (size, step)
            if gained > 0.0:
                size, model = new_size, new
            # A step of hardly anything is the last, and one that so many like it do not lead where it counts.
            behind = model.fit.objective - self._reach(slip, model.forward)
            if gained < max(LAST, ROUGH * (model.fit.objective - data(model.forward)), behind / PATIENCE):
                break
        return self._judged(slip, size, model)

    def _judged(self, slip: Slip, size: float, model: Model) -> Judged:
        """What a slip of a size gains whose model is fitted."""
        gain = self._value(slip, self.model) - self._value(slip, model)
        return Judged(slip, size, gain, 0.5 * gain + occam(slip, size, gain), model)

    def at(self, slip: Slip, size: float, last: Fit | None) -> Judged:
        """The slip at one size, fitted from the last fit as well."""
        return self._judged(slip, *self._fitted(slip, size, last, True))

    def _step(self, slip):
        """Step of a slip's size from a record that is changed already; sizes add up."""
        (own,), _ = self._own
        return self._with_size(own, self._slope(slip), slip)[1]

    def _slope(self, slip):
        """Change of every run's data with the size of a slip, by central differences."""
        record = self.model.bench.record
        sides = []
        for step in (slip.step, -slip.step):
            ((parts, _),), _ = self._residuals(slip.change(record, step), near=True)
            sides.append(parts)
        return [(b[0] - a[0]) / (2.0 * slip.step) for a, b in zip(*sides, strict=True)]

    def _value(self, slip, model):
        """−2 log L; without the volume of the noise for a change that only rescales. What is lost counts as
        noise does.
        """
        lost = data(self.model.forward) - data(model.forward)
        return model.fit.objective + lost if slip.continuous else model.objective

    def _put_right(self, slip, size):
        """The record changed by a size, and its predictor."""
        record, lost = self.model.bench.record, self.model.bench.lost
        bench = replace(self._bench(slip.change(record, size)), lost=slip.lost(lost, record, size))
        return bench, Forward(self.make(bench), self.threads, self.model.forward.cut)

    def _fitted(self, slip, size, start: Fit | None = None, afresh: bool = False):
        """The record changed by a size and its model, fitted from a start, or from the model as it is and
        from nuisances of zero; `afresh` from all of these.
        """
        far = max(LONGEST * slip.width, MASSES if FAULTS[slip.fault].curved else 0.0)
        size = float(np.clip(size, slip.start - far, slip.start + far)) if slip.continuous else 0.0
        bench, forward = self._put_right(slip, size)
        one = self.model.fit
        own = self._nuisances(slip) * self._units(forward)
        anew = [own, 0.0 * one.nu] if afresh or not start else []
        nu = ([start.nu] if start else []) + anew
        one, reach = start or one, self._reach(slip, forward)
        many_u = np.repeat(one.u[None], len(nu), axis=0)
        found = fit(forward, one.hypothesis, many_u, np.stack(nu), finish=False, reach=reach)
        # Last steps may gain much, but not as much as that share.
        if found.objective < reach + policy.PART * max(excess(self.model), policy.SURE_GAIN):
            found = finished(forward, found)
        self.simulations += forward.chains
        return size, Model(bench, forward, found)

    def _reach(self, slip: Slip, forward: Forward) -> float:
        """Objective of the record put right above which a slip is of no use, so that its fit need not end.

        What has no size is right or wrong: where it is no better than the record as it is, by how much does
        not matter. Of a size that takes away a small part of a large misfit nothing is made.
        """
        far, one = excess(self.model), self.model
        if not slip.continuous:
            return one.objective - noise_volume(forward.experiment) - (self.least or 0.0)
        if self.least is not None:
            return one.fit.objective - self.least
        return one.fit.objective - policy.PART * far if far > policy.SURE_GAIN else np.inf


def _numbers(run: RunBlock) -> tuple[np.ndarray, np.ndarray]:
    """(n,) values and errors of a run of a table, in SI."""
    found = [observable(o) for o in run.observables]
    return np.array([o.value for o in found]), np.array([error(o) for o in found])


def _farther(before: tuple[float, float] | None, size: float, step: float) -> float:
    """The step to where steps vanish, by those at two sizes (secant).

    The slope of a trace to its own delay is that of its noise as well, which makes steps too short.
    """
    if before is None or size == before[0]:
        return step
    shrinks = (before[1] - step) / (size - before[0])
    return step / min(max(shrinks, 1.0 / FARTHER), 1.0)


def _ridged(hessian):
    """A matrix that can be solved with where a nuisance is known exactly."""
    return hessian + 1e-9 * np.diag(np.maximum(np.diag(hessian), 1e-9))
