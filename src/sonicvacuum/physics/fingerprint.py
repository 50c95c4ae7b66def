"""A short name for what a function does, so that compiled code is never used for an edited formula."""

import hashlib
from functools import lru_cache
from types import CodeType, FunctionType, ModuleType


@lru_cache(maxsize=4096)
def fingerprint(function: FunctionType) -> str:
    """Hexadecimal digest of a function's code, constants and everything of Python's that it calls.

    Comments and places do not count. Objects of other kinds count by their `repr`.
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
    else:
        digest.update(f"{type(value).__name__} {value!r}".encode())


def _feed_function(digest, function, seen):
    code = function.__code__
    _feed(digest, code, seen)
    for cell in function.__closure__ or ():
        _feed(digest, cell.cell_contents, seen)
    _feed(digest, (function.__defaults__, function.__kwdefaults__), seen)
    names = _names(code)
    modules = [m for n in names if isinstance(m := function.__globals__.get(n), ModuleType)]
    for name in names:
        if name in function.__globals__:
            _feed(digest, function.__globals__[name], seen)
        for module in modules:
            if isinstance(called := getattr(module, name, None), FunctionType):
                _feed(digest, called, seen)


def _names(code):
    """Names that a code object and those nested in it refer to."""
    inner = [n for constant in code.co_consts if isinstance(constant, CodeType) for n in _names(constant)]
    return sorted({*code.co_names, *inner})
