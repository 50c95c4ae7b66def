"""What `make` calls: Snakemake, which after a run that was killed starts as after any other.

A killed Snakemake leaves its lock behind; its jobs may live on; files may be half made. The lock goes where
nothing alive holds it, jobs without a Snakemake are ended, and what was not finished is made again. Two runs
never work in one folder: the second is refused. Arguments are those of `snakemake`.
"""

import fcntl
import os
import signal
import sys
import time
from pathlib import Path

# Stands in the environment of every job: the folder of the run that it belongs to.
MARK = "SONICVACUUM_RUN"
PATIENCE_S = 10.0


def processes() -> dict[int, Path]:
    """Number → folder under /proc of all processes but this one; nothing where a system has no /proc."""
    found = Path("/proc").glob("[0-9]*")
    return {int(path.name): path for path in found if int(path.name) != os.getpid()}


def orphans(folder: Path) -> list[int]:
    """Jobs of former runs in a folder. To be asked where no run is at work there."""
    mark = f"{MARK}={folder}".encode()
    return [n for n, path in processes().items() if mark in _read(path / "environ").split(b"\0")]


def runs(folder: Path) -> list[int]:
    """Snakemakes at work in a folder, however they were started."""
    found = []
    for number, path in processes().items():
        words = [word.rpartition(b"/")[2] for word in _read(path / "cmdline").split(b"\0")]
        if b"snakemake" in words[:4] and _folder(path) == folder:
            found.append(number)
    return found


def _read(path):
    """Content of a file of a process; nothing for one that has ended or is another user's."""
    try:
        return path.read_bytes()
    except OSError:
        return b""


def _folder(path):
    try:
        return Path(os.readlink(path / "cwd"))
    except OSError:
        return None


def end(numbers: list[int]) -> None:
    """Ask processes to end, and end those that have not in time."""
    for sent in (signal.SIGTERM, signal.SIGKILL):
        for number in numbers:
            try:
                os.kill(number, sent)
            except ProcessLookupError:
                continue
        until = time.monotonic() + PATIENCE_S
        while numbers and time.monotonic() < until:
            numbers = [n for n in numbers if _read(Path(f"/proc/{n}/cmdline"))]
            time.sleep(0.05)


def clear(folder: Path) -> None:
    """Remove what a killed run left in the way; to be called while no other `make` is at work.

    Raises:
        SystemExit: where a Snakemake that was started otherwise works there.
    """
    locks = sorted((folder / ".snakemake/locks").glob("*.lock"))
    if not locks:
        return
    if not Path("/proc/self").exists():
        return  # Snakemake itself then says how to remove them
    end(orphans(folder))
    if at_work := runs(folder):
        sys.exit(f"{folder}: Snakemake (process {at_work[0]}) is at work here; wait for it, or stop it")
    print(f"An earlier run was killed: removing its lock; what it had not finished is made again ({folder})")
    for lock in locks:
        lock.unlink()


def hold(folder: Path) -> None:
    """Keep other runs out until the process ends, however it ends.

    Raises:
        SystemExit: where another run is at work.
    """
    (folder / ".snakemake").mkdir(exist_ok=True)
    # Left open, and handed on to Snakemake, which takes this process over; jobs do not inherit it.
    held = os.open(folder / ".snakemake/running", os.O_CREAT | os.O_RDWR)
    try:
        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        sys.exit(f"{folder}: another `make` is at work here; wait for it, or stop it")
    os.set_inheritable(held, True)


def main() -> None:
    """Replace this process by Snakemake."""
    folder = Path.cwd().resolve()
    hold(folder)
    clear(folder)
    os.environ[MARK] = str(folder)
    sys.stdout.flush()
    os.execv(sys.executable, [sys.executable, "-m", "snakemake", "--rerun-incomplete", *sys.argv[1:]])


if __name__ == "__main__":
    main()
