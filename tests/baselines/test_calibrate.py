"""Calibration: probabilities that come true, from cases whose truth is known."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum.discover.fit.calibration import Calibration, of_package
from sonicvacuum.files import InputError
from sonicvacuum_blind.baselines.calibrate import Outcome, calibrate, outcomes

NAMES = ("none", "tsuji", "gravity")


def drawn(temper, count, seed=3):
    """Cases whose truth follows probabilities of weights tempered by `temper`, none of them unknown."""
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    cases = []
    for _ in range(count):
        logs = dict(zip(NAMES, rng.normal(0.0, 3.0, 3).tolist(), strict=True))
        weights = np.exp(temper * np.array(list(logs.values())))
        truth = str(rng.choice(NAMES, p=weights / weights.sum()))
        cases.append(Outcome(logs, -20.0, truth))
    return cases


def test_overconfident_evidence_is_tempered():
    found = calibrate(drawn(0.5, 2000))
    # The standard error of the temper from 2000 cases is 0.02.
    assert found.temper == pytest.approx(0.5, abs=0.08)
    assert found.none == pytest.approx(0.0, abs=0.3)  # its standard error is 0.08
    assert found.cases == 2000


@given(st.floats(0.2, 3.0), st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(0.2, 4.0))
def test_any_calibration_gives_probabilities(temper, none, unknown, slope):
    p = Calibration(temper, none, unknown, slope).probabilities({"none": 0.0, "tsuji": 5.0}, -1.0)
    assert math.isclose(sum(p.values()), 1.0, abs_tol=1e-12)  # rounding
    assert set(p) == {"none", "tsuji", "unknown"}


def test_the_package_is_calibrated():
    assert of_package().cases > 200


def test_cases_without_verdict_are_named(tmp_path):
    (tmp_path / "truth/a").mkdir(parents=True)
    (tmp_path / "truth/a/truth.json").write_text('{"kind": "null", "effects": []}')
    (tmp_path / "verdicts").mkdir()
    with pytest.raises(InputError, match="no verdict for a"):
        outcomes(tmp_path / "truth", tmp_path / "verdicts")


def test_sets_are_cases_too(tmp_path):
    for folder in ("truth/a", "verdicts/a"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "truth/a/truth.json").write_text('{"kind": "pair", "effects": ["tsuji", "gravity"]}')
    (tmp_path / "verdicts/a/verdict.json").write_text('{"alarms": {"single": 1e-6, "pair": 0.5}}')
    (tmp_path / "verdicts/a/candidates.csv").write_text(
        "effects,delta_chi2,log10_bayes\ntsuji,60,10\ngravity+tsuji,110,20\ntsuji+gravity,112,21\n"
    )
    (case,) = outcomes(tmp_path / "truth", tmp_path / "verdicts")
    assert case.truth == "gravity + tsuji"
    assert set(case.logs) == {"none", "tsuji", "gravity + tsuji"}
    assert case.unknown < 0.0  # the pair leaves noise
    # The second effect has a prior of its own, which its evidence has to make up for.
    assert case.logs["gravity + tsuji"] - case.logs["tsuji"] < 11.0 * math.log(10.0)
