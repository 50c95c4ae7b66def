"""Records searched side by side: the same files as one by one, in their order, and a clean end."""

import json
import multiprocessing
import os
import signal
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from click.testing import CliRunner
from made_tables import ball

from sonicvacuum import records
from sonicvacuum.cli.discover import Failure, _attempt, discover
from sonicvacuum.cli.many import side_by_side
from sonicvacuum.discover import session
from sonicvacuum.files import InputError


def slow_square(x, wait):
    time.sleep(wait)
    return x * x


def refuse(x):
    raise InputError(f"number {x}: refused")


def killed(x):
    os.kill(os.getpid(), signal.SIGKILL)


def leave_a_file(folder, wait):
    (folder / "process").write_text(str(os.getpid()))
    (folder / "begun").touch()
    try:
        time.sleep(wait)
    finally:
        (folder / "ended").touch()


def put_away_slowly(folder, wait):
    (folder / "begun").touch()
    try:
        time.sleep(wait)
    finally:
        time.sleep(0.5)
        (folder / "ended").touch()


def wait_for(path, gone=False):
    """A process begins or ends within seconds on any machine; a minute tells that it never does."""
    for _ in range(600):
        if path.exists() != gone:
            return
        time.sleep(0.1)
    pytest.fail(f"{path}: never {'went' if gone else 'came'}")


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
    wait_for(folders[1] / "begun")
    found.close()
    wait_for(folders[1] / "ended")


def test_a_process_that_is_asked_twice_to_end_puts_all_away(tmp_path):
    found = side_by_side(put_away_slowly, [(tmp_path, 600.0)], 1)
    with ThreadPoolExecutor(1) as beside:
        result = beside.submit(next, found)
        wait_for(tmp_path / "begun")
        for process in multiprocessing.active_children() * 2:
            process.terminate()
            time.sleep(0.1)
        with pytest.raises(SystemExit):
            result.result()
    assert (tmp_path / "ended").exists()


def begin_and_wait(folder):
    list(side_by_side(leave_a_file, [(folder, 600.0)], 2))


def test_no_process_outlives_the_first_one_when_that_is_killed(tmp_path):
    first = multiprocessing.get_context("spawn").Process(target=begin_and_wait, args=(tmp_path,))
    first.start()
    wait_for(tmp_path / "begun")
    process = int((tmp_path / "process").read_text())
    first.kill()
    wait_for(tmp_path / "ended")
    wait_for(Path(f"/proc/{process}"), gone=True)


def test_records_side_by_side_give_the_files_of_one_at_a_time(empty, tmp_path):
    paths = []
    for name, record in (("table", ball()), ("traces", empty)):
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


@pytest.mark.parametrize(("error", "code"), [(InputError("no cure"), 2), (TypeError("no law"), 1)])
def test_one_search_that_fails_does_not_end_the_others(hidden, empty, tmp_path, monkeypatch, error, code):
    for name, record in (("damped", hidden), ("empty", empty)):
        records.write(record, tmp_path / name)
    whole, errors = session.discover, [error]

    def but_for_the_first(*given, **how):
        if errors:
            raise errors.pop()
        return whole(*given, **how)

    monkeypatch.setattr(session, "discover", but_for_the_first)
    paths, out = [str(tmp_path / name) for name in ("damped", "empty")], tmp_path / "found"
    asked = [*paths, "--out", str(out), "--no-figures", "--threads", "1"]
    result = CliRunner().invoke(discover, asked)
    assert result.exit_code == code
    assert f"Error: {paths[0]}: " in result.stderr
    assert str(error) in result.stderr
    assert ("Traceback" in result.stderr) == (code == 1)
    assert result.stderr.splitlines()[-1] == "Error: 1 of 2 searches failed, as told above"
    assert result.stdout.startswith(f"{paths[1]}: none")
    assert (out / "empty" / "verdict.json").is_file()
    assert not (out / "damped").exists()


def test_a_failure_in_a_process_of_its_own_comes_back_as_such():
    """A record that is none, which no user can give, is a fault of the program; no record is refused."""
    told = list(side_by_side(_attempt, [(given, "out", (), False, 1, True) for given in ((None,), ())], 2))
    assert [type(t) for t in told] == [Failure, Failure]
    assert "Traceback" in told[0].broken
    assert "give at least one" in told[1].error and not told[1].broken
