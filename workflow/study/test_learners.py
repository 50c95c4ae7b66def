"""The rules that learn, on cases they cannot miss; `make study` runs this before the study.

Not among the project's tests, whose environment has neither scikit-learn nor PySINDy.
"""

import json

import numpy as np
import pytest

from sonicvacuum import records
from sonicvacuum_blind.baselines import forest, motion, state
from sonicvacuum_blind.baselines.terms import EFFECTS
from sonicvacuum_blind.hide import Spec, write


@pytest.mark.parametrize(
    "effect", ["linear-dashpot", "viscous-drag", "guide-friction", "dynamic-modulus", "none"]
)
def test_sparse_regression_names_the_term_in_motion_without_noise(effect, tmp_path):
    kind, effects = ("null", ()) if effect == "none" else ("single", (effect,))
    write(Spec("x", kind, "one-speed", "white", effects, 10.0, 4, 0), tmp_path / "r", tmp_path / "t")
    record = records.read(tmp_path / "r" / "x")
    truth = json.loads((tmp_path / "t" / "x" / "truth.json").read_text())
    made = state.rows(record, truth, 1e-5, np.random.default_rng(1))
    stiffness, chosen = state.select(made)
    true = motion.true_plan(record, record.runs[0], truth).modulus_ratio
    # The other term takes a share of the modulus where the two look alike.
    assert stiffness == pytest.approx(true, rel=0.02)
    terms = [list(EFFECTS.values())[k] for k in chosen]
    if effect in ("none", "dynamic-modulus"):
        return
    assert terms == [effect]


def test_forest_learns_what_one_feature_tells(monkeypatch):
    """One of ten features tells the name, the others are noise: cases not seen are named rightly."""
    from types import SimpleNamespace

    random = np.random.default_rng(3)
    labels = ["tsuji", "gravity", "none"] * 30
    table = random.standard_normal((90, 10))
    table[:, 4] += 20.0 * np.array([["tsuji", "gravity", "none"].index(x) for x in labels])
    table[::7, 2] = np.nan
    cases = [SimpleNamespace(row=SimpleNamespace(id=k), label=x) for k, x in enumerate(labels)]
    monkeypatch.setattr(forest, "_table", lambda chosen: table[[c.row.id for c in chosen]])
    monkeypatch.setattr(forest, "_labels", lambda chosen: np.array([c.label for c in chosen]))
    for names in (forest.cross_validated(cases), forest.trained(cases[:60], cases[60:])):
        # A tree tries two of the ten features at a split, so that one name in twenty may go wrong.
        assert np.mean([names[k] == labels[k] for k in names]) >= 0.95
        assert set(names) <= set(range(90))
