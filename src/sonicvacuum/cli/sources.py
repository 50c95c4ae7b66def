"""Which source files a verb runs, read off the imports: what a rule of the workflow depends on.

Snakemake does not see edits to an installed package; a rule that takes the digest of these files as a
parameter is run again when one of them changes, and left alone when another does. (As inputs of some 250 jobs
the same files would be looked up 22 000 times in each run.) Needs grimp (extra `workflow`).
"""

import hashlib
from collections.abc import Iterable
from functools import cache
from importlib import import_module
from pathlib import Path

import click
import grimp

from sonicvacuum.cli import cli

PACKAGES = ("sonicvacuum", "sonicvacuum_blind", "sonicvacuum_paper")
# Files beside modules that are no modules: templates, styles, scripts, tables, settings.
DATA = (".j2", ".css", ".js", ".csv", ".json", ".yaml")


def module_of(verb: str) -> str:
    """Module that holds a verb, such as `paper observe`; ValueError for one that does not exist."""
    group = cli
    *groups, name = verb.split()
    for part in groups:
        group = group.get_command(click.Context(group), part)
    if name not in getattr(group, "verbs", {}):
        raise ValueError(f"verb {verb!r}: there is none")
    return group.verbs[name].split(":")[0]


def imported(modules: Iterable[str], without: Iterable[str] = ()) -> set[str]:
    """Modules of the three packages that are loaded with some of them, these included.

    A package's `__init__` is loaded with every module in it. Imports inside functions count, those for type
    checkers only do not.

    Args:
        modules: full names.
        without: modules that are not followed, since the call at hand never loads them.
    """
    left_out = set(without)
    found: set[str] = set()
    waiting = list(modules)
    while waiting:
        module = waiting.pop()
        if module in found or module in left_out:
            continue
        found.add(module)
        if "." in module:
            waiting.append(module.rpartition(".")[0])
        waiting += _graph().find_modules_directly_imported_by(module)
    return found


def files(verbs: Iterable[str], without: Iterable[str] = ()) -> dict[str, Path]:
    """Source files of some verbs and the data beside them: name from the package on → path, in order."""
    found: dict[str, Path] = {}
    for module in imported(map(module_of, verbs), without):
        path, folder = _path(module), module.split(".")
        folder = folder if path.name == "__init__.py" else folder[:-1]
        beside = [] if path.name == "__init__.py" else [p for p in _listing(path.parent) if p.suffix in DATA]
        found |= {"/".join([*folder, p.name]): p for p in (path, *beside)}
    return dict(sorted(found.items()))


def digest(verbs: Iterable[str], without: Iterable[str] = (), beside: Iterable[str | Path] = ()) -> str:
    """SHA-256 of what some verbs run: names and contents of their files, wherever these lie.

    Args:
        verbs, without: as in `files`.
        beside: further files that decide what is run, such as lock files; their order counts.
    """
    whole = hashlib.sha256()
    named = [*files(verbs, without).items(), *((Path(path).name, Path(path)) for path in beside)]
    for name, path in named:
        whole.update(f"{name}\0{_content(path)}\n".encode())
    return whole.hexdigest()


@cache
def _content(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


@cache
def _listing(folder: Path) -> list[Path]:
    return list(folder.iterdir())


@cache
def _graph() -> grimp.ImportGraph:
    return grimp.build_graph(*PACKAGES, cache_dir=None, exclude_type_checking_imports=True)


@cache
def _path(module: str) -> Path:
    """File of a module, which is not loaded; its package is, and loads nothing."""
    package, *rest = module.split(".")
    stem = Path(import_module(package).__path__[0]).joinpath(*rest)
    return stem / "__init__.py" if stem.is_dir() else stem.with_suffix(".py")
