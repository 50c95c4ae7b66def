"""The draws: with nothing drawn they are the ladder's own runs; what they share, and how they are counted."""

import numpy as np
import pytest

from sonicvacuum import config
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.rows import Row
from sonicvacuum_paper.uncertainty import agreement, inputs, loss, reading, sample, table
from sonicvacuum_paper.uncertainty.batch import Batch, last_digit, set_up
from sonicvacuum_paper.verdict import Target


@pytest.fixture(scope="module")
def nominal(cases):
    """Readings of two lanes in which everything is as printed, of the lossless layer."""
    card = config.card(cases, "fig3a", "layer")
    draws = inputs.neutral(2)
    batch = Batch.of(card, set_up(card, draws), sample.lasting(card))
    return reading.of_lanes(batch, sample.CASES["fig3a"], draws) | reading.of_contacts(batch)


# Samples of 1 us instead of 0.5, and a shorter record; the rise time is known to half a sample of some 35.
@pytest.mark.parametrize(
    ("key", "part"),
    [
        (("speed", "g9-g5"), 1e-3),
        (("amplitude", "g9"), 1e-3),
        (("duration_02", "g9"), 1e-3),
        (("width_02", "g9"), 1e-3),
        (("decay", "g9-g5"), 1e-3),
        (("arrival", "wall"), 1e-3),
        (("peak_pressure_over_onset", "g9-g5"), 1e-3),
        (("strain_rate", "g9-g5"), 0.04),
    ],
)
def test_with_nothing_drawn_the_lanes_are_the_runs_of_the_ladder(nominal, metrics, key, part):
    own = metrics.at("fig3a.layer", *key)
    assert nominal[key] == pytest.approx(own.value, rel=part)


def test_the_first_peaks_of_a_sweep_are_those_that_are_fitted(cases, metrics):
    card = config.card(cases, "fig3a", "layer")
    draws = inputs.neutral(2)
    found = reading.of_peaks(Batch.of(card, set_up(card, draws), sample.lasting(card)), draws)
    # A parabola through three samples of 1 us instead of a fit; 0.1 us of 86.
    own: Row = metrics.at("fig3a.layer", "speed", "g9-g5")
    assert found["speed", "g9-g5"] == pytest.approx(own.value, rel=2e-3)


def test_draws_are_the_same_however_many_inputs_are_asked_for_and_stay_in_their_bounds():
    draws = inputs.draws(500)
    assert all(len(values) == 500 for values in draws.values())
    assert all(np.array_equal(v, inputs.draws(500)[name]) for name, v in draws.items())
    bound = 2 * PRINTED.gauge_offset / (4 * PRINTED.bead_diameter)
    assert np.abs(draws["apart"]).max() < bound
    # Two equal uniform errors: bound/sqrt(6), as the ledger has it; 500 draws know it to 3 %.
    assert draws["apart"].std() == pytest.approx(bound / 6**0.5, rel=0.1)
    assert not np.array_equal(draws["apart"], draws["apart_bare"])


def test_misplaced_gauges_move_all_speeds_of_a_chain_by_one_factor(cases):
    steel, coated = config.card(cases, "fig3b", "nominal"), config.card(cases, "fig3a", "layer")
    draws = inputs.neutral(1) | {"apart": np.array([0.05])}
    assert reading.misread(coated, draws) == pytest.approx(1 / 1.05)
    assert reading.misread(steel, draws) == 1.0


@pytest.mark.parametrize(
    ("mass", "digit"), [(0.44e-3, 1e-5), (1.23e-3, 1e-5), (0.036e-3, 1e-6), (0.123e-3, 1e-6)]
)
def test_the_last_digit_of_a_printed_mass(mass, digit):
    assert last_digit(mass) == pytest.approx(digit)


def test_the_loss_is_found_again_where_nothing_is_drawn(cases):
    card = config.card(cases, "fig3a", "matched-loss")
    found = loss.calibrated(card, inputs.neutral(1), sample.lasting(card))
    assert found == pytest.approx(card.effects["kuwabara-kono"]["time_us"], abs=0.05)  # one decimal there


@pytest.mark.parametrize(
    ("target", "probable"),
    [
        (Target("equals", 0.0, 0.0, 1.0), 1.0),  # in the middle of the draws
        (Target("equals", 2.0, 2.0, 1.0), 0.0455),  # two standard deviations: erfc(sqrt 2)
        (Target("at_most", -np.inf, 0.0), 0.5),
        (Target("between", -1.0, 1.0), 0.6827),
        (Target("within", 0.0, 0.0, 1 / 6**0.5), 0.8413),  # a deviation has one side: P(x <= 1)
    ],
)
def test_probability_of_normal_draws(target, probable):
    # Quantiles in place of draws: exact to 1/N.
    from scipy.special import ndtri

    values = ndtri((np.arange(2000) + 0.5) / 2000)
    assert agreement.probability(target, values, np.zeros(2000)) == pytest.approx(probable, abs=2e-3)


def test_a_table_comes_back_as_written(tmp_path):
    row = table.Agreement("fig3a-speed", "layer", 1.0, 2.0, 3.0, 8, 0.25)
    table.write([row], tmp_path / "u.csv")
    assert table.read(tmp_path / "u.csv") == {"fig3a-speed": {"layer": 0.25}}
