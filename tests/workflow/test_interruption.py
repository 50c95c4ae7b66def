"""An interruption ends a command soon, amid one long computation, and leaves nothing half-written."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from ball import RECORD
from msgspec.structs import replace

from sonicvacuum import card, config
from sonicvacuum.cli import ended
from sonicvacuum.cli.cards import read_card
from sonicvacuum.cli.simulate import _tell_beforehand
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.physics import watch

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "workflow/scripts"))

import interrupt  # noqa: E402

# What is promised is a second; on a busy machine it may be more, and what is interrupted would take hours.
PATIENCE = 120.0
MAIN = "import sys; from sonicvacuum.cli import main; sys.argv[0] = 'sonicvacuum'; main()"
# The same, making a file of its first argument once a simulation is told to have gone on.
TOLD = """
import pathlib, sys
from sonicvacuum.physics import watch
moving = pathlib.Path(sys.argv.pop(1))
with watch.told_to(lambda part: part > 0.0 and moving.touch()):
"""


# A search whose verdict takes for ever to be written, and whose putting away takes a moment.
WRITING = """
import pathlib, sys, time
from sonicvacuum.discover import session, written
begun = pathlib.Path(sys.argv.pop(1))

def write(result, folder):
    (folder / "verdict.json").write_text("half")
    begun.touch()
    try:
        time.sleep(600)
    finally:
        time.sleep(0.5)

session.discover, written.write = lambda *given, **how: None, write
"""


@pytest.fixture
def endless(tmp_path):
    """The file of a card whose simulation takes hours: three days of a chain."""
    path = ROOT / "config.yaml"
    resolved = config.card(config.read(path), "fig3b", "nominal", path)
    (tmp_path / "card.json").write_bytes(card.dump(replace(resolved, duration_s=3e5, interval_s=1e3)))
    return tmp_path / "card.json"


def heard():
    """Let a process hear interruptions as one that was started at a terminal."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def test_a_long_simulation_ends_soon_and_leaves_the_last_result(endless, tmp_path_factory):
    out, moving = endless.with_name("out.npz"), tmp_path_factory.mktemp("moving") / "moving"
    out.write_bytes(b"finished before")
    call = ["simulate", str(endless), "--no-limits", "--out", str(out)]
    command = [sys.executable, "-c", f"{TOLD}    {MAIN}", str(moving), *call]
    # Tests that a shell runs in the background inherit that interruptions are ignored.
    with subprocess.Popen(command, stderr=subprocess.PIPE, preexec_fn=heard) as running:
        try:
            late = time.monotonic() + PATIENCE
            while not moving.exists() and running.poll() is None and time.monotonic() < late:
                time.sleep(0.05)
            assert moving.exists()
            running.send_signal(signal.SIGINT)
            _, told = running.communicate(timeout=PATIENCE)
        finally:
            running.kill()
    assert running.returncode == 130
    assert b"Traceback" not in told
    assert out.read_bytes() == b"finished before"
    assert sorted(p.name for p in endless.parent.iterdir()) == ["card.json", "out.npz"]


@pytest.mark.parametrize(("sent", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_who_is_asked_to_end_while_writing_leaves_nothing_half_written(tmp_path, sent, code):
    (tmp_path / "ball").mkdir()
    (tmp_path / "ball/record.yaml").write_text(RECORD)
    (tmp_path / "out").mkdir()
    (tmp_path / "out/verdict.json").write_text("finished before")
    asked = ["discover", str(tmp_path / "ball"), "--out", str(tmp_path / "out"), "--threads", "1"]
    command = [sys.executable, "-c", f"{WRITING}\n{MAIN}", str(tmp_path / "begun"), *asked]
    with subprocess.Popen(command, stderr=subprocess.PIPE, start_new_session=True) as running:
        try:
            late = time.monotonic() + PATIENCE
            while not (tmp_path / "begun").exists() and running.poll() is None and time.monotonic() < late:
                time.sleep(0.05)
            assert (tmp_path / "begun").exists()
            for _ in range(3):  # as `timeout` does, which asks the command and then its group
                running.send_signal(sent)
                time.sleep(0.1)
            _, told = running.communicate(timeout=PATIENCE)
        finally:
            running.kill()
    assert running.returncode == code
    assert told.strip() == b""
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["verdict.json"]
    assert (tmp_path / "out/verdict.json").read_text() == "finished before"


def test_a_copy_that_is_asked_to_end_puts_nothing_of_the_first_one_away(tmp_path):
    with ended.heard() as came:
        copy = os.fork()
        if not copy:
            try:
                (tmp_path / "begun").touch()
                time.sleep(60.0)
            finally:
                (tmp_path / "put away").touch()
                os._exit(0)
        while not (tmp_path / "begun").exists():
            time.sleep(0.01)
        os.kill(copy, signal.SIGTERM)
        _, status = os.waitpid(copy, 0)
    assert os.waitstatus_to_exitcode(status) == 143
    assert not (tmp_path / "put away").exists()
    assert came == []


def test_what_is_ignored_stays_so_and_all_is_as_before_afterwards():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with ended.heard():
            assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
            assert signal.getsignal(signal.SIGTERM) not in (signal.SIG_DFL, signal.SIG_IGN)
        assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_second_request_interrupts_again_where_the_first_one_was_lost(monkeypatch):
    monkeypatch.setattr(ended, "GRACE", 0.05)
    with ended.heard() as came:
        for _ in range(2):
            with pytest.raises(KeyboardInterrupt):
                os.kill(os.getpid(), signal.SIGTERM)
                time.sleep(1.0)
            os.kill(os.getpid(), signal.SIGTERM)  # at once: passed over
            time.sleep(0.1)
    assert came == [signal.SIGTERM] * 2


def test_what_a_long_simulation_asks_for_is_told_beforehand(endless, capsys):
    long = read_card(endless)
    _tell_beforehand(long, CATALOGUE, limits=False)
    told = capsys.readouterr().err
    assert re.fullmatch(
        r"fig3b\.nominal: \S+ steps of a bead, some \S+ to \S+ s of one core; .*memory\n", told
    )
    _tell_beforehand(replace(long, duration_s=7e-4, interval_s=2.5e-7), CATALOGUE, limits=True)
    assert capsys.readouterr().err == ""


def test_without_no_limits_it_is_refused_with_its_numbers(endless):
    out = endless.with_name("out.npz")
    command = [sys.executable, "-c", MAIN, "simulate", str(endless), "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2
    assert "steps of a bead" in done.stderr
    assert "--no-limits" in done.stderr
    assert not out.exists()


def test_progress_is_told_and_an_interruption_stops_the_work():
    told, stopped = [], []

    def work(seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end and not stopped:
            time.sleep(0.01)

    def listener(part):
        told.append(part)
        if len(told) == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), watch.told_to(listener):
        watch.run(work, [(60.0,), (60.0,)], 1, lambda: stopped.append(True), lambda: 0.25)
    assert told == [0.25] * 3
    assert stopped
    assert not watch._listeners


@pytest.mark.parametrize("moment", [0.1, 0.3, 0.6])
def test_a_verb_that_is_still_starting_ends_without_a_word(moment, tmp_path):
    """A short version of `make interrupt`, which tries every verb; moments in processor time."""
    line = f"predict --beads 400 --diameter 5mm --material brass --speed 1 --out {tmp_path}/made/shown.svg"
    # The interpreter's own start is not ours, and takes what the machine takes.
    own = [sys.executable, "-c", "import time, sonicvacuum; print(time.process_time())"]
    before = float(subprocess.run(own, capture_output=True, text=True, check=True).stdout)
    found = interrupt.interrupted(tmp_path, line, before + moment, dict(os.environ))
    assert found["code"] in (*interrupt.CODES, 0)
    assert interrupt.faults(found, []) == []
    written = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert [path.name for path in written] in ([], ["shown.svg"])
    assert all(path.read_text().endswith("</svg>\n") for path in written)


def test_errors_of_the_work_arrive():
    def fail():
        raise ValueError("from the thread")

    with pytest.raises(ValueError, match="from the thread"):
        watch.run(fail, [()], 1, lambda: None, lambda: 0.0)
    with pytest.raises(ValueError, match="from the thread"):
        watch.aside(fail)
