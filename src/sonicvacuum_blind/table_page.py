"""A table of counted shares within the page of docs/ that tells of it."""

import math
from collections.abc import Iterable
from pathlib import Path

from sonicvacuum.files import InputError, read_text, replacing
from sonicvacuum_blind.score import SummaryLine

BEGIN, END = "<!-- table -->", "<!-- end of table -->"
HEAD = "| asked | of | records | value | 95 % | goal |\n| --- | --- | ---: | ---: | ---: | --- |"


def table(lines: Iterable[SummaryLine]) -> str:
    """Markdown of all lines that some record stands behind."""
    return "\n".join([HEAD, *(_format(line) for line in lines if line.count)])


def _format(line):
    goal = line.goal.replace(">=", "≥").replace("<=", "≤")
    between = "" if math.isnan(line.low) else f"{line.low:.3g} to {line.high:.3g}"
    return f"| {line.measure} | {line.group} | {line.count} | {line.value:.3g} | {between} | {goal} |"


def around(page) -> tuple[str, str]:
    """What stands before the page's table, and behind it.

    Raises:
        InputError: where the page does not say where its table stands.
    """
    text = read_text(page)
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(END) < text.index(BEGIN):
        raise InputError(f"{page}: write {BEGIN} and after it {END}, once each, on lines of their own")
    return text.split(BEGIN)[0], text.split(END)[1]


def write(lines: Iterable[SummaryLine], page) -> None:
    """The page (Markdown) with its table replaced, all else as it is; InputError as from `around`."""
    before, after = around(page)
    with replacing(Path(page)) as out:
        out.write(f"{before}{BEGIN}\n{table(lines)}\n{END}{after}")
