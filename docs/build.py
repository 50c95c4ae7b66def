"""What `make docs` adds to the pages that stand here: gallery of effects, ledger, committed figures.

Hooks of MkDocs. The gallery is simulated: a chain of twelve steel beads without and with each effect,
written as CSV and drawn from it.
"""

import csv
import tempfile
from pathlib import Path

from mkdocs.structure.files import File

from sonicvacuum.figures import gallery

ROOT = Path(__file__).resolve().parents[1]
_DRAWN = Path(tempfile.mkdtemp(prefix="gallery-"))


def on_files(files, config):
    """The pages and pictures that are made."""
    for name in gallery.write(_DRAWN):
        for kind in ("csv", "svg"):
            path = _DRAWN / f"{name}.{kind}"
            files.append(File.generated(config, f"gallery/{name}.{kind}", abs_src_path=str(path)))
    for path in sorted((ROOT / "figures").glob("*.png")):
        files.append(File.generated(config, f"figures/{path.name}", abs_src_path=str(path)))
    files.append(File.generated(config, "effects.md", content=gallery.page("gallery")))
    files.append(File.generated(config, "ledger.md", content=_ledger()))
    return files


def on_page_markdown(markdown, page, config, files):
    """Links to the committed figures as they are on the site; their guide is only named."""
    return markdown.replace("[figures/README.md](../figures/README.md)", "`figures/README.md`").replace(
        "](../figures/", "](figures/"
    )


def _ledger():
    """Every statement of the paper and what became of it."""
    with open(ROOT / "workflow/resources/reference/ledger.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    head = "# Ledger of claims\n\nEvery checkable statement of the paper, held against the simulation.\n\n"
    lines = ["| claim | where | verdict | why |", "|---|---|---|---|"]
    for row in rows:
        cells = (f"`{row['claim']}`", row["section"], row["verdict"], row["reason"])
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return head + "\n".join(lines) + "\n"
