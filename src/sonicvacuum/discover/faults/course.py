"""The smooth course of a table's quantities over the runs' speeds, and the few values that leave it."""

import itertools
import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.foremost import Place

# A course is told by so many values at least, without those that leave it; several leave it only where they
# are no more than one in so many.
FEWEST, ONE_IN = 3, 3
# Values of a long course that are tried together: those without which, one at a time, least is left.
TRIED = 20
# χ² that two values by themselves leave less than they do in each other's place, and still are these.
EXCHANGED = 30.0
# From this relative error on a value says nothing: it was taken for off before.
NOTHING = 1.0


@dataclass(frozen=True)
class Standing:
    """What leaves the courses of a table.

    Attributes:
        values: places of values that are off, each by itself.
        exchanged: pairs of places, each of which has the value of the other.
    """

    values: frozenset[Place] = frozenset()
    exchanged: tuple[tuple[Place, Place], ...] = ()


@dataclass(frozen=True)
class _Course:
    """One quantity over the runs.

    Attributes:
        places: (run, place in it) of each of its n values.
        measured, expected: (n,) logarithms.
        speed: (n,) logarithms of the striker's speed in m/s.
        error: (n,) standard errors of measured over expected.
    """

    places: tuple[Place, ...]
    measured: np.ndarray
    expected: np.ndarray
    speed: np.ndarray
    error: np.ndarray

    def most(self) -> int:
        """How many of its values may be off."""
        n = len(self.places)
        return min(max(n // ONE_IN, 1), n - FEWEST, policy.MOST)

    def left(self, sets: np.ndarray) -> np.ndarray:
        """(m,) χ² along a straight line without each of m sets of k values, (m, k) places among them."""
        weight = self.error**-2.0
        x, y = self.speed - self.speed.mean(), self.measured - self.expected
        y = y - np.average(y, weights=weight)
        sums = np.array([weight, weight * x, weight * x * x, weight * y, weight * x * y, weight * y * y])
        one, sx, sxx, sy, sxy, syy = sums.sum(axis=1)[:, None] - sums[:, sets].sum(axis=2)
        spread = np.maximum(one * sxx - sx**2, 1e-12 * one * sums[2].sum())
        along = (one * sxy - sx * sy) ** 2 / (one * spread)
        return np.maximum(syy - sy**2 / one - along, 0.0)

    def without(self, count: int) -> tuple[float, tuple[int, ...]]:
        """The least χ² without so many of its values, and which these are."""
        asked = np.arange(len(self.places))
        if count > 1:
            asked = np.sort(np.argsort(self.left(asked[:, None]), kind="stable")[:TRIED])
        sets = list(itertools.combinations(asked.tolist(), count))
        left = self.left(np.array(sets, dtype=int).reshape(len(sets), count))
        return float(left.min()), sets[left.argmin()]

    def but(self, own: tuple[int, ...]) -> float:
        """χ² along a straight line without some of its values."""
        return float(self.left(np.array(own, dtype=int)[None])[0])

    def freedom(self, own: tuple[int, ...]) -> int:
        """Degrees of freedom that noise has along the line without some of its values."""
        return len(self.places) - len(own) - 2

    def exchanged(self, a: int, b: int) -> "_Course":
        """The course with two of its values in each other's place."""
        order = np.arange(len(self.places))
        order[[a, b]] = b, a
        return replace(self, measured=self.measured[order], error=self.error[order])


def standing_out(runs, start, model) -> Standing:
    """The values that by themselves leave the course of their own quantity over the runs' speeds, as few as
    explain it: three at most, of several no two of one run, whose speed may be another one.

    Whatever effect acts, logarithms of measured over expected values lie along a line, roughly: without these
    values they do, in all quantities.
    """
    courses = [c for c in _courses(runs, start, model) if len(c.places) > FEWEST]
    best = [[c.without(count) for count in range(c.most() + 1)] for c in courses]
    for count in range(1, policy.MOST + 1):
        chosen = _least(best, count)
        if chosen is not None and _plain(courses, chosen):
            return _told(courses, chosen)
    return Standing()


def _courses(runs, start, model) -> Iterable[_Course]:
    experiment, series = model.forward.experiment, defaultdict(list)
    for k, (_, rows) in enumerate(runs):
        speed = math.log(experiment.record.runs[k].striker.speed_m_s)
        speed_error = experiment.runs[k].speed_rel_sigma
        for j, one in rows:
            expected = float(start[k][0, 0, j]) * experiment.runs[k].scalars[j].sigma
            if not (expected > 0.0 and one.value > 0.0):
                continue
            own = one.sigma / max(one.value, expected)
            if own < NOTHING:
                error = math.hypot(own, policy.SPEED_POWER * speed_error)
                row = math.log(one.value), math.log(expected), speed, error
                series[one.in_words].append(((k, j), *row))
    for own in series.values():
        places, *columns = zip(*own, strict=True)
        yield _Course(places, *(np.array(c) for c in columns))


def _least(best, count) -> list[tuple[int, ...]] | None:
    """Which values of each course to leave out, so many in all, that least is left; None where there are
    fewer that may be.

    Args:
        best: for each course what is left without 0, 1, ... of its values, and without which.
        count: how many in all.
    """
    least: dict[int, tuple[float, list]] = {0: (0.0, [])}
    for own in best:
        grown: dict[int, tuple[float, list]] = {}
        for before, (left, chosen) in least.items():
            for n, (more, which) in enumerate(own):
                total = before + n
                if total <= count and (total not in grown or left + more < grown[total][0]):
                    grown[total] = left + more, [*chosen, which]
        least = grown
    return least[count][1] if count in least else None


def _plain(courses: Sequence[_Course], chosen: list[tuple[int, ...]]) -> bool:
    """Whether each of some values by itself takes far more from the courses than is left of all of them
    beyond noise, and no two are of one run.
    """
    runs = [c.places[n][0] for c, own in zip(courses, chosen, strict=True) for n in own]
    if len(set(runs)) < len(runs):
        return False
    bent = sum(c.but(own) - c.freedom(own) for c, own in zip(courses, chosen, strict=True))
    gains = [
        c.but(own[:i] + own[i + 1 :]) - c.but(own)
        for c, own in zip(courses, chosen, strict=True)
        for i in range(len(own))
    ]
    return min(gains) > max(policy.PLAIN_GAIN, policy.PLAIN_RATIO * (1.0 + max(bent, 0.0)))


def _told(courses: Sequence[_Course], chosen: list[tuple[int, ...]]) -> Standing:
    """Values as they are told of: two of one course that would lie along it in each other's place as
    exchanged.
    """
    values, exchanged = set(), []
    for c, own in zip(courses, chosen, strict=True):
        rest = list(own)
        for a, b in itertools.combinations(own, 2):
            others = tuple(n for n in own if n not in (a, b))
            if {a, b} <= set(rest) and c.exchanged(a, b).but(others) < c.but(own) + EXCHANGED:
                exchanged.append((c.places[a], c.places[b]))
                rest = [n for n in rest if n not in (a, b)]
        values |= {c.places[n] for n in rest}
    return Standing(frozenset(values), tuple(exchanged))
