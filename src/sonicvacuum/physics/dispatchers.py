"""Numba's dispatchers with a cache of ours (`compiled`) instead of Numba's own: for code that keeps Numba's
arrays, as the integrator of hidden-effect data does.
"""

import contextlib
import hashlib
import pickle
from pathlib import Path

import numba
from numba.core.caching import CompileResultCacheImpl, _Cache
from numba.core.serialize import dumps

from sonicvacuum.physics import watch
from sonicvacuum.physics.compiled import (
    PATIENCE,
    cache_folder,
    files_digest,
    lock,
    made,
    own,
    preparing,
    uncollected,
    write,
)
from sonicvacuum.stages import compiling


class _SignatureCache(_Cache):
    """Numba's interface to a cache: one file per signature."""

    def __init__(self, dispatcher, sources):
        self._function, self._sources = dispatcher.py_func, sources

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
        names = (self._function.__qualname__, *(files_digest((file,)) for file in self._sources))
        key = (*names, str(signature), target.codegen().magic_tuple())
        return cache_folder() / f"{hashlib.sha256(repr(key).encode()).hexdigest()[:32]}.bin"

    def load_overload(self, sig, target_context):
        if cache_folder() is None:
            return None
        # Whatever is wrong with the file, compiling afresh is the cure.
        with contextlib.suppress(Exception):
            payload = pickle.loads(own(self.path(sig, target_context)))
            target_context.refresh()
            return CompileResultCacheImpl.rebuild(None, target_context, payload)
        return None

    def save_overload(self, sig, data):
        made.append(self._function.__qualname__)
        if cache_folder() is None:
            return
        with contextlib.suppress(OSError):
            write(self.path(sig, data.target_context), dumps(data._reduce()))


def cached(dispatcher, sources: tuple[Path, ...] = ()):
    """Give a Numba function this cache instead of Numba's own.

    Args:
        dispatcher: what `numba.njit` returned.
        sources: files outside `sonicvacuum.physics` with whose code it is compiled.
    """
    dispatcher._cache = _SignatureCache(dispatcher, sources)
    return dispatcher


_prepared = set()


def prepare(dispatcher, name: str, arguments: tuple) -> None:
    """Load or compile a function for the types of `arguments`, whose signature goes by `name`.

    Of several processes that lack it one compiles, and the others wait and load.
    """
    if name in _prepared:
        return
    with preparing:
        if name not in _prepared:
            _load_or_compile(dispatcher, tuple(numba.typeof(a) for a in arguments))
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


def _load_or_compile(dispatcher, signature):
    folder = cache_folder()
    path = dispatcher._cache.path(signature, dispatcher.targetctx) if folder else None
    if path and path.exists():
        dispatcher.compile(signature)
        return
    _import_array_functions()
    with compiling(), lock(path, PATIENCE) if path else contextlib.nullcontext():
        _compile(dispatcher, signature)


def _compile(dispatcher, signature):
    with uncollected():
        watch.aside(dispatcher.compile, signature)
