"""Effects of the user's own: from a Python file (`--effects my_law.py`), or from an installed package.

A file stands alone: it may import what is installed, and holds one `EFFECT` or several `EFFECTS` (see
`sonicvacuum.effects` for how one is written). A package names the same objects under the entry-point group
`sonicvacuum.effects`. Both are checked and tried once (`effects.trial`) before anything is searched with
them.
"""

import hashlib
import sys
import traceback
from collections.abc import Iterable
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from types import ModuleType

from sonicvacuum.effects import CATALOGUE, Catalogue, Effect, Source
from sonicvacuum.files import InputError, read_text

GROUP = "sonicvacuum.effects"


def catalogue(files: Iterable = ()) -> Catalogue:
    """The project's effects, then those of installed packages, then those of files.

    Raises:
        InputError: naming file, line or effect, what is wrong and the cure.
    """
    result = CATALOGUE
    for name, found in (*_installed(), *((str(f), read(f)) for f in files)):
        try:
            result = result.extended(found)
        except ValueError as error:
            raise InputError(f"{name}: {error}") from None
    return result


def read(path) -> tuple[Effect, ...]:
    """The effects of a Python file, checked and tried; their source is the file's name and digest.

    The text itself is run, never an older compiled copy of it.
    """
    text = read_text(path)
    digest = hashlib.sha256(text.encode()).hexdigest()
    module = ModuleType(f"sonicvacuum_own_{digest[:16]}")
    module.__file__ = str(path)
    # Where dataclasses of the file look themselves up; named by its content, so that nothing is overwritten.
    sys.modules[module.__name__] = module
    try:
        exec(compile(text, str(path), "exec"), module.__dict__)
    except SyntaxError as error:
        raise InputError(f"{path}, line {error.lineno}: not Python: {error.msg}; correct it") from None
    except (Exception, SystemExit) as error:
        told = " ".join(str(error).split())
        raise InputError(
            f"{path}, line {_line(error, path)}: {type(error).__name__}: {told}; "
            "see the documentation of sonicvacuum.effects for what an effect consists of"
        ) from None
    return _sourced(_found(module.__dict__, path), Source(Path(path).name, digest), path)


def _line(error, path):
    """The last line of the file that the error went through."""
    frames = traceback.extract_tb(error.__traceback__)
    return next((f.lineno for f in reversed(frames) if f.filename == str(path)), "?")


def _found(names, path):
    """What `EFFECT` or `EFFECTS` hold."""
    if ("EFFECT" in names) == ("EFFECTS" in names):
        raise InputError(f"{path}: needs EFFECT = Effect(...), or EFFECTS with several, one of the two")
    return names["EFFECT"] if "EFFECT" in names else names["EFFECTS"]


def _sourced(found, source, where):
    """The effects in an object, checked, with their source."""
    from sonicvacuum.effects.trial import check  # brings the integrator, which the catalogue alone needs not

    several = found if isinstance(found, tuple | list) else (found,)
    if not several:
        raise InputError(f"{where}: EFFECTS is empty; put an Effect into it")
    for one in several:
        if not isinstance(one, Effect):
            raise InputError(f"{where}: holds {one!r} in place of an effect; use sonicvacuum.effects.Effect")
        try:
            check(one)
        except ValueError as error:
            raise InputError(f"{where}: {error}") from None
    return tuple(replace(one, source=source) for one in several)


def _installed():
    """(entry point, its effects) of all installed packages, by name."""
    for point in sorted(metadata.entry_points(group=GROUP), key=lambda p: (p.name, p.value)):
        where = f"entry point {point.name} = {point.value} of {_package(point)}"
        try:
            found = point.load()
            digest = hashlib.sha256(_text(point.module)).hexdigest()
        except (Exception, SystemExit) as error:
            told = " ".join(str(error).split())
            raise InputError(
                f"{where}: {type(error).__name__}: {told}; mend the package, or uninstall it"
            ) from None
        found = _found(vars(found), where) if isinstance(found, ModuleType) else found
        yield where, _sourced(found, Source(_package(point), digest), where)


def _text(module):
    """What an installed law is written in: all of the package that it belongs to, whose other modules may
    hold what it computes, or its module where that stands alone or in an archive.
    """
    parts = module.split(".")
    above = (sys.modules[".".join(parts[: k + 1])] for k in range(len(parts)))
    # Several distributions may share the name of a package that has no file.
    package = next((m for m in above if hasattr(m, "__path__") and getattr(m, "__file__", None)), None)
    files = sorted(Path(package.__file__).parent.rglob("*.py")) if package else []
    if files:
        return b"".join(file.read_bytes() for file in files)
    own = sys.modules[module]
    return own.__spec__.loader.get_data(own.__file__)


def _package(point):
    return f"{point.dist.name} {point.dist.version}" if point.dist else "a package"
