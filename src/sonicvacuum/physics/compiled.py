"""A cache of compiled code, and of what else takes long, that is never stale and that many processes may use
at once.

Numba's own cache looks at the file of one function only: an edit of any function that it calls goes
unseen, and processes that write together may mix their files up. Here each stepper (`kept`), and each
signature of another function, is one file, named by a digest of what it is and the processor,
in a folder named by a digest of the source of `sonicvacuum.physics` and of the versions of what works it out.
Force laws from elsewhere (effects) stand in the name with a digest of their own formulas. Nothing is ever
overwritten with something else, and nothing is loaded that another user could have written.

The folder lies in the user's cache folder, or in $SONICVACUUM_CACHE_DIR. Where it cannot be written,
code is compiled afresh by each process.
"""

import contextlib
import gc
import hashlib
import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from threading import RLock

from sonicvacuum.physics import watch
from sonicvacuum.physics.machine import processor
from sonicvacuum.stages import compiling

_PACKAGE = Path(__file__).resolve().parent
_KEPT_FOLDERS = 8
# Longer than any compilation: a process that still holds the lock then is taken for dead.
PATIENCE = 60.0
_DIGEST = hashlib.sha256().digest_size


def source_digest(package: Path = _PACKAGE) -> str:
    """Digest of all Python files of a package and of the versions of what compiles and calls them."""
    versions = (sys.version, *(version(name) for name in ("numba", "llvmlite", "numpy", "scipy")))
    return files_digest(tuple(sorted(package.rglob("*.py"))), package, repr(versions))


@lru_cache
def files_digest(files: tuple[Path, ...], folder: Path | None = None, more: str = "") -> str:
    """Digest of some files, their names as seen from a folder (or alone), and of a text."""
    digest = hashlib.sha256(more.encode())
    for path in files:
        digest.update(str(path.relative_to(folder) if folder else path.name).encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:20]


@lru_cache(maxsize=1)
def cache_folder() -> Path | None:
    """This version's folder, made if need be; None where it cannot be written."""
    try:
        base = os.environ.get("SONICVACUUM_CACHE_DIR") or _user_folder()
        folder = Path(base) / f"compiled-{source_digest()}"
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
        os.utime(folder)
    except OSError:
        return None
    with contextlib.suppress(OSError):
        _prune(folder)
    return folder


def _user_folder():
    from platformdirs import user_cache_dir

    return user_cache_dir("sonicvacuum", appauthor=False)


def _prune(folder):
    """Remove all but the folders used last."""
    others = [f for f in folder.parent.glob("compiled-*") if f != folder]
    for old in sorted(others, key=lambda f: f.stat().st_mtime)[: -_KEPT_FOLDERS + 1]:
        shutil.rmtree(old, ignore_errors=True)


def write(path, content):
    """Write a file that is there whole or not at all."""
    descriptor, partial = tempfile.mkstemp(dir=path.parent)
    try:
        with open(descriptor, "wb") as file:
            file.write(content)
        os.replace(partial, path)
    except BaseException:  # a full disk is not filled further by what nobody reads
        with contextlib.suppress(OSError):
            os.unlink(partial)
        raise


def own(path: Path) -> bytes:
    """Content of a file that nobody else could have written: what it says is run.

    Raises:
        PermissionError: for a file of another user, or one that others may write.
    """
    with open(path, "rb") as file:
        status = os.fstat(file.fileno())
        others = status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
        if hasattr(os, "getuid") and (others or status.st_uid != os.getuid()):
            raise PermissionError(f"{path}: may have been written by another user")
        return file.read()


# Names of what this process compiled.
made: list[str] = []
# Of several threads one at a time loads or compiles.
preparing = RLock()


def kept(name: str, make: Callable[[], bytes]) -> bytes:
    """What goes by `name` on this processor, as an earlier process made it, or made now and kept.

    Of several processes that lack it one makes it, and the others wait.
    """
    key = repr((name, *processor())).encode()
    folder = cache_folder()
    path = folder / f"{hashlib.sha256(key).hexdigest()[:32]}.bin" if folder else None
    content = _whole(path)
    if content is None:
        with compiling(), lock(path, PATIENCE) if path else contextlib.nullcontext():
            content = _whole(path)
            if content is None:
                content = _made(name, make)
                if path:
                    with contextlib.suppress(OSError):
                        write(path, hashlib.sha256(content).digest() + content)
    return content


def _whole(path):
    """Content of a file of the cache; None where it is not there, damaged, or could be another user's."""
    with contextlib.suppress(OSError):
        if path:
            whole = own(path)
            digest, content = whole[:_DIGEST], whole[_DIGEST:]
            if hashlib.sha256(content).digest() == digest:
                return content
    return None


def _made(name, make):
    found = []
    with uncollected():
        watch.aside(lambda: found.append(make()))
    made.append(name)
    return found[0]


@contextlib.contextmanager
def uncollected():
    """Without the collection of garbage, which takes a quarter of a compilation and finds next to nothing."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


@contextlib.contextmanager
def lock(path, patience):
    """Whether this process alone compiles what is kept at `path`, as far as it could be found out within
    `patience` (s).
    """
    from filelock import FileLock, Timeout

    lock = FileLock(path.with_suffix(".lock"))
    alone = False
    with contextlib.suppress(Timeout, OSError):
        lock.acquire(timeout=patience)
        alone = True
    try:
        yield alone
    finally:
        lock.release()
