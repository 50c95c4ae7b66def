"""One vector of fixed length for each record, from the scores of the nominal model's residual.

Runs are condensed to a mean and a slope over the logarithm of the striker's speed, gauges to the first, the
last and those between, so that records of any number of runs and gauges give the same entries. Scores come as
they are and over their root sum of squares, which leaves the shape without the strength. What a record does
not have is NaN.
"""

import math

import numpy as np

from sonicvacuum.discover.judge.locate import FEATURES
from sonicvacuum.files import read_yaml
from sonicvacuum_blind.baselines.cases import Case, Cell
from sonicvacuum_blind.score import whole

ROLES = ("first", "inner", "last")
QUANTITIES = ("speed", "amplitude", "duration", "decay", "restitution", "contact_duration")
OCCURRENCES = 3
# Numbers of the cell of one feature: scores, scores without their strength, sizes; mean and slope each.
PER_CELL = 6
WIDTH = (len(FEATURES) * len(ROLES) + len(QUANTITIES) * OCCURRENCES) * PER_CELL + 5


def vector(case: Case) -> np.ndarray:
    """(WIDTH,) features of one case."""
    path = case.record / "record.yaml"
    setting = read_yaml(path)
    with whole(path, "give the records that the verdicts are on"):
        return _vector(case, setting)


def _vector(case, setting):
    speeds = {run["id"]: math.log(run["striker"]["speed_m_s"]) for run in setting["runs"]}
    total = math.sqrt(sum(c.z**2 for c in case.cells if not math.isnan(c.z))) or 1.0
    groups = _grouped(case.cells)
    parts = [_condensed(groups.get(key, []), speeds, total) for key in _keys()]
    excess = (case.misfit - 1.0) * math.sqrt(case.data / 2.0)
    beads, sensors = setting["chain"]["beads"], len(setting.get("sensors", []))
    return np.array([*np.concatenate(parts), excess, total, len(speeds), sensors, beads])


def _keys():
    yield from ((role, feature) for role in ROLES for feature in FEATURES)
    yield from ((k, quantity) for quantity in QUANTITIES for k in range(OCCURRENCES))


def _grouped(cells: tuple[Cell, ...]) -> dict[tuple, list[Cell]]:
    """(role of the gauge, feature) or (occurrence in its run, quantity) → cells of all runs."""
    sensors = list(dict.fromkeys(c.sensor for c in cells if c.sensor))
    groups: dict[tuple, list[Cell]] = {}
    seen: dict[tuple, int] = {}
    for cell in cells:
        if cell.sensor:
            key = (_role(sensors.index(cell.sensor), len(sensors)), cell.feature)
        else:
            place = seen.get((cell.run, cell.feature), 0)
            seen[cell.run, cell.feature] = place + 1
            key = (place, cell.feature)
        groups.setdefault(key, []).append(cell)
    return groups


def _role(place, count):
    return "first" if place == 0 else "last" if place == count - 1 else "inner"


def _condensed(cells, speeds, total):
    """(PER_CELL,) means and slopes over the runs."""
    if not cells:
        return np.full(PER_CELL, math.nan)
    x = np.array([speeds[c.run] for c in cells])
    z, sizes = np.array([c.z for c in cells]), np.array([c.size for c in cells])
    return np.concatenate([_line(x, values) for values in (z, z / total, sizes)])


def _line(x, y):
    """Mean, and slope of the straight line through the points (NaN where all have one speed)."""
    if np.isnan(y).any():
        return math.nan, math.nan
    spread = x - x.mean()
    squares = float(spread @ spread)
    return float(y.mean()), float(spread @ y) / squares if squares > 1e-12 else math.nan
