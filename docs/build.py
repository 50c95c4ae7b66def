"""What `make docs` adds to the pages that stand here: gallery of effects, ledger, committed figures, and the
notebooks as pages.

Hooks of MkDocs. The gallery is simulated: a chain of twelve steel beads without and with each effect,
written as CSV and drawn from it.
"""

import base64
import csv
import json
import tempfile
from pathlib import Path

from mkdocs.structure.files import File

from sonicvacuum.figures import gallery
from sonicvacuum.report.inline import formula

ROOT = Path(__file__).resolve().parents[1]
_DRAWN = Path(tempfile.mkdtemp(prefix="gallery-"))
REPOSITORY = "repository:"
LEDGER = """# Ledger of claims

Every checkable statement of the paper (C. Daraio and V. F. Nesterenko, 2006), held against the simulation.
The coating is taken as it is printed, a bonded layer of 50 µm and 2.76 GPa without losses, and nothing is
fitted: this model decides the verdict. What other models give for each statement stands in
`workflow/resources/reference/ledger.csv`; how each is tested, and where its error comes from, in
`workflow/resources/claims.csv` and `claims.md`.

* **reproduced**: within two standard errors of what is printed, or within the bound that it states.
* **disagrees**: further off than that.
* **outside the model**: only a model with a loss can show it.
* **inconsistent in the paper**: printed numbers or labels contradict one another, or geometry.
* **not testable**: what it would take is not printed.

σ is one standard error of the paper's value; a difference counted in it stands in the last column, as in
(+0.58 σ).

"""


def on_files(files, config):
    """The pages and pictures that are made."""
    for name in gallery.write(_DRAWN):
        for kind in ("csv", "svg"):
            path = _DRAWN / f"{name}.{kind}"
            files.append(File.generated(config, f"gallery/{name}.{kind}", abs_src_path=str(path)))
    for path in sorted((ROOT / "figures").glob("*.png")):
        files.append(File.generated(config, f"figures/{path.name}", abs_src_path=str(path)))
    files.append(File.generated(config, "effects.md", content=gallery.page("gallery", formula)))
    files.append(File.generated(config, "ledger.md", content=_ledger()))
    for path in sorted((ROOT / "docs").glob("*.ipynb")):
        text, pictures = _notebook(path)
        files.append(File.generated(config, f"{path.stem}.md", content=text))
        for name, picture in pictures.items():
            files.append(File.generated(config, name, content=picture))
    return files


def on_page_markdown(markdown, page, config, files):
    """Links as they are on the site: to committed figures, whose guide is only named, to notebooks, and to
    files of the repository, which stand two folders above the site. Effects and ledger have pages there that
    the repository has not.
    """
    for written, there in (
        (
            "[Effects](../src/sonicvacuum/effects) (one file each; `make docs` makes a page of them)",
            "[Effects](effects.md)",
        ),
        (
            "[Ledger](../workflow/resources/reference/ledger.csv) (a table; `make docs` makes a page of it)",
            "[Ledger](ledger.md)",
        ),
        ("[figures/README.md](../figures/README.md)", "`figures/README.md`"),
        ("[docs/example](example/README.md)", "`docs/example`"),
        ("](../figures/", "](figures/"),
        ("](../", f"]({REPOSITORY}"),
        (".ipynb)", ".md)"),
    ):
        markdown = markdown.replace(written, there)
    return markdown


def on_page_content(html, page, config, files):
    """Links to files of the repository, none of the site: only now, so that all others are checked."""
    return html.replace(f'href="{REPOSITORY}', 'href="../../').replace(f'src="{REPOSITORY}', 'src="../../')


def _notebook(path):
    """A notebook with what it printed and drew, as Markdown, and its pictures: place → PNG."""
    parts, pictures = [], {}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"])
        parts.append(source if cell["cell_type"] == "markdown" else f"```python\n{source}\n```")
        for output in cell.get("outputs", ()):
            if "text" in output:
                parts.append(f"```text\n{''.join(output['text'])}```")
            elif "image/png" in output.get("data", {}):
                name = f"notebooks/{path.stem}-{len(pictures)}.png"
                pictures[name] = base64.b64decode(output["data"]["image/png"])
                parts.append(f"![What the cell draws]({name})")
    return "\n\n".join(parts) + "\n", pictures


def _ledger():
    """Every statement of the paper and what became of it."""
    resources = ROOT / "workflow/resources"
    stated = {row["claim"]: row["statement"] for row in _rows(resources / "claims.csv")}
    lines = ["| statement | where | verdict | why |", "|---|---|---|---|"]
    for row in _rows(resources / "reference/ledger.csv"):
        statement = f"{stated[row['claim']]} (`{row['claim']}`)"
        cells = (statement, row["section"], row["verdict"], row["reason"])
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return LEDGER + "\n".join(lines) + "\n"


def _rows(path):
    """Rows of a table."""
    with open(path, encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))
