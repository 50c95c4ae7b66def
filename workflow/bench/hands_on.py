"""The tables of docs/hands-on.md, from what `starts.py`, `ten_minutes.py`, `long_records.py` and `pages.py`
measured.

`python workflow/bench/hands_on.py` renews the page from the tables kept beside the ledger.
"""

import argparse
import csv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "workflow/resources/reference"
PAGE = ROOT / "docs/hands-on.md"
# Name of the table → its columns → their heads.
HEADS = {
    "ten_minutes": {
        "layout": "layout",
        "list_s": "`--list`, s",
        "import_s": "import, s",
        "check_s": "check, s",
        "discover_s": "discover, s",
        "named": "named",
        "told_besides": "told besides",
    },
    "starts": {
        "verb": "verb",
        "help_s": "`--help`, s",
        "begun_s": "until its input is read, s",
        "load_s": "loading in all, s",
        "kernels_s": "kernels, s",
        "run_s": "run, s",
    },
    "pages": {
        "page": "page",
        "kB": "kB",
        "at 1300": "at 1300",
        "all unfolded": "all unfolded",
        "at 900": "at 900",
        "at 400": "at 400",
        "A4 pages": "A4 pages",
    },
    "long_records": {
        "samples": "samples of a run",
        "reading_s": "reading, s",
        "search_s": "search, s",
        "memory_MB": "memory, MB",
        "named": "named",
    },
}


def table(name: str) -> str:
    """One table as Markdown; seconds stand right."""
    heads = HEADS[name]
    with open(KEPT / f"{name}.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    numbers = name == "pages"
    rule = ["---:" if c.endswith("_s") or (numbers and c != "page") else "---" for c in heads]
    cells = [[_cell(column, row[column]) for column in heads] for row in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in [list(heads.values()), rule, *cells])


def _cell(column, text):
    return f"`{text}`" if column == "told_besides" and text else text or "–"


def renewed(text: str) -> str:
    """The page with its tables as measured."""
    for name in HEADS:
        first, last = f"<!-- {name}: made by workflow/bench/hands_on.py -->\n", f"\n<!-- end of {name} -->"
        start, end = text.index(first) + len(first), text.index(last)
        text = text[:start] + table(name) + text[end:]
    return text


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.parse_args()
    PAGE.write_text(renewed(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
