"""The smooth course of a table's quantities over the runs' speeds, and the value that leaves it."""

import math
from collections import defaultdict

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.foremost import Place


def standing_out(runs, start, model) -> set[Place]:
    """The value that by itself leaves the course of its own quantity over the runs' speeds, if there is one.

    Whatever effect acts, logarithms of measured over expected values lie along a line, roughly: without that
    value they do, in all quantities.
    """
    experiment, series = model.forward.experiment, defaultdict(list)
    for k, (_, rows) in enumerate(runs):
        speed, error = (
            math.log(experiment.record.runs[k].striker.speed_m_s),
            experiment.runs[k].speed_rel_sigma,
        )
        for j, one in rows:
            expected = float(start[k][0, 0, j]) * experiment.runs[k].scalars[j].sigma
            if expected > 0.0 and one.value > 0.0:
                own = math.hypot(one.sigma / max(one.value, expected), policy.SPEED_POWER * error)
                row = math.log(one.value / expected) / own, 1.0 / own, speed / own
                series[one.in_words].append(((k, j), row))
    courses = [_course(*zip(*own, strict=True)) for own in series.values() if len(own) > 3]
    gain, at = max((best for _, best in courses), default=(0.0, (0, 0)))
    left = sum(square for square, _ in courses) - gain
    return {at} if gain > policy.PLAIN_GAIN and gain > policy.PLAIN_RATIO * (1.0 + left) else set()


def _course(places, rows) -> tuple[float, tuple[float, Place]]:
    """χ² of one quantity along a line, and the most by which it is less without one value, with its place.

    Args:
        places: (run, place in it) of each of its m values.
        rows: m times (logarithm of measured over expected, 1, logarithm of the speed in m/s), each over the
            standard error of the first.
    """
    table = np.array(rows)

    def squares(without=None):
        own = np.delete(table, without, axis=0) if without is not None else table
        best = np.linalg.lstsq(own[:, 1:], own[:, 0], rcond=None)[0]
        return float(np.square(own[:, 0] - own[:, 1:] @ best).sum())

    whole = squares()
    return whole, max((whole - squares(n), place) for n, place in enumerate(places))
