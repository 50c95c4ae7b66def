"""A law that the catalogue lacks replaces names that only come near it, and no others."""

import numpy as np
import pytest
import stiff_rate
from made_records import made

from sonicvacuum.blas import one_thread
from sonicvacuum.discover import unnamed
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.judge.law import formula, surface
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.search.singles import setup_of
from sonicvacuum.effects import CATALOGUE

SPEEDS = (0.3, 0.5, 0.9)
with_law = one_thread(unnamed.with_law)
STIFFER = ("stiffer", {"share": 0.15})


def investigation(effects, name, named=True):
    """Of a record with hidden effects one name that was found beside something unknown, or was in doubt."""
    own = CATALOGUE.extended([stiff_rate.EFFECT])
    forward = Forward(experiment(made(effects, seed=5, speeds=SPEEDS, catalogue=own)[0]))
    null = nominal(forward)
    effect = CATALOGUE.effect(name)
    one = Hypothesis((Component(effect, variants(effect, setup_of(forward))[0]),))
    starts = [[c.low + share * (c.high - c.low) for c in one.coordinates] for share in (0.2, 0.5, 0.8)]
    found = fit(forward, one, np.array(starts), null.nu)
    odds = {f"{name} + unknown": 0.6, "unknown": 0.4}
    return Investigation(
        forward, null, None, 0.0, [], odds,
        [name, "unknown"] if named else ["unknown"], found if named else null, {}, ["as it was"],
        rivals=[Rival(0.6, found)],
    )  # fmt: skip


@pytest.fixture(scope="module")
def told():
    """Of contacts that stiffen with the rate, for which a gauge's low-pass was found, which is wrong."""
    return with_law(investigation([STIFFER], "sensor-lowpass"))


def test_a_name_that_only_comes_near_is_gone(told):
    found, law = told
    assert found.named == ["unknown"]
    assert found.final is found.null
    assert found.probabilities["unknown"] > 0.99
    assert sum(found.probabilities.values()) == pytest.approx(1.0)
    assert "than sensor-lowpass" in found.reasons[0]
    size = sum(found.sizes)
    left, before = law.held_out.sum() - size, law.held_out_before.sum() - size
    assert left < 0.2 * before  # what is asked of a law outside the catalogue


def test_where_much_more_than_noise_is_left_a_law_takes_away_much_of_it_or_names_stay(monkeypatch):
    """A real chain's friction gave way to a law with a power of 5.8 of the rate that left as much as it."""
    one = investigation([STIFFER], "sensor-lowpass")
    size = sum(one.sizes)
    for much, most in ((False, 100.0), (True, 75.0)):
        monkeypatch.setattr(unnamed.gross, "gross", lambda *_, much=much: much)
        assert unnamed._Weighed(one)._most(size + 100.0) == size + most
    monkeypatch.setattr(unnamed.policy, "LAW_FURTHER", 0.9999)
    found, law = with_law(one)
    assert found is one and law is None


def test_the_formula_has_the_power_of_the_rate(told):
    words = formula(surface(told[1]))
    assert "sgn" not in words
    # The law's coefficients are rounded off where the rate is small, so that the power is only near.
    assert float(words.split("|^")[1]) == pytest.approx(stiff_rate.EXPONENT, abs=0.15)


def test_where_effects_were_in_doubt_the_law_beats_them():
    found, law = with_law(investigation([STIFFER], "sensor-lowpass", named=False))
    assert law is not None
    assert found.named == ["unknown"]
    assert found.probabilities["unknown"] > 0.99
    assert "any effects" in found.reasons[0]


def test_a_true_name_beside_such_a_law_stays():
    found, law = with_law(investigation([STIFFER, ("sensor-droop", {"tau_us": 300.0})], "sensor-droop"))
    assert law is not None
    assert found.named == ["sensor-droop", "unknown"]
    assert found.reasons == ["as it was"]


def test_a_true_law_of_the_catalogue_stays():
    one = investigation([("kuwabara-kono", {"time_us": 0.3})], "kuwabara-kono")
    found, law = with_law(one)
    assert law is None
    assert found is one


def test_what_leaves_nothing_unknown_is_not_asked():
    one = investigation([("kuwabara-kono", {"time_us": 0.3})], "kuwabara-kono")
    whole = Investigation(**{**vars(one), "named": ["kuwabara-kono"]})
    assert with_law(whole) == (whole, None)
