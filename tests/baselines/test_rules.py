"""Rules on hand-made cases whose right answer is plain."""

import math

import pytest
from made_cases import case, single

from sonicvacuum_blind.baselines import rules


def test_best_chi2_takes_the_largest_gain_and_names_nearly_always():
    made = case([single("tsuji", 3.0), single("gravity", 4.0), single("mass-defect", -1.0)])
    assert rules.best_chi2(made) == "gravity"
    assert rules.best_chi2(case([single("gravity", -1.0)])) == "none"
    assert rules.best_chi2(case()) == "none"


def test_bic_pays_for_every_parameter():
    """k ln N with N = 1000: 6.9 for one parameter, 20.7 for three."""
    simple, rich = single("tsuji", 10.0, 1), single("velocity-power", 20.0, 3)
    assert rules.bic(case([simple, rich])) == "tsuji"
    assert rules.bic(case([rich])) == "none"
    assert rules.bic(case([rich], data=100)) == "velocity-power"
    assert rules.bic(case([single("tsuji", 6.9)])) == "none"
    assert rules.bic(case([single("tsuji", 6.91)])) == "tsuji"


def test_nearest_shape_goes_by_the_size_of_the_cosine_alone():
    made = case([single("tsuji", 90.0, cosine=0.3), single("gravity", 2.0, cosine=-0.5), single("x", 1.0)])
    assert rules.nearest_shape(made) == "gravity"
    assert rules.likeness(made) == pytest.approx(0.5 * 1000**0.5)
    assert rules.nearest_shape(made, least=rules.likeness(made)) == "none"
    assert rules.likeness(case()) == 0.0


def test_likeness_is_that_beyond_the_chance_of_so_many_data():
    """A cosine of 0.9 with four data says less than one of 0.1 with a thousand."""
    few = case([single("tsuji", 1.0, cosine=0.9)], data=4)
    many = case([single("tsuji", 1.0, cosine=0.1)], data=1000)
    assert rules.likeness(few) < rules.likeness(many)


def test_least_likeness_lets_one_null_in_a_hundred_through():
    nulls = [case([single("tsuji", 1.0, cosine=k / 1000)]) for k in range(1001)]
    least = rules.least_likeness(nulls)
    assert least == pytest.approx(0.99 * 1000**0.5)
    assert sum(rules.nearest_shape(c, least) != "none" for c in nulls) == 10
    assert rules.least_likeness([]) == 0.0


def test_tables_without_cosines_are_told():
    assert not rules.has_cosines([case([single("tsuji", 1.0)])])
    assert rules.has_cosines([case([single("tsuji", 1.0, cosine=0.0)])])
    assert math.isnan(single("tsuji", 1.0).cosine)
