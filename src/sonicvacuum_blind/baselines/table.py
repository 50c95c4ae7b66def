"""The table of all rules on the same cases, with Wilson intervals.

Counted are exact names on singles, false alarms on nulls, wrong names on cases from outside the catalogue.
Records of several effects are left out: these rules name one effect or none.
"""

from collections.abc import Callable, Iterable, Mapping

import numpy as np

from sonicvacuum.blas import one_thread
from sonicvacuum.files import InputError
from sonicvacuum_blind import design
from sonicvacuum_blind.baselines import rules
from sonicvacuum_blind.baselines.cases import Case
from sonicvacuum_blind.baselines.line import RuleLine
from sonicvacuum_blind.baselines.names import ALARM, EXACT, NULLS, OUTSIDE, SINGLES, WRONG
from sonicvacuum_blind.breakdown import ONE_NAME, label_of_verdict
from sonicvacuum_blind.score import NONE, UNKNOWN, Row
from sonicvacuum_blind.shares import share, strength_bin
from sonicvacuum_blind.study import STRENGTHS

# Leftover d′ from which a case from outside the catalogue counts.
LEFTOVER = 7.5
METHOD, IDEAL = "sonicvacuum", "ideal rule"
QUIETER = 100.0
RULES = ("best-chi2", "bic", "nearest-shape", "forest", "state")


def lines(rule: str, names: Mapping[str, str], cases: Iterable[Case], note: str = "") -> list[RuleLine]:
    """Lines of one rule: names by case id; cases without a name are left out."""
    rows = [c.row for c in cases if c.row.id in names]
    found = []
    for measure, group, chosen, right in _groups(rows):
        hits = sum(right(row, names[row.id]) for row in chosen)
        if chosen:
            found.append(RuleLine(rule, measure, group, len(chosen), *share(hits, len(chosen)), note))
    return found


def _groups(rows: list[Row]) -> Iterable[tuple[str, str, list[Row], Callable[[Row, str], bool]]]:
    """Measure, group, its rows, and what is right there; over all strengths, of the main list alone."""
    singles = [r for r in rows if r.kind == "single"]
    main = [r for r in singles if not r.added]
    for strength in STRENGTHS:
        chosen = [r for r in singles if r.design == "traces" and strength_bin(r) == strength]
        yield EXACT, f"traces, d' {strength:g}", chosen, _exact
    for kind in design.KINDS:
        if kind != "traces":
            yield EXACT, kind, [r for r in main if r.design == kind], _exact
    yield EXACT, SINGLES, main, _exact
    yield ALARM, NULLS, [r for r in rows if r.kind == "null"], _named
    outside = [r for r in rows if r.kind == "foreign" and r.leftover >= LEFTOVER]
    yield WRONG, OUTSIDE, outside, _named


def _exact(row, name):
    return name == row.effects


def _named(row, name):
    return name not in (NONE, UNKNOWN)


def ideal(cases: Iterable[Case]) -> list[RuleLine]:
    """The ideal rule's share on singles, as computed for each record."""
    rows = [c.row for c in cases if not np.isnan(c.row.ideal)]
    found = []
    for measure, group, chosen, _ in _groups(rows):
        if chosen and measure == EXACT:
            value = float(np.mean([r.ideal for r in chosen]))
            found.append(RuleLine(IDEAL, measure, group, len(chosen), value, np.nan, np.nan, "computed"))
    return found


@one_thread
def compare(
    cases: list[Case], training: list[Case], wanted: Iterable[str], state_cases: int
) -> list[RuleLine]:
    """All lines: the method's own, the ideal rule's, then those of the wanted rules in their order.

    Args:
        cases: of the study.
        training: of another family of seeds, possibly none.
        wanted: of `RULES`.
        state_cases: so many cases, evenly spread, for the rule `state`.

    Raises:
        InputError: for a rule whose package is missing.
    """
    own = {c.row.id: label_of_verdict(c.row) for c in cases}
    found = [*lines(METHOD, own, cases), *ideal(cases)]
    for rule in RULES:
        if rule in wanted:
            found += _of_rule(rule, cases, training, state_cases)
    return found


def _of_rule(rule, cases, training, state_cases):
    if rule in ("best-chi2", "bic"):
        name = {"best-chi2": rules.best_chi2, "bic": rules.bic}[rule]
        return lines(rule, {c.row.id: name(c) for c in cases}, cases)
    if rule == "nearest-shape":
        return _nearest(cases, training)
    try:
        return _forest(cases, training) if rule == "forest" else _state(cases, state_cases)
    except ModuleNotFoundError as error:
        raise InputError(f"rule {rule}: needs {error.name}, which is not installed; run make study") from None


def _nearest(cases, training):
    if not rules.has_cosines(cases):
        return []
    nulls = [c for c in training if c.row.kind == "null"]
    least = rules.least_likeness(nulls)
    note = (
        f"none below the likeness that 1 % of {len(nulls)} training nulls exceed" if nulls else "never none"
    )
    return lines("nearest-shape", {c.row.id: rules.nearest_shape(c, least) for c in cases}, cases, note)


def _one_name(cases):
    """Those that hide no more than these rules can name."""
    return [c for c in cases if c.row.kind in ONE_NAME]


def _forest(cases, training):
    from sonicvacuum_blind.baselines import forest

    plain, known = _one_name(cases), _one_name(training)
    note = f"learned from four fifths of the study's own {len(plain)} cases in turn"
    found = lines("forest, cross-validated", forest.cross_validated(plain), plain, note)
    if known:
        note = f"learned from {len(known)} training cases"
        found = lines("forest, trained", forest.trained(known, plain), plain, note) + found
    return found


def _state(cases, most):
    from sonicvacuum_blind.baselines import state

    fit = [c for c in _one_name(cases) if any(cell.sensor for cell in c.cells)]
    chosen = fit[:: max(1, -(-len(fit) // most))]
    some = "all cases" if len(chosen) == len(fit) else f"{len(chosen)} of {len(fit)} cases"
    can = [c for c in chosen if c.row.kind == "single" and c.row.effects in state.EXPRESSIBLE]
    found = []
    for rule, noise, quieter in (
        ("state", "the gauges'", 1.0),
        ("state, noise / 100", "a hundredth of the gauges'", QUIETER),
    ):
        names = {c.row.id: state.name(c, quieter) for c in chosen}
        note = f"full motion of all beads, {noise} relative noise; {some} with traces"
        found += lines(rule, names, chosen, note)
        note += f"; only the {len(state.EXPRESSIBLE)} effects that have a term"
        found += lines(f"{rule}, expressible", names, can, note)
    return found
