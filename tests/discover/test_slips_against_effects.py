"""Slips in competition with effects: what is put right, what shares its probability, what an effect keeps."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from made_records import SIGMA, made
from made_slips import altered
from msgspec.structs import replace

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, ranking
from sonicvacuum.discover.faults.competition import Search
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.judged import Judged
from sonicvacuum.discover.faults.policy import LIKELIER
from sonicvacuum.discover.faults.ranking import Ranking
from sonicvacuum.discover.faults.slips import hypotheses
from sonicvacuum.discover.faults.weights import parts
from sonicvacuum.discover.rounds import investigate
from sonicvacuum.effects import CATALOGUE

RANDOM = np.random.default_rng(np.random.SeedSequence(77))


def judged(record, fault, gain=100.0):
    """A slip of a record as if it had been judged."""
    slip = next(s for s in hypotheses(record) if s.fault == fault)
    return Judged(slip, 0.1, gain, 0.5 * gain, SimpleNamespace())


def found():
    """An investigation that names striker-error."""
    nominal, final = SimpleNamespace(objective=300.0), SimpleNamespace(objective=200.0)
    odds = {"none": 0.0, "unknown": 0.02, "striker-error": 0.98}
    forward = SimpleNamespace(experiment=SimpleNamespace(catalogue=CATALOGUE))
    return SimpleNamespace(
        named=["striker-error"], probabilities=odds, reasons=[], null=nominal, final=final, sizes=[100],
        forward=forward,
    )  # fmt: skip


def test_an_effect_that_is_the_same_as_a_slip_is_not_named_with_confidence(empty):
    search, seen = Search(Bench(empty), CATALOGUE, 1, []), found()
    rivals = [judged(empty, "speed-common"), judged(empty, "gain-common")]
    assert search.weighed(seen, rivals, False) is None
    # Two slips and the effect, all with the same evidence and the same prior.
    assert seen.probabilities["striker-error"] == pytest.approx(0.98 / 3.0)
    assert sum(seen.probabilities.values()) == pytest.approx(1.0)
    assert [f.fault for f in search.findings] == ["speed-common", "gain-common"]
    assert all(f.probability == pytest.approx(1.0 / 3.0) for f in search.findings)
    assert not any(f.corrected for f in search.findings)
    assert "speed-common or gain-common" in seen.reasons[-1]


def test_swapped_gauges_are_put_right_and_the_damping_is_named(hidden):
    v = session.discover(changes.gauges_swapped(hidden, "g4", "g7")).verdict
    (slip,) = v.faults
    assert (slip.fault, slip.sensor) == ("gauges-swapped", ["g4", "g7"])
    assert slip.probability > 0.9
    assert v.named == ["kuwabara-kono"]
    assert any("record put right: gauges-swapped" in reason for reason in v.reasons)


def test_noise_is_not_called_misstated_where_gauges_were_swapped(hidden):
    """Each gauge has the noise that is stated for the other."""
    loud = altered(hidden, "g7", lambda y: y + 4.0 * SIGMA * RANDOM.normal(size=y.shape))
    sensors = [s if s.id != "g7" else replace(s, sigma_N=np.sqrt(17.0) * SIGMA) for s in loud.block.sensors]
    stated = dataclasses.replace(loud, block=replace(loud.block, sensors=sensors))
    v = session.discover(changes.gauges_swapped(stated, "g4", "g7")).verdict
    assert [f.fault for f in v.faults] == ["gauges-swapped"]
    assert v.named == ["kuwabara-kono"]


@pytest.mark.long
def test_a_slip_is_looked_for_beside_the_likeliest_effect_where_none_was_named():
    """Neither alone explains the record, and another profile along the chain may explain more than either."""
    record, _ = made([("viscous-drag", {"rate_per_s": 150.0})], seed=5, speeds=(0.2, 0.45, 0.95))
    one = Search(Bench(changes.strikers(record, "speed_m_s", -0.13, ("v0",))), CATALOGUE, 1, [])
    seen = investigate(one.make(one.bench), 1, one.nominal().fit)
    assert seen.candidates[0].effect == "viscous-drag"
    after = one._instead(dataclasses.replace(seen, named=["unknown"], final=seen.null), [])
    assert after.named == ["viscous-drag"]
    assert [(f.fault, f.run, f.corrected) for f in one.findings] == [("run-off", "v0", True)]


def test_exchanged_runs_are_put_right_beside_an_effect_of_speed():
    """Either run alone looks struck at another speed; that and striker-error passed for the truth."""
    record, _ = made([("contact-exponent", {"exponent": 1.495})], seed=5, speeds=(0.2, 0.45, 0.95))
    v = session.discover(changes.runs_swapped(record, "v1", "v2")).verdict
    assert [(f.fault, f.run) for f in v.faults] == [("runs-swapped", "v1 and v2")]
    assert v.named == ["contact-exponent"]


@pytest.mark.long
def test_a_run_that_is_off_is_put_right_beside_an_effect():
    """An error of all strikers explains a part of one run's, and was named beside the drag with 0.998."""
    record, _ = made([("viscous-drag", {"rate_per_s": 400.0})], seed=6, speeds=(0.2, 0.45, 0.95))
    v = session.discover(changes.strikers(record, "speed_m_s", 0.1, ("v1",))).verdict
    assert [(f.fault, f.run) for f in v.faults] == [("run-off", "v1")]
    assert v.faults[0].value == pytest.approx(np.exp(-0.1), abs=0.03)  # the stated 1 %, three times
    assert v.named == ["viscous-drag"]


@pytest.mark.long
@pytest.mark.parametrize(
    ("effects", "ratio", "named"),
    [([], 0.1, []), ([("kuwabara-kono", {"time_us": 0.6})], 0.03, ["kuwabara-kono"])],
)
def test_heavier_beads_are_no_error_of_the_striker(effects, ratio, named):
    """Where the striker meets the beads once more is no smooth matter of masses: a search by slopes stopped
    on the way, and striker-error was named with 0.95 and more.
    """
    record, _ = made(effects, seed=7, speeds=(0.2, 0.45, 0.95))
    v = session.discover(changes.beads(record, "mass_g", -ratio)).verdict
    assert v.named == named
    assert [f.fault for f in v.faults] == ["bead-mass"]
    assert v.faults[0].probability > 0.9
    # Moduli stated to 5 % and speeds stated to 1 % take up some of what a mass changes.
    assert v.faults[0].value == pytest.approx(np.exp(ratio), abs=0.015)


def test_a_slip_likelier_than_the_effect_that_is_like_another_is_told(empty):
    near = [judged(empty, "bead-mass", 103.0), judged(empty, "striker-mass", 100.0)]
    first, second, effect = parts(near, near[1])
    assert effect == second
    assert first == pytest.approx(np.exp(1.5) / (np.exp(1.5) + 2.0))  # the same priors, Δχ² of 3
    assert first > LIKELIER


@pytest.mark.long
def test_a_gauge_in_volts_does_not_change_the_name_of_the_damping(hidden):
    """Beside a gain that far off, pairs that were held to the catalogue's range of it fitted worse."""
    v = session.discover(altered(hidden, "wall", lambda y: 0.08 * y)).verdict
    assert set(v.named) == {"sensor-gain", "kuwabara-kono"}


def test_a_dead_gauge_is_no_effect_of_the_model(empty):
    noise = np.random.default_rng(np.random.SeedSequence(8)).normal(size=700)
    v = session.discover(altered(empty, "g7", lambda _: SIGMA * noise)).verdict
    assert v.faults[0].fault == "gauge-dead"
    assert v.named == []


def test_a_slip_that_an_effect_explains_away_is_not_put_right_first():
    """Contacts three times as stiff hasten every pulse, as a bead too many on paper would, but altogether."""
    record, _ = made([("dynamic-modulus", {"modulus_ratio": 3.0})], seed=3)
    told = session.discover(record).verdict
    assert told.named == ["dynamic-modulus"] and not told.faults
    found = told.parameters["dynamic-modulus"]["modulus_ratio"]
    assert found.value == pytest.approx(3.0, abs=3.0 * found.sigma)  # three standard errors


@pytest.mark.parametrize(("foreseen", "followed"), [(0.45, True), (0.2, False)])
def test_a_small_slip_is_followed_where_slopes_foresee_half_of_what_the_effect_gains(
    empty, monkeypatch, foreseen, followed
):
    """Beads a tenth too heavy were told as dynamic-modulus with 0.98: half of their gain was foreseen."""
    seen, asked = found(), []
    own = seen.null.objective - seen.final.objective
    fitted = judged(empty, "bead-mass", gain=own + 5.0)
    judge = SimpleNamespace(
        simulations=0,
        look_at=lambda slips: [judged(empty, "bead-mass", gain=foreseen * own)],
        follow_all=lambda near: asked.extend(near) or [fitted for _ in near],
    )
    monkeypatch.setattr(ranking, "Judge", lambda model, make: judge)
    slips = Ranking(Bench(empty), CATALOGUE, 1, [])
    kept = slips.as_small(SimpleNamespace(bench=Bench(empty)), seen)
    assert kept == [fitted] * followed
    assert len(asked) == followed
