"""A cache of compiled code that is never stale and that many processes may use at once.

Numba's own cache looks at the file of one function only: an edit of any function that it calls goes
unseen, and processes that write together may mix their files up. Here each compiled signature is one
file, named by a digest of the signature and the processor, in a folder named by a digest of the source of
`sonicvacuum.physics` and of the versions of all that takes part. Force laws from elsewhere (effects) stand in
the signature with a digest of their own formulas. Nothing is ever overwritten with something else, and
nothing is loaded that another user could have written.

The folder lies in the user's cache folder, or in $SONICVACUUM_CACHE_DIR. Where it cannot be written,
code is compiled afresh by each process.
"""

import contextlib
import gc
import hashlib
import os
import pickle
import shutil
import stat
import sys
import tempfile
from functools import lru_cache
from pathlib import Path
from threading import Lock

import llvmlite
import numba
import numpy as np
from numba.core.caching import CompileResultCacheImpl, _Cache
from numba.core.serialize import dumps

from sonicvacuum.physics import watch
from sonicvacuum.stages import compiling

_PACKAGE = Path(__file__).resolve().parent
_KEPT_FOLDERS = 8
# Longer than any compilation: a process that still holds the lock then is taken for dead.
_PATIENCE = 60.0


def source_digest(package: Path = _PACKAGE) -> str:
    """Digest of all Python files of a package and of the versions of what compiles them."""
    versions = (sys.version, numba.__version__, llvmlite.__version__, np.__version__)
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


class _SignatureCache(_Cache):
    """Numba's interface to a cache: one file per signature.

    Numba's own makes its contexts ready to compile before it loads, a third of a second of every process.
    What counts no references to arrays (option `_nrt`) needs nothing of that, and the compiler makes them
    ready itself.
    """

    def __init__(self, dispatcher, sources):
        self._function, self._sources = dispatcher.py_func, sources
        self._counts_references = dispatcher.targetoptions.get("_nrt", True)

    @property
    def cache_path(self):
        return str(cache_folder())

    def enable(self):
        pass

    def disable(self):
        pass

    def flush(self):
        pass

    def path(self, signature, target):
        own = (self._function.__qualname__, *(files_digest((file,)) for file in self._sources))
        key = (*own, str(signature), target.codegen().magic_tuple())
        return cache_folder() / f"{hashlib.sha256(repr(key).encode()).hexdigest()[:32]}.bin"

    def load_overload(self, sig, target_context):
        if cache_folder() is None:
            return None
        # Whatever is wrong with the file, compiling afresh is the cure.
        with contextlib.suppress(Exception):
            payload = pickle.loads(_own(self.path(sig, target_context)))
            if self._counts_references:
                target_context.refresh()
            return CompileResultCacheImpl.rebuild(None, target_context, payload)
        return None

    def save_overload(self, sig, data):
        if cache_folder() is None:
            return
        with contextlib.suppress(OSError):
            payload = dumps(data._reduce())
            path = self.path(sig, data.target_context)
            with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
                file.write(payload)
            os.replace(file.name, path)


def _own(path: Path) -> bytes:
    """Content of a file that nobody else could have written: whoever makes a pickle runs code here.

    Raises:
        PermissionError: for a file of another user, or one that others may write.
    """
    with open(path, "rb") as file:
        status = os.fstat(file.fileno())
        others = status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
        if hasattr(os, "getuid") and (others or status.st_uid != os.getuid()):
            raise PermissionError(f"{path}: may have been written by another user")
        return file.read()


def cached(dispatcher, sources: tuple[Path, ...] = ()):
    """Give a Numba function this cache instead of Numba's own.

    Args:
        dispatcher: what `numba.njit` returned.
        sources: files outside `sonicvacuum.physics` with whose code it is compiled.
    """
    dispatcher._cache = _SignatureCache(dispatcher, sources)
    return dispatcher


_prepared = set()
# Of several threads one at a time loads or compiles.
_preparing = Lock()


def prepare(dispatcher, name: str, arguments: tuple, soon: dict | None = None) -> None:
    """Load or compile a function for the types of `arguments`, whose signature goes by `name`.

    Of several processes that lack it one compiles. The others meanwhile compile what they need `soon` (name →
    first argument, the rest being alike) and nobody else compiles, or wait, and load.
    """
    if name in _prepared:
        return
    with _preparing:
        if name in _prepared:
            return
        signature = tuple(numba.typeof(a) for a in arguments)
        left = [(numba.typeof(first), *signature[1:]) for n, first in (soon or {}).items() if n != name]
        _load_or_compile(dispatcher, signature, left)
        _prepared.add(name)


def _import_array_functions():
    """Import Numba's array functions, but without scipy's linear algebra: no kernel multiplies matrices.

    Numba loads it only to see that it is there, which is a fifth of a second of every process's start; where
    it is used, Numba checks again.
    """
    with contextlib.suppress(ImportError, AttributeError):
        from numba.np import linalg

        check, linalg.ensure_blas = linalg.ensure_blas, lambda: None
        try:
            import numba.np.arraymath  # noqa: F401
        finally:
            linalg.ensure_blas = check


def _load_or_compile(dispatcher, signature, soon=()):
    folder = cache_folder()
    path = dispatcher._cache.path(signature, dispatcher.targetctx) if folder else None
    if path and path.exists():
        dispatcher.compile(signature)
        return
    _import_array_functions()
    with compiling():
        for other in soon if path else ():
            with _lock(path, 0.0) as alone:
                if alone:
                    _compile(dispatcher, signature)
                    return
            _compile_unless_another_does(dispatcher, other)
        with _lock(path, _PATIENCE) if path else contextlib.nullcontext():
            _compile(dispatcher, signature)


def _compile_unless_another_does(dispatcher, signature):
    path = dispatcher._cache.path(signature, dispatcher.targetctx)
    with _lock(path, 0.0) as alone:
        if alone and not path.exists():
            _compile(dispatcher, signature)


def _compile(dispatcher, signature):
    with _uncollected():
        watch.aside(dispatcher.compile, signature)


@contextlib.contextmanager
def _uncollected():
    """Without the collection of garbage, which takes a quarter of a compilation and finds next to nothing."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


@contextlib.contextmanager
def _lock(path, patience):
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
