"""The blind study as README and report show it, and what of it is kept in git.

Tables come from `sonicvacuum score` (summary.csv) and `sonicvacuum baselines` (baselines.csv); both are
rendered as Markdown and as HTML from the same cells.
"""

import math
import re
from dataclasses import fields
from html import escape
from pathlib import Path

import pandas as pd

from sonicvacuum.baselines.names import PANELS, RULES
from sonicvacuum.baselines.table import Line as Baseline
from sonicvacuum.blind.score import Line
from sonicvacuum.files import InputError, read_text, replacing
from sonicvacuum.report import tables

SUMMARY = [f.name for f in fields(Line)]
BASELINES = [f.name for f in fields(Baseline)]
BEGIN = "<!-- study: made by `snakemake publish_study`, do not edit -->"
END = "<!-- end of study -->"
REFERENCE = ("blind_full.csv", "blind_full_baselines.csv")

Table = tuple[list[str], list[list[str]]]


def results(summary: pd.DataFrame) -> Table:
    """Header and cells of what was asked and found; lines without cases are left out."""
    header = ["asked", "of", "cases", "found", "95 %", "ideal rule", "goal", ""]
    rows = [_result(row) for row in summary.to_dict("records") if row["count"] not in ("", "0")]
    return header, rows


def _result(row):
    found, low, high, ideal = (tables.number(row[key], 3) for key in ("value", "low", "high", "ideal"))
    interval = f"{low} to {high}" if low else ""
    goal = row["goal"].replace("<=", "≤").replace(">=", "≥")
    return [row["measure"], row["group"], row["count"], found, interval, ideal, goal, reached(row)]


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
    """Header and cells of the simpler rules: one line for each rule, shares in per cent with intervals."""
    header = ["rule", *(title.split(" ", 1)[1].lower() for *_, title, _ in PANELS), "remarks"]
    cells = {(r["rule"], r["measure"], r["group"]): r for r in baselines.to_dict("records")}
    rows = []
    for rule, name in RULES.items():
        own = [cells.get((rule, measure, group)) for measure, group, *_ in PANELS]
        if any(own):
            note = next(r["note"] for r in own if r)
            rows.append([name, *(_percent(r) for r in own), note])
    return header, rows


def _percent(row):
    if row is None:
        return "–"
    value, low, high = (100.0 * float(row[key] or "nan") for key in ("value", "low", "high"))
    interval = "" if math.isnan(low) else f" ({low:.1f} to {high:.1f})"
    return f"{value:.1f} %{interval}, {row['count']} cases"


def as_markdown(table: Table) -> str:
    """A table in Markdown."""
    header, rows = table
    lines = [header, ["---"] * len(header), *([c.replace("|", "\\|") for c in row] for row in rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def as_html(table: Table) -> str:
    """A table in HTML, every cell escaped."""
    header, rows = table
    head = "".join(f"<th>{escape(c)}</th>" for c in header)
    body = "\n".join("<tr>" + "".join(f"<td>{escape(c)}</td>" for c in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead>\n<tbody>{body}</tbody></table>"


def markdown(summary: pd.DataFrame, baselines: pd.DataFrame) -> str:
    """Both tables with a sentence each."""
    table = results(summary)
    met, missed = (sum(row[-1] == word for row in table[1]) for word in ("met", "missed"))
    return "\n\n".join(
        (
            f"{cases(summary)} records. Of {met + missed} goals set beforehand {met} are met, {missed} "
            "missed; the hidden effects were made apart from the engine (95 % intervals; what an ideal rule "
            "reaches beside):",
            as_markdown(table),
            "The same records given to simpler rules (shares in per cent, 95 % intervals):",
            as_markdown(rivals(baselines)),
        )
    )


def cases(summary: pd.DataFrame) -> int:
    """Number of records of a study: every one has been timed."""
    timed = (summary["measure"] == "seconds per record") & summary["group"].str.endswith("median")
    return int(summary.loc[timed, "count"].astype(int).sum())


def html(summary: pd.DataFrame, baselines: pd.DataFrame) -> str:
    """Both tables one after the other."""
    return f"{as_html(results(summary))}\n{as_html(rivals(baselines))}"


def read(summary_path, baselines_path) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Both tables; InputError for other columns."""
    return tables.read(summary_path, SUMMARY), tables.read(baselines_path, BASELINES)


def publish(summary_path, baselines_path, readme_path, reference_folder) -> None:
    """Copy both tables to their place in git and renew the README's part.

    Raises:
        InputError: where a table has other columns or the README lacks the markers; nothing is written then.
    """
    text = markdown(*read(summary_path, baselines_path))
    renewed = with_study(read_text(readme_path), text)
    for source, name in zip((summary_path, baselines_path), REFERENCE, strict=True):
        with replacing(Path(reference_folder) / name) as stream:
            stream.write(read_text(source))
    with replacing(readme_path) as stream:
        stream.write(renewed)


def with_study(readme: str, text: str) -> str:
    """The README with the text between the study's markers replaced; InputError without markers."""
    if BEGIN not in readme or END not in readme:
        raise InputError(
            f"README.md: the markers are missing; put {BEGIN} and {END} around the study's table"
        )
    before, rest = readme.split(BEGIN, 1)
    return f"{before}{BEGIN}\n{text.strip()}\n{END}{rest.split(END, 1)[1]}"
