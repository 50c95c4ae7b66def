"""What a rule depends on is what its verb imports: an edit reruns these rules and no others."""

from pathlib import Path

import pytest

from sonicvacuum.cli.sources import files, imported, module_of

PAGES = ["sonicvacuum.cli.page"]
MODEL = ["sonicvacuum.cli.model"]
CATALOGUE = ["sonicvacuum.effects"]
# Verb as the rules call it → what the call never loads.
VERBS = {
    "card": MODEL,
    "simulate": MODEL,
    "discover": PAGES,
    "page": [],
    "paper observe": [],
    "paper draw": [],
    "paper ledger": [],
    "paper report": [],
    "blind hide": CATALOGUE,
    "blind score": CATALOGUE,
    "blind draw": [],
}
ENGINE = {"card", "simulate", "discover", "page", "paper observe", "paper draw", "paper report"}


@pytest.mark.parametrize(
    ("edited", "rerun"),
    [
        ("sonicvacuum.physics.kernel", ENGINE),
        ("sonicvacuum.effects.tsuji", ENGINE),
        ("sonicvacuum.discover.rounds", {"discover", "page", "paper report"}),
        ("sonicvacuum.report.words", {"page", "paper report"}),
        ("sonicvacuum_paper.gauges", {"paper observe"}),
        ("sonicvacuum_paper.figures.fig3", {"paper draw", "paper report"}),
        ("sonicvacuum_paper.wording", {"paper ledger", "paper report"}),
        ("sonicvacuum_blind.stepper", {"blind hide", "blind score", "paper report"}),
        ("sonicvacuum_blind.summary", {"blind score"}),
        ("sonicvacuum_blind.figures", {"blind draw", "paper report"}),
        ("sonicvacuum_blind.followup", set()),
    ],
)
def test_an_edit_reruns_the_rules_that_import_it(edited, rerun):
    found = {verb for verb, without in VERBS.items() if edited in imported([module_of(verb)], without)}
    assert found == rerun


def test_hidden_data_do_not_follow_the_engine_nor_the_catalogue_that_is_tested_on_them():
    seen = imported([module_of("blind hide")], CATALOGUE)
    assert not {m for m in seen if m.startswith(("sonicvacuum.effects", "sonicvacuum.discover"))}
    assert not seen & {"sonicvacuum.physics.kernel", "sonicvacuum.physics.run"}


def test_files_are_named_once_in_order_with_the_data_beside_them():
    found = files(["page"])
    assert found == sorted(set(found))
    assert all(Path(path).is_file() for path in found)
    names = {Path(path).name for path in found}
    assert {"record.html.j2", "style.css", "calibration.json", "words.py", "__init__.py"} <= names
    assert not {path for path in found if "sonicvacuum_paper" in path or "sonicvacuum_blind" in path}


@pytest.mark.parametrize("verb", ["guess", "paper guess", "card observe"])
def test_a_verb_that_does_not_exist_is_refused(verb):
    with pytest.raises(ValueError, match=f"verb '{verb}': there is none"):
        module_of(verb)
