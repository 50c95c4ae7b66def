"""Which source files a verb runs, read off the imports: what a rule of the workflow depends on.

Snakemake does not see edits to an installed package; a rule that names these files as inputs is run again
when one of them changes, and left alone when another does. Needs grimp (extra `workflow`).
"""

from collections.abc import Iterable
from functools import cache
from importlib import import_module
from pathlib import Path

import click
import grimp

from sonicvacuum.cli import cli

PACKAGES = ("sonicvacuum", "sonicvacuum_blind", "sonicvacuum_paper")
# Files beside modules that are no modules: templates, styles, tables, settings.
DATA = (".j2", ".css", ".csv", ".json", ".yaml")


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


def files(verbs: Iterable[str], without: Iterable[str] = ()) -> list[str]:
    """Source files of some verbs and the data beside them, sorted; relative to the working folder."""
    here, found = Path.cwd(), set()
    for module in imported(map(module_of, verbs), without):
        path = _path(module)
        found.add(path)
        if path.name != "__init__.py":
            found.update(p for p in path.parent.iterdir() if p.suffix in DATA)
    return sorted(str(p.relative_to(here) if p.is_relative_to(here) else p) for p in found)


@cache
def _graph() -> grimp.ImportGraph:
    return grimp.build_graph(*PACKAGES, cache_dir=None, exclude_type_checking_imports=True)


def _path(module: str) -> Path:
    """File of a module, which is not loaded; its package is, and loads nothing."""
    package, *rest = module.split(".")
    stem = Path(import_module(package).__path__[0]).joinpath(*rest)
    return stem / "__init__.py" if stem.is_dir() else stem.with_suffix(".py")
