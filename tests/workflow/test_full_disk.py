"""A disk that takes no more: one sentence, exit code 1, and what stood there before is whole.

The disk is played by the largest size that a file may have, which each verb exceeds at its first bytes.
"""

import resource
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from ball import RECORD
from test_command_line import CONFIG, call

MOST = 8  # bytes
CHAIN = ["--beads", "8", "--diameter", "5mm", "--material", "bearing-steel", "--speed", "0.5"]
ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests/fuzz"))

from tables import Tables  # noqa: E402

EXAMPLE = ROOT / "docs/example"
FULL = ROOT / "workflow/resources/reference/blind_full"
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
    "paper ledger": f"paper ledger t/metrics.csv --claims t/claims.csv --config {ROOT}/config.yaml "
    "--uncertainty t/probable.csv --out ledger.csv",
    "paper audit": f"paper audit t/metrics.csv --assumptions t/assumptions.csv --config {ROOT}/config.yaml "
    "--out audit.csv",
    "paper runs": "paper runs small.nominal.json --histories histories --metrics metrics.csv --out runs.html",
    "paper timings": "paper timings benchmarks --out timings.csv",
    "paper report": "paper report --ledger ledger.csv --assumptions audit.csv --metrics t/metrics.csv "
    "--claims t/claims.csv --out report.html",
    "paper publish": "paper publish --ledger ledger.csv --claims t/claims.csv --readme t/README.md "
    "--guide guide.md --reference kept.csv --study t/score.csv --naming naming.csv",
    "blind hide": "blind hide --study small --list cases.csv",
    "blind score": "blind score --truth t/truth --verdicts t/verdict --out scores.csv --summary summary.csv "
    "--tables scored",
    "blind draw": "blind draw scored --picture confusion --out pictures",
    "blind page": f"blind page --full {FULL} --out blind.html",
    "blind publish": f"blind publish {FULL} --page t/study.md --keep kept",
    "design": f"design --effects kuwabara-kono,gravity {' '.join(CHAIN)} --most 1 --out design.svg",
    "export": "export --law hunt-crossley --damping_s_per_m 0.1 --mass_g 4 --diameter_mm 10 --material brass "
    "--speeds 0.5 2 --to lammps --out law.txt",
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
    Tables(folder / "t")
    shutil.copy(ROOT / "docs/study.md", folder / "t")
    for name in ("histories", "benchmarks/rule"):
        (folder / name).mkdir(parents=True)
    (folder / "benchmarks/rule/job.tsv").write_text("s\tmax_rss\tcpu_time\n1.0\t10.0\t1.0\n")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for line in CALLS.values():
            assert call(patch, *line.format("").split()) == 0, line
            if line.startswith("simulate"):
                shutil.copy("history.npz", "histories/small.nominal.npz")
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
    assert ".partial" not in told  # of no file that the user would look for
    assert snapshot(made) == before


def test_a_place_that_cannot_be_written_is_the_callers_fault(made, monkeypatch, capsys):
    monkeypatch.chdir(made)
    assert call(monkeypatch, *CALLS["card"].replace("small.nominal.json", "config.yaml/x.json").split()) == 2
    assert capsys.readouterr().err.startswith("Error: config.yaml")


def test_a_full_standard_output_is_told():
    run = [sys.executable, "-c", "from sonicvacuum.cli import main; main()", "materials"]
    with open("/dev/full", "w") as full:
        done = subprocess.run(run, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 1
    assert done.stderr.startswith("Error: ") and done.stderr.count("\n") == 1
