"""The blind studies as docs/study.md and the report show them.

Tables come from `sonicvacuum blind score` (summary.csv and those of the pictures), `sonicvacuum blind
baselines` (baselines.csv) and `sonicvacuum blind resolved` (resolved_summary.csv); page and report show the
same cells.
"""

import math
import re
from dataclasses import MISSING, dataclass, fields
from pathlib import Path

import pandas as pd

from sonicvacuum.files import read_text
from sonicvacuum.report import tables
from sonicvacuum_blind import words
from sonicvacuum_blind.baselines.line import RuleLine
from sonicvacuum_blind.baselines.names import PANELS, RULES
from sonicvacuum_blind.score import Row, SummaryLine

SUMMARY = [f.name for f in fields(SummaryLine)]
BASELINES = [f.name for f in fields(RuleLine)]
# Columns of both that hold numbers, and of the first.
SHARES = ("value", "low", "high")
NUMBERS = (*SHARES, "ideal", "of_ideal")


@dataclass(frozen=True)
class Table:
    """What people read: header, cells, and how many columns after the second hold numbers."""

    header: list[str]
    rows: list[list[str]]
    numbers: int = 0

    @property
    def markdown(self) -> str:
        """The table in Markdown."""
        rules = ["---:" if 2 <= k < 2 + self.numbers else "---" for k in range(len(self.header))]
        lines = [self.header, rules, *([c.replace("|", "\\|") for c in row] for row in self.rows)]
        return "\n".join("| " + " | ".join(line) + " |" for line in lines)


@dataclass(frozen=True)
class Study:
    """Tables of a study, as text; those not made are None.

    Attributes:
        summary: of the score.
        baselines: of the simpler rules.
        resolved: of one more run for ambiguous cases.
        fresh: of fresh runs foretold.
        score: row of each record; none are kept of the study of seed 20062.
    """

    summary: pd.DataFrame
    baselines: pd.DataFrame | None = None
    resolved: pd.DataFrame | None = None
    fresh: pd.DataFrame | None = None
    score: pd.DataFrame | None = None

    @property
    def cases(self) -> int:
        """Number of records: of rows; without them, of what the summary adds up, where each is timed."""
        if self.score is not None:
            return len(self.score)
        timed = self.summary["measure"] == "seconds per record"
        timed &= self.summary["group"].str.endswith("median")
        return int(self.summary.loc[timed, "count"].astype(int).sum())

    @property
    def goals(self) -> tuple[int, int, int]:
        """Numbers of goals met, open and missed."""
        rows = [*self.summary.to_dict("records")]
        rows += [] if self.resolved is None else self.resolved.to_dict("records")
        found = [reached(row) for row in rows if row["count"] not in ("", "0")]
        return found.count("met"), found.count("open"), found.count("missed")


def _of_rows(path):
    """Columns of a table of cases: later ones may be missing."""
    there = read_text(path).partition("\n")[0].split(",") if path.exists() else ()
    return [f.name for f in fields(Row) if f.default is MISSING or f.name in there]


def read(folder) -> Study:
    """The tables in a folder; InputError where there is no summary.csv or one has other columns."""
    folder = Path(folder)
    found = {
        name: tables.read(folder / f"{name}.csv", columns, numbers)
        for name, columns, numbers in (
            ("baselines", BASELINES, SHARES),
            ("resolved_summary", SUMMARY, NUMBERS),
            ("fresh", SUMMARY, NUMBERS),
            ("score", _of_rows(folder / "score.csv"), ("seconds",)),
        )
        if (folder / f"{name}.csv").exists()
    }
    summary = tables.read(folder / "summary.csv", SUMMARY, NUMBERS)
    names = ("baselines", "resolved_summary", "fresh", "score")
    return Study(summary, *(found.get(name) for name in names))


def results(summary: pd.DataFrame) -> Table:
    """What was asked and found, held against the goals; lines without cases are left out."""
    header = ["asked", "of", "cases", "found", "95 %", "ideal rule", "goal", ""]
    return Table(header, [_result(row) for row in _filled(summary)], 5)


def findings(summary: pd.DataFrame) -> Table:
    """What was asked and found, without judgement and times, for a study too small for either.

    Times differ from run to run, and the page must not.
    """
    header = ["asked", "of", "cases", "found", "95 %", "ideal rule"]
    rows = [row for row in _filled(summary) if not row["measure"].startswith("seconds")]
    return Table(header, [_result(row)[:6] for row in rows], 4)


def followed(resolved: pd.DataFrame, fewest: int = 1) -> Table:
    """What one more run decides; lines with fewer cases are left out."""
    header = ["asked", "run", "cases", "found", "95 %", "goal", ""]
    rows = [_result(row) for row in _filled(resolved) if int(row["count"]) >= fewest]
    return Table(header, [[*row[:5], *row[6:]] for row in rows], 4)


def _filled(table):
    return [row for row in table.to_dict("records") if row["count"] not in ("", "0")]


def _result(row):
    found, low, high, ideal = (tables.number(row[key], 3) for key in ("value", "low", "high", "ideal"))
    interval = f"{low} to {high}" if low else ""
    goal = row["goal"].replace("<=", "≤").replace(">=", "≥")
    of = words.group(row["group"])
    return [words.asked(row["measure"]), of, row["count"], found, interval, ideal, goal, judgement(row)]


def judgement(row: dict) -> str:
    """Whether a line meets its goal, in words; where not, whether the ideal rule misses it too."""
    found = reached(row)
    alone = {**row, "value": row["ideal"], "low": "", "high": ""}
    if found == "missed" and row["ideal"] not in ("", "nan") and reached(alone) == "missed":
        return "missed, by the ideal rule too"
    return found


def reached(row: dict) -> str:
    """Whether a line's 95 % interval lies inside its goal ("met"), outside ("missed") or across its bound
    ("open"); its value decides where there is no interval; nothing where there is no goal, or where the
    ideal rule tells nothing.
    """
    found = re.fullmatch(r"(<=|>=) ([\d.]+)( of ideal)?|([\d.]+) to ([\d.]+)", row["goal"])
    value, low, high = (float(row[key] or "nan") for key in ("value", "low", "high"))
    if not found:
        return ""
    sign, bound, of_ideal, *ends = found.groups()
    if of_ideal:
        bound = float(bound) * (float(row["ideal"] or "nan") or math.nan)
    least, most = (bound, math.inf) if sign == ">=" else (-math.inf, bound) if sign else ends
    least, most = float(least), float(most)
    if math.isnan(low) or math.isnan(high):
        low = high = value
    if math.isnan(least) or math.isnan(most) or math.isnan(low):
        return ""
    if least <= low and high <= most:
        return "met"
    return "missed" if high < least or low > most else "open"


def rivals(baselines: pd.DataFrame) -> Table:
    """The simpler rules: one line for each, shares in per cent with intervals."""
    header = ["rule", *(title.split(" ", 1)[1].lower() for *_, title, _ in PANELS), "remarks"]
    cells = {(r["rule"], r["measure"], r["group"]): r for r in baselines.to_dict("records")}
    rows = []
    for rule, name in RULES.items():
        own = [cells.get((rule, measure, group)) for measure, group, *_ in PANELS]
        if any(own):
            note = next(r["note"] for r in own if r)
            rows.append([name, *(percent(r) for r in own), note])
    return Table(header, rows)


def percent(row: dict | None) -> str:
    """A share with interval and cases, a dash where there is none."""
    if row is None:
        return "–"
    value, low, high = (100.0 * float(row[key] or "nan") for key in ("value", "low", "high"))
    interval = "" if math.isnan(low) else f" ({low:.1f} to {high:.1f})"
    return f"{value:.1f} %{interval}, {row['count']} cases"
