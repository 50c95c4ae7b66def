"""What a rule depends on is what its verb imports: an edit reruns these rules and no others."""

import os
import shutil
import subprocess
import sys

import pytest

from sonicvacuum.cli.sources import digest, files, imported, module_of

PAGES = ("sonicvacuum.cli.page", "sonicvacuum.drawn")
MODEL = ("sonicvacuum.cli.model",)
CATALOGUE = ("sonicvacuum.effects",)
# Verb as the rules call it → what the call never loads.
VERBS = {
    "card": MODEL,
    "simulate": MODEL,
    "discover": PAGES,
    "page": (),
    "paper observe": (),
    "paper draw": (),
    "paper uncertainty": (),
    "paper rivals": (),
    "paper ledger": (),
    "paper report": (),
    "paper runs": (),
    "blind page": (),
    "blind hide": CATALOGUE,
    "blind score": CATALOGUE,
    "blind draw": (),
}
ENGINE = {
    *("card", "simulate", "discover", "page"),
    *("paper observe", "paper draw", "paper report", "paper runs", "paper uncertainty", "paper rivals"),
}


@pytest.mark.parametrize(
    ("edited", "rerun"),
    [
        ("sonicvacuum.physics.kernel", ENGINE),
        ("sonicvacuum.effects.tsuji", ENGINE),
        ("sonicvacuum.discover.rounds", {"discover", "page", "paper report"}),
        ("sonicvacuum.discover.fit.wide", {"discover", "page", "paper report", "paper rivals"}),
        ("sonicvacuum.report.words", {"page", "paper report"}),
        ("sonicvacuum_paper.gauges", {"paper observe", "paper uncertainty", "paper rivals"}),
        ("sonicvacuum_paper.figures.fig3", {"paper draw", "paper report"}),
        ("sonicvacuum_paper.wording", {"paper ledger", "paper report"}),
        ("sonicvacuum_blind.stepper", {"blind hide", "blind score", "blind page"}),
        ("sonicvacuum_blind.summary", {"blind score"}),
        ("sonicvacuum_blind.figures", {"blind draw", "blind page"}),
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


def test_files_are_named_from_their_package_in_order_with_the_data_beside_them():
    found = files(["page"])
    assert list(found) == sorted(found)
    assert all(path.is_file() and path.as_posix().endswith(name) for name, path in found.items())
    assert {
        "sonicvacuum/report/record.html.j2",
        "sonicvacuum/report/style.css",
        "sonicvacuum/discover/fit/calibration.json",
        "sonicvacuum/report/words.py",
        "sonicvacuum/__init__.py",
    } <= set(found)
    assert {name.split("/")[0] for name in found} == {"sonicvacuum"}


DIGESTS = f"""
from sonicvacuum.cli.sources import digest
for verb, without in {VERBS!r}.items():
    print(verb, digest([verb], without), sep=":")
"""


@pytest.fixture
def copied(tmp_path, pytestconfig):
    """A copy of the packages, and what finds the digest of every verb there."""
    source = tmp_path / "elsewhere" / "src"
    shutil.copytree(pytestconfig.rootpath / "src", source, ignore=shutil.ignore_patterns("__pycache__"))

    def digests():
        environment = os.environ | {"PYTHONPATH": str(source)}
        done = subprocess.run(
            [sys.executable, "-c", DIGESTS], env=environment, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        return dict(line.split(":") for line in done.stdout.splitlines())

    return source, digests


def test_digests_say_what_stands_in_the_files_and_not_where_they_lie(copied):
    source, digests = copied
    here = {verb: digest([verb], without) for verb, without in VERBS.items()}
    assert digests() == here
    assert len(set(here.values())) == len(here)
    # A module, and a template beside modules.
    for edited, rerun in (
        ("sonicvacuum_blind/stepper.py", {"blind hide", "blind score", "blind page"}),
        ("sonicvacuum/report/record.html.j2", {"page", "paper report", "paper runs", "blind page"}),
    ):
        before = digests()
        with open(source / edited, "a") as stream:
            stream.write("# edited\n")
        after = digests()
        assert {verb for verb in VERBS if after[verb] != before[verb]} == rerun


def test_files_beside_the_sources_count_by_content(tmp_path):
    found = {digest(["simulate"], MODEL)}
    for version in ("2.0", "2.1"):
        lock = tmp_path / version / "requirements.lock"
        lock.parent.mkdir()
        lock.write_text(f"numpy=={version}\n")
        found.add(digest(["simulate"], MODEL, [lock]))
    assert len(found) == 3


@pytest.mark.parametrize("verb", ["guess", "paper guess", "card observe"])
def test_a_verb_that_does_not_exist_is_refused(verb):
    with pytest.raises(ValueError, match=f"verb '{verb}': there is none"):
        module_of(verb)
