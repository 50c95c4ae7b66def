"""What was found, how sure that is and what is left open, in words."""

import pytest
from made_verdicts import KINDS, SPREAD, gaps, model, verdict
from msgspec.structs import replace

from sonicvacuum.discover.judge.strained import ONLY_WITH
from sonicvacuum.discover.parts import CellFit, GoodnessOfFit
from sonicvacuum.discover.verdict import Fault, Where
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.report import bench, misfit, next_run, phrases, rows, words


@pytest.mark.parametrize(
    ("probability", "text"),
    [
        (1.0, "practically certain (above 0.99)"),
        (0.96, "very probable (0.96)"),
        (0.85, "probable (0.85)"),
        (0.51, "more probable than not (0.51)"),
        (0.499, "as probable as not (0.50)"),
        (0.9496, "very probable (0.95)"),
        (0.2, "less probable than all its rivals together (0.20)"),
    ],
)
def test_probabilities_in_words(probability, text):
    assert phrases.in_words(probability) == text


@pytest.mark.parametrize(
    ("ps", "told"),
    [
        ([0.1], "there with probability 0.1."),
        ([0.1, 0.9], "there with probability 0.1, in some trace of 2 with 0.19."),
        ([1e-30, 0.9, 0.8], "there with probability 1e-30, in some trace of 3 with 3e-30."),
        ([1.0, 1.0], "there, as in some trace of 2, with probability above 0.99."),
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
        ("viscous-drag", "rate_per_s", "15.03", "1", "below 15 s⁻¹"),
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
    assert told[2].startswith("The best single effect leaves no more than noise would")


@pytest.mark.parametrize(
    ("step", "p", "said"),
    [
        ("none", 1.0, "The nominal model leaves no more than noise would."),
        ("single", 0.4, "The best single effect leaves no more than noise would: chance does as much with "
                        "probability 0.4."),
        ("pair", 0.003, "By chance alone, what the best pair leaves would come about with probability "
                        "0.003."),
        ("set", 0.0, "By chance alone, what the last set of effects leaves would come about with probability "
                     "below 1e-300."),
    ],
)  # fmt: skip
def test_what_noise_would_leave_is_called_that_and_no_probability_is_one(step, p, said):
    assert words.decided(verdict(reasons=[], alarms={step: p})) == [said]


def test_what_may_stand_in_a_place_of_a_set_stands_in_the_first_line():
    both = "kuwabara-kono + wall-compliance", "relaxing-contact + wall-compliance"
    odds = {"unknown": 0.06, both[0]: 0.69, both[1]: 0.25}
    alike = [["kuwabara-kono", "relaxing-contact"]]
    named = ["wall-compliance", "kuwabara-kono"]
    text = words.headline(verdict(named=named, probabilities=odds, confusable=alike, parameters={}))
    assert text.endswith(
        "That is more probable than not (0.69). These data cannot tell viscoelastic Hertz contact from "
        "relaxing contact (0.25 in its place): one or the other is probable (0.94)."
    )
    alone = words.headline(verdict(named=named, probabilities=odds, parameters={}))
    assert alone.endswith("(0.69).")
    # One that fits as well and is improbable beforehand has no number that would say anything.
    weak = {"unknown": 0.058, both[0]: 0.94, both[1]: 0.002}
    text = words.headline(verdict(named=named, probabilities=weak, confusable=alike, parameters={}))
    assert text.endswith("These data cannot tell viscoelastic Hertz contact from relaxing contact.")


def test_sets_that_were_never_fitted_are_told_as_that():
    odds = SPREAD | {"kuwabara-kono + tsuji": 0.02, "kuwabara-kono + viscous-drag": 1e-4}
    said = words.unfitted(verdict(probabilities=odds), {"kuwabara-kono", "tsuji"})
    assert said.startswith("No pair of effects was fitted, as what is named leaves nothing significant")
    assert said.endswith("So viscoelastic Hertz contact and damping with constant restitution (0.02).")
    assert words.unfitted(verdict(probabilities=odds), {"kuwabara-kono + tsuji"}) == ""
    pair = odds | {"gravity + kuwabara-kono + tsuji": 0.01}
    assert words.unfitted(verdict(probabilities=pair), {"kuwabara-kono + tsuji"}).startswith("Other sets")
    assert words.unfitted(verdict(), {"kuwabara-kono", "tsuji"}) == ""


def test_a_gap_within_the_scatter_of_noise_is_not_called_closed():
    """Of 8100 data noise gives a mean of 1 ± √(2/8100): 1.025 says nothing, 1.211 does."""
    small = verdict(gap=gaps(1.025, 1.02499, (1.025, 1.02499)))
    told = misfit.gap(small, 3, 8100)
    assert "of the gap closed" not in told and "it stays at 1.025." in told
    assert "scatter by 0.016, so that no gap is seen in it: what is named takes less" in told
    small.reasons.append(f"{ONLY_WITH} the modulus of the beads 1.3 times the stated one, 5.2 of its errors")
    assert "what the nominal model would have of the record, as told above" in misfit.gap(small, 3, 8100)
    large = misfit.gap(verdict(gap=gaps(1.211, 1.009, (1.211, 1.009))), 3, 8100)
    assert large.count("of the gap closed") == 2


def test_an_error_in_common_is_told_to_count_where_a_quantity_fails_that_has_it():
    where = [Where(run="a", sensor="", feature="speed", z=-3.5, p=4e-4)]
    cells = [
        {"sensor": "", "feature": name, "q_before": q} for name, q in (("speed", "1e-3"), ("duration", "0.5"))
    ]
    shared, own = {"common": ["gauge-places"]}, {"common": []}
    assert "in common (gauge-places) is counted" in misfit.where(verdict(where=where), cells, [shared, own])
    assert "in common" not in misfit.where(verdict(where=where), cells, [own, shared])
    assert "in common" not in misfit.where(verdict(where=where), cells)


def test_what_may_stand_beside_or_instead_of_a_name_is_told():
    odds = {"tsuji": 0.6, "gravity + tsuji": 0.12, "none": 0.02, "unknown": 0.26}
    told = words.alternatives(verdict(named=["tsuji"], probabilities=odds, parameters={}))
    assert told == (
        "No other effect comes near: damping with constant restitution can be told from every other effect "
        "that was fitted. Beside that there may be gravity along the chain (0.12). "
        "That it is something unknown instead has the probability 0.26. "
        "That nothing is missing has the probability 0.02."
    )
    sure = words.alternatives(verdict(named=["tsuji"], probabilities={"tsuji": 0.995, "unknown": 0.005}))
    assert "instead" not in sure and "Beside" not in sure


def test_nothing_missing_that_is_as_probable_is_told_as_a_rival():
    """A page said that no rival comes near and that all are ruled out, beside "nothing missing" with 0.50."""
    odds = {"none": 0.5, "striker-error": 0.5, "unknown": 0.0}
    alone = verdict(named=["striker-error"], parameters={}, probabilities=odds, next_experiment=None)
    told = words.alternatives(alone)
    assert told.startswith("No other effect comes near: ")
    assert told.endswith("That nothing is missing has the probability 0.50.")
    assert next_run.told(alone, [{"sensor": "g1"}]) == (
        "No proposal: these data rule out every other effect that was fitted. "
        "Whether it is there at all, more runs of the same kind would tell."
    )
    slip = Fault(fault="speed-common", run=None, sensor=None, probability=0.5, value=1.1)
    slipped = replace(alone, faults=[slip])
    assert words.alternatives(slipped).endswith(
        "That nothing is missing, but a slip told above was made, has the probability 0.50."
    )
    assert next_run.told(slipped, [{"sensor": "g1"}]).endswith("check it there, and measure again.")


def test_one_effect_that_comes_near_is_told_as_one():
    odds = {"none": 0.9, "tsuji": 0.08, "gravity + unknown": 0.02}
    told = words.alternatives(verdict(named=[], probabilities=odds, parameters={}))
    assert told == "The nearest single effect: damping with constant restitution (0.08)."


def test_an_unknown_misfit_says_nothing_of_what_would_lower_it():
    """Models that were tried and not named may lower it: their bars stand below."""
    told = misfit.gap(verdict(named=["unknown"], parameters={}, gap=gaps(6.026, 6.026)))
    assert told == (
        "The nominal model leaves a mean squared misfit of 6.026 times that of the noise; 1 is expected. "
        "As no effect is named, none was added."
    )


def test_large_scores_are_told_without_powers_of_ten():
    where = [Where(run="a", sensor="g1", feature="amplitude", z=2137.0, p=0.0)]
    cells = [{"sensor": "g1", "feature": "amplitude", "q_before": "0"}]
    assert "by 2137 standard errors" in misfit.where(verdict(where=where), cells)


def test_every_side_of_a_feature_can_be_told_against_a_prediction():
    """`The data show … than predicted`: each is a comparative."""
    for sides in misfit.SIDES.values():
        for said in sides:
            assert any(word in ("more", "less") or word.endswith("er") for word in said.split())


def test_what_is_far_more_probable_than_what_stands_for_it_is_told_first():
    """Data that leave a rival at 0.002 were said not to tell it from what has 0.99."""
    alike, named = [["viscous-drag", "linear-dashpot"]], ["viscous-drag"]
    odds = {"none": 0.0, "unknown": 0.005, "viscous-drag": 0.993, "linear-dashpot": 0.002}
    sure = verdict(named=named, probabilities=odds, confusable=alike, parameters={})
    text = words.headline(sure)
    assert text.startswith("What is missing: Viscous drag (viscous-drag)")
    assert text.endswith("practically certain (0.99); linear dashpot in its place is not ruled out.")
    assert words.alternatives(sure).startswith(
        "By far the likeliest is viscous drag; linear dashpot in its place is not ruled out."
    )
    even = odds | {"viscous-drag": 0.9, "linear-dashpot": 0.095}
    text = words.headline(verdict(named=named, probabilities=even, confusable=alike, parameters={}))
    assert "one of viscous drag or linear dashpot, which these data cannot tell apart" in text
