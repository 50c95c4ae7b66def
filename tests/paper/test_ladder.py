"""The losses of the ladder: found again from the one statement that they are calibrated on."""

import pytest
from msgspec.structs import replace
from scipy.optimize import brentq

from sonicvacuum import config, simulation
from sonicvacuum_paper import gauges
from sonicvacuum_paper.one_run import OneRun
from sonicvacuum_paper.printed import PRINTED


def run(card, time_us):
    """The card with another time of its loss."""
    effects = {**card.effects, "kuwabara-kono": {"time_us": time_us}}
    return OneRun(simulation.simulate(replace(card, effects=effects)))


def duration(card, time_us):
    """At the upper gauge, in us, at the level of the claim."""
    found = run(card, time_us)
    return gauges.duration(found, found.gauges[0], 0.02).value


@pytest.mark.parametrize("column", ["layer-loss", "matched-loss"])
def test_the_loss_is_calibrated_on_the_duration(cases, column):
    card = config.card(cases, "fig3a", column)
    written = card.effects["kuwabara-kono"]["time_us"]

    def missing(time_us):
        return duration(card, time_us) - 1e6 * PRINTED.duration_coated

    found = brentq(missing, 0.9 * written, 1.1 * written, xtol=1e-3)
    assert round(found, 1) == written  # stated with one decimal


@pytest.mark.parametrize(("column", "time_us"), [("layer-loss", 5.9), ("matched-loss", 3.9)])
def test_what_the_speed_would_calibrate_it_to(cases, column, time_us):
    # The numbers of claims.md: the layer's loss is the same either way, that of Hertz is not.
    card = config.card(cases, "fig3a", column)
    assert run(card, time_us).speed().value == pytest.approx(PRINTED.speed_coated, rel=0.002)  # one decimal
    assert (duration(card, time_us) > 200.0) == (column == "matched-loss")
