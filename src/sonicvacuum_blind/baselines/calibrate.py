"""Calibration of stated probabilities on cases whose truth is known.

The numbers of `discover.calibration` maximise the probability given to what was hidden: none, one effect, a
set of effects, or something outside the catalogue (unknown).
"""

import math
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import scipy

from sonicvacuum.blas import one_thread
from sonicvacuum.discover.fit.calibration import Calibration, of_package
from sonicvacuum.discover.fit.evidence import unknown_odds
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.verdict import write_json
from sonicvacuum.files import InputError, reading
from sonicvacuum.tables import read_csv
from sonicvacuum_blind import TRUTH
from sonicvacuum_blind.score import NONE, UNKNOWN, found_in, load, whole

__all__ = ["Outcome", "calibrate", "outcomes", "write_json"]

# No probability counts as smaller: one freak case must not decide.
_LEAST = 1e-4
# Width of the normal priors of all four numbers about no change.
_WIDTH = 2.0
_CURE = "run sonicvacuum discover on its record again"


@dataclass(frozen=True)
class Outcome:
    """One case: log weights of none, effects and sets, log odds of unknown, and what is true."""

    logs: dict[str, float]
    unknown: float
    truth: str


@one_thread
def outcomes(truth_folder, verdict_folder) -> list[Outcome]:
    """All cases below two folders.

    Raises:
        InputError: where a case lacks verdict or table, or one of these is not what it should be.
    """
    truths, verdicts = found_in(truth_folder, TRUTH), found_in(verdict_folder, "verdict.json")
    result = []
    for id, path in sorted(truths.items()):
        if id not in verdicts:
            raise InputError(f"{verdict_folder}: no verdict for {id}; run sonicvacuum discover on its record")
        found = _evidence(verdicts[id].parent / "candidates.csv")
        with whole(f"{verdicts[id]} (truth: {path})", _CURE):
            result.append(_outcome(load(path), load(verdicts[id]), found))
    if not result:
        raise InputError(f"{truth_folder}: no case")
    return result


def _evidence(table: Path):
    """Effects, one or several → ln of their evidence over that of none."""
    rows = read_csv(table, _CURE, ("effects", "log10_bayes"))
    with reading(table, _CURE):
        return {tuple(r["effects"].split("+")): float(r["log10_bayes"]) * math.log(10.0) for r in rows}


def _outcome(truth, verdict, found):
    alone = [SimpleNamespace(effect=names[0], log_bayes=x) for names, x in found.items() if len(names) == 1]
    sets = [SimpleNamespace(effects=names, log_bayes=x) for names, x in found.items() if len(names) > 1]
    logs, alarms = explanations.log_weights(alone, sets), verdict["alarms"]
    # What the best of them leaves: sets were only asked for where one effect leaves something.
    p = next((alarms[step] for step in ("set", "pair", "single", "none") if step in alarms), 1.0)
    true = {"null": NONE, "foreign": UNKNOWN}.get(truth["kind"], explanations.key(truth["effects"]))
    return Outcome(logs, math.log(unknown_odds(p)), true)


@one_thread
def calibrate(cases: list[Outcome]) -> Calibration:
    """The calibration under which what is true is most probable; what is said of sets stays as it is."""

    kept = of_package().unknown_set

    def loss(numbers):
        shape = (math.exp(numbers[0]), *(float(n) for n in numbers[1:3]), math.exp(numbers[3]))
        calibration = Calibration(*shape, 0, kept)
        given = (
            calibration.probabilities(c.logs, c.unknown, "+" in max(c.logs, key=c.logs.get)).get(c.truth, 0.0)
            for c in cases
        )
        return -sum(math.log(max(p, _LEAST)) for p in given) + 0.5 * float(numbers @ numbers) / _WIDTH**2

    found = scipy.optimize.minimize(
        loss, np.zeros(4), method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-4}
    )
    temper, none, unknown, slope = (float(n) for n in found.x)
    rounded = (round(x, 4) for x in (math.exp(temper), none, unknown, math.exp(slope)))
    return Calibration(*rounded, len(cases), kept)
