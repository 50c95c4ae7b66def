"""Effects of the user's own: from a Python file (`--effects my_law.py`), or from an installed package.

A file stands alone: it may import what is installed, and holds one `EFFECT` or several `EFFECTS` (see
`sonicvacuum.effects` for how one is written). A package names the same objects under the entry-point group
`sonicvacuum.effects`. Both are checked and tried once (`effects.trial`) before anything is searched with
them.

A model says what its effects were written in, and another text is refused (`discover.compare`). Of a file it
is the file; of a package the module that the entry point names and the modules of the same package that it
imports, at any remove: neither its tests nor what else it does. Import statements are read, wherever they
stand, so that one law has one digest, whatever else a process has loaded. Where one imports by names that are
worked out (`import_module`, `__import__`, `*` of a package), all of its package counts. What is outside of
it, and what is no Python text (tables, compiled extensions), does not.
"""

import ast
import hashlib
import sys
import traceback
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from importlib import metadata, util
from pathlib import Path
from types import ModuleType

from sonicvacuum.effects import CATALOGUE, Catalogue, Effect, Source
from sonicvacuum.files import InputError, read_text

GROUP = "sonicvacuum.effects"
_INIT = "__init__.py"
# Beginning of the names of modules that are files of effects.
_OWN = "sonicvacuum_own_"
# Who imports this imports modules that no statement names.
_WORKED_OUT = ("importlib.import_module",)


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


def given(known: Catalogue | None, place: str) -> Catalogue:
    """The catalogue that a function was given, for None that of no file; InputError for anything else."""
    if known is None:
        return catalogue()
    if not isinstance(known, Catalogue):
        raise InputError(f"{place}: catalogue: is {known!r:.100}; give one, as of sv.catalogue('my_law.py')")
    return known


def read(path) -> tuple[Effect, ...]:
    """The effects of a Python file, checked and tried; their source is the file's name and digest.

    The text itself is run, never an older compiled copy of it.
    """
    text = read_text(path)
    digest = hashlib.sha256(text.encode()).hexdigest()
    module = ModuleType(f"{_OWN}{digest[:16]}")
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


def blamed(error: BaseException) -> str | None:
    """What is said of an error in the code of a file that was read: file, line, error; None for any other."""
    own = {m.__file__ for name, m in list(sys.modules.items()) if name.startswith(_OWN)}
    frames = [
        f
        for one in (error, error.__cause__)
        if one is not None
        for f in traceback.extract_tb(one.__traceback__)
        if f.filename in own
    ]
    if not frames:
        return None
    told = f"{type(error).__name__}: {' '.join(str(error).split())}"
    return f"{frames[-1].filename}, line {frames[-1].lineno}: {told}; correct the effect's code"


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
            digest = _digest(point.module)
        except (Exception, SystemExit) as error:
            told = " ".join(str(error).split())
            raise InputError(
                f"{where}: {type(error).__name__}: {told}; mend the package, or uninstall it"
            ) from None
        found = _found(vars(found), where) if isinstance(found, ModuleType) else found
        yield where, _sourced(found, Source(_package(point), digest), where)


def _digest(module):
    """Of what an installed law is written in: modules of its package by name, length and text, or its own
    module's text where that stands alone or in an archive.
    """
    parts = module.split(".")
    above = (sys.modules[".".join(parts[: k + 1])] for k in range(len(parts)))
    # Several distributions may share the name of a package that has no file.
    package = next((m for m in above if hasattr(m, "__path__") and getattr(m, "__file__", None)), None)
    files = _modules(module, package.__name__, Path(package.__file__).parent) if package else {}
    if not files:
        own = sys.modules[module]
        return hashlib.sha256(own.__spec__.loader.get_data(own.__file__)).hexdigest()
    whole = hashlib.sha256()
    for name, text in sorted(files.items()):
        whole.update(f"{name} {len(text)}\n".encode() + text)
    return whole.hexdigest()


def _modules(module, package, folder):
    """Relative name → text of a module and of what it imports from its package, at any remove."""
    found, seen, left = {}, set(), [module]
    while left:
        name = left.pop()
        if name in _WORKED_OUT:
            return {f.relative_to(folder).as_posix(): f.read_bytes() for f in folder.rglob("*.py")}
        if name in seen or not f"{name}.".startswith(f"{package}."):
            continue
        seen.add(name)
        above, _, own = name.rpartition(".")
        place = folder.joinpath(*name.removeprefix(package).split("."))
        file = _file(place)
        if file:
            found[file.relative_to(folder).as_posix()] = text = file.read_bytes()
            left += _imports(text, name if file.name == _INIT else above)
        elif own == "*" and (place.parent / _INIT).is_file():
            left += _WORKED_OUT
        left.append(above)  # the package that a module is in runs before it
    return found


def _file(path):
    """The text of a package or a module, None for neither."""
    return next((f for f in (path / _INIT, path.with_name(f"{path.name}.py")) if f.is_file()), None)


def _imports(text, package):
    """Absolute names that the import statements of a module in a package may mean, `NAME.*` for `*`."""
    try:
        nodes = list(ast.walk(ast.parse(text)))
    except SyntaxError:  # of another Python: nothing that could have run
        return
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            with suppress(ImportError):  # from above the uppermost package: nothing that could have run
                base = util.resolve_name("." * node.level + (node.module or ""), package)
                yield from (base, *(f"{base}.{alias.name}" for alias in node.names))
        elif getattr(node, "id", getattr(node, "attr", "")) in ("import_module", "__import__"):
            yield from _WORKED_OUT


def _package(point):
    return f"{point.dist.name} {point.dist.version}" if point.dist else "a package"
