"""Numbers of the terminal: no digits beyond an error, no unit of what has none."""

from types import SimpleNamespace

import pytest
from click.testing import CliRunner

from sonicvacuum.cli import cli
from sonicvacuum.export import result
from sonicvacuum.export.table import Coefficient, Measured
from sonicvacuum.prediction.design_text import places


@pytest.mark.parametrize(
    ("value", "sigma", "told"),
    [(0.55124, 0.028, "0.551 +- 0.028"), (0.9819, 0.005, "0.9819 +- 0.0050"), (2.0, None, "2"),
     (4.2e-9, 1.3e-10, "4.2e-09 +- 1.3e-10")],
)  # fmt: skip
def test_a_coefficient_has_the_digits_of_its_error(value, sigma, told):
    one = Coefficient(effect="kuwabara-kono", parameter="time_us", value=value, sigma=sigma, unit="us")
    assert result._coefficient(one) == f"  kuwabara-kono time_us = {told} us"


def test_a_pure_number_has_no_unit():
    one = Measured(
        run="v0", quantity="restitution", speed_m_s=0.1, value=0.9819, sigma=0.005, model=0.9682, unit="1"
    )
    assert result._measured(one) == "  v0: restitution at 0.1 m/s 0.9819 +- 0.0050, model 0.9682"


def test_gauges_are_listed_with_one_and():
    assert places(["8", "10", "wall"]) == "beads 8, 10 and wall"
    assert places(["8", "10"]) == "beads 8 and 10" and places(["8", "wall"]) == "bead 8 and wall"


def test_compare_says_what_its_numbers_are(monkeypatch, tmp_path):
    score = SimpleNamespace(gap=SimpleNamespace(before=6.283, after=0.9808), warnings=[])
    monkeypatch.setattr("sonicvacuum.discover.compare.read_model", lambda *_: None)
    monkeypatch.setattr("sonicvacuum.discover.compare.compare", lambda *_: score)
    monkeypatch.setattr("sonicvacuum.discover.verdict.write_json", lambda *_: None)
    monkeypatch.setattr("sonicvacuum.records.read", lambda _: None)
    (tmp_path / "rec").mkdir()
    (tmp_path / "model.json").write_text("{}")
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(cli, ["compare", "rec", "--model", "model.json", "--json", "score.json"])
    said = "rec: mean squared misfit over that of the noise: nominal model 6.28, MODEL 0.981\n"
    assert done.output == said
