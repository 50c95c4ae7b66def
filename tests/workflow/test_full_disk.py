"""A disk that takes no more: one sentence, exit code 1, and what stood there before is whole.

The disk is played by the largest size that a file may have, which each verb exceeds at its first bytes.
"""

import os
import resource
import subprocess
import sys

import pytest
from ball import RECORD
from test_command_line import CONFIG, call

MOST = 8  # bytes
CHAIN = ["--beads", "8", "--diameter", "5mm", "--material", "bearing-steel", "--speed", "0.5"]
EXAMPLE = os.path.join(os.path.dirname(__file__), "../../docs/example")
# Verb → its call, in a folder where all of them have run once, in this order.
CALLS = {
    "card": "card --case small --out small.nominal.json",
    "schema": "schema --out schema.json",
    "simulate": "simulate small.nominal.json --out history.npz",
    "predict": f"predict {' '.join(CHAIN)} --gauges 3,wall --out shown.svg",
    "record new": "record new fresh{}",
    "record import": f"record import {EXAMPLE}/shot1.csv --record {EXAMPLE}/chain.yaml --impact-at 0us "
    "--channel CH1=g5 --channel CH2=g11 --channel CH3=wall --scale g5=25N/V --scale g11=25N/V "
    "--scale wall=50N/V --out scope{}",
    "discover": "discover ball --out found --threads 1 --no-figures --quiet",
    "page": "page found",
    "compare": "compare ball --model found/model.json --json score.json",
    "paper observe": "paper observe small.nominal.json history.npz --signals signals.csv --metrics one.csv",
    "paper metrics": "paper metrics one.csv --config config.yaml --out metrics.csv",
    "paper animate": "paper animate solitary --out wave.svg",
    "blind hide": "blind hide --study small --list cases.csv",
}


def snapshot(folder):
    """File → content of all below a folder."""
    return {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder in which every verb has written once."""
    folder = tmp_path_factory.mktemp("full")
    (folder / "config.yaml").write_text(CONFIG)
    (folder / "ball").mkdir()
    (folder / "ball/record.yaml").write_text(RECORD)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for line in CALLS.values():
            assert call(patch, *line.format("").split()) == 0, line
    return folder


@pytest.mark.parametrize("verb", CALLS)
def test_what_stood_there_is_whole(made, monkeypatch, capsys, verb):
    monkeypatch.chdir(made)
    before, limits = snapshot(made), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (MOST, limits[1]))
    try:
        code = call(monkeypatch, *CALLS[verb].format("-again").split())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    told = capsys.readouterr().err.strip()
    assert code == 1
    assert told.startswith("Error: ") and "\n" not in told
    assert snapshot(made) == before


def test_a_place_that_cannot_be_written_is_the_callers_fault(made, monkeypatch, capsys):
    monkeypatch.chdir(made)
    assert call(monkeypatch, *CALLS["card"].replace("small.nominal.json", "config.yaml/x.json").split()) == 2
    assert capsys.readouterr().err.startswith("Error: config.yaml")


def test_a_full_standard_output_is_told(made):
    run = [sys.executable, "-c", "from sonicvacuum.cli import main; main()", "materials"]
    with open("/dev/full", "w") as full:
        done = subprocess.run(run, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 1
    assert done.stderr.startswith("Error: ") and done.stderr.count("\n") == 1
