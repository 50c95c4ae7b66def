"""A short name for what a function does, so that compiled code is never used for an edited formula."""

import hashlib
import re
from functools import lru_cache
from types import CodeType, FunctionType, ModuleType

import numpy as np

# Where an object lies in memory, as its `repr` may say (`numpy.where` does): another place in each process.
_ADDRESS = re.compile(r" at 0x[0-9a-fA-F]+")


@lru_cache(maxsize=4096)
def fingerprint(function: FunctionType) -> str:
    """Hexadecimal digest of a function's code, constants and everything of Python's that it calls.

    Constants count wherever they stand, arrays by all their bytes, containers by what they hold, other
    objects by their `repr`; comments and places, in the source or in memory, do not.
    """
    digest = hashlib.sha256()
    _feed(digest, function, set())
    return digest.hexdigest()[:16]


def _feed(digest, value, seen):
    value = getattr(value, "py_func", value)
    if isinstance(value, FunctionType):
        if value not in seen:
            seen.add(value)
            _feed_function(digest, value, seen)
    elif isinstance(value, CodeType):
        digest.update(value.co_code)
        digest.update(repr((value.co_names, value.co_varnames, value.co_freevars)).encode())
        for constant in value.co_consts:
            _feed(digest, constant, seen)
    elif isinstance(value, ModuleType):
        digest.update(value.__name__.encode())
    elif isinstance(value, np.ndarray):
        digest.update(f"array {value.dtype} {value.shape}".encode() + value.tobytes())
    elif isinstance(value, tuple | list | dict):
        digest.update(f"{type(value).__name__} {len(value)}".encode())
        for part in value.items() if isinstance(value, dict) else value:
            _feed(digest, part, seen)
    else:
        digest.update(f"{type(value).__name__} {_ADDRESS.sub('', repr(value))}".encode())


def _feed_function(digest, function, seen):
    code = function.__code__
    _feed(digest, code, seen)
    for cell in function.__closure__ or ():
        _feed(digest, cell.cell_contents, seen)
    _feed(digest, (function.__defaults__, function.__kwdefaults__), seen)
    names = _names(code)
    for name in names:
        if name in function.__globals__:
            _feed(digest, function.__globals__[name], seen)
    modules = [m for n in names if isinstance(m := function.__globals__.get(n), ModuleType)]
    for module in modules:
        # Grows while it is read: what a name means in a module may be a module again.
        for used in (getattr(module, n) for n in names if hasattr(module, n)):
            if not isinstance(used, ModuleType):
                _feed(digest, used, seen)
            elif used not in modules:
                modules.append(used)


def _names(code):
    """Names that a code object and those nested in it refer to."""
    inner = [n for constant in code.co_consts if isinstance(constant, CodeType) for n in _names(constant)]
    return sorted({*code.co_names, *inner})
