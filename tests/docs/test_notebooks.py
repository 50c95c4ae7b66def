"""The notebooks in docs/ run as they stand, print what they show, and have a picture."""

import contextlib
import io
import json

import pytest
from matplotlib import pyplot

NAMES = ("fig3a", "verdict", "dimer")


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_prints_what_it_shows(name, pytestconfig, monkeypatch):
    """Code cells, one after the other in one scope, from the folder that they stand in."""
    folder = pytestconfig.rootpath / "docs"
    book = json.loads((folder / f"{name}.ipynb").read_text(encoding="utf-8"))
    monkeypatch.chdir(folder)
    scope: dict = {}
    pyplot.close("all")
    for cell in (c for c in book["cells"] if c["cell_type"] == "code"):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            exec(compile("".join(cell["source"]), name, "exec"), scope)
        shown = "".join(line for output in cell["outputs"] for line in output.get("text", ()))
        assert said.getvalue() == shown
    pictures = [
        output
        for c in book["cells"]
        for output in c.get("outputs", ())
        if "image/png" in output.get("data", ())
    ]
    assert len(pictures) == len(pyplot.get_fignums()) == 1
    pyplot.close("all")


def test_every_notebook_is_linked(pytestconfig):
    page = (pytestconfig.rootpath / "docs/notebooks.md").read_text(encoding="utf-8")
    found = {path.stem for path in (pytestconfig.rootpath / "docs").glob("*.ipynb")}
    assert found == set(NAMES)
    assert all(f"]({name}.ipynb)" in page for name in NAMES)
