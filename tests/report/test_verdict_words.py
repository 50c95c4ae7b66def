"""What was found, how sure that is and what is left open, in words."""

import pytest
from made_verdicts import KINDS, gaps, model, verdict
from msgspec.structs import replace

from sonicvacuum.discover.parts import CellFit, GoodnessOfFit
from sonicvacuum.discover.verdict import Where
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.report import bench, misfit, rows, words


@pytest.mark.parametrize(
    ("probability", "text"),
    [
        (1.0, "practically certain (above 0.99)"),
        (0.96, "very probable (0.96)"),
        (0.85, "probable (0.85)"),
        (0.5, "more probable than not (0.50)"),
        (0.2, "less probable than all its rivals together (0.20)"),
    ],
)
def test_probabilities_in_words(probability, text):
    assert words.in_words(probability) == text


@pytest.mark.parametrize(
    ("ps", "told"),
    [
        ([0.1], "there with probability 0.1."),
        ([0.1, 0.9], "there with probability 0.1, in some trace of 2 with 0.19."),
        ([1e-30, 0.9, 0.8], "there with probability 1e-30, in some trace of 3 with 3e-30."),
        ([1.0, 1.0], "there with probability 1, in some trace of 2 with 1."),
    ],
)
def test_the_worst_of_many_traces_is_told_as_that(ps, told):
    """One of twelve traces has a p below 0.08 more often than not."""
    cells = [CellFit(run="a", sensor=f"g{k}", chi2=2.0 - k, p=p, whiteness=0.5) for k, p in enumerate(ps)]
    left = GoodnessOfFit(nominal=cells, extended=cells, p={}, smooth_rel=0.0, wider=1.0)
    assert misfit.goodness(verdict(fit=left)).endswith(told)


def test_a_gap_that_is_not_closed_is_not_called_closed():
    assert "the gap is not closed" in misfit.gap(verdict(gap=gaps(2.0, 2.5)))
    assert "of the gap closed" not in misfit.gap(verdict(gap=gaps(0.9, 0.8)))


def test_runs_left_out_that_show_nothing_are_told_by_their_number():
    same = verdict(gap=gaps(9.0, 1.0, (9.0, 9.0)))
    assert misfit.gap(same, 2).endswith("the remaining run does not show the effect by itself.")
    assert misfit.gap(same, 4).endswith("the remaining runs do not show the effect by themselves.")


@pytest.mark.parametrize(
    ("feature", "z", "said"),
    [
        ("speed_at_amplitude", 3.0, "the measured speed at the stated amplitude is higher than predicted"),
        ("duration", -3.0, "the measured duration is shorter than predicted"),
        ("amplitude", -3.0, "the measured amplitude is lower than predicted"),
    ],
)
def test_a_quantity_is_told_on_its_side(feature, z, said):
    where = [Where(run="a", sensor="", feature=feature, z=z, p=1e-4)]
    cells = [{"sensor": "", "feature": feature, "q_before": "1e-4"}]
    assert said in misfit.where(verdict(where=where), cells)


def test_a_modulus_that_had_to_move_far_is_told_first():
    far = replace(model(KINDS["none"]), modulus_ratio=3.07)
    assert "has to be 3.07 times as large as recorded" in bench.moved_modulus(KINDS["none"], far)
    assert bench.moved_modulus(KINDS["none"], replace(far, modulus_ratio=1.1)) == ""
    assert bench.moved_modulus(KINDS["single"], far) == ""


def test_data_in_which_nothing_would_show_are_not_called_free_of_effects():
    blind = {"named": [], "parameters": {}, "upper_limits": {}, "not_testable": ["gravity", "tsuji"]}
    odds = {"none": 0.999, "unknown": 0.001}
    text = words.headline(verdict(**blind, probabilities=odds))
    assert "no effect of the catalogue would show" in text
    assert "certain" not in text
    some = blind | {"upper_limits": {"tsuji": {"gamma": 0.1}}, "not_testable": ["gravity"]}
    text = words.headline(verdict(**some, probabilities=odds))
    assert "none of the effects that these data could show is missing is practically certain" in text


def test_none_that_is_less_probable_than_an_effect_says_so():
    odds = {"none": 0.3, "tsuji": 0.6, "unknown": 0.1}
    text = words.headline(verdict(named=[], probabilities=odds, parameters={}))
    assert "damping with constant restitution (0.60 against 0.30 for none)" in text


def test_a_set_beside_something_unknown_is_called_the_nearest():
    odds = {
        "unknown": 0.5,
        "gravity + unknown": 0.23,
        "tsuji + unknown": 0.23,
        "gravity + tsuji + unknown": 0.04,
    }
    named = ["tsuji", "gravity", "unknown"]
    text = words.headline(verdict(named=named, probabilities=odds, parameters={}))
    assert text.startswith("Something is missing that nothing of the catalogue explains. Two of its effects")
    assert text.index("(tsuji)") < text.index("(gravity)")
    assert text.endswith(
        "probability 0.04; that one of them is 0.46; that it is something unknown alone 0.50."
    )
    surer = odds | {"unknown": 0.02, "gravity + tsuji + unknown": 0.52}
    text = words.headline(verdict(named=named, probabilities=surer, parameters={}))
    assert text.startswith("Two effects are missing")


@pytest.mark.parametrize(
    ("effect", "parameter", "value", "estimate", "told"),
    [
        ("viscous-drag", "rate_per_s", "15.03", "1", "below 15 1/s"),
        # Fades as its parameter grows.
        ("sensor-droop", "tau_us", "138.4292", "345.6", "above 138 µs"),
        # Off is what the record says: 0 for a chain that lies, 1 for one that stands.
        ("gravity", "fraction", "0.0813", "0.02", "below 0.0813"),
        ("gravity", "fraction", "0.9312", "0.99", "above 0.931"),
        # Departs either way: both ends, told from the value without the effect.
        ("contact-exponent", "exponent", "1.50042", "1.5", "1.4996 to 1.5004"),
        ("contact-exponent", "exponent", "1.61234", "1.5", "1.39 to 1.61"),
        ("sensor-offset", "offset_fraction", "0.1508", "-0.02", "−0.151 to 0.151"),
        # The lower end lies outside of what is searched.
        ("striker-error", "mass_ratio", "1.901", "0.91", "below 1.9"),
    ],
)
def test_a_limit_says_on_which_side_of_the_value_without_the_effect_it_lies(
    effect, parameter, value, estimate, told
):
    row = {"effect": effect, "parameter": parameter, "limit_95": value, "estimate": estimate}
    assert rows.limit(row, CATALOGUE)["limit"] == told


def test_only_the_first_reason_is_called_decisive():
    reasons = ["it leaves nothing", "masses taken as exact"]
    told = words.decided(verdict(reasons=reasons, alarms={"single": 0.4}))
    assert told[:2] == ["Decisive: it leaves nothing.", "Besides: masses taken as exact."]
    assert told[2].startswith("By chance alone, what the best single effect leaves")
