"""The blind studies as docs/study.md and the report show them, and what of the full one is kept in git.

Tables come from `sonicvacuum blind score` (summary.csv and those of the pictures), `sonicvacuum blind
baselines` (baselines.csv) and `sonicvacuum blind resolved` (resolved_summary.csv); page and report show the
same cells.
"""

import math
import re
from dataclasses import dataclass, fields
from pathlib import Path

import pandas as pd

from sonicvacuum.files import InputError, read_text, replacing
from sonicvacuum.report import tables
from sonicvacuum_blind.baselines.names import DESIGNS, PANELS, RULES
from sonicvacuum_blind.baselines.table import Line as Baseline
from sonicvacuum_blind.score import Line

SUMMARY = [f.name for f in fields(Line)]
BASELINES = [f.name for f in fields(Baseline)]
# Columns of both that hold numbers, and of the first.
SHARES = ("value", "low", "high")
NUMBERS = (*SHARES, "ideal", "of_ideal")
BEGIN = "<!-- study: made by `snakemake publish_study`, do not edit -->"
END = "<!-- end of study -->"
# What is kept of a study: what must be there, and what may.
KEPT = ("summary", "baselines", "confusion", "accuracy", "reliability", "coverage")
ALSO_KEPT = ("resolved_summary",)
# Said beside the lines on held-out gaps: χ² of N data scatters by √(2N).
HELD_OUT = (
    "A held-out gap of d′² in N data drowns in the scatter of χ², √(2N), while d′ is below (2N)^¼, about 10 "
    "here: the median of single records shows that scatter, the gaps added up show what is closed."
)
# Where docs/study.md finds the pictures drawn from these tables.
PICTURE = "../figures/blind_{}.png"


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
    """

    summary: pd.DataFrame
    baselines: pd.DataFrame | None = None
    resolved: pd.DataFrame | None = None

    @property
    def cases(self) -> int:
        """Number of records: every one has been timed."""
        timed = self.summary["measure"] == "seconds per record"
        timed &= self.summary["group"].str.endswith("median")
        return int(self.summary.loc[timed, "count"].astype(int).sum())

    @property
    def goals(self) -> tuple[int, int]:
        """Numbers of goals met and missed."""
        rows = [*self.summary.to_dict("records")]
        rows += [] if self.resolved is None else self.resolved.to_dict("records")
        found = [reached(row) for row in rows if row["count"] not in ("", "0")]
        return found.count("met"), found.count("missed")


def read(folder) -> Study:
    """The tables in a folder; InputError where there is no summary.csv or one has other columns."""
    folder = Path(folder)
    found = {
        name: tables.read(folder / f"{name}.csv", columns, numbers)
        for name, columns, numbers in (
            ("baselines", BASELINES, SHARES),
            ("resolved_summary", SUMMARY, NUMBERS),
        )
        if (folder / f"{name}.csv").exists()
    }
    summary = tables.read(folder / "summary.csv", SUMMARY, NUMBERS)
    return Study(summary, found.get("baselines"), found.get("resolved_summary"))


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


def followed(resolved: pd.DataFrame) -> Table:
    """What one more run decides."""
    header = ["asked", "run", "cases", "found", "95 %", "goal", ""]
    rows = [_result(row) for row in _filled(resolved)]
    return Table(header, [[*row[:5], *row[6:]] for row in rows], 4)


def _filled(table):
    return [row for row in table.to_dict("records") if row["count"] not in ("", "0")]


def _result(row):
    found, low, high, ideal = (tables.number(row[key], 3) for key in ("value", "low", "high", "ideal"))
    interval = f"{low} to {high}" if low else ""
    goal = row["goal"].replace("<=", "≤").replace(">=", "≥")
    design, *rest = row["group"].replace("d'", "d′").split(", ")
    group = ", ".join([DESIGNS.get(design, design), *rest])
    return [row["measure"], group, row["count"], found, interval, ideal, goal, judgement(row)]


def judgement(row: dict) -> str:
    """Whether a line meets its goal, in words; where not, whether the ideal rule misses it too."""
    found = reached(row)
    known = row["ideal"] not in ("", "nan")
    if found == "missed" and known and reached({**row, "value": row["ideal"]}) == "missed":
        return "missed, by the ideal rule too"
    return found


def reached(row: dict) -> str:
    """Whether a line meets its goal: "met", "missed", or nothing where there is none."""
    found = re.fullmatch(r"(<=|>=) ([\d.]+)|([\d.]+) to ([\d.]+)", row["goal"])
    if not found:
        return ""
    sign, bound, low, high = found.groups()
    value = float(row["value"])
    if sign:
        low, high = (bound, math.inf) if sign == ">=" else (-math.inf, bound)
    return "met" if float(low) <= value <= float(high) else "missed"


def rivals(baselines: pd.DataFrame) -> Table:
    """The simpler rules: one line for each, shares in per cent with intervals."""
    header = ["rule", *(title.split(" ", 1)[1].lower() for *_, title, _ in PANELS), "remarks"]
    cells = {(r["rule"], r["measure"], r["group"]): r for r in baselines.to_dict("records")}
    rows = []
    for rule, name in RULES.items():
        own = [cells.get((rule, measure, group)) for measure, group, *_ in PANELS]
        if any(own):
            note = next(r["note"] for r in own if r)
            rows.append([name, *(_percent(r) for r in own), note])
    return Table(header, rows)


def _percent(row):
    if row is None:
        return "–"
    value, low, high = (100.0 * float(row[key] or "nan") for key in ("value", "low", "high"))
    interval = "" if math.isnan(low) else f" ({low:.1f} to {high:.1f})"
    return f"{value:.1f} %{interval}, {row['count']} cases"


def markdown(study: Study) -> str:
    """The part of docs/study.md that is made: tables and pictures, with a sentence each."""
    met, missed = study.goals
    parts = [
        f"{study.cases} records. Of {met + missed} goals set beforehand {met} are met, {missed} "
        "missed; the hidden effects were made apart from the engine (95 % intervals; what an ideal rule "
        "reaches beside):",
        results(study.summary).markdown,
        HELD_OUT,
        f"![Share of right names against the strength of what is hidden]({PICTURE.format('accuracy')})",
        "What is taken for what, and whether stated probabilities come true: "
        "[figures/README.md](../figures/README.md).",
    ]
    if study.baselines is not None:
        parts += [
            "The same records given to simpler rules (shares in per cent, 95 % intervals):",
            rivals(study.baselines).markdown,
        ]
    if study.resolved is not None:
        parts += [
            "Records of which several effects were left (of a part of the study), taken together with one "
            "more run, the one that the verdict proposes or one drawn from all that it could propose:",
            followed(study.resolved).markdown,
        ]
    return "\n\n".join(parts)


def publish(folder, page_path, kept_folder) -> None:
    """Copy a study's tables to their place in git and renew their page.

    Raises:
        InputError: where a table is missing or has other columns, or the page lacks the markers; nothing
            is written then.
    """
    folder, kept_folder = Path(folder), Path(kept_folder)
    texts = {name: read_text(folder / f"{name}.csv") for name in KEPT}
    texts |= {n: read_text(folder / f"{n}.csv") for n in ALSO_KEPT if (folder / f"{n}.csv").exists()}
    renewed = with_study(read_text(page_path), markdown(read(folder)))
    for name in (*KEPT, *ALSO_KEPT):
        path = kept_folder / f"{name}.csv"
        if name in texts:
            with replacing(path) as stream:
                stream.write(texts[name])
        else:
            path.unlink(missing_ok=True)
    with replacing(page_path) as stream:
        stream.write(renewed)


def with_study(page: str, text: str) -> str:
    """The page with the text between the study's markers replaced; InputError without markers."""
    if BEGIN not in page or END not in page:
        raise InputError(
            f"docs/study.md: the markers are missing; put {BEGIN} and {END} around the study's table"
        )
    before, rest = page.split(BEGIN, 1)
    return f"{before}{BEGIN}\n{text.strip()}\n{END}{rest.split(END, 1)[1]}"
