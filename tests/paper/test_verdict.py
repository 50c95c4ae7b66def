"""Verdicts: what counts as reproduced, as a disagreement, and as not testable."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from sonicvacuum.files import InputError
from sonicvacuum_paper.verdict import BOUND, DISAGREES, LIMIT, NOT_TESTABLE, REPRODUCED, TESTS, Target, judge

VALUES = st.floats(-1e6, 1e6)
SIGMAS = st.floats(1e-6, 1e6)
ERRORS = st.floats(0.0, 1e6)
BOUNDED = ("equals", "at_least", "at_most", "between")


def target(test, value, sigma):
    return Target(
        test, *{"at_least": (value, math.inf), "at_most": (-math.inf, value)}.get(test, (value, value)), sigma
    )


@given(value=VALUES, claimed=VALUES, sigma=SIGMAS)
def test_equals_turns_at_the_limit(value, claimed, sigma):
    difference = (value - claimed) / sigma
    assume(abs(abs(difference) - LIMIT) > 1e-6)
    judged = judge(target("equals", claimed, sigma), value)
    assert judged.verdict == (DISAGREES if abs(difference) > LIMIT else REPRODUCED)
    assert judged.difference_sigma == pytest.approx(difference, rel=1e-12)  # rounding


@given(test=st.sampled_from(BOUNDED), value=VALUES, claimed=VALUES, sigma=st.just(0.0) | SIGMAS, error=ERRORS)
def test_a_difference_below_the_numerical_error_never_disagrees(test, value, claimed, sigma, error):
    assume(test != "equals" or sigma > 0.0)
    assume(abs(value - claimed) <= error)
    assert judge(target(test, claimed, sigma), value, error).verdict == REPRODUCED


@given(test=st.sampled_from(BOUNDED), value=VALUES, claimed=VALUES, sigma=SIGMAS, error=ERRORS)
def test_a_numerical_error_only_ever_softens(test, value, claimed, sigma, error):
    hard, soft = (judge(target(test, claimed, sigma), value, e) for e in (0.0, error))
    assert abs(soft.difference_sigma) <= abs(hard.difference_sigma)
    assert not (hard.verdict == REPRODUCED and soft.verdict == DISAGREES)


@given(value=VALUES, bound=VALUES, sigma=st.just(0.0) | SIGMAS)
def test_at_least_mirrors_at_most(value, bound, sigma):
    below, above = (
        judge(target("at_least", bound, sigma), value),
        judge(target("at_most", -bound, sigma), -value),
    )
    assert below.verdict == above.verdict
    assert below.difference_sigma == -above.difference_sigma or math.isnan(below.difference_sigma)


@given(value=VALUES, low=VALUES, high=VALUES, sigma=st.just(0.0) | SIGMAS)
def test_between_is_at_least_and_at_most(value, low, high, sigma):
    assume(low <= high)
    inside = judge(Target("between", low, high, sigma), value).verdict
    both = {
        judge(target("at_least", low, sigma), value).verdict,
        judge(target("at_most", high, sigma), value).verdict,
    }
    assert (inside == REPRODUCED) == (both == {REPRODUCED})


@given(value=VALUES, claimed=VALUES, sigma=SIGMAS)
def test_within_turns_at_its_bound(value, claimed, sigma):
    beyond = abs(value - claimed) - BOUND * sigma
    assume(abs(beyond) > 1e-6 * (1.0 + abs(claimed)))
    judged = judge(target("within", claimed, sigma), value)
    assert judged.verdict == (DISAGREES if beyond > 0.0 else REPRODUCED)


def test_a_bound_is_the_sum_of_two_equal_errors():
    # The standard error of the sum of two uniform errors of half width h each, over its bound 2 h.
    one = np.linspace(-1.0, 1.0, 2001)
    total = one[:, None] + one[None, :]
    assert 2.0 / np.sqrt(np.mean(total**2)) == pytest.approx(BOUND, rel=2e-3)  # 2001 points


def test_strict_bound_is_strict_and_has_no_difference_in_sigma():
    judged = judge(target("at_most", 1.0, 0.0), 1.0001)
    assert judged.verdict == DISAGREES and math.isnan(judged.difference_sigma)
    assert judge(target("at_most", 1.0, 0.0), 1.0).difference_sigma == 0.0


def test_rounding_is_no_disagreement():
    assert judge(target("at_least", 0.3, 0.0), 0.1 * 3 - 1e-16).verdict == REPRODUCED


@pytest.mark.parametrize(("value", "verdict"), [(3, REPRODUCED), (2, DISAGREES), (4, DISAGREES)])
def test_count_is_the_integer_itself(value, verdict):
    assert judge(target("count", 3.0, 0.0), value).verdict == verdict


@pytest.mark.parametrize(("value", "verdict"), [(1.0, REPRODUCED), (0.0, DISAGREES)])
def test_order_holds_or_not(value, verdict):
    assert judge(target("order", 1.0, 0.0), value).verdict == verdict


@pytest.mark.parametrize("test", ["count", "order"])
def test_what_changes_with_the_step_is_not_testable(test):
    assert judge(target(test, 1.0, 0.0), 1.0, 1.0).verdict == NOT_TESTABLE


@pytest.mark.parametrize("test", TESTS)
def test_no_value_no_verdict(test):
    assert judge(target(test, 1.0, 1.0), math.nan).verdict == NOT_TESTABLE


def test_unknown_error_counts_as_none():
    assert judge(target("equals", 1.0, 0.1), 1.5, math.nan) == judge(target("equals", 1.0, 0.1), 1.5, 0.0)


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        (("about", "3", ""), "test is 'about'; use one of equals, within, at_least"),
        (("equals", "3", ""), "sigma is missing"),
        (("equals", "three", "1"), "'three' or sigma '1' is not a number"),
        (("between", "3", ""), "`between` needs lo..hi"),
        (("at_most", "1..3", ""), "`between` needs lo..hi"),
        (("between", "3..1", ""), "must ascend"),
        (("at_most", "3", "-1"), "must not be negative"),
    ],
)
def test_a_target_that_does_not_fit_names_its_place(cells, message):
    with pytest.raises(InputError, match=f"claims.csv: speed: .*{message}"):
        Target.parse(*cells, where="claims.csv: speed")


def test_bounds_of_a_parsed_target():
    assert Target.parse("between", "100..1000", "500") == Target("between", 100.0, 1000.0, 500.0)
    assert Target.parse("at_least", "5") == Target("at_least", 5.0, math.inf, 0.0)
    assert Target.parse("at_most", "5") == Target("at_most", -math.inf, 5.0, 0.0)
