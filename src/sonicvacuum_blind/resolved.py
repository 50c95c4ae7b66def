"""What one more run decides: records whose first verdict left several effects, taken together with the run
that was proposed and, for comparison, with a random one.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum_blind import TRUTH
from sonicvacuum_blind.followup import CHOICES, FILE
from sonicvacuum_blind.score import SummaryLine, found_in, load, whole
from sonicvacuum_blind.shares import counted, ratio_of_sums

# Effect → general laws of which it is a limit, which therefore no run can rule out: a contact that relaxes
# at once is Kuwabara's and Kono's, with A = g tau.
GENERAL = {"kuwabara-kono": {"relaxing-contact"}}


@dataclass(frozen=True)
class Followed:
    """One case with one further run. Truths: 1 or 0.

    Attributes:
        id, design, noise, effects, d_prime: as asked for.
        before, left_before: name given to the first record, and what could not be told from it.
        choice: one of `CHOICES`.
        change: of the experiment, quantity=value.
        predicted: χ² by which the proposed run was expected to decide; NaN for a random one.
        named, left: the same with the further run; joined by `+`.
        resolved: named exactly what is hidden, and no other effect is left beside it.
        exact_before, exact: named exactly what is hidden, whatever is left beside it.
    """

    id: str
    design: str
    noise: str
    effects: str
    d_prime: float
    before: str
    left_before: str
    choice: str
    change: str
    predicted: float
    named: str
    left: str
    resolved: int
    exact_before: int
    exact: int


def resolved(truth_folder, verdict_folder, choice: str, record_folder, joint_folder) -> list[Followed]:
    """Rows of all cases that have a further run, by id; none where no case has.

    Args:
        truth_folder, verdict_folder: of the first records.
        choice: one of `CHOICES`.
        record_folder: of the further runs, as `followup.write` makes them.
        joint_folder: of the verdicts on both together.

    Raises:
        InputError: where a truth or verdict is missing or lacks a key.
    """
    changes = found_in(record_folder, FILE)
    folders = {TRUTH: truth_folder, "verdict.json": verdict_folder}
    found = {name: found_in(folder, name) for name, folder in folders.items()}
    found["joint"] = found_in(joint_folder, "verdict.json")
    folders["joint"] = joint_folder
    for name, folder in folders.items():
        missing = sorted(set(changes) - set(found[name]))
        if missing:
            what = "joint verdict (sonicvacuum discover --together)" if name == "joint" else name
            raise InputError(f"{folder}: no {what} for {len(missing)} of {len(changes)} cases: {missing[0]}")
    files = ((changes[id], *(found[name][id] for name in folders)) for id in sorted(changes))
    return [_row(choice, *paths) for paths in files]


def _row(choice, change_path, truth_path, verdict_path, joint_path):
    change, truth, first, joint = map(load, (change_path, truth_path, verdict_path, joint_path))
    if change.get("choice") != choice:
        raise InputError(
            f"{change_path}: choice is {change.get('choice')}, not {choice}; give the folder of these"
        )
    files = f"{joint_path} (truth: {truth_path}, first verdict: {verdict_path}, change: {change_path})"
    with whole(files, "run sonicvacuum discover and blind follow again"):
        return row(truth, first, change, joint)


def row(truth: dict, first: dict, change: dict, joint: dict) -> Followed:
    """One case with one further run.

    Raises:
        KeyError: for a key that is missing.
    """
    hidden, named, left = set(truth["effects"]), joint["named"], _left(joint)
    exact, proposed = set(named) == hidden, change["choice"] == "proposed"
    return Followed(
        id=truth["id"],
        design=truth["design"],
        noise=truth["noise"],
        effects="+".join(truth["effects"]),
        d_prime=truth["d_prime"],
        before="+".join(first["named"]),
        left_before="+".join(_left(first)),
        choice=change["choice"],
        change=" ".join(f"{k}={v}" for k, v in change["change"].items()),
        predicted=float(first["next_experiment"]["delta_chi2"]) if proposed else math.nan,
        named="+".join(named),
        left="+".join(left),
        resolved=int(exact and not left),
        exact_before=int(set(first["named"]) == hidden),
        exact=int(exact),
    )


def _left(verdict):
    """Effects that a verdict cannot tell from those it names."""
    return sorted({name for names in verdict["confusable"] for name in names} - set(verdict["named"]))


def summary(rows: Iterable[Followed]) -> list[SummaryLine]:
    """Shares with 95 % intervals: resolved by each choice, by it alone; how much oftener by the proposed run;
    exact names before and after.
    """
    rows = list(rows)
    of = {choice: {r.id: r for r in rows if r.choice == choice} for choice in CHOICES}
    both = [id for id in of["proposed"] if id in of["random"]]
    goals = {"proposed": ">= 0.9"}

    def but_for_limits(row):
        return row.exact and set(row.left.split("+")) - {""} <= GENERAL.get(row.effects, set())

    lines = [
        counted("resolved by one more run", c, (r.resolved for r in of[c].values()), goals.get(c, ""))
        for c in CHOICES
    ]
    lines += [
        counted("resolved, but for limits", c, (int(but_for_limits(r)) for r in of[c].values()))
        for c in CHOICES
    ]
    if any(of["random"][id].resolved for id in both):
        hits = (np.array([of[c][id].resolved for id in both]) for c in CHOICES)
        found = ratio_of_sums(*hits)
        lines.append(SummaryLine("resolved, ratio", "proposed over random", len(both), *found, goal=">= 2.5"))
    for one, other in (CHOICES, CHOICES[::-1]):
        alone = [of[one][id].resolved and not of[other][id].resolved for id in both]
        lines.append(counted("resolved by this run alone", one, alone))
    before = {r.id: r.exact_before for r in rows}
    lines.append(counted("exact name of ambiguous cases", "before", before.values()))
    return lines + [
        counted("exact name of ambiguous cases", c, (r.exact for r in of[c].values())) for c in CHOICES
    ]
