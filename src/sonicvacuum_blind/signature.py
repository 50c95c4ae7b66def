"""Signal-to-noise ratio d′ of what is hidden, once the record's own errors have taken what they can explain.

Predictions of a design form one vector (all traces, then all scalars), whitened by the noise. Errors of
striker speed (one for each run), trigger (one for each run), gains (one for each gauge) and modulus are
directions with the standard deviations that the record states. With prior covariance Λ of those directions N,
the ratio that an ideal test reaches is d′² = sᵀ (I + N Λ Nᵀ)⁻¹ s; with unlimited errors (`flat`) the
directions are projected out. A per cent of modulus may move traces by a hundred standard deviations, so that
the errors are refitted through the integrator (`Frame.signature`), not only along straight lines.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from sonicvacuum_blind.design import Design
from sonicvacuum_blind.prediction import (
    TOLERANCE,
    Change,
    Errors,
    Prediction,
    Whitener,
    nothing,
    predict,
    read_again,
)

STEP = 2e-3  # relative, of speed and modulus differences
# A change larger than this fraction of all data may have moved pulses by their own length; the errors are
# then fitted from the best of these moduli, in standard deviations.
FAR = 0.15
MODULI = (-14.0, -10.0, -7.0, -4.5, -3.0, -1.5, 0.0, 1.5, 3.0, 4.5, 7.0, 10.0, 14.0)
# A fit ends where a step promises less than this share of d′, or the shortest of halved steps fails.
GAIN, SMALLEST = 2e-3, 0.05


def nuisances(
    design: Design,
    whiten: Whitener,
    at: Errors | None = None,
    central: bool = True,
    base: Prediction | None = None,
) -> np.ndarray:
    """(data, errors) whitened change for one standard deviation of each error, in the order of
    `Errors.vector`.

    Forward instead of central differences (`central` False) suffice on the way to a minimum; `base` is the
    prediction there where it is known.
    """
    at = at or Errors.of(design)
    base = base or predict(design, nothing, at)
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
        columns.append(whiten.vector(read_again(design, louder)) - whole)
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
class Fit:
    """Errors fitted to a change.

    Attributes:
        seen: (data + errors,) what is left and the errors, in units of standard deviations.
        slopes: (data, errors) as last known.
        exact: whether these were taken where the errors are.
    """

    seen: np.ndarray
    slopes: np.ndarray
    exact: bool

    @property
    def size(self) -> float:
        """The norm, d′."""
        return float(_norm(self.seen))

    @property
    def vector(self) -> np.ndarray:
        """(errors,) fitted."""
        return self.seen[len(self.slopes) :]

    @property
    def rest(self) -> np.ndarray:
        """(data,) what is left."""
        return self.seen[: len(self.slopes)]

    def step(self) -> np.ndarray:
        """(errors,) to the minimum if data were linear in the errors, whose prior holds them near zero."""
        slopes = self.slopes
        normal = slopes.T @ slopes + np.eye(slopes.shape[1])
        return np.linalg.solve(normal, slopes.T @ (self.rest + slopes @ self.vector)) - self.vector

    def promised(self, vector: np.ndarray) -> float:
        """d′ with other errors, if data were linear in them."""
        return float(np.hypot(_norm(self.rest - self.slopes @ (vector - self.vector)), _norm(vector)))

    def moved(self, seen: np.ndarray) -> "Fit":
        """The fit after a step, its slopes corrected by what they missed of it (Broyden, Math. Comput. 19,
        577, 1965).
        """
        step = seen[len(self.slopes) :] - self.vector
        missed = self.rest - seen[: len(self.slopes)] - self.slopes @ step
        return Fit(seen, self.slopes + np.outer(missed, step / (step @ step)), False)


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
        base = predict(design)
        slopes = nuisances(design, whiten, base=base)
        return cls(design, whiten, whiten.vector(base), slopes, solver(slopes))

    def nominal(self, vector: np.ndarray) -> np.ndarray:
        """(data,) whitened prediction with errors alone."""
        return self.whiten.vector(predict(self.design, nothing, Errors.of(self.design, vector)))

    def slopes_at(self, vector: np.ndarray) -> np.ndarray:
        """(data, errors) change for one standard deviation of each error, with errors already there."""
        return nuisances(self.design, self.whiten, Errors.of(self.design, vector), False)

    @cached_property
    def moduli(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """(errors, prediction) for each of `MODULI`."""
        vectors = np.zeros((len(MODULI), self.slopes.shape[1]))
        vectors[:, len(self.design.runs)] = MODULI
        return [(v, self.nominal(v)) for v in map(self.bounded, vectors)]

    @cached_property
    def but_modulus(self) -> tuple[np.ndarray, np.ndarray]:
        """`slopes` and `solve` of all errors but the modulus."""
        slopes = np.delete(self.slopes, len(self.design.runs), axis=1)
        return slopes, solver(slopes)

    def change(self, change: Change, tolerance: float = TOLERANCE) -> np.ndarray:
        """(data,) whitened difference that a change makes."""
        return self.whiten.vector(predict(self.design, change, tolerance=tolerance)) - self.base

    def seen(self, difference: np.ndarray) -> np.ndarray:
        """(data + errors,) what is left of a small difference, errors acting linearly."""
        errors = self.solve @ difference
        return np.concatenate([difference - self.slopes @ errors, errors])

    def signature(self, change: Change) -> np.ndarray:
        """(data + errors,) what is left of a change of any size, the errors refitted through the
        integrator.
        """
        return self.fit(change).seen

    def fit(self, change: Change, rounds: int = 40, near: np.ndarray | None = None) -> Fit:
        """Errors refitted to a change, through the integrator.

        Gauss and Newton's iteration, until a step promises to change d′ by less than `GAIN`. Slopes follow
        from the steps themselves; they are taken afresh before the end and wherever a step makes d′ grow, and
        steps are halved if that does not help.

        Args:
            change: of the model.
            rounds: at most.
            near: (errors,) that may be a good start.
        """
        shown = self.whiten.vector(predict(self.design, change))
        now, share = self._start(shown, near), 1.0
        for _ in range(rounds):
            vector = self.bounded(now.vector + share * now.step())
            if now.size - now.promised(vector) < GAIN * now.size or share < SMALLEST:
                if now.exact:
                    break
                now = Fit(now.seen, self.slopes_at(now.vector), True)
                continue
            seen = np.concatenate([shown - self.nominal(vector), vector])
            if _norm(seen) < now.size:
                now, share = now.moved(seen), 1.0
            elif now.exact:
                share *= 0.5
            else:
                now = Fit(now.seen, self.slopes_at(now.vector), True)
        return now

    def _start(self, shown, near):
        """Errors and slopes: at the nominal model, near another fit, or the best of some moduli if pulses
        are off in all of these.
        """
        none = np.zeros(self.slopes.shape[1])
        fits = [(none, self.base)]
        if near is not None:
            fits.append((near, self.nominal(near)))
        if min(_norm(shown - data) for _, data in fits) > FAR * _norm(self.base):
            fits += self.moduli
        seen = [np.concatenate([shown - data, vector]) for vector, data in fits]
        k = int(np.argmin([_norm(s) for s in seen]))
        if k == 0:
            return Fit(seen[0], self.slopes, True)
        return Fit(seen[k], self.slopes_at(fits[k][0]), True)

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
        return float(_norm(rest - self.slopes[:, used] @ np.linalg.lstsq(self.slopes[:, used], rest)[0]))


def _norm(x):
    return float(np.sqrt(x @ x))


def solver(slopes: np.ndarray) -> np.ndarray:
    """(errors, data) least squares with a standard normal prior on the errors."""
    return np.linalg.solve(slopes.T @ slopes + np.eye(slopes.shape[1]), slopes.T)
