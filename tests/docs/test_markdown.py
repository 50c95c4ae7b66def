"""Tables of the pages can be read: docs/tables.css keeps right-aligned cells on one line."""

import re

# Letters that a cell on one line may have, lest the other columns are left with a word a line.
WIDEST = 60


def cells(path):
    """Alignment and text of each cell of the tables of a page."""
    aligned = None
    for line in path.read_text(encoding="utf-8").splitlines():
        row = [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip())[1:-1]]
        if not row:
            aligned = None
        elif all(re.fullmatch(r":?-+:?", cell) for cell in row):
            aligned = row
        elif aligned:
            yield from zip(aligned, row, strict=True)


def test_cells_that_stay_on_one_line_are_short(pytestconfig):
    pages = sorted((pytestconfig.rootpath / "docs").glob("*.md"))
    found = [(p.name, text) for p in pages for to, text in cells(p) if to.endswith(":")]
    # Every page with a column to the right is looked at, or what follows would hold of nothing.
    right = {p.name for p in pages if re.search(r"^\|.*-:", p.read_text(encoding="utf-8"), re.M)}
    assert right
    assert {name for name, _ in found} == right
    assert [one for one in found if len(one[1]) > WIDEST] == []


def test_cells_are_read_with_the_side_that_they_stand_on(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("| a | b |\n| --- | ---: |\n| x \\| y | 1 |\n| z | 2 |\n\n| none | here |\n")
    assert list(cells(page)) == [("---", "x \\| y"), ("---:", "1"), ("---", "z"), ("---:", "2")]


def test_what_stands_within_a_list_is_indented_by_four(pytestconfig):
    # By less, Python-Markdown ends the list there and runs the next item into the paragraph.
    for page in sorted((pytestconfig.rootpath / "docs").glob("*.md")):
        text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        assert re.findall(r"^\n {1,3}\S.*", text, re.M) == [], page.name
