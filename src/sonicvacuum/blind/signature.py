"""Signal-to-noise ratio d′ of what is hidden, once the record's own errors have taken what they can explain.

Predictions of a design form one vector (all traces, then all scalars), whitened by the noise. Errors of
striker speed (one for each run), trigger (one for each run), gains (one for each gauge) and modulus are
directions with the standard deviations that the record states. With prior covariance Λ of those directions N,
the ratio that an ideal test reaches is d′² = sᵀ (I + N Λ Nᵀ)⁻¹ s; with unlimited errors (`flat`) the
directions are projected out. A per cent of modulus may move traces by a hundred standard deviations, so that
the errors are refitted through the integrator (`Frame.signature`), not only along straight lines.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.blind.design import Design
from sonicvacuum.blind.gauges import bounce, read, scalar
from sonicvacuum.blind.plan import Plan

# Of the integrator, for signatures: 1e-5 of a peak, against changes of the order of 1e-2.
TOLERANCE = 1e-7
STEP = 2e-3  # relative, of speed and modulus differences
# A change larger than this fraction of all data may have moved pulses by their own length; the errors are
# then fitted from the best of these moduli, in standard deviations.
FAR = 0.15
MODULI = (-14.0, -10.0, -7.0, -4.5, -3.0, -1.5, 0.0, 1.5, 3.0, 4.5, 7.0, 10.0, 14.0)

Change = Callable[[Plan], Plan]


def nothing(plan: Plan) -> Plan:
    """The nominal plan."""
    return plan


@dataclass(frozen=True)
class Errors:
    """What is off within a record's stated errors, in units of these.

    Attributes:
        speeds, triggers: (runs,).
        gains: (gauges,).
        modulus: a number.
    """

    speeds: np.ndarray
    modulus: float
    gains: np.ndarray
    triggers: np.ndarray

    @classmethod
    def of(cls, design: Design, vector=None) -> "Errors":
        """Errors from one vector (speeds, modulus, gains, triggers); none without it."""
        runs, gauges = len(design.runs), len(design.reference.gauges)
        vector = np.zeros(2 * runs + gauges + 1) if vector is None else np.asarray(vector)
        return cls(
            vector[:runs],
            float(vector[runs]),
            vector[runs + 1 : runs + 1 + gauges],
            vector[runs + 1 + gauges :],
        )

    @property
    def vector(self) -> np.ndarray:
        """All in one."""
        return np.concatenate([self.speeds, [self.modulus], self.gains, self.triggers])


@dataclass(frozen=True)
class Prediction:
    """What a design's gauges show without noise.

    Attributes:
        traces: (runs, gauges, samples) N, also where the record holds scalars only.
        scalars: (scalars,) SI units.
    """

    traces: np.ndarray
    scalars: np.ndarray


def predict(
    design: Design,
    change: Change = nothing,
    errors: Errors | None = None,
    tolerance: float = TOLERANCE,
) -> Prediction:
    """Noise-free readings of all runs, with errors, each plan passed through `change`."""
    errors = errors or Errors.of(design)
    stiffness = 1.0 + design.modulus_sigma * errors.modulus
    plans = [
        change(replace(p, speed=p.speed * (1.0 + design.speed_sigma * e), modulus_ratio=stiffness))
        for p, e in zip(design.runs, errors.speeds, strict=True)
    ]
    if design.kind == "ball":
        found = [bounce(p, tolerance) for p in plans]
        values = np.array([found[s.run][s.quantity] for s in design.scalars])
        return Prediction(np.zeros((len(plans), 0, 0)), values)
    shifts = design.trigger_sigma * errors.triggers
    traces = np.stack([read(p, design.times(t), tolerance) for p, t in zip(plans, shifts, strict=True)])
    traces *= 1.0 + design.gain_sigma * errors.gains[:, None]
    return _read_again(design, traces)


def _read_again(design, traces):
    """A prediction from traces, its scalars read off them."""
    values = [
        scalar(design.runs[s.run], traces[s.run], design.times(), s.quantity, s.options)
        for s in design.scalars
    ]
    return Prediction(traces, np.array(values))


@dataclass(frozen=True)
class Whitener:
    """Divides by the noise; `correlation` is that of neighbouring samples (AR(1)), of variance sigma²."""

    design: Design
    correlation: float = 0.0

    def vector(self, prediction: Prediction) -> np.ndarray:
        """One vector in units of standard deviations."""
        scalars = prediction.scalars / np.array([s.sigma for s in self.design.scalars], dtype=float)
        if not self.design.samples:
            return scalars
        scaled = prediction.traces / np.array(self.design.sigma)[None, :, None]
        if self.correlation:
            fresh = (scaled[..., 1:] - self.correlation * scaled[..., :-1]) / np.sqrt(
                1.0 - self.correlation**2
            )
            scaled = np.concatenate([scaled[..., :1], fresh], axis=-1)
        return np.concatenate([scaled.ravel(), scalars])


def nuisances(design: Design, whiten: Whitener, at: Errors | None = None, central: bool = True) -> np.ndarray:
    """(data, errors) whitened change for one standard deviation of each error, in the order of
    `Errors.vector`.

    Forward instead of central differences (`central` False) suffice on the way to a minimum.
    """
    at = at or Errors.of(design)
    base = predict(design, nothing, at)
    whole = whiten.vector(base)
    behind = None if central else whole
    runs, gauges = len(design.runs), len(design.reference.gauges)
    every = _slope(design, whiten, at, slice(0, runs), STEP / design.speed_sigma, behind)
    columns = [np.where(_of_run(design, run), every, 0.0) for run in range(runs)]
    columns.append(_slope(design, whiten, at, runs, STEP / max(design.modulus_sigma, STEP), behind))
    if design.kind == "ball":
        return np.stack([*columns, *np.zeros((runs, len(every)))], axis=1)
    for k in range(gauges):
        louder = base.traces.copy()
        louder[:, k] *= 1.0 + design.gain_sigma / (1.0 + design.gain_sigma * at.gains[k])
        columns.append(whiten.vector(_read_again(design, louder)) - whole)
    return np.stack([*columns, *_triggers(design, whiten, base)], axis=1)


def _slope(design, whiten, at, places, step, behind):
    """Difference for errors `places` moved together by `step` standard deviations, from `behind` if given."""

    def moved(size):
        vector = at.vector
        vector[places] += size
        return whiten.vector(predict(design, nothing, Errors.of(design, vector)))

    return (moved(step) - moved(-step)) / (2.0 * step) if behind is None else (moved(step) - behind) / step


def _of_run(design, run):
    """(data,) whether each entry of the vector belongs to a run."""
    scalars = np.array([s.run == run for s in design.scalars], dtype=bool)
    if not design.samples:
        return scalars
    traces = np.zeros((len(design.runs), len(design.sigma), design.samples), dtype=bool)
    traces[run] = True
    return np.concatenate([traces.ravel(), scalars])


def _triggers(design, whiten, base):
    """A trigger shifts all traces of a run; scalars do not know it."""
    slopes = -np.gradient(base.traces, design.interval, axis=2) * design.trigger_sigma
    for run in range(len(design.runs)):
        only = np.zeros_like(slopes)
        only[run] = slopes[run]
        yield whiten.vector(Prediction(only, np.zeros(len(design.scalars))))


@dataclass(frozen=True)
class Frame:
    """A design with its noise and its errors: maps changes of the model to what an ideal test can see.

    What is seen is a vector (residual, errors fitted) in units of standard deviations: its norm is d′.

    Attributes:
        design: the record.
        whiten: by its noise.
        base: (data,) whitened nominal prediction.
        slopes: (data, errors) of it.
        solve: (errors, data) maps a whitened difference to the errors that explain it best.
    """

    design: Design
    whiten: Whitener
    base: np.ndarray
    slopes: np.ndarray
    solve: np.ndarray

    @classmethod
    def of(cls, design: Design, correlation: float = 0.0) -> "Frame":
        """The frame of a design."""
        whiten = Whitener(design, correlation)
        slopes = nuisances(design, whiten)
        return cls(design, whiten, whiten.vector(predict(design)), slopes, _solver(slopes))

    def change(self, change: Change, tolerance: float = TOLERANCE) -> np.ndarray:
        """(data,) whitened difference that a change makes."""
        return self.whiten.vector(predict(self.design, change, tolerance=tolerance)) - self.base

    def seen(self, difference: np.ndarray) -> np.ndarray:
        """(data + errors,) what is left of a small difference, errors acting linearly."""
        errors = self.solve @ difference
        return np.concatenate([difference - self.slopes @ errors, errors])

    def signature(self, change: Change, rounds: int = 25) -> np.ndarray:
        """(data + errors,) what is left of a change of any size, the errors refitted through the integrator.

        Gauss and Newton's iteration, halving steps that make d′ grow; it stops once d′ changes by less than
        0.3 %.
        """
        shown = self.whiten.vector(predict(self.design, change))
        vector, step = self._start(shown)
        moved = self.whiten.vector(predict(self.design, nothing, Errors.of(self.design, vector)))
        best, slopes = np.concatenate([shown - moved, vector]), self.slopes
        halved = False
        for _ in range(rounds):
            tried = self.bounded(vector + step)
            rest = shown - self.whiten.vector(predict(self.design, nothing, Errors.of(self.design, tried)))
            now, last = np.concatenate([rest, tried]), np.linalg.norm(best)
            size = np.linalg.norm(now)
            if size > last:
                step, halved = 0.5 * step, True
                if np.max(np.abs(step)) < 1e-2:
                    break
                continue
            best, vector = now, tried
            if last - size < 3e-3 * size and not halved:
                break
            halved = False
            slopes = nuisances(self.design, self.whiten, Errors.of(self.design, vector), False)
            # The errors' prior pulls them back to zero.
            step = _solver(slopes) @ (rest + slopes @ vector) - vector
        return best

    def _start(self, shown):
        """Errors and first step: at the nominal model, or at the best of some moduli if pulses are off."""
        vector = np.zeros(self.slopes.shape[1])
        if np.linalg.norm(shown - self.base) < FAR * np.linalg.norm(self.base):
            return vector, self.solve @ (shown - self.base)
        runs, found = len(self.design.runs), []
        for modulus in MODULI:
            vector[runs] = modulus
            tried = self.bounded(vector)
            errors = Errors.of(self.design, tried)
            rest = shown - self.whiten.vector(predict(self.design, nothing, errors))
            found.append((np.hypot(np.linalg.norm(rest), modulus), modulus, tried, errors, rest))
        _, _, vector, errors, rest = min(found, key=lambda f: f[:2])
        slopes = nuisances(self.design, self.whiten, errors, False)
        return vector, _solver(slopes) @ (rest + slopes @ vector) - vector

    def bounded(self, vector: np.ndarray) -> np.ndarray:
        """Errors that leave speeds and modulus between a third and three times the stated ones."""
        errors = Errors.of(self.design, vector)
        speed, modulus = self.design.speed_sigma, max(self.design.modulus_sigma, 1e-12)
        speeds = np.clip(errors.speeds, -0.67 / speed, 2.0 / speed)
        stiff = float(np.clip(errors.modulus, -0.67 / modulus, 2.0 / modulus))
        return replace(errors, speeds=speeds, modulus=stiff).vector

    def flat(self, seen: np.ndarray) -> float:
        """d′ that would be left if the record's errors had no stated limits."""
        rest = seen[: len(self.base)]
        used = np.linalg.norm(self.slopes, axis=0) > 0.0
        return float(
            np.linalg.norm(rest - self.slopes[:, used] @ np.linalg.lstsq(self.slopes[:, used], rest)[0])
        )


def _solver(slopes):
    """(errors, data) least squares with a standard normal prior on the errors."""
    return np.linalg.solve(slopes.T @ slopes + np.eye(slopes.shape[1]), slopes.T)
