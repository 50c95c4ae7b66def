"""Verdicts against truths: one row for each case; tables made of the rows: `summary` and `breakdown`."""

import json
import math
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from sonicvacuum.files import InputError, read_text, reading
from sonicvacuum.tables import write_csv
from sonicvacuum_blind import TRUTH

CONFIDENT = 0.9
NINETY = 1.6448536269514722  # standard deviations on either side of a 90 % interval
NONE, UNKNOWN = "none", "unknown"


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
        exact: named exactly what is hidden; nothing for null, unknown for foreign.
        class_level: single named, or one that the verdict itself calls confusable with it.
        false_alarm: an effect of the catalogue was named that is not hidden.
        says_unknown: the verdict holds unknown.
        confident_wrong: such a name with probability 0.9 or more and no word of unknown.
        closed: held-out gap closed.
        before, chi2: held-out mean squared residual over the floor, without and with what is named.
        inside, intervals: stated 90 % intervals of rightly named effects that hold the truth, of so many.
        seconds, simulations: what it cost.
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
    exact: int
    class_level: int
    false_alarm: int
    says_unknown: int
    confident_wrong: int
    closed: float
    before: float
    chi2: float
    inside: int
    intervals: int
    seconds: float
    simulations: int


def score(truth_folder, verdict_folder) -> list[Row]:
    """Rows of all cases below a folder of truths, by id.

    Folders may be nested; a case is found by the name of the folder that holds its file.

    Raises:
        InputError: where a case has no verdict, or a file is not what it should be.
    """
    truths, verdicts = found_in(truth_folder, TRUTH), found_in(verdict_folder, "verdict.json")
    if not truths:
        raise InputError(f"{truth_folder}: holds no {TRUTH}; make cases with sonicvacuum blind hide")
    missing = sorted(set(truths) - set(verdicts))
    if missing:
        raise InputError(
            f"{verdict_folder}: no verdict for {len(missing)} of {len(truths)} cases, first {missing[0]}; "
            "run sonicvacuum discover on their records"
        )
    return [
        row(load(truths[id]), load(verdicts[id]), f"{verdicts[id]} (truth: {truths[id]})")
        for id in sorted(truths)
    ]


def found_in(folder, name: str) -> dict[str, Path]:
    """Id of a case → its file of that name, however deep below a folder."""
    return {path.parent.name: path for path in Path(folder).rglob(name)}


def load(path: Path) -> dict:
    """A truth, verdict or change; InputError where it is no JSON object."""
    try:
        content = json.loads(read_text(path))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid JSON ({error})") from None
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected keys and values at the top level, found {type(content).__name__}")
    return content


def row(truth: dict, verdict: dict, path="verdict.json") -> Row:
    """One case.

    Raises:
        InputError: where the verdict lacks a key that is needed, which the message names, or one of the two
            holds what does not belong there.
    """
    with reading(path, "run sonicvacuum discover again, or hide"):
        try:
            return _row(truth, verdict)
        except KeyError as error:
            raise InputError(f"{path}: {error.args[0]}: missing; this key is required") from None


def _row(truth, verdict):
    effects, named = truth["effects"], verdict["named"]
    claimed = [n for n in named if n != UNKNOWN]
    probabilities = verdict["probabilities"]
    top = max(probabilities, key=lambda name: (probabilities[name], name))
    real = [] if truth["kind"] == "foreign" else effects
    wrong = [n for n in claimed if n not in real]
    held_out = (verdict.get("gap") or {}).get("held_out") or {}
    inside, intervals = _coverage(truth, verdict) if real else (0, 0)
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
        ideal=truth["ideal"].get("+".join(effects), 0.0) if truth["ideal"] else math.nan,
        named="+".join(named),
        top=top.replace(" + ", "+"),
        confidence=probabilities[top],
        exact=int(set(named) == ({UNKNOWN} if truth["kind"] == "foreign" else set(effects))),
        class_level=int(_class_level(effects, named, verdict["confusable"])),
        false_alarm=int(bool(wrong)),
        says_unknown=int(UNKNOWN in named),
        confident_wrong=int(UNKNOWN not in named and confidently(probabilities, wrong)),
        closed=_number(held_out.get("closed")),
        before=_over_floor(held_out, "before"),
        chi2=_over_floor(held_out, "after"),
        inside=inside,
        intervals=intervals,
        seconds=_number((verdict.get("timing_s") or {}).get("total")),
        simulations=int(verdict.get("simulations") or 0),
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


def _coverage(truth, verdict):
    """(inside, all) of the stated 90 % intervals of effects that are hidden and named."""
    inside = total = 0
    for hidden in truth["hidden"]:
        stated = verdict["parameters"].get(hidden["id"], {}) if hidden["id"] in verdict["named"] else {}
        for name, true in hidden["parameters"].items():
            found = stated.get(name)
            if not isinstance(found, dict) or not found.get("sigma"):
                continue
            total += 1
            inside += abs(found["value"] - true) <= NINETY * found["sigma"]
    return inside, total


@dataclass(frozen=True)
class Line:
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
