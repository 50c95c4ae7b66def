"""After a run that was killed, or ran out of disk, `make` finds its own way back to the same bytes.

A short version of `make crash`, which disturbs 60 runs at random moments.
"""

import os
import subprocess
import sys
import time

import pytest

sys.path.insert(0, f"{os.path.dirname(__file__)}/../../workflow/scripts")

import crash
import start

TARGET = "results/cards/coated.soft.json"


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of an undisturbed run."""
    folder = crash.project(tmp_path_factory.mktemp("crash") / "whole")
    run = crash.Run(folder, TARGET)
    assert run.end() == 0, run.log.read_text()
    assert crash.products(folder) == {TARGET}
    return folder


def test_a_killed_run_needs_no_cure_by_hand(whole, tmp_path):
    folder = crash.project(tmp_path / "killed")
    run = crash.Run(folder, TARGET)
    while not list((folder / ".snakemake/locks").glob("*.lock")):
        assert run.process.poll() is None
        time.sleep(0.01)
    run.disturb("group")
    assert run.end() < 0
    again = crash.Run(folder, TARGET)
    assert again.end() == 0, again.log.read_text()
    assert "An earlier run was killed: removing its lock" in again.log.read_text()
    assert (folder / TARGET).read_bytes() == (whole / TARGET).read_bytes()


def test_a_full_disk_leaves_nothing_that_passes_for_a_product(whole, tmp_path):
    # 64 bytes hold the locks, and neither a card nor the record of a finished job.
    row = crash.attempt(tmp_path / "full", TARGET, "disk", 0.0, 64, whole)
    assert row["disturbed_exit"] > 0
    assert (row["recovered_exit"], row["same_bytes"], row["idle_then"]) == (0, True, True)


@pytest.fixture
def locked(tmp_path):
    """A folder that a Snakemake has locked."""
    (tmp_path / ".snakemake/locks").mkdir(parents=True)
    (tmp_path / ".snakemake/locks/0.output.lock").write_text(f"{TARGET}\n")
    return tmp_path.resolve()


def asleep(folder, *words, **environment):
    """A process in a folder, with further words in its command line."""
    command = [sys.executable, "-c", "print(flush=True); import time; time.sleep(60)", *words]
    process = subprocess.Popen(
        command, cwd=folder, env=os.environ | environment, stdout=subprocess.PIPE, text=True
    )
    process.stdout.readline()
    return process


def test_a_snakemake_at_work_keeps_its_lock(locked):
    process = asleep(locked, "snakemake")
    try:
        with pytest.raises(SystemExit, match=rf"Snakemake \(process {process.pid}\) is at work here"):
            start.clear(locked)
    finally:
        process.kill()
        process.wait()
    assert list((locked / ".snakemake/locks").iterdir())
    start.clear(locked)
    assert not list((locked / ".snakemake/locks").iterdir())


def test_a_job_that_outlived_its_snakemake_is_ended_and_no_other(locked, tmp_path_factory):
    elsewhere = tmp_path_factory.mktemp("elsewhere").resolve()
    own, other = (asleep(locked, **{start.MARK: str(folder)}) for folder in (locked, elsewhere))
    try:
        assert start.orphans(locked) == [own.pid]
        start.end([own.pid])
        assert own.wait(timeout=10) < 0
        assert other.poll() is None
    finally:
        for process in (own, other):
            process.kill()
            process.wait()


def test_two_runs_never_work_in_one_folder(tmp_path):
    command = [sys.executable, start.__file__, "--version"]
    hold = (
        f"import sys; sys.path.insert(0, {os.path.dirname(start.__file__)!r}); import start, pathlib, time;"
    )
    hold += "start.hold(pathlib.Path.cwd()); print(flush=True); time.sleep(60)"
    first = subprocess.Popen([sys.executable, "-c", hold], cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    first.stdout.readline()
    second = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert second.returncode == 1
    assert "another `make` is at work here" in second.stderr
    first.kill()
    first.wait()
    assert subprocess.run(command, cwd=tmp_path, capture_output=True).returncode == 0
