"""A clone that was copied or moved is told of the environment that is not its own."""

import shutil
import subprocess

from sonicvacuum.cli.helped import strayed


def test_the_command_notices_that_another_clone_s_environment_runs(tmp_path):
    """As after copying a clone: its .venv, activated, runs what it was copied from."""
    for clone in ("first", "copy"):
        (tmp_path / clone / "src/sonicvacuum").mkdir(parents=True)
        (tmp_path / clone / ".venv").mkdir()
    told = strayed(tmp_path / "copy", tmp_path / "first/.venv")
    assert str(tmp_path / "first/.venv") in told
    assert "make env" in told
    assert strayed(tmp_path / "copy", tmp_path / "copy/.venv") == ""
    assert strayed(tmp_path, tmp_path / "first/.venv") == ""


def test_make_notices_a_clone_that_was_moved(tmp_path, pytestconfig):
    names = ("Makefile", "requirements.lock", "requirements-build.lock")
    for name in names:
        shutil.copy(pytestconfig.rootpath / name, tmp_path)
    (tmp_path / ".venv").mkdir()
    stamp = tmp_path / ".venv/locked"
    locks = "".join(
        (tmp_path / name).read_text() for name in ("requirements-build.lock", "requirements.lock")
    )

    def make():
        # A Python that is none: nothing is ever built here.
        call = ["make", "PYTHON=false", ".venv/locked"]
        return subprocess.run(call, cwd=tmp_path, capture_output=True, text=True)

    stamp.write_text(f"built in {tmp_path.resolve()}\n{locks}")
    assert make().returncode == 0
    stamp.write_text(f"built in /elsewhere\n{locks}")
    assert make().returncode != 0
    stamp.write_text(f"built in {tmp_path.resolve()}\n{locks}changed\n")
    assert make().returncode != 0
