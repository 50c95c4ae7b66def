"""What a verdict states beside its names, held against the truth: places, probabilities, intervals, limits,
the record's own errors, and where data and model disagree.
"""

import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy

from sonicvacuum.files import InputError, read_text
from sonicvacuum.tables import read_csv

UNKNOWN = "unknown"
CREDIBLE = 0.95
# Cells of the map of disagreement: what a model without the hidden effect leaves there is something from
# SMALL d′ on, and must be seen from LARGE on; found is what has a corrected p below FOUND, the rate of false
# discoveries of discover's map.
SMALL, LARGE, FOUND = 1.0, 5.0, 0.03
PLACES = ("bead", "contact", "sensor")
# The likeliest places count as far as they have this probability together.
SET = 0.9
# Parameters whose effect vanishes as they grow, and what the others are where they do nothing.
INVERSE = (("sensor-droop", "tau_us"), ("coating-thickness", "layer_thickness_um"))
NOTHING = {"exponent": 1.5}
# Ends at which studies hide a truth.
ENDS = {("gravity", "fraction"): (0.0, 1.0)}
CURE = "run sonicvacuum discover again"


def load(path: Path) -> dict:
    """A truth, verdict or change; InputError where it is no JSON object."""
    try:
        content = json.loads(read_text(path))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid JSON ({error})") from None
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected keys and values at the top level, found {type(content).__name__}")
    return content


def right_names(truth: dict) -> list[str]:
    """What a verdict should name: hidden effects of the catalogue, `unknown` for one from outside."""
    effects = list(truth["effects"])
    return {"foreign": [UNKNOWN], "beside": [*effects[:1], UNKNOWN]}.get(truth["kind"], effects)


def _beside(folder: Path | None, name: str) -> Path | None:
    """A file beside the verdict, None where there is none."""
    return folder / name if folder and (folder / name).exists() else None


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect that is hidden and named.

    Attributes:
        id, kind, design, d_prime, effect, parameter: whose.
        truth, value, sigma: as hidden, and as stated.
        pit: posterior probability below the truth.
    """

    id: str
    kind: str
    design: str
    d_prime: float
    effect: str
    parameter: str
    truth: float
    value: float
    sigma: float
    pit: float

    @property
    def at_an_end(self) -> bool:
        """Whether the truth is an end of what the parameter can be: a chain that lies flat, or stands."""
        return self.truth in ENDS.get((self.effect, self.parameter), ())


def parameters(truth: dict, verdict: dict, folder: Path | None = None) -> list[Parameter]:
    """Those of effects that are hidden and named, from `posterior.csv` where there is one, else normal."""
    draws, found = _draws(folder), []
    for hidden in truth["hidden"] if truth["kind"] != "foreign" else ():
        stated = verdict["parameters"].get(hidden["id"], {}) if hidden["id"] in verdict["named"] else {}
        for name, true in hidden["parameters"].items():
            one = stated.get(name)
            if not isinstance(one, dict) or not one.get("sigma"):
                continue
            below = scipy.special.ndtr((true - one["value"]) / one["sigma"])
            if (hidden["id"], name) in draws:
                value, weight = draws[hidden["id"], name]
                below = weight[value < true].sum() / weight.sum()
            case = truth["id"], truth["kind"], truth["design"], hidden["d_prime"]
            found.append(Parameter(*case, hidden["id"], name, true, one["value"], one["sigma"], float(below)))
    return found


def _draws(folder):
    """(effect, parameter) → values and weights (n,)."""
    path, cells = _beside(folder, "posterior.csv"), {}
    for row in read_csv(path, CURE, ["effect", "parameter", "value", "weight"]) if path else ():
        pair = float(row["value"]), float(row["weight"])
        cells.setdefault((row["effect"], row["parameter"]), []).append(pair)
    return {key: np.array(pairs).T for key, pairs in cells.items()}


def key_of(names) -> str:
    """The entry of a verdict's probabilities for a set of names."""
    known = sorted(n for n in names if n != UNKNOWN)
    return " + ".join([*known, *([UNKNOWN] if UNKNOWN in names else [])]) or "none"


def of_named(verdict: dict) -> float:
    """The probability that a verdict states of what it names."""
    return verdict["probabilities"].get(key_of(verdict["named"]), 0.0)


def credible_set(probabilities: dict[str, float]) -> list[str]:
    """The likeliest explanations that together have `CREDIBLE` of the probability."""
    order = sorted(probabilities, key=lambda name: (-probabilities[name], name))
    total = np.cumsum([probabilities[name] for name in order])
    return order[: int(np.searchsorted(total, CREDIBLE)) + 1]


def brier(probabilities: dict[str, float], right: str) -> float:
    """Squared error of all explanations, `right` being so (Brier, Mon. Weather Rev. 78, 1, 1950): 0 to 2."""
    wrong = sum(p**2 for name, p in probabilities.items() if name != right)
    return wrong + (1.0 - probabilities.get(right, 0.0)) ** 2


def place_right(truth: dict, folder: Path | None) -> float:
    """1 where hidden effects that are named are named at their beads, contacts and gauges, 0 where not; NaN
    where none has a place.
    """
    path = _beside(folder, "model.json")
    effects = load(path)["effects"] if path else {}
    told = {(name, kind): [at] for name, given in effects.items() for kind, at in given.items()}
    return _among(truth, folder, told)


def place_in(truth: dict, folder: Path | None) -> float:
    """The same with places that have 90 % together in `posterior.csv`, the likeliest first."""
    sets = {}
    for key, (at, weight) in _draws(folder).items():
        order = np.argsort(-weight, kind="stable")
        before = np.cumsum(weight[order]) - weight[order]
        sets[key] = at[order][before < SET * weight.sum()]
    return _among(truth, folder, sets)


def _among(truth, folder, told):
    """1 where all hidden effects sit at one of their (effect, kind of place) → places, 0 where one does not;
    NaN where none is told of.
    """
    right = []
    gauges = [sensor["id"] for sensor in _record(folder).get("sensors", ())]
    for hidden in truth["hidden"] if truth["kind"] != "foreign" else ():
        for kind in set(PLACES) & set(hidden):
            at = [int(x) for x in told.get((hidden["id"], kind), ())]
            if at:
                right.append(hidden[kind] in ([gauges[x] for x in at] if kind == "sensor" else at))
    return float(all(right)) if right else math.nan


def _record(folder):
    """The record as the verdict was given it; empty where it does not say."""
    path = _beside(folder, "given.json")
    return load(path)["records"][0]["record"] if path else {}


def limits(truth: dict, verdict: dict) -> tuple[int, int]:
    """(held, all) upper limits on parameters of hidden effects that are not named.

    Left out: effects with a place, whose limit may be that of another place, and gravity, of which nothing is
    another number in a vertical chain.
    """
    held = total = 0
    for hidden in truth["hidden"] if truth["kind"] != "foreign" else ():
        name, given = hidden["id"], verdict.get("upper_limits", {}).get(hidden["id"], {})
        if name in verdict["named"] or name == "gravity" or set(PLACES) & set(hidden):
            continue
        for key, true in hidden["parameters"].items():
            if isinstance(given.get(key), float) and _away(name, key, true) > 0.0:
                total += 1
                held += _away(name, key, true) <= _away(name, key, given[key])
    return held, total


def _away(effect, name, value):
    """How far a parameter is from doing nothing."""
    if (effect, name) in INVERSE:
        return 1.0 / value
    return abs(math.log(value)) if name.endswith("_ratio") else abs(value - NOTHING.get(name, 0.0))


def errors_left(truth: dict, folder: Path | None) -> float:
    """Root mean square of what the model's speeds, triggers, gains and modulus are off, in stated errors; NaN
    where the verdict does not say.
    """
    record, path = _record(folder), _beside(folder, "model.json")
    if not record or not path:
        return math.nan
    model, drawn, off = load(path), truth["errors_sigma"], []
    trigger = record.get("trigger_sigma_us")
    for k, run in enumerate(record["runs"]):
        off.append(
            (
                model["speed_ratio"].get(run["id"], math.nan) - 1.0,
                run["striker"].get("speed_rel_sigma"),
                drawn["speeds"][k],
            )
        )
        off.append((model["trigger_us"].get(run["id"], math.nan), trigger, drawn["triggers"][k]))
    for sensor, true in zip(record.get("sensors", ()), drawn["gains"], strict=False):
        off.append((model["gain"].get(sensor["id"], math.nan) - 1.0, sensor.get("gain_rel_sigma"), true))
    beads = record["materials"][record["chain"]["bead"]["material"]]
    off.append((model["modulus_ratio"] - 1.0, beads.get("modulus_rel_sigma"), drawn["modulus"]))
    misses = np.array([value / sigma - true for value, sigma, true in off if sigma])
    misses = misses[np.isfinite(misses)]
    return float(np.sqrt(np.mean(misses**2))) if len(misses) else math.nan


def located(cells: str, folder: Path | None) -> tuple[int, int, int, int]:
    """(cells found where something is left, found where nothing is, found of the large ones, large ones).

    Args:
        cells: of the case, as `ideal.IdealLine` has them.
        folder: of the verdict.
    """
    path = _beside(folder, "where.csv")
    if not cells or not path:
        return 0, 0, 0, 0
    sizes = {name: float(size) for name, size in (cell.split("=") for cell in cells.split())}
    seen = {
        f"{row['run']}/{row['sensor'] or row['feature']}"
        for row in read_csv(path, CURE, ["run", "sensor", "feature", "q_before"])
        if float(row["q_before"] or "nan") < FOUND
    }
    right = sum(sizes.get(name, 0.0) >= SMALL for name in seen)
    large = {name for name, size in sizes.items() if size >= LARGE}
    return right, len(seen) - right, len(large & seen), len(large)
