"""The scripts that documentation tells to run say what they do, and refuse what they cannot take."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *ROOT.glob("docs/*.md"), *ROOT.glob("docs/*/*.md")]
TOLD = sorted(
    {
        script
        for page in PAGES
        for script in re.findall(r"python (workflow/\w+/\w+\.py)", page.read_text(encoding="utf-8"))
    }
)


def run(script, *words):
    return subprocess.run(
        [sys.executable, script, *words], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )


def test_documentation_tells_of_scripts():
    assert len(TOLD) > 5


@pytest.mark.parametrize("script", TOLD)
def test_a_script_says_what_it_does(script):
    done = run(script, "--help")
    assert done.returncode == 0, done.stderr
    first = (ROOT / script).read_text(encoding="utf-8").removeprefix('"""').split()[:3]
    assert done.stdout.startswith("usage: ")
    assert " ".join(first) in " ".join(done.stdout.split())


@pytest.mark.parametrize("script", TOLD)
def test_a_wrong_option_is_refused_before_anything_is_done(script):
    done = run(script, "--no-such-option")
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
