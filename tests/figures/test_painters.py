"""Processes that draw beside a search: the same pictures, and none left behind."""

import os
import signal
import subprocess
import sys
import time

from sonicvacuum.figures.aside import painters

STARTS = """
import sys, time
from sonicvacuum.figures.aside import painters

def started():
    with painters(2) as pool:
        sys.stdout.write(" ".join(map(str, pool._processes)))
        sys.stdout.flush()
        time.sleep(60)

if __name__ == "__main__":
    started()
"""


def is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_one_thread_draws_by_itself():
    with painters(1) as pool:
        assert pool is None


def test_work_is_done_in_other_processes():
    with painters(2) as pool:
        assert pool.submit(os.getpid).result() != os.getpid()


def test_none_outlives_a_killed_search(tmp_path):
    """A process that waits for work does not hear that nobody is left to give it any, unless it looks."""
    script = tmp_path / "starts.py"
    script.write_text(STARTS)
    search = subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE, text=True)
    started = [int(p) for p in os.read(search.stdout.fileno(), 1000).split()]
    search.send_signal(signal.SIGKILL)
    search.wait()
    deadline = time.monotonic() + 60.0  # a loaded machine takes its time to start and to end them
    while any(map(is_alive, started)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert len(started) == 2
    assert not any(map(is_alive, started))
