"""The mutations that the tests of discover's statistics notice: each can still be made, and is told."""

import importlib.util
import re

import pytest


@pytest.fixture(scope="module")
def script(pytestconfig):
    path = pytestconfig.rootpath / "workflow/scripts/mutations.py"
    spec = importlib.util.spec_from_file_location("mutations", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_each_mutation_stands_once_in_the_source(script, pytestconfig):
    source = pytestconfig.rootpath / "src/sonicvacuum/discover"
    for title, name, old, new in script.MUTATIONS:
        (path,) = (p for p in source.rglob(name) if "faults" not in p.parts)
        text = path.read_text(encoding="utf-8")
        assert script.mutated(text, old, new) != text, title


def test_the_table_tells_of_every_mutation_and_of_tests_that_exist(script, pytestconfig):
    root = pytestconfig.rootpath
    section = (
        (root / "docs/architecture.md").read_text(encoding="utf-8").partition("## What each mutation")[2]
    )
    rows = re.findall(r"^\| ([^|]+) \| (`.+`) \|$", section.partition("## Words")[0], re.M)
    assert [title for title, _ in rows] == [m[0] for m in script.MUTATIONS]
    tests = "".join((root / path).read_text(encoding="utf-8") for path in script.TESTS)
    for title, names in rows:
        for name in re.findall(r"`(\w+)`", names):
            assert f"def {name}(" in tests, title
