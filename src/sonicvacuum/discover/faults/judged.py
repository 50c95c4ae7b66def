"""A slip as it was judged, and what follows: whether it is obvious or out of reach, a record suspicious.

Records that differ in a slip differ in their data and in their noise, so that not χ² but −2 log L is
compared: χ², the penalty of the nuisances, and the logarithm of the noise of every sample that counts.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.slips import Slip
from sonicvacuum.discover.faults.table import FAULTS
from sonicvacuum.discover.fit import tails
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward


@dataclass(frozen=True)
class Model:
    """A model fitted to a record: predictor, fit and −2 log L up to a constant of the raw data."""

    bench: Bench
    forward: Forward
    fit: Fit

    @property
    def objective(self) -> float:
        """−2 log L with the nuisances' prior."""
        return self.fit.objective + noise_volume(self.forward.experiment)


@dataclass(frozen=True)
class Judged:
    """A slip beside a model of the record with it.

    Attributes:
        slip: the hypothesis.
        size: where it fits best.
        gain: Δ(−2 log L) against the model of the record as it is.
        log_bayes: natural log of the Bayes factor against it, prior of the slip left aside.
        model: fitted to the record put right; None after a linear look.
    """

    slip: Slip
    size: float
    gain: float
    log_bayes: float
    model: Model | None = None

    @property
    def log_odds(self) -> float:
        """Log of prior times Bayes factor."""
        return self.log_bayes + self.slip.log_prior

    def findings(self, probability: float = 1.0) -> list[Finding]:
        """What is said of it."""
        found = self.slip.findings(self.size, probability)
        if not (self.slip.seen and self.model):
            return found
        return [replace(one, value=self.slip.seen(self.model)) for one in found]


def each_once(judged: Iterable[Judged]) -> list[Judged]:
    """Each slip as it is likeliest, whatever it was judged beside; the likeliest first."""
    best: dict[tuple, Judged] = {}
    for one in sorted(judged, key=lambda j: -j.log_odds):
        # One without a size is another one at another bead, or with another number of them.
        which = None if one.slip.continuous else one.slip.value(0.0)
        best.setdefault((*one.slip.at, which), one)
    return list(best.values())


def excess(model: Model) -> float:
    """χ² of a nominal fit, its nuisances' included, above the number of data."""
    return model.fit.objective - data(model.forward)


def most_of(objective: float, size: float) -> float:
    """What a slip has to gain that explains a misfit: all but a share of what `size` data's noise is not."""
    return (1.0 - policy.LEFT) * (objective - size - scatter(size))


def obvious(judged: Judged, model: Model) -> bool:
    """Whether a slip takes away nearly all misfit by itself; of the values of a table, most of it."""
    if judged.slip.plain:
        return judged.gain > policy.SURE_VALUES
    if judged.slip.of_values:
        return judged.gain > max(policy.SURE_VALUES, policy.SHARE_VALUES * excess(model))
    return (
        judged.gain > policy.SURE_GAIN
        and judged.gain > policy.SHARE * excess(model)
        and not FAULTS[judged.slip.fault].alias
    )


def of_one_run(judged: Judged, model: Model) -> bool:
    """Whether a slip of one whole run, its time zero or speed, takes away nearly all misfit of traces."""
    slip, least = judged.slip, max(policy.LIKELY_GAIN, policy.SHARE * excess(model))
    alone = slip.run is not None and slip.sensor is None and slip.continuous and model.bench.record.signals
    return bool(alone) and judged.gain > least and not FAULTS[slip.fault].alias


def other_clock(judged: Judged, model: Model) -> bool:
    """Whether a slip makes all times so much longer or shorter as no effect does: where forces are known,
    even a modulus that did would betray itself by them.
    """
    slip, known = judged.slip, any(gauge.calibrated for gauge in model.forward.experiment.gauges)
    return slip.fault == "clock" and not slip.run and known and abs(judged.size) > policy.OTHER_CLOCK


def exchanged(judged: Judged, model: Model) -> bool:
    """Whether runs that look exchanged are struck, in the nominal fit, each at about the speed stated for the
    run whose striker it would have: whatever leads it so far from what is stated, for all, is no effect.
    """
    if judged.slip.fault != "runs-swapped" or judged.slip.of_values or judged.slip.sensor:
        return False
    record = model.bench.record
    stated, struck = (_speeds(one) for one in (record, judged.slip.change(record, 0.0)))
    places = [run.id for run in model.forward.experiment.runs]
    moved = [run for run in stated if struck[run] != stated[run]]
    for run in moved:
        way, place = struck[run] - stated[run], places.index(run)
        sigma = model.forward.nuisance_sigma[place]
        missed = abs(model.fit.nu[place] * sigma - way)
        if abs(way) <= policy.FAR_APART * sigma or missed > policy.EXCHANGED * abs(way):
            return False
    return bool(moved)


def _speeds(record):
    """Run → logarithm of its striker's stated speed."""
    return {run.id: math.log(run.striker.speed_m_s) for run in record.block.runs}


def without_slip(judged: Judged, model: Model) -> Model | None:
    """The model of the record as it is, fitted from where a slip led it, if it fits better for that alone.

    Far from the data a fit may end where pulses miss each other; any slip whose own fit does not would then
    seem to explain what it has nothing to do with.
    """
    one = model.fit
    found = fit(model.forward, one.hypothesis, one.u[None], judged.model.fit.nu[None])
    return replace(model, fit=found) if one.objective - found.objective > policy.LEAST_GAIN else None


def speaks_for(judged: Judged, model: Model) -> bool:
    """Whether data may speak for a size that other numbers of the record do: where the model strains its
    nuisances without it, or comes near the data with it, as far as a look can tell.
    """
    return strained(model) or excess(model) - judged.gain < policy.ROUGHLY_THERE * data(model.forward)


def out_of_reach(judged: Judged, model: Model) -> bool:
    """Whether a slip, looked at, leaves so much more misfit than there is that no fit would mend it."""
    return excess(model) - judged.gain > policy.REACH * max(excess(model), 1.0)


def of_the_chain(slip: Slip) -> bool:
    """Whether a slip has no size and moves all pulses at once: another number of beads."""
    return not slip.continuous and FAULTS[slip.fault].stretches


def both_off(worth: list[Judged]) -> set[str]:
    """Pairs of runs, as `runs-swapped` names them, that both look struck at another speed."""
    off = [j.slip.run for j in worth if j.slip.fault == "run-off"]
    return {f"{a} and {b}" for a in off for b in off if a != b}


def scatter(size: float) -> float:
    """χ² above so many data that is noise at most."""
    return policy.SUSPICIOUS * math.sqrt(2.0 * size)


def suspicious(model: Model) -> bool:
    """Whether a nominal fit leaves more than its noise, or strains its nuisances."""
    one, size = model.fit, data(model.forward)
    if tabled(model.forward.experiment) and scale_gain(one.objective / size, size) > policy.LEAST_GAIN:
        return True
    return float(one.normal.chi2.sum()) - size > scatter(size) or strained(model)


def strained(model: Model) -> bool:
    """Whether a nominal fit strains its nuisances by more than chance would."""
    nu = model.fit.nu
    return float(nu @ nu) > tails.chi_squared_at(1e-3, len(nu))


def tabled(experiment: Experiment) -> bool:
    """Whether all data are values, without traces."""
    return not any(run.has_signals for run in experiment.runs)


def scale_gain(square: float, count: int) -> float:
    """Δ(−2 log L) of so many values for the best factor on their errors, whose mean square is `square`."""
    return count * (square - 1.0 - math.log(max(square, 1e-12)))


def noise_volume(experiment: Experiment) -> float:
    """Σ log σ² of all samples that count, their correlation included; of values where there are no traces."""
    if tabled(experiment):
        return sum(2.0 * math.log(one.sigma) for run in experiment.runs for one in run.scalars)
    sigma2 = experiment.innovation
    counts = sum(
        np.full(len(sigma2), len(r.time)) if r.present is None else r.present.sum(axis=1)
        for r in experiment.runs
    )
    return float(np.sum(counts * np.log(sigma2))) if len(sigma2) else 0.0


def occam(slip: Slip, size: float, gain: float) -> float:
    """Log of the Occam factor: width of the posterior times the prior's density at the size."""
    if not slip.continuous:
        return slip.occam
    sigma = max(abs(size), 1e-12) / math.sqrt(max(gain, 1.0))
    away = (size - slip.expected) / slip.width
    density = 1.0 / (math.pi * slip.width * (1.0 + away**2))
    return min(0.0, math.log(max(math.sqrt(2.0 * math.pi) * sigma * density, 1e-12)))
