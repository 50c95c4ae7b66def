"""Verdicts against truths: one row for each case; tables made of the rows: `summary` and `breakdown`."""

import math
from collections.abc import Callable, Container
from contextlib import contextmanager
from dataclasses import MISSING, asdict, dataclass, fields, replace
from pathlib import Path

from sonicvacuum.files import InputError, reading
from sonicvacuum.tables import read_csv, write_csv
from sonicvacuum_blind import TRUTH, stated
from sonicvacuum_blind.stated import load

CONFIDENT = 0.9
# A slip counts as named from this probability on.
LIKELY = 0.5
IDEAL = ("id", "ideal", "before", "cells")
NONE, UNKNOWN = "none", stated.UNKNOWN


@dataclass(frozen=True)
class Row:
    """One case. Truths: 1 or 0; numbers that do not apply are NaN.

    Attributes:
        id, kind, design, noise, effects, d_prime: as asked for; effects joined by `+`.
        reached: least d′ of the effects as hidden; 0 for null.
        leftover: d′ that no single effect of the catalogue explains.
        nearest: the other effect that explains the hidden one best.
        ideal: share of data sets of this record in which an ideal rule gives the true names (singles, pairs).
        named: verdict, joined by `+`.
        top, confidence: most probable entry of the probabilities, and its probability.
        stated: probability of the name given.
        brier: squared error of all probabilities, 0 to 2.
        credible, credible_size: the truth is in the 95 % credible set of explanations, which has so many.
        place: hidden bead, contact or gauge named, NaN where there is none or its effect is not named.
        exact: named exactly what is hidden; nothing for null, unknown for foreign, the effect and unknown
            for beside.
        class_level: single named, or one that the verdict itself calls confusable with it.
        false_alarm: an effect of the catalogue was named that is not hidden.
        says_unknown: the verdict holds unknown.
        wrong: such a name, and no word of unknown.
        confident_wrong: the same where it, or the set named, has probability 0.9 or more.
        slip: a slip of the laboratory is named, with probability 0.5 or more; these records have none.
        closed: held-out gap closed.
        before, chi2: held-out mean squared residual over the floor, without and with what is named.
        held, limits: upper limits on hidden effects not named that hold the truth, of so many.
        errors_before, errors_after: by how much the record's own errors are off, root mean square in stated
            errors: moved there by what is hidden if nothing is named, and as the verdict has them.
        cells_right, cells_wrong, cells_seen, cells_large: cells (run and gauge) of the map of disagreement
            found where something is left and where nothing is; of those where much is, found and all.
        seconds, simulations: what it cost.
        added: the case is one that the study has besides its main list, of a kind of which that has few: it
            counts among its like, and not where all cases are added up.
        place_in: the hidden bead, contact or gauge is among those that have 90 % together, as for `place`;
            NaN of verdicts that have no odds of places.
    """

    id: str
    kind: str
    design: str
    noise: str
    effects: str
    d_prime: float
    reached: float
    leftover: float
    nearest: str
    ideal: float
    named: str
    top: str
    confidence: float
    stated: float
    brier: float
    credible: int
    credible_size: int
    place: float
    exact: int
    class_level: int
    false_alarm: int
    says_unknown: int
    wrong: int
    confident_wrong: int
    slip: int
    closed: float
    before: float
    chi2: float
    held: int
    limits: int
    errors_before: float
    errors_after: float
    cells_right: int
    cells_wrong: int
    cells_seen: int
    cells_large: int
    seconds: float
    simulations: int
    added: int = 0
    place_in: float = math.nan


def score(
    truth_folder,
    verdict_folder,
    ideal_paths=(),
    added: Callable[[int], Container[int]] = lambda seed: (),
) -> list[Row]:
    """Rows of all cases below a folder of truths, by id.

    Folders may be nested; a case is found by the name of the folder that holds its file. What an ideal rule
    makes of a case, and where the case shows, stands in tables of `sonicvacuum blind ideal`. Places of the
    cases that the study of a seed has besides its main list come from `added`.

    Raises:
        InputError: where a case has no verdict, or a file is not what it should be.
    """
    known = {line["id"]: line for path in ideal_paths for line in read_csv(path, columns=IDEAL)}
    rows = []
    for where, path in cases(truth_folder, verdict_folder):
        truth, ideal = load(where), known.get(where.parent.name)
        found = row(truth, load(path), f"{path} (truth: {where})", path.parent, ideal)
        rows.append(replace(found, added=int(truth.get("place") in added(truth.get("seed")))))
    return rows


def intervals(truth_folder, verdict_folder) -> list[stated.Parameter]:
    """Stated intervals of all cases, with what was hidden; InputError as from `score`."""
    found = []
    for truth, path in cases(truth_folder, verdict_folder):
        with whole(f"{path} (truth: {truth})"):
            found += stated.parameters(load(truth), load(path), path.parent)
    return found


def cases(truth_folder, verdict_folder, partly: bool = False) -> list[tuple[Path, Path]]:
    """Files of truth and verdict of each case, by id; `partly`: of those that have a verdict.

    Raises:
        InputError: where there is no truth, or no verdict of a case.
    """
    truths, verdicts = found_in(truth_folder, TRUTH), found_in(verdict_folder, "verdict.json")
    if not truths:
        raise InputError(f"{truth_folder}: holds no {TRUTH}; make cases with sonicvacuum blind hide")
    missing = sorted(set(truths) - set(verdicts))
    if missing and not (partly and verdicts):
        raise InputError(
            f"{verdict_folder}: no verdict for {len(missing)} of {len(truths)} cases, first {missing[0]}; "
            "run sonicvacuum discover on their records"
        )
    return [(truths[id], verdicts[id]) for id in sorted(set(truths) & set(verdicts))]


def found_in(folder, name: str) -> dict[str, Path]:
    """Id of a case → its file of that name, however deep below a folder."""
    return {path.parent.name: path for path in Path(folder).rglob(name)}


@contextmanager
def whole(path, cure: str = "run sonicvacuum discover again, or hide"):
    """Turn a key that files of a case lack, or what does not belong there, into one InputError.

    Args:
        path: of the files, for the message.
        cure: what gives files that are whole.
    """
    with reading(path, cure):
        try:
            yield
        except KeyError as error:
            raise InputError(f"{path}: {error.args[0]}: missing; this key is required: {cure}") from None


def row(truth: dict, verdict: dict, path="verdict.json", folder: Path | None = None, ideal=None) -> Row:
    """One case.

    Args:
        truth, verdict: of the case.
        path: for messages.
        folder: of the verdict's tables; what needs them does not apply without.
        ideal: the case's line of `sonicvacuum blind ideal`.

    Raises:
        InputError: where the verdict lacks a key that is needed, which the message names, or one of the two
            holds what does not belong there.
    """
    with whole(path):
        return _row(truth, verdict, folder, ideal)


def _row(truth, verdict, folder, ideal):
    effects, named, hidden = truth["effects"], verdict["named"], stated.right_names(truth)
    claimed = [n for n in named if n != UNKNOWN]
    probabilities = verdict["probabilities"]
    top = max(probabilities, key=lambda name: (probabilities[name], name))
    wrong = [n for n in claimed if n not in hidden]
    held_out = (verdict.get("gap") or {}).get("held_out") or {}
    given, right = stated.key_of(named), stated.key_of(hidden)
    likely = stated.credible_set(probabilities)
    held, limits = stated.limits(truth, verdict)
    cells = stated.located(ideal["cells"] if ideal else "", folder)
    return Row(
        id=truth["id"],
        kind=truth["kind"],
        design=truth["design"],
        noise=truth["noise"],
        effects="+".join(effects),
        d_prime=truth["d_prime"],
        reached=_reached(truth),
        leftover=truth["leftover_d_prime"],
        nearest=truth["nearest"]["id"],
        ideal=float(ideal["ideal"]) if ideal else math.nan,
        named="+".join(named),
        top=top.replace(" + ", "+"),
        confidence=probabilities[top],
        stated=probabilities.get(given, 0.0),
        brier=stated.brier(probabilities, right),
        credible=int(right in likely),
        credible_size=len(likely),
        place=stated.place_right(truth, folder),
        exact=int(set(named) == set(hidden)),
        class_level=int(_class_level(effects, named, verdict["confusable"])),
        false_alarm=int(bool(wrong)),
        says_unknown=int(UNKNOWN in named),
        wrong=int(bool(wrong) and UNKNOWN not in named),
        confident_wrong=int(
            bool(wrong)
            and UNKNOWN not in named
            and (confidently(probabilities, wrong) or probabilities.get(given, 0.0) >= CONFIDENT)
        ),
        slip=int(any(fault["probability"] >= LIKELY for fault in verdict.get("faults") or [])),
        closed=_number(held_out.get("closed")),
        before=_over_floor(held_out, "before"),
        chi2=_over_floor(held_out, "after"),
        held=held,
        limits=limits,
        errors_before=float(ideal["before"]) if ideal else math.nan,
        errors_after=stated.errors_left(truth, folder),
        cells_right=cells[0],
        cells_wrong=cells[1],
        cells_seen=cells[2],
        cells_large=cells[3],
        seconds=_number((verdict.get("timing_s") or {}).get("total")),
        simulations=int(verdict.get("simulations") or 0),
        place_in=stated.place_in(truth, folder),
    )


def confidently(probabilities: dict[str, float], wrong: list[str]) -> bool:
    """Whether one of some effects, alone or among others (keys join several by ` + `), is held sure."""

    def marginal(effect):
        return sum(p for name, p in probabilities.items() if effect in name.split(" + "))

    return any(marginal(n) >= CONFIDENT for n in wrong)


def _reached(truth):
    if truth["kind"] == "foreign":
        return truth["leftover_d_prime"]
    return min((h["d_prime"] for h in truth["hidden"]), default=0.0)


def _number(value):
    return math.nan if value is None else float(value)


def _over_floor(gap, when):
    residual, floor = _number(gap.get(when)), _number(gap.get("floor"))
    return residual / floor if floor else math.nan


def _class_level(effects, named, confusable):
    """Every hidden effect named, itself or by one that the verdict cannot tell from it."""
    if len(named) != len(effects):
        return False
    classes = [set(c) for c in confusable]

    def covers(one, other):
        return one == other or any({one, other} <= c for c in classes)

    return all(any(covers(e, n) for n in named) for e in effects)


@dataclass(frozen=True)
class SummaryLine:
    """One line: a share or a median of so many cases, its 95 % interval, and what it is measured against.

    Attributes:
        measure, group: what, of which cases.
        count: of the cases.
        value, low, high: with 95 % interval.
        ideal: the ideal rule's share of the same cases, NaN where there is none.
        of_ideal: value over ideal.
        goal: as set beforehand.
    """

    measure: str
    group: str
    count: int
    value: float
    low: float
    high: float
    ideal: float = math.nan
    of_ideal: float = math.nan
    goal: str = ""


def write_table(lines: list, kind: type, path) -> None:
    """Rows or lines as CSV, numbers to six digits."""
    cells = ([f"{v:.6g}" if isinstance(v, float) else v for v in asdict(line).values()] for line in lines)
    write_csv(path, [f.name for f in fields(kind)], cells)


def read_table(kind: type, path) -> list:
    """Lines of a table that `write_table` wrote, as that dataclass; columns with a default may be missing.

    Raises:
        InputError: where it is no such table.
    """
    names = {f.name: f.type for f in fields(kind)}
    with reading(path, "make it with sonicvacuum blind score"):
        rows = read_csv(path, columns=[f.name for f in fields(kind) if f.default is MISSING])
        return [
            kind(**{name: type(row[name]) for name, type in names.items() if name in row}) for row in rows
        ]
