"""No truth of a blind case reaches its verdict, which is the same with the truth next door or without."""

import json
import os
import subprocess
import sys

import pytest
from ball import RECORD

TRUTH = {"id": "case", "kind": "single", "effects": ["hunt-crossley"], "hidden": []}


def sandbox(folder, truth):
    """A folder that holds the record, and its truth next door if wanted, readable by nobody."""
    (folder / "records/case").mkdir(parents=True)
    (folder / "records/case/record.yaml").write_text(RECORD)
    if truth:
        (folder / "truth/case").mkdir(parents=True)
        (folder / "truth/case/truth.json").write_text(json.dumps(TRUTH))
        os.chmod(folder / "truth/case/truth.json", 0)
    return folder


def discovered(folder):
    """The verdict, but for the time it took; the command knows nothing but the folder it runs in."""
    call = [sys.executable, "-c", "from sonicvacuum.cli import main; main()"]
    call += ["discover", "records/case", "--out", "found", "--no-figures"]
    done = subprocess.run(call, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    verdict = json.loads((folder / "found/verdict.json").read_text())
    return {key: value for key, value in verdict.items() if key != "timing_s"}


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The verdict where there is no truth anywhere near."""
    folder = sandbox(tmp_path_factory.mktemp("alone"), truth=False)
    verdict = discovered(folder)
    assert {path.name for path in folder.iterdir()} == {"records", "found"}
    return verdict


def test_the_verdict_is_the_same_with_the_truth_next_door(alone, tmp_path):
    assert discovered(sandbox(tmp_path, truth=True)) == alone


def test_the_verdict_depends_on_the_record(alone, tmp_path):
    folder = sandbox(tmp_path, truth=False)
    (folder / "records/case/record.yaml").write_text(RECORD.replace("value: 0.99", "value: 0.995"))
    assert discovered(folder) != alone
