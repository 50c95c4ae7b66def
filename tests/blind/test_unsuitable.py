"""Files that a verb of the blind test is not meant for: one message with file and cure, nothing written."""

import pytest
from case_files import put
from click.testing import CliRunner

from sonicvacuum.cli import cli
from sonicvacuum.files import InputError

# As `hide` and `discover` leave them; extras and slips state other things of their cases.
TRUTH = {
    **{"id": "x", "kind": "single", "design": "traces", "noise": "white", "effects": ["tsuji"]},
    **{"d_prime": 10.0, "leftover_d_prime": 0.5, "nearest": {"id": "gravity"}, "seed": 5, "place": 0},
    "hidden": [{"id": "tsuji", "parameters": {"alpha": 0.1}, "d_prime": 10.0}],
}
VERDICT = {
    **{"named": ["tsuji"], "probabilities": {"tsuji": 1.0}, "confusable": [], "parameters": {}, "faults": []},
    **{"gap": {"fitted": {"before": 2.0, "after": 1.0}}, "timing_s": {"total": 1.0}},
    **{"alarms": {"none": 0.5}, "next_experiment": None},
}
SLIP = {"slip": "sound", "setup": 0, "run": None, "sensor": None}
COMPARED = {"data": 100, "gap": {"before": 1.5, "after": 1.1}}


def without(content, key):
    return {name: value for name, value in content.items() if name != key}


def refused(folder, verb, truth=TRUTH, verdict=VERDICT, candidates=None, more=()):
    """The message of a verb that counts; it must have written nothing."""
    put(folder / "truth", "x", "truth.json", truth)
    put(folder / "found", "x", "verdict.json", verdict)
    put(folder / "compared", "x", "compared.json", COMPARED)
    if candidates:
        (folder / "found" / "x" / "candidates.csv").write_text(candidates)
    outputs = {"--out": folder / "out.csv"} | ({} if verb == "calibrate" else {"--summary": folder / "s.csv"})
    call = [f"--truth={folder / 'truth'}", f"--verdicts={folder / 'found'}", *more]
    call += [f"{option}={path}" for option, path in outputs.items()]
    done = CliRunner().invoke(cli, ["blind", verb, *call])
    assert isinstance(done.exception, InputError), done.exception
    assert not any(path.exists() for path in outputs.values())
    return str(done.exception)


@pytest.mark.parametrize("verb, key", [("slips-score", "slip"), ("extras-score", "chi2_systematic")])
def test_truths_of_hide_are_none_of_slips_and_extras(tmp_path, verb, key):
    told = refused(tmp_path, verb)
    assert f"{key}: missing" in told
    assert str(tmp_path / "truth" / "x" / "truth.json") in told
    assert f"truths of sonicvacuum blind {verb.removesuffix('-score')}" in told


def test_a_slip_that_nobody_knows_is_named(tmp_path):
    told = refused(tmp_path, "slips-score", TRUTH | SLIP | {"slip": "coffee"})
    assert "slip 'coffee' is not one of sound" in told


@pytest.mark.parametrize(
    "verb, key",
    [("slips-score", "faults"), ("extras-score", "gap"), ("score", "parameters"), ("score", "named")],
)
def test_a_verdict_without_a_key_that_is_counted_is_named(tmp_path, verb, key):
    told = refused(tmp_path, verb, TRUTH | SLIP, without(VERDICT, key))
    assert f"{tmp_path / 'found' / 'x' / 'verdict.json'}" in told
    assert f"{key}: missing" in told


def test_a_number_that_is_none_is_named_with_its_files(tmp_path):
    more = [f"--compared={tmp_path / 'compared'}"]
    told = refused(tmp_path, "foretold", TRUTH | {"d_prime": "much"}, more=more)
    assert "'much'" in told and str(tmp_path / "truth" / "x" / "truth.json") in told


@pytest.mark.parametrize(
    "candidates, words",
    [
        ("name,price\ntea,2\n", "no column effects"),
        ("effects,log10_bayes\ntsuji,much\n", "'much'"),
    ],
)
def test_foreign_tables_of_candidates_do_not_calibrate(tmp_path, candidates, words):
    told = refused(tmp_path, "calibrate", candidates=candidates)
    assert str(tmp_path / "found" / "x" / "candidates.csv") in told
    assert words in told


def test_calibrate_names_what_a_verdict_lacks(tmp_path):
    table = "effects,log10_bayes\ntsuji,3\n"
    assert "alarms: missing" in refused(
        tmp_path, "calibrate", verdict=without(VERDICT, "alarms"), candidates=table
    )
