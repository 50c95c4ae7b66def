"""What scripts that no test runs take from the packages is there; `make bench` asked for what had moved."""

import ast
import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
OURS = ("sonicvacuum", "sonicvacuum_blind", "sonicvacuum_paper")
SCRIPTS = sorted((ROOT / "workflow").rglob("*.py"))


def taken(text):
    """(module, name) of all that a script imports from our packages."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in OURS:
            yield from ((node.module, alias.name) for alias in node.names)


def there(module, name) -> bool:
    """Whether a module has a name, or a module of that name."""
    found = importlib.import_module(module)
    if hasattr(found, name):
        return True
    return hasattr(found, "__path__") and importlib.util.find_spec(f"{module}.{name}") is not None


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_what_a_script_imports_is_there(script):
    missing = [pair for pair in taken(script.read_text(encoding="utf-8")) if not there(*pair)]
    assert not missing


def test_a_name_that_has_gone_is_told():
    (gone,) = taken("from sonicvacuum.physics.table import INVERSE_MASS")
    assert not there(*gone)
    assert all(there(*pair) for pair in taken("from sonicvacuum.physics import run\nfrom math import pi"))
