"""The library alone, with no more than its own dependencies: discover works, the rest says what it needs."""

import subprocess
import sys

import pytest
from ball import RECORD

# Stands in for an environment without these packages: they cannot be found.
BARE = """
import sys

class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {"matplotlib", "pandas", "snakemake", "grimp", "sklearn", "pysindy"}:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name.partition(".")[0])

sys.meta_path.insert(0, Missing())
from sonicvacuum.cli import main
main()
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "ball").mkdir()
    (tmp_path / "ball/record.yaml").write_text(RECORD)
    return tmp_path


def bare(folder, *arguments):
    """The finished process of a call of the command."""
    command = [sys.executable, "-c", BARE, *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def test_discover_and_its_page_need_neither_matplotlib_nor_workflow(folder):
    done = bare(folder, "discover", "ball", "--out", "found")
    assert done.returncode == 0, done.stderr
    assert {"verdict.json", "index.html", "candidates.svg"} <= {p.name for p in (folder / "found").iterdir()}
    refused = bare(folder, "page", "--png", "found")
    assert refused.returncode == 2
    assert "matplotlib is not installed" in refused.stderr
    assert "sonicvacuum[figures]" in refused.stderr
    assert not list((folder / "found").glob("*.png"))


def test_tables_of_the_reproduction_name_their_extra(folder):
    (folder / "benchmarks").mkdir()
    done = bare(folder, "paper", "timings", "benchmarks", "--out", "times.csv")
    assert done.returncode == 2
    assert "sonicvacuum[workflow]" in done.stderr
