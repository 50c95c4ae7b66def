"""Where results go: never over what is read, told before anything is computed, whole or not at all."""

import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from sonicvacuum.files import InputError, check_written

try:
    import fcntl
except ImportError:  # not on Windows
    fcntl = None

_PARTIAL, _EARLIER = ".partial", ".earlier"


def check_apart(outputs: Iterable, inputs: Iterable) -> None:
    """Refuse to write over what is read.

    Args:
        outputs: files to be written; None is passed over.
        inputs: files that are read, or folders, all files below which are read; None is passed over.

    Raises:
        InputError: where an output is one of them, be it by another spelling, a symbolic or a hard link, or
            where two outputs are one.
    """
    outputs = [Path(path) for path in outputs if path is not None]
    places: dict[Path, Path] = {}
    for path in outputs:
        # Not `Path.resolve`, which a link that points to itself ends in an error of its own.
        other = places.setdefault(Path(os.path.realpath(path)), path)
        if other is not path:
            raise InputError(f"{path}: {other} is written there too; give each output a place of its own")
    standing = {_identity(path): path for path in outputs if path.is_file()}
    if not standing:
        return
    for path in (Path(path) for path in inputs if path is not None):
        for file in path.rglob("*") if path.is_dir() else [path]:
            target = standing.get(_identity(file)) if file.is_file() else None
            if target:
                raise InputError(f"{target}: is {file}, which is read here; give another place to write")


def _identity(path):
    status = path.stat()
    return status.st_dev, status.st_ino


def check_folder(folder) -> None:
    """InputError where a folder cannot be made or written; nothing is left of the trial."""
    folder = Path(os.path.realpath(folder))
    existing = next(place for place in (folder, *folder.parents) if os.path.lexists(place))
    if not existing.is_dir():
        raise InputError(f"{folder}: {existing} is a file; give another folder to write")
    try:
        with tempfile.TemporaryDirectory(prefix=".", dir=existing):
            return
    except OSError as error:
        raise InputError(
            f"{folder}: cannot be written ({error.strerror}); give another folder to write"
        ) from None


@contextmanager
def renewed(folder, last: str, stale: Iterable[str] = ()) -> Iterator[Path]:
    """A temporary folder whose files take their place in `folder` only once all are written.

    While files change places `last` is missing, so that a folder that holds it holds the files of one run. An
    exception (a full disk, an interruption) leaves what stood there before, also where it comes in between.
    A kill in between leaves a folder without `last`, which no reader takes for a result, and loses nothing:
    the earlier files are in a hidden folder within, `.….earlier`, and new ones that have no place yet in
    another, `.….partial`.

    Args:
        folder: where the files go; made if need be.
        last: name of the file that goes away first and comes last.
        stale: names of files of an earlier run that go away too if this one does not write them.
    """
    folder = Path(folder)
    made = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with tempfile.TemporaryDirectory(prefix=".", suffix=_PARTIAL, dir=folder) as fresh:
            yield Path(fresh)
            _exchange(Path(fresh), folder, last, stale)
    except BaseException as error:
        if made:
            with suppress(OSError):
                folder.rmdir()
        named = getattr(error, "filename", None)
        if isinstance(named, str) and Path(named).parent.name.endswith((_PARTIAL, _EARLIER)):
            error.filename = str(folder / Path(named).name)  # where the file was to stand
        raise


def cut_off(folder) -> str:
    """Where the files of a folder are whose exchange was killed, in words; nothing where none was."""
    hidden = [path.name for path in Path(folder).iterdir() if path.is_dir() and path.name.startswith(".")]
    names = {ending: sorted(n for n in hidden if n.endswith(ending)) for ending in (_EARLIER, _PARTIAL)}
    if not names[_EARLIER]:
        return ""
    new = f", new ones in {' and '.join(names[_PARTIAL])}" if names[_PARTIAL] else ""
    return (
        f"files were changing places here when their writer was killed: earlier ones are in "
        f"{' and '.join(names[_EARLIER])}{new}; move one set into the folder"
    )


def _exchange(fresh, folder, last, stale):
    """Move the files of `fresh` into `folder`; an exception puts back what stood there."""
    names = {path.name for path in fresh.iterdir()}
    leaving = (last, *sorted({*names, *stale} - {last}))
    for name in leaving:
        check_written(folder / name)  # a folder of that name is none of ours
    with _alone(folder), tempfile.TemporaryDirectory(prefix=".", suffix=_EARLIER, dir=folder) as earlier:
        try:
            for name in leaving:
                if os.path.lexists(folder / name):
                    os.replace(folder / name, Path(earlier, name))
            for name in sorted(names, key=lambda name: (name == last, name)):
                os.replace(fresh / name, folder / name)
        except BaseException:
            if any(fresh.iterdir()):  # else the new ones stand already
                _put_back(Path(earlier), fresh, folder, leaving, names)
            raise


@contextmanager
def _alone(folder):
    """Within this nobody else moves files into the folder; whoever comes meanwhile waits.

    A lock of the system, which ends with its process and leaves no file. Where there are none (some file
    systems of networks) nobody waits.
    """
    if fcntl is None:
        yield
        return
    held = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):
            fcntl.flock(held, fcntl.LOCK_EX)
        yield
    finally:
        os.close(held)


def _put_back(earlier, fresh, folder, leaving, names):
    """The files of before in their places again, `last` the last of them."""
    for name in reversed(leaving):
        if os.path.lexists(earlier / name):
            os.replace(earlier / name, folder / name)
        elif name in names and not (fresh / name).exists():
            (folder / name).unlink()
