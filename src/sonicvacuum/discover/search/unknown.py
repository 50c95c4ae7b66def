"""The test of shapes: is anything left in the residual of a fitted model that it should not contain?

The residual is projected on groups of directions: the catalogue, a flexible contact law and drag, stiffness
and mass of each contact and bead, their smooth and alternating profiles along the chain, distortions of each
gauge, gain and delay of each gauge in each run, and time bins around the pulse. Each group gives a χ² of as
many degrees of freedom as it resolves, and its largest score, which tells one heavier bead among forty where
the χ² of all does not; the smallest p counts, times their number.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import tails
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.refit import Fit, polish
from sonicvacuum.discover.model import flexible
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import directions as ways
from sonicvacuum.discover.search import profiles, screen
from sonicvacuum.discover.search.directions import Direction, Family
from sonicvacuum.physics.beyond import Defect

# A misfit along the directions of a group, in words.
GROUPS = {
    "catalogue": "such as an effect of the catalogue makes",
    "law": "such as another contact law or a drag makes",
    "place": "such as a single bead or contact makes",
    "profile": "such as stiffness or mass that changes along the chain makes",
    "gauge": "such as a gauge that distorts its readings makes",
    "run": "such as the gain or delay of a gauge in one run makes",
    "time": "in a stretch of time about the pulse",
    "scalars": "in single values",
}
# Cosines between signatures that are resolved as different.
_RANK = 1e-3
_BINS = np.arange(-2.0, 9.0, 1.0)


@dataclass(frozen=True)
class ShapeTest:
    """What is left in a residual along each group of shapes.

    Attributes:
        groups: group → (χ², degrees of freedom, p).
        p: of the whole, after the number of groups.
        group: the group of the smallest p.
        screen: all directions.
    """

    groups: dict[str, tuple[float, int, float]]
    p: float
    group: str
    screen: screen.Screen

    @property
    def failed(self) -> bool:
        """Whether a real misfit is left."""
        return self.p < policy.SHAPE_MISFIT

    @property
    def misfit(self) -> str:
        """What is left along the group of the smallest p, in words."""
        return in_words(self.group)

    @property
    def failing(self) -> np.ndarray:
        """(K',) places in the screen of the directions of all groups that are surely not empty."""
        sure = [g for g, (_, _, p) in self.groups.items() if p * len(self.groups) < policy.SHAPE_MISFIT]
        return np.flatnonzero([d.effect in sure for d in self.screen.directions])


def in_words(group: str) -> str:
    """A misfit along the directions of a group."""
    return f"a misfit {GROUPS[group]}"


def shape_test(forward: Forward, fit: Fit, catalogue: screen.Screen | None = None) -> ShapeTest:
    """Test what a fitted model leaves; `catalogue` is its screen, where at hand.

    Rough slopes will do: along whichever direction a residual is asked, noise leaves the same there.
    """
    shapes = list(distortions(forward, fit)) if _traced(forward) else []
    scalars = scalar_directions(forward)
    shapes += [scalars] if scalars else []
    whole = _screened(forward, fit, families(forward), shapes, rough=True)
    groups = _groups(whole)
    if catalogue is not None and len(catalogue.z):
        groups["catalogue"] = _largest(catalogue)
    worst = min(groups, key=lambda g: groups[g][2])
    return ShapeTest(groups, min(1.0, groups[worst][2] * len(groups)), worst, whole)


def simplest(forward: Forward, null: Fit) -> tuple[str, float]:
    """The one profile along the chain, or distortion of one gauge, that should gain most, and its Δχ².

    An explanation out of the catalogue that gains less than one such shape is not the simplest. Both are
    tried at finite strength, as slopes may promise too much.
    """
    if not forward.experiment.beads or not _traced(forward):
        return "", 0.0
    shapes = [s for s in distortions(forward, null) if s[0][0].effect == "gauge"]
    seen = _screened(forward, null, [profiles.family()], shapes)
    at = [k for k, d in enumerate(seen.directions) if d.effect == "gauge"]
    best = max(at, key=lambda k: seen.z[k] ** 2)
    shape = seen.directions[best]
    profile = max(_tried(forward, null, seen, share) for share in (0.4, 0.7, 1.0))
    if profile[0] > seen.z[best] ** 2:
        return f"a {profile[1]} profile along the chain", profile[0]
    gain = _distorted(forward, null, seen, best)
    if profile[0] > gain:
        return f"a {profile[1]} profile along the chain", profile[0]
    return f"{shape.strength} of gauge {forward.experiment.gauges[shape.place or 0].id}", gain


def _distorted(forward, null, seen: screen.Screen, k) -> float:
    """Δχ² of a distortion of one gauge at its estimate, nuisances fitted: they may have to go far."""
    e, d = forward.experiment, seen.directions[k]
    readings = raw(forward, null)
    peaks = [np.abs(r).max(axis=1, initial=0.0) for r in readings]
    largest = np.maximum(np.max(peaks, axis=0), 1e-300)[:, None]
    runs = []
    for run, predicted in zip(e.runs, readings, strict=True):
        added = np.zeros_like(predicted)
        added[d.place] = (seen.strength[k] * _DISTORTIONS[d.strength](predicted / largest) * largest)[d.place]
        runs.append(replace(run, readings=run.readings - added) if run.has_signals else run)
    changed = forward.of(replace(e, runs=tuple(runs)))
    start = linearise(changed, null.hypothesis, null.u[None], seen.moved(k)[1][None])
    found = polish(changed, Fit(null.hypothesis, start))
    forward.simulations += changed.simulations
    return min(float(seen.z[k] ** 2), null.objective - found.objective)


def _tried(forward, null, seen: screen.Screen, share) -> tuple[float, str]:
    """Δχ² of the best profile, taken `share` of its estimate far, and its name."""
    family = profiles.family()
    strengths = share * seen.strength[: len(family.directions)]
    columns = ways.finite(forward, null.hypothesis, null.u, null.nu, family, strengths)
    base = forward.columns(null.hypothesis, null.u[None], null.nu[None], precise=True)
    there = screen.from_columns(forward, null, family.directions, base, columns)
    gain = 2.0 * there.projected[0] - np.diag(there.projected[1])
    k = int(np.argmax(gain))
    return float(gain[k]), family.directions[k].strength


def _traced(forward):
    return any(r.has_signals for r in forward.experiment.runs)


def _screened(forward, fit, simulated, shapes, rough=False) -> screen.Screen:
    """The screen of families that are simulated and of (directions, columns of each run)."""
    base = forward.columns(fit.hypothesis, fit.u[None], fit.nu[None], precise=True)
    at = fit.hypothesis, fit.u, fit.nu
    parts = [(family.directions, ways.simulate(forward, *at, family, rough)[0]) for family in simulated]
    parts += shapes
    directions = tuple(d for part in parts for d in part[0])
    slopes = [np.concatenate([part[1][run] for part in parts]) for run in range(len(base))]
    return screen.from_columns(forward, fit, directions, base, slopes)


def _groups(whole):
    names = [d.effect for d in whole.directions]
    result = {}
    for name in dict.fromkeys(names):
        at = np.flatnonzero([n == name for n in names])
        result[name] = test(whole, at)
    return result


def test(whole: screen.Screen, at: np.ndarray) -> tuple[float, int, float]:
    """χ² of the residual's part along some directions, its degrees of freedom, and p: of that, or of the
    largest score among them (Bonferroni: times their number), whichever is less likely, times two.
    """
    at = at[whole.length[at] > 1e-3 * np.sqrt(np.einsum("kk->k", whole.products.sum(axis=0)))[at]]
    if not len(at):
        return 0.0, 0, 1.0
    values, vectors = np.linalg.eigh(whole.correlation[np.ix_(at, at)])
    kept = values > _RANK
    scores = whole.projected[0][at] / whole.length[at]
    parts = (vectors[:, kept].T @ scores) / np.sqrt(values[kept])
    chi2, freedom = float(parts @ parts), int(kept.sum())
    spread = tails.chi_squared(chi2, float(freedom))
    if freedom == 1:
        return chi2, freedom, spread
    alone = len(at) * tails.chi_squared(float(np.square(scores).max()), 1)
    return chi2, freedom, min(1.0, 2.0 * min(spread, alone))


def _largest(catalogue):
    """The same for the largest single score of the catalogue, its p from simulated noise."""
    reference = catalogue.threshold(0.01)
    trials = 0.01 / tails.chi_squared(reference, 1)
    largest = float(np.square(catalogue.z).max())
    return largest, 1, min(1.0, trials * tails.chi_squared(largest, 1))


def families(forward: Forward) -> list[Family]:
    """The flexible law; stiffness of each contact and mass of each bead, one by one and as profiles."""
    found = [_law()]
    return (
        [*found, _places(forward.experiment.beads), profiles.family()] if forward.experiment.beads else found
    )


def _law():
    directions = [Direction("law", f"a{k}", two_sided=True) for k in range(flexible.CONTACT + flexible.DRAG)]

    def change(setup, index, strengths):
        contact, drag = flexible.changes(index, strengths)
        return flexible.add(setup, contact, drag)

    return Family(tuple(directions), change, 0.15)


def _places(beads):
    places = [Direction("place", "stiffness", place=c, two_sided=True) for c in range(beads + 1)]
    places += [Direction("place", "mass", place=b, two_sided=True) for b in range(1, beads + 1)]

    def change(setup, index, strengths):
        here = [np.where(index == k, 1.0 + strengths, 1.0) for k in range(len(places))]
        changed = [
            Defect(d.strength, d.place, ratio)
            for d, ratio in zip(places, here, strict=True)
            if np.any(ratio != 1.0)
        ]
        return profiles.with_defects(setup, changed)

    return Family(tuple(places), change, 1.2)


def distortions(forward: Forward, fit: Fit):
    """Pairs (directions, whitened columns of each run) of what gauges may do to a signal."""
    e = forward.experiment
    readings = raw(forward, fit)
    peaks = np.array([np.abs(r).max(axis=1, initial=0.0) for r in readings])
    largest = np.maximum(peaks.max(axis=0), 1e-300)
    for name, function in _DISTORTIONS.items():
        shapes = [function(r / largest[:, None]) * largest[:, None] for r in readings]
        yield _by_gauge("gauge", name, e, shapes)
    for name, function in {"gain": lambda y: y, "delay": _slope}.items():
        for run in range(len(readings)):
            if readings[run].shape[1]:
                shapes = [function(r) if k == run else np.zeros_like(r) for k, r in enumerate(readings)]
                yield _by_gauge("run", f"{name} {e.runs[run].id}", e, shapes)
    for low, high in pairwise(_BINS):
        shapes = [_bin(r, low, high) for r in readings]
        yield _by_gauge("time", f"{low:g} to {high:g} widths", e, shapes)


def _slope(y):
    return np.gradient(y, axis=1) if y.shape[1] > 1 else y


def _integral(y):
    return np.cumsum(y, axis=1) / max(1, y.shape[1])


_DISTORTIONS = {
    "quadratic": lambda y: y * np.abs(y),
    "cubic": lambda y: y**3,
    "delay": _slope,
    "bandwidth": lambda y: _slope(_slope(y)),
    "leak": _integral,
}


def _bin(y, low, high):
    """Ones, times the peak, in a window of pulse widths around each gauge's peak."""
    result = np.zeros_like(y)
    for s, trace in enumerate(y):
        if not len(trace) or not trace.max() > 0.0:
            continue
        peak = int(trace.argmax())
        width = max(2, int(np.count_nonzero(trace > 0.5 * trace[peak])))
        first, last = (int(np.clip(peak + width * (b - 0.5), 0, len(trace))) for b in (low, high))
        result[s, first:last] = trace[peak]
    return result


def _by_gauge(group, name, e, shapes):
    """One direction for each gauge, and its whitened columns."""
    count = len(e.gauges)
    directions = [Direction(group, name, place=s, two_sided=True) for s in range(count)]
    columns = []
    for run, shape in enumerate(shapes):
        alone = np.einsum("st,gs->gst", shape, np.eye(count))
        columns.append(e.whiten(run, alone, np.zeros((count, len(e.runs[run].scalars)))))
    return directions, e.divided(columns)


def scalar_directions(forward: Forward):
    """Every scalar as a direction of its own."""
    e = forward.experiment
    total = sum(len(r.scalars) for r in e.runs)
    if not total:
        return None
    columns, first = [], 0
    for run, data in enumerate(e.runs):
        part = np.zeros((total, e.length(run)))
        for k in range(len(data.scalars)):
            part[first + k, e.length(run) - len(data.scalars) + k] = 1.0
        first += len(data.scalars)
        columns.append(part)
    names = [(run, k) for run, data in enumerate(e.runs) for k in range(len(data.scalars))]
    return [Direction("scalars", "value", (("run", r), ("k", k)), two_sided=True) for r, k in names], columns


def raw(forward: Forward, fit: Fit) -> list[np.ndarray]:
    """For each run the predicted readings (S, T) at the recorded times."""
    e = forward.experiment
    whole = tuple(replace(run, present=None) for run in e.runs)
    plain = replace(e.uncoloured, runs=whole, smooth=None)
    white = forward.of(plain)
    found = white.sampled(fit.hypothesis, fit.u[None], fit.nu[None])
    forward.simulations += white.simulations
    return [
        value[0, : len(e.gauges) * len(run.time)].reshape(len(e.gauges), len(run.time)) * e.sigma[:, None]
        for value, run in zip(found, e.runs, strict=True)
    ]


def irreplaceable(shapes: ShapeTest, fit: Fit, needed: float) -> list[int]:
    """Effects of a fit that are still seen when the shapes that fail their test may take what they like.

    Where a shape outside the catalogue is left beside an effect, the effect may be no more than what comes
    nearest to it. In the linearised model with those shapes free, its strength has to stand off from zero by
    as much as an effect needs to be named.
    """
    scores, free = shapes.screen, fit.normal.free
    at = shapes.failing
    gradient, hessian = (part[0] for part in scores.normal.total())
    cross, products = scores.cross.sum(axis=0)[:, at], scores.products.sum(axis=0)[np.ix_(at, at)]
    length = np.sqrt(np.maximum(np.diag(products), 1e-300))
    cross, products = cross / length, products / np.outer(length, length)
    whole = np.block([[hessian, cross], [cross.T, products]])
    whole += 1e-9 * np.diag(np.maximum(np.diag(whole), 1e-9))
    right = np.concatenate([gradient, scores.score.sum(axis=0)[at] / length])
    covariance = np.linalg.pinv(whole, rcond=1e-11, hermitian=True)
    step, error = (covariance @ right)[:free], np.sqrt(np.maximum(np.diag(covariance)[:free], 1e-300))
    strengths = fit.hypothesis.strengths(fit.u, error, step)
    return [k for k, strength in enumerate(strengths) if strength**2 > needed]
