"""A law of the user's own, from its file to verdict.json, model.json and its score on a further run."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from made_records import made

import sonicvacuum as sv
from sonicvacuum import plugins, records
from sonicvacuum.cli.compare import compare
from sonicvacuum.cli.discover import discover
from sonicvacuum.discover.compare import read_model
from sonicvacuum.files import InputError

LAW = Path(__file__).with_name("deep_damping.py")
DAMPING = 3e4


def call(verb, *words):
    """Run a verb; its exception, None where all went well."""
    return CliRunner().invoke(verb, [str(w) for w in words]).exception


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A record with the hidden law, what was found in it with the law's file, and one further run."""
    root, known = tmp_path_factory.mktemp("own"), plugins.catalogue([LAW])
    hidden = [("deep-damping", {"damping_kg_s_m": DAMPING})]
    records.write(made(hidden, seed=21, speeds=(0.3, 1.5), catalogue=known)[0], root / "record")
    records.write(made(hidden, seed=22, speeds=(0.7,), catalogue=known)[0], root / "further")
    words = ("--out", root / "found", "--no-figures", "--threads", 1, "--effects", LAW)
    assert call(discover, root / "record", *words) is None
    return root


def written(folder, name):
    return json.loads((folder / "found" / name).read_text())


def test_the_law_is_named_measured_and_said_where_it_is_from(folder):
    verdict, model = written(folder, "verdict.json"), written(folder, "model.json")
    assert verdict["named"] == ["deep-damping"]
    value = verdict["parameters"]["deep-damping"]["damping_kg_s_m"]
    assert abs(value["value"] - DAMPING) < 4.0 * value["sigma"]
    assert list(model["effects"]) == ["deep-damping"]
    source = {"name": LAW.name, "sha256": plugins.read(LAW)[0].source.sha256}
    assert verdict["sources"] == model["sources"] == {"deep-damping": source}


def score(folder, *words):
    model = folder / "found" / "model.json"
    path = folder / "score.json"
    return call(compare, folder / "further", "--model", model, "--json", path, *words), path


def test_the_model_closes_the_gap_of_a_further_run(folder):
    failed, path = score(folder, "--effects", LAW)
    assert failed is None
    gap = json.loads(path.read_text())["gap"]
    assert gap["before"] > 10.0
    assert gap["after"] == pytest.approx(1.0, abs=0.15)  # six standard errors √(2/2100), and the model's


def test_python_scores_and_simulates_it_as_the_command_does(folder):
    model, known = folder / "found/model.json", sv.catalogue(LAW)
    assert known.ids[-1] == "deep-damping"
    further = sv.read(folder / "further")
    found = sv.compare(model, further, threads=1, catalogue=known)
    assert found.effects == ["deep-damping"]
    assert found.gap.after < 0.1 * found.gap.before
    for given in (model, read_model(model, known)):
        with pytest.raises(sv.InputError, match=r"comes from deep_damping\.py"):
            sv.compare(given, further, threads=1)
    ball = sv.bead(diameter_mm=5.0, material="glass")
    effects = {"deep-damping": {"damping_kg_s_m": DAMPING}}
    parts = sv.chain(bead=ball, beads=4), sv.striker(ball, speed_m_s=0.5), [sv.gauge("wall")]
    card = sv.case(*parts, duration_us=100, effects=effects)
    assert sv.simulate(card, known).readings()["wall"].max() > 0.0
    with pytest.raises(sv.InputError, match="no effect is called 'deep-damping'"):
        sv.simulate(card)
    plain = sv.case(*parts, duration_us=100)
    damped = [
        sv.simulate(plain, known, model=m).readings()["wall"] for m in (model, read_model(model, known))
    ]
    assert damped[0].max() < 0.99 * sv.simulate(plain).readings()["wall"].max()
    assert (damped[0] == damped[1]).all()
    with pytest.raises(sv.InputError, match=r"comes from deep_damping\.py"):
        sv.simulate(plain, model=model)


def test_without_its_file_the_model_is_refused(folder):
    failed, _ = score(folder)
    assert isinstance(failed, InputError)
    assert "effects.deep-damping: comes from deep_damping.py" in str(failed)
    assert "give its file with --effects" in str(failed)


def test_with_an_edited_file_the_model_is_refused(folder, tmp_path):
    (tmp_path / "other.py").write_text(LAW.read_text() + "\n# Another text, though the same law.\n")
    failed, _ = score(folder, "--effects", tmp_path / "other.py")
    assert isinstance(failed, InputError)
    assert "was made with deep_damping.py" in str(failed)
