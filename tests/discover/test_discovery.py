"""From a record to a verdict, on small records: what is named, how sure, what is written, what is refused."""

import json

import msgspec
import numpy as np
import pytest
from click.testing import CliRunner
from made_records import DAMPING, made
from scipy.optimize import least_squares

import sonicvacuum as sv
from sonicvacuum import records
from sonicvacuum.cli.compare import compare
from sonicvacuum.cli.discover import discover
from sonicvacuum.discover import session, written
from sonicvacuum.discover.compare import read_model
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import directions, screen
from sonicvacuum.discover.verdict import Verdict
from sonicvacuum.effects import IDS, effect
from sonicvacuum.files import InputError


def test_the_batch_fit_finds_what_scipy_finds(hidden, setup):
    forward = Forward(experiment(hidden))
    (free,) = variants(effect("kuwabara-kono"), setup)
    one = Hypothesis((Component(effect("kuwabara-kono"), free),))
    found = fit(forward, one, np.array([[-2.0]]), np.zeros((1, forward.layout.size)))

    def residuals(x):
        values = forward.sampled(one, x[None, :1], x[None, 1:])
        parts = [forward.data(run) - value[0] for run, value in enumerate(values)]
        return np.concatenate([*parts, x[1:]])

    start = np.concatenate([[-2.0], np.zeros(forward.layout.size)])
    reference = least_squares(residuals, start, x_scale="jac", diff_step=1e-4, xtol=1e-10, ftol=1e-10)
    # Both stop where χ² gains less than 1e-3.
    assert found.objective == pytest.approx(2.0 * reference.cost, abs=0.01)
    assert found.u[0] == pytest.approx(reference.x[0], abs=0.05 * found.sigma[0])  # a small part of its error


def test_a_direction_like_a_nuisance_keeps_what_the_prior_leaves(empty, setup):
    forward = Forward(experiment(empty))
    families = directions.of_effect(effect("dynamic-modulus"), setup)
    families += directions.of_effect(effect("sensor-gain"), setup)
    found = screen.screen(forward, nominal(forward), families)
    # One typical departure (0.5; 0.1) over the prior's standard error (0.05; 0.02), less what the data miss
    # of 1.
    assert found.length[0] == pytest.approx(0.5 / 0.05, rel=0.01)
    assert found.length[1:] == pytest.approx(0.1 / 0.02, rel=0.05)


def test_hidden_damping_is_named_and_measured(verdict):
    v = verdict.verdict
    assert v.named == ["kuwabara-kono"]
    assert max(v.probabilities, key=v.probabilities.get) == "kuwabara-kono"
    found = v.parameters["kuwabara-kono"]["time_us"]
    assert abs(found.value - DAMPING) < 4.0 * found.sigma
    assert found.sigma < 0.2 * DAMPING  # it is measured, not merely allowed
    assert v.gap.fitted.after == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / verdict.found.sizes.sum()))
    assert v.gap.held_out.after < v.gap.held_out.before
    assert v.where


def test_nothing_is_named_where_nothing_is_missing(nothing):
    v = nothing.verdict
    assert v.named == []
    assert v.parameters == {}
    assert v.gap.fitted.before == v.gap.fitted.after
    assert max(v.probabilities, key=v.probabilities.get) == "none"


def test_probabilities_cover_the_catalogue_and_add_up(verdict):
    p = verdict.verdict.probabilities
    assert {name for key in p for name in key.split(" + ")} <= {"none", "unknown", *IDS}
    sets = {key: value for key, value in p.items() if " + " in key}
    # What may hide behind the one effect that was named has it, and is far less likely.
    assert all(verdict.verdict.named[0] in key for key in sets)
    assert 0.0 < sum(sets.values()) < 0.1
    assert sum(p.values()) == pytest.approx(1.0, abs=1e-9)  # rounding


def test_the_verdict_does_not_depend_on_threads(hidden, verdict, monkeypatch):
    # Fits of this small record are short, and would follow one another.
    monkeypatch.setattr("sonicvacuum.discover.model.abreast.SAVED", -1.0)
    again = session.discover(hidden, threads=2).verdict
    same = ("named", "probabilities", "parameters", "gap", "where", "upper_limits", "simulations")
    assert all(getattr(again, key) == getattr(verdict.verdict, key) for key in same)


def test_files_are_written_and_read_back(verdict, tmp_path):
    written.write(verdict, tmp_path / "out")
    text = (tmp_path / "out/verdict.json").read_bytes()
    assert msgspec.json.decode(text, type=Verdict) == verdict.verdict
    names = {p.name for p in (tmp_path / "out").iterdir()}
    assert names == {
        "verdict.json", "model.json", "where.csv", "candidates.csv", "gap.csv", "limits.csv", "traces.csv",
        "given.json", "posterior.csv",
    }  # fmt: skip
    model = read_model(tmp_path / "out/model.json")
    assert list(model.effects) == [n for n in verdict.verdict.named if n != "unknown"]


def test_python_takes_what_was_found_as_it_takes_the_file(verdict, tmp_path):
    written.write(verdict, tmp_path / "out")
    assert read_model(tmp_path / "out/model.json") == verdict.model
    new = made([("kuwabara-kono", {"time_us": 0.3})], seed=9, speeds=(0.6,))[0]
    given = (verdict, verdict.model, tmp_path / "out/model.json")
    first, *others = (sv.compare(model, new, threads=1) for model in given)
    assert first.effects == ["kuwabara-kono"]
    assert others == [first, first]


def test_a_model_closes_the_gap_of_a_record_it_has_not_seen(verdict, tmp_path):
    written.write(verdict, tmp_path / "out")
    records.write(made([("kuwabara-kono", {"time_us": 0.3})], seed=9, speeds=(0.6,))[0], tmp_path / "new")
    call = [str(tmp_path / "new"), "--model", str(tmp_path / "out/model.json")]
    result = CliRunner().invoke(compare, [*call, "--json", str(tmp_path / "score.json")])
    assert result.exit_code == 0, result.output
    score = json.loads((tmp_path / "score.json").read_text())
    assert score["gap"]["after"] < score["gap"]["before"]
    assert score["gap"]["after"] == pytest.approx(1.0, abs=6.0 * np.sqrt(2.0 / score["data"]))


def test_a_bad_model_is_refused_with_its_key(tmp_path):
    path = tmp_path / "model.json"
    content = {"record": "r", "speed_ratio": {}, "trigger_us": {}, "gain": {}, "modulus_ratio": 1.0}
    path.write_text(json.dumps({**content, "effects": {"magic": {}}}))
    with pytest.raises(InputError, match=r"effects\.magic: no such effect"):
        read_model(path)
    path.write_text(json.dumps({**content, "effects": {"tsuji": {"beta": 1.0}}}))
    with pytest.raises(InputError, match=r"effects\.tsuji\.beta: unknown key"):
        read_model(path)
    path.write_text("{")
    with pytest.raises(InputError, match="not a model"):
        read_model(path)


def test_a_missing_record_leaves_nothing_behind(tmp_path):
    result = CliRunner().invoke(discover, [str(tmp_path / "none"), "--out", str(tmp_path / "out")])
    assert isinstance(result.exception, InputError)
    assert not (tmp_path / "out").exists()
