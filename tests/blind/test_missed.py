"""Records of the studies that the search had got wrong, each for its reason."""

import numpy as np
import pytest

from sonicvacuum.discover import session
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum_blind import extra_cases
from sonicvacuum_blind.hide import Spec, hide
from sonicvacuum_blind.study import cases

# The list of systematic errors and sets that the first samples were drawn from.
OLDER = 65_927_677


@pytest.mark.long
@pytest.mark.parametrize(
    ("place", "named"),
    [
        # The wall's modulus, known to a twentieth, stood in for it 39 standard errors off.
        (147, {"wall-compliance"}),
        # Slopes promised half of what viscous drag gains, which leaves much.
        (677, {"guide-friction"}),
        # The pair was fitted, in a minimum of its own.
        (1824, {"contact-gap", "mass-defect"}),
    ],
)
def test_the_lowest_minimum_is_found(place, named):
    record, truth = hide(cases("again")[place])
    found = session.discover(record, limits=False).verdict
    assert set(found.named) == named
    for hidden in truth["hidden"]:
        own = found.parameters[hidden["id"]]
        for name, value in hidden["parameters"].items():
            assert abs(own[name].value - value) < 4.0 * own[name].sigma


@pytest.mark.long
def test_a_fit_ends_in_the_valley_that_the_truth_lies_in():
    """Alone its contact ended beside its minimum, and a second effect made up for that. How far along the
    valley it ends, an error or two, is a matter of rounding, which differs from machine to machine.
    """
    record, truth = hide(cases("again")[1832])
    result = session.discover(record, limits=False)
    assert result.verdict.named == ["relaxing-contact"]
    (hidden,), one = truth["hidden"], result.found.final
    at = [c.inverse(hidden["parameters"][c.parameter.name]) for c in one.hypothesis.coordinates]
    again = fit(result.found.forward, one.hypothesis, [at, at], np.stack([one.nu, 0.0 * one.nu]))
    # One standard error makes 1 in χ²: less than that is the same minimum.
    assert one.objective < again.objective + 1.0
    told, drawn = result.verdict.parameters[hidden["id"]], {d.parameter: d.error for d in result.posterior}
    for name, value in hidden["parameters"].items():
        assert abs(told[name].value - value) < 4.0 * drawn[name]


def test_an_effect_behind_one_at_a_bead_is_fitted():
    """Slopes promise 99 of friction and 179 of a gap, and keep neither: friction gains 338 in χ², and a bead
    next to the striker 286, which was named.
    """
    record, _ = hide(
        Spec("friction", "single", "traces", "white", ("guide-friction",), 20.0, 95_771_918, 119)
    )
    assert session.discover(record, limits=False).verdict.named == ["guide-friction"]


def test_a_preload_behind_what_slopes_promise_is_fitted():
    """Slopes promise 5 of a preload of 1.2 mN on beads that bear their own weight, and 32 of a gauge that
    droops, which was named with a law of damping beside it: the preload gains 65 in χ².
    """
    record, truth = hide(
        Spec("preload", "single", "one-speed", "white", ("static-preload",), 10.0, 33_744_973, 3703)
    )
    found = session.discover(record, limits=False).verdict
    assert found.named == ["static-preload"]
    own, (hidden,) = found.parameters["static-preload"]["force_N"], truth["hidden"]
    assert abs(own.value - hidden["parameters"]["force_N"]) < 3.0 * own.sigma  # 1.4 with this seed


@pytest.mark.long
def test_two_laws_of_damping_that_hide_behind_one_are_both_named():
    """One of them leaves nothing that passes for a misfit, and both together are four times as likely."""
    laws = ("hunt-crossley", "kuwabara-kono")
    record, truth = hide(Spec("full-2006", "pair", "traces", "white", laws, 20.0, 95_771_918, 2006))
    found = session.discover(record, limits=False).verdict
    assert set(found.named) == set(laws)
    assert found.probability == max(found.probabilities.values())
    for hidden in truth["hidden"]:
        ((name, value),) = hidden["parameters"].items()
        own = found.parameters[hidden["id"]][name]
        assert abs(own.value - value) < 3.0 * own.sigma  # with these seeds 0.8 and 1.3


@pytest.mark.long
@pytest.mark.parametrize(
    ("place", "named"),
    [
        # A compliant wall beside a systematic error of 1 %, which explains more than any effect does alone.
        (89, ["wall-compliance", "unknown"]),
        # Nothing beside one of 0.3 %: a decaying gauge gains as much as would do beside noise.
        (101, ["unknown"]),
    ],
)
def test_beside_a_systematic_error_that_explains_more(place, named):
    record, _ = extra_cases.make(extra_cases.cases(OLDER)[place])
    assert session.discover(record, limits=False).verdict.named == named


@pytest.mark.long
def test_one_effect_is_found_for_which_two_others_had_made_up():
    """Friction, a contact exponent and damping: a relaxing contact and an error of the striker stood for the
    last. Laws of damping are alike here (an ideal test is left with d′ 3.7 between some).
    """
    record, _ = extra_cases.make(extra_cases.cases(OLDER)[47])
    named = session.discover(record, limits=False).verdict.named
    assert len(named) == 3
    assert {"contact-exponent", "guide-friction"} < set(named)


@pytest.mark.long
def test_three_strong_effects_of_which_no_pair_stands_out():
    """Every pair leaves nine times the noise and more, and only the gauge's gain stands out of them; beside
    gain and damping slopes promise nine tenths of the rest of gravity. Another law of damping leaves as much
    as the one that is hidden (36.8 in χ², and 40.5).
    """
    three = ("gravity", "sensor-gain", "hunt-crossley")
    record, _ = hide(Spec("full-2120", "set", "scalars", "white", three, 20.0, 33_744_973, 2120))
    found = session.discover(record, limits=False).verdict
    assert {"gravity", "sensor-gain"} < set(found.named)
    assert len(found.named) == 3
    assert "unknown" not in found.named
    assert found.probabilities["gravity + hunt-crossley + sensor-gain"] > 0.1  # 0.33; 0.59 what is named


@pytest.mark.long
def test_two_effects_that_only_together_explain_what_one_leaves():
    """Beside the low-pass a law of damping gains 22 in χ², too little to be told from anything else; a weight
    along the chain gains 5 there, friction 1, and both together 69.
    """
    three = ("guide-friction", "gravity", "sensor-lowpass")
    record, truth = hide(Spec("full-2818", "set", "varied", "white", three, 20.0, 33_744_973, 2818))
    found = session.discover(record, limits=False).verdict
    assert set(found.named) == set(three)
    for hidden in truth["hidden"]:
        ((name, value),) = hidden["parameters"].items()
        own = found.parameters[hidden["id"]][name]
        assert abs(own.value - value) < 3.0 * own.sigma  # with this seed 0.1, 0.5 and 0.4


@pytest.mark.long
def test_a_slower_striker_beside_a_wall_is_no_gain_that_all_gauges_share():
    """Alone the gain explains more of both than either effect does, and was told with 0.999, the wall beside
    it; the wall and the striker fit better by 24 in χ².
    """
    two = ("wall-compliance", "striker-error")
    record, _ = hide(Spec("full-0417", "pair", "traces", "white", two, 50.0, 33_744_973, 417))
    found = session.discover(record, limits=False).verdict
    assert set(found.named) == set(two)
    assert found.probabilities["striker-error + wall-compliance"] > 0.9  # 0.95; as much as a name may have
    assert not found.faults


@pytest.mark.long
@pytest.mark.parametrize(
    ("place", "design", "two", "strength", "seed"),
    [
        # Coated beads and a slow gauge, neither of which gains anything alone: a heavier bead was named.
        (2177, "scalars", ("coating-thickness", "sensor-lowpass"), 20.0, 83_589_096),
        # Beside the weight the bead was put four beads off, 475 in χ² behind a gap: unknown.
        (2316, "traces", ("gravity", "mass-defect"), 50.0, 83_589_096),
        # The weight closes a gap of twice the width next to the one that was taken without it.
        (2762, "varied", ("gravity", "contact-gap"), 20.0, 39_790_781),
    ],
)
def test_two_effects_of_which_one_takes_back_what_the_other_does(place, design, two, strength, seed):
    record, truth = hide(Spec(f"full-{place:04d}", "pair", design, "white", two, strength, seed, place))
    found = session.discover(record, limits=False).verdict
    assert set(found.named) == set(two)
    for hidden in truth["hidden"]:
        own = found.parameters[hidden["id"]]
        for name, value in hidden["parameters"].items():
            assert abs(own[name].value - value) < 3.0 * own[name].sigma  # 1.3 at most with these seeds
    # In the first, errors of speeds that are nine times the stated ones had been told as well.
    assert not found.faults


@pytest.mark.long
@pytest.mark.parametrize(
    ("place", "design", "three", "least"),
    [
        # Slopes at the droop and a relaxation, which leave noise, promise 10 in χ² of the loss: it gains 61.
        (797, "traces", ("sensor-droop", "hunt-crossley", "relaxing-contact"), 0.9),
        # Beside friction a preload gains most, and grew to six effects with a log evidence of 510; 523 here.
        (1391, "one-speed", ("linear-dashpot", "guide-friction", "sensor-droop"), 0.9),
        # The best pair leaves something, and the second, 12 behind it in log evidence, by chance nothing.
        (1997, "traces", ("coating-thickness", "tsuji", "plastic-contact"), 0.5),
    ],
)
def test_three_effects_are_found_behind_the_pairs_of_them_that_stand_out(place, design, three, least):
    spec = Spec(f"full-{place:04d}", "set", design, "white", three, 20.0, 1_234_567, place)
    record, _ = hide(spec)
    found = session.discover(record, limits=False).verdict
    assert set(found.named) == set(three)
    assert found.probabilities[" + ".join(sorted(three))] > least  # 0.996, 0.95 and 0.66


@pytest.mark.long
def test_the_interval_of_a_contact_that_relaxes_slowly_holds_its_truth():
    """Strength and time of it are nearly one number; slopes of short steps put both 20 errors off."""
    record, truth = hide(cases("again")[1399])
    found = session.discover(record, limits=False)
    assert found.verdict.named == ["relaxing-contact"]
    (hidden,) = truth["hidden"]
    for one in found.posterior:
        value = hidden["parameters"][one.parameter]
        assert one.quantile(0.025) < value < one.quantile(0.975)
