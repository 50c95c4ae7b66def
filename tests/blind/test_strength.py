"""d′ is what a matched filter reaches, and the ideal rule is as good as it says."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from sonicvacuum.discover import policy
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.effects import Setup
from sonicvacuum_blind import catalogue, design
from sonicvacuum_blind.prediction import Errors, predict
from sonicvacuum_blind.record import as_record
from sonicvacuum_blind.signature import Frame
from sonicvacuum_blind.strength import (
    FALSE_ALARM,
    LARGEST,
    Rival,
    ceiling,
    leftover,
    log_evidence,
    nearest,
    rivals,
    scale,
)


@pytest.fixture(scope="module")
def frame():
    return Frame.of(design.draw("traces", np.random.default_rng(11)))


@pytest.fixture(scope="module")
def scaled(frame):
    """Viscoelastic contacts at d′ = 8."""
    return scale(frame, catalogue.BY_ID["kuwabara-kono"], 8.0, 1, None, None)


def test_scaled_effects_have_the_wanted_strength(frame, scaled):
    assert scaled.d_prime == pytest.approx(8.0, rel=0.006)
    again = frame.signature(
        catalogue.hidden(
            catalogue.BY_ID["kuwabara-kono"], scaled.strength, None, None, frame.design.reference
        )
    )
    assert np.linalg.norm(again) == pytest.approx(scaled.d_prime, rel=4e-3)  # twice where fits end


def test_matched_filter_sees_d_prime_standard_deviations(frame, scaled):
    """Noise and errors drawn, through the integrator; errors so small that data are linear in them."""
    small = replace(
        frame.design,
        speed_sigma=frame.design.speed_sigma / 100.0,
        modulus_sigma=frame.design.modulus_sigma / 100.0,
        trigger_sigma=frame.design.trigger_sigma / 10.0,
    )
    frame = Frame.of(small)
    entry = catalogue.BY_ID["kuwabara-kono"]
    change = catalogue.hidden(entry, scaled.strength, None, None, small.reference)
    seen = frame.signature(change)
    size = np.linalg.norm(seen)
    random = np.random.default_rng(1)
    draws = []
    for _ in range(120):
        errors = Errors.of(small, random.standard_normal(frame.slopes.shape[1]))
        data = frame.whiten.vector(predict(small, change, errors)) + random.standard_normal(len(frame.base))
        draws.append(frame.seen(data - frame.base) @ seen / size)
    assert np.mean(draws) == pytest.approx(size, abs=3.5 / np.sqrt(120))  # 3.5 standard errors
    assert np.std(draws) == pytest.approx(1.0, abs=3.5 / np.sqrt(240))


def test_matched_filter_on_null_data_sees_nothing(frame, scaled):
    random = np.random.default_rng(2)
    size = np.linalg.norm(scaled.seen)
    errors = random.standard_normal((300, frame.slopes.shape[1]))
    data = errors @ frame.slopes.T + random.standard_normal((300, len(frame.base)))
    draws = np.array([frame.seen(d) @ scaled.seen / size for d in data])
    assert np.mean(draws) == pytest.approx(0.0, abs=3.5 / np.sqrt(300))  # 3.5 standard errors
    assert np.std(draws) == pytest.approx(1.0, abs=3.5 / np.sqrt(600))


def test_what_the_stated_errors_explain_is_not_seen(frame):
    """A modulus off by one stated standard deviation has d′ below one, and none with unlimited errors."""
    sigma = frame.design.modulus_sigma

    def stiffer(plan):
        return replace(plan, modulus_ratio=1.0 + sigma)

    seen = frame.signature(stiffer)
    assert np.linalg.norm(frame.change(stiffer)) > 30.0
    assert np.linalg.norm(seen) <= 1.0 + 1e-3
    assert frame.flat(seen) < 0.1


def test_slopes_are_differences_of_the_integrator(frame):
    runs = len(frame.design.runs)
    for k in (0, runs, runs + 2, 2 * runs + 3):
        vector = np.zeros(frame.slopes.shape[1])
        vector[k] = 0.01
        ahead, behind = (
            frame.whiten.vector(predict(frame.design, errors=Errors.of(frame.design, s * vector)))
            for s in (1.0, -1.0)
        )
        difference = (ahead - behind) / 0.02
        error = np.linalg.norm(difference - frame.slopes[:, k]) / np.linalg.norm(difference)
        assert error < 0.02, k  # step sizes differ; a trigger's slope is taken between samples


def test_correlated_noise_is_whitened():
    made = design.draw("one-speed", np.random.default_rng(4))
    frame = Frame.of(made, correlation=0.6)
    random = np.random.default_rng(5)
    noise = random.standard_normal((1, 3, made.samples))
    for k in range(1, made.samples):
        noise[..., k] = 0.6 * noise[..., k - 1] + 0.8 * noise[..., k]
    clean = predict(made)
    noisy = replace(clean, traces=clean.traces + np.array(made.sigma)[:, None] * noise)
    white = frame.whiten.vector(noisy) - frame.base
    assert np.std(white) == pytest.approx(1.0, abs=4.0 / np.sqrt(2 * len(white)))  # 4 standard errors
    assert np.mean(white[1:] * white[:-1]) == pytest.approx(0.0, abs=4.0 / np.sqrt(len(white)))


@pytest.mark.parametrize(("kind", "seed"), [("traces", 4), ("traces", 23), ("scalars", 2), ("ball", 6)])
def test_rivals_are_what_may_be_named(kind, seed):
    """The rule would be beaten too easily with rivals that no verdict has, a coating of bare beads."""
    made = design.draw(kind, np.random.default_rng(seed))
    assert made.coated == (seed == 23)
    clean = predict(made)
    known = experiment(as_record(made, clean.traces, clean.scalars, "nothing hidden"))
    setup = Setup(known.batches[0].chain, known.gauges)
    asked = {effect.id for effect in known.catalogue.candidates(setup)}
    named = {r.id for r in rivals(Frame.of(made))}
    assert ("coating-thickness" in named) == made.coated
    assert named <= asked


def test_an_effect_explains_itself(frame, scaled):
    directions = rivals(frame)
    assert {r.id for r in directions} > {"kuwabara-kono", "mass-defect", "sensor-gain", "gravity"}
    assert leftover(directions, scaled.seen) < 0.1 * scaled.d_prime  # curvature between two strengths
    other, left = nearest(directions, scaled.seen, "kuwabara-kono")
    assert other != "kuwabara-kono"
    assert 0.0 < left < scaled.d_prime


def test_evidence_is_the_integral_over_strengths():
    a = np.linspace(0.0, LARGEST, 200_001)
    z = np.array([-40.0, -1.0, 0.0, 5.0, 28.0, 60.0])
    largest = a[None] * z[:, None] - 0.5 * a**2
    top = largest.max(axis=1)
    exact = top + np.log(np.trapezoid(np.exp(largest - top[:, None]), a, axis=1) / LARGEST)
    assert log_evidence(z) == pytest.approx(exact, abs=1e-5)  # trapezoids of 1.5e-4


def test_ideal_rule_tells_right_angles_apart_and_no_copies():
    one, two = np.eye(50)[:2]
    apart = [Rival("a", None, one), Rival("b", None, two)]
    assert ceiling(apart, 8.0 * one, np.random.default_rng(1))["a"] > 0.99
    same = [Rival("a", None, one), Rival("b", None, one), Rival("b", None, -one)]
    shares = ceiling(same, 8.0 * one, np.random.default_rng(1))
    assert shares["a"] > 0.99  # b could have had the other sign too: half the evidence
    nothing = ceiling(apart, 0.0 * one, np.random.default_rng(1))
    assert nothing["none"] == pytest.approx(0.99, abs=0.001)  # the level itself, on the same draws


def test_ideal_rule_pays_for_a_low_rate_of_false_alarms():
    """Two directions at right angles: the larger of two normal z passes `limit` in 1 % of data sets."""
    one, two = np.eye(50)[:2]
    limit = stats.norm.isf(1.0 - np.sqrt(0.99))
    found = ceiling([Rival("a", None, one), Rival("b", None, two)], 3.0 * one, np.random.default_rng(2))
    assert found["a"] == pytest.approx(
        stats.norm.sf(limit - 3.0), abs=0.06
    )  # 2000 draws, 20 beyond the limit


def test_impossible_strengths_are_capped(frame):
    entry = replace(catalogue.BY_ID["sensor-offset"], most=1e-6)
    found = scale(frame, entry, 10.0, 1, None, "g1")
    assert found.strength == 1e-6
    assert found.d_prime < 1.0


def test_the_ideal_rule_may_name_as_many_empty_records_as_the_method():
    """Said twice, since nothing of the engine is imported where data are made."""
    assert FALSE_ALARM == policy.FALSE_ALARM
