"""Where results go: never over what is read, told before anything is computed, whole or not at all."""

import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from sonicvacuum.files import InputError

_PARTIAL = ".partial"


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

    An exception inside leaves what stood there before. While the files change places `last` is missing, so
    that a folder that holds it holds the files of one run.

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
            names = {path.name for path in Path(fresh).iterdir()}
            for name in (last, *sorted(set(stale) - names)):
                (folder / name).unlink(missing_ok=True)
            for name in sorted(names, key=lambda name: (name == last, name)):
                os.replace(Path(fresh, name), folder / name)
    except BaseException as error:
        if made:
            with suppress(OSError):
                folder.rmdir()
        named = getattr(error, "filename", None)
        if isinstance(named, str) and Path(named).parent.name.endswith(_PARTIAL):
            error.filename = str(folder / Path(named).name)  # where the file was to stand
        raise
