"""The reason of a verdict in one sentence, built from the numbers."""

import math
from collections.abc import Mapping

from sonicvacuum_paper.columns import Metrics
from sonicvacuum_paper.compare import needs_of
from sonicvacuum_paper.ladder import title
from sonicvacuum_paper.rows import Row
from sonicvacuum_paper.verdict import BOUND, NOT_TESTABLE, REPRODUCED, Judged, Target, judge

# Quoted where the quantity itself does not exist: the same pulse at a level that losses leave intact.
COMPANIONS = {
    "duration": "duration_05",
    "duration_02": "duration_05",
    "width": "width_05",
    "width_02": "width_05",
}


def comparison(metrics: Metrics, claim, target: Target, rows: Mapping[str, Row], column: str) -> str:
    """What the deciding column gives, and against what.

    Args:
        metrics: all metrics, for what an ordering compares.
        claim: the claim, of which value, sigma, unit and quantity are quoted.
        target: what its cells ask for.
        rows: column → the claim's metric.
        column: the one that decides.
    """
    outcome = judge(target, rows[column].value, rows[column].numerical_error)
    if outcome.verdict == NOT_TESTABLE:
        return f"Not testable: {outcome.reason}."
    # A case that the ladder's models share has nothing to tell apart.
    one = column != "named" and len({r.key for c, r in rows.items() if c not in ("named", "ideal")}) == 1
    told = _compared(metrics, target, rows[column], claim, column, outcome)
    return f"{told}." if one else f"{title(column)}: {told}."


def absence(metrics: Metrics, metric: str, rows: list[Row]) -> str:
    """Why there is no number; the first of the rows tells."""
    if not rows:
        return f"Not testable: {metric} has not been found in any column."
    row = rows[0]
    companion = metrics.at(row.case, COMPANIONS.get(row.quantity, ""), row.sensor)
    if companion is None or not companion.known:
        return f"Not testable: {row.reason}."
    return f"Not testable: {row.reason}; {companion.quantity} is {companion.value:.4g} {companion.unit}."


def shown(value: float, target: Target) -> str:
    """A number with four digits, or with as many as its comparison takes.

    They tell it from a strict bound that it does not equal, and by a twentieth of sigma from its neighbours.
    """
    for digits in range(4, 12):
        text = f"{value:.{digits}g}"
        rounded = abs(float(text) - value)
        if rounded <= 0.05 * target.sigma if target.sigma > 0.0 else _apart(float(text), value, target):
            break
    return text


def _apart(rounded, value, target):
    """Whether the rounded number stands on the same side of the bounds as the number."""
    bounds = (target.low, target.high)
    return all(rounded != bound or abs(value - bound) <= 1e-12 * abs(bound) for bound in bounds)


def _compared(metrics, target, row, claim, column, outcome):
    unit = "" if claim.unit in ("", "1") else f" {claim.unit}"
    if target.test == "order":
        return _ordered(metrics, row, column, outcome)
    if target.test == "count":
        return f"{claim.quantity} {row.value:g} against {target.low:g}"
    bound = {"at_least": "at least ", "at_most": "at most "}.get(target.test, "")
    spread = f" ± {claim.sigma}" if target.sigma > 0.0 else ""
    if target.test == "within":
        spread, unit = f" ± {target.sigma:.1g}", f"{unit}, bound {BOUND * target.sigma:.3g}"
    against = f"{bound}{claim.value.replace('..', ' to ')}{spread}{unit}"
    return f"{claim.quantity} {shown(row.value, target)} against {against}{_by(outcome)}"


def _ordered(metrics, row, column, outcome):
    """Whether the order holds, with the values that it compares."""
    told = "the order holds" if outcome.verdict == REPRODUCED else "the order does not hold"
    found = [(need, metrics.find(need[0], column, *need[1:])) for need in needs_of(row)]
    values = [
        f"{case} {r.quantity.replace('_', ' ')} {r.value:.4g}" for (case, *_), r in found if r and r.known
    ]
    return f"{told} ({', '.join(values)})" if values else told


def by(outcome: Judged) -> str:
    """A difference in standard errors, empty where there is none."""
    d = outcome.difference_sigma
    return f"{d:+.2g}" if math.isfinite(d) and d != 0.0 else ""


def _by(outcome):
    return f" ({by(outcome)} σ)" if by(outcome) else ""
