"""The tables of docs/hands-on.md are those that were measured and kept."""

import importlib.util


def test_the_page_shows_what_was_measured(pytestconfig):
    path = pytestconfig.rootpath / "workflow/bench/hands_on.py"
    spec = importlib.util.spec_from_file_location("hands_on", path)
    hands_on = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hands_on)
    text = hands_on.PAGE.read_text(encoding="utf-8")
    assert hands_on.renewed(text) == text
    assert len(hands_on.table("ten_minutes").splitlines()) > 10
