"""The workflow where Snakemake alone is installed: it lints, and a run says what is missing."""

import os
import subprocess
import sys

import pytest


@pytest.fixture
def alone(tmp_path, pytestconfig):
    """Call of snakemake in the project's root, where neither library nor engine are installed."""
    (tmp_path / "sitecustomize.py").write_text(
        "import sys\n"
        "for name in 'sonicvacuum sonicvacuum_paper sonicvacuum_blind msgspec grimp numba'.split():\n"
        "    sys.modules[name] = None\n"
    )
    command = [sys.executable, "-m", "snakemake", "--cores", "1"]
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    return lambda *arguments: subprocess.run(
        [*command, *arguments],
        cwd=pytestconfig.rootpath,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def test_the_lint_passes_where_only_snakemake_is_installed(alone):
    """As the workflow catalogue runs it."""
    done = alone("--lint")
    assert done.returncode == 0, done.stdout
    assert "good condition" in done.stdout


def test_without_the_library_a_run_says_how_to_install_it(alone):
    done = alone("--dry-run", "results/ledger.csv")
    assert done.returncode != 0
    assert "has no package sonicvacuum: run `make` in" in done.stdout
