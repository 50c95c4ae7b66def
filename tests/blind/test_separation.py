"""`discover` never reads a truth, though one lies beside the record."""

import json
import subprocess
import sys

from sonicvacuum_blind.hide import Spec, write

# Python reports every file that is opened or folder that is listed; the command runs as a user would run it.
WATCH = """
import sys

def watch(event, arguments):
    if event in ("open", "os.listdir", "os.scandir") and "truth" in str(arguments[0]):
        sys.stderr.write(f"TOUCHED {event} {arguments[0]}\\n")

sys.addaudithook(watch)
from sonicvacuum.cli import main
sys.argv = ["sonicvacuum", *sys.argv[1:]]
main()
"""


def run(folder, *arguments):
    command = [sys.executable, "-c", WATCH, *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_discover_never_opens_the_truth(tmp_path):
    write(Spec("case", "null", "ball", "white", (), 0.0, 3, 0), tmp_path / "records", tmp_path / "truth")
    done = run(tmp_path, "discover", "records/case", "--out", "out", "--no-figures")
    assert done.returncode == 0, done.stderr
    assert "TOUCHED" not in done.stderr
    (verdict,) = tmp_path.glob("out/**/verdict.json")
    assert "named" in json.loads(verdict.read_text())


def test_the_watch_sees_who_reads_a_truth(tmp_path):
    write(Spec("case", "null", "ball", "white", (), 0.0, 3, 1), tmp_path / "records", tmp_path / "truth")
    done = run(
        tmp_path,
        *[
            "blind",
            "score",
            "--truth",
            "truth",
            "--verdicts",
            "records",
            "--out",
            "a.csv",
            "--summary",
            "b.csv",
        ],
    )
    assert done.returncode == 2
    assert "TOUCHED" in done.stderr
