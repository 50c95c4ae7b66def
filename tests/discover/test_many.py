"""Records searched side by side: the same files as one by one, in their order, and a clean end."""

import json
import os
import signal
import time

import pytest
from click.testing import CliRunner

from sonicvacuum import records
from sonicvacuum.cli.discover import discover
from sonicvacuum.cli.many import side_by_side
from sonicvacuum.files import InputError


def slow_square(x, wait):
    time.sleep(wait)
    return x * x


def refuse(x):
    raise InputError(f"number {x}: refused")


def killed(x):
    os.kill(os.getpid(), signal.SIGKILL)


def leave_a_file(folder, wait):
    (folder / "begun").touch()
    try:
        time.sleep(wait)
    finally:
        (folder / "ended").touch()


def test_results_come_in_the_order_of_the_tasks():
    tasks = [(k, 0.3 - 0.1 * k) for k in range(3)]
    assert list(side_by_side(slow_square, tasks, 2)) == [0, 1, 4]


def test_what_a_call_raises_is_raised_after_the_results_before_it():
    found = side_by_side(refuse, [(7,)], 2)
    with pytest.raises(InputError, match="number 7"):
        next(found)


def test_a_process_that_is_killed_is_told_of_and_nothing_waits_for_it():
    with pytest.raises(InputError, match="want of memory"):
        list(side_by_side(killed, [(1,), (2,)], 2))


def test_who_stops_asking_ends_the_processes_and_lets_them_clean_up(tmp_path):
    folders = [tmp_path / "a", tmp_path / "b"]
    for folder in folders:
        folder.mkdir()
    found = side_by_side(leave_a_file, [(folders[0], 0.0), (folders[1], 600.0)], 2)
    next(found)
    while not (folders[1] / "begun").exists():
        time.sleep(0.05)
    found.close()
    for _ in range(200):  # ten seconds for a process to end
        if (folders[1] / "ended").exists():
            break
        time.sleep(0.05)
    assert (folders[1] / "ended").exists()


def test_records_side_by_side_give_the_files_of_one_at_a_time(hidden, empty, tmp_path):
    paths = []
    for name, record in (("damped", hidden), ("empty", empty)):
        records.write(record, tmp_path / name)
        paths.append(str(tmp_path / name))
    told = {}
    for threads in ("1", "2"):
        out = tmp_path / f"found{threads}"
        asked = [*paths, "--out", str(out), "--no-figures", "--threads", threads]
        result = CliRunner().invoke(discover, asked, catch_exceptions=False)
        assert result.exit_code == 0
        told[threads] = result.output.splitlines()
    assert told["1"] == told["2"]
    assert [line.split(":")[0] for line in told["1"]] == paths
    for one in sorted((tmp_path / "found1").rglob("*.*")):
        other = tmp_path / "found2" / one.relative_to(tmp_path / "found1")
        if one.name == "verdict.json":
            left, right = (json.loads(p.read_text()) | {"timing_s": 0} for p in (one, other))
            assert left == right
        elif one.is_file():
            assert one.read_bytes() == other.read_bytes()
