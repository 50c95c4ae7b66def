"""A clock far off beside an effect that moves all times: `striker-error` with 0.995 before, for a modulus."""

import math
from types import SimpleNamespace

import pytest
from made_records import made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, clocks
from sonicvacuum.effects import CATALOGUE

STIFFER = [("dynamic-modulus", {"modulus_ratio": 2.4})]


def test_a_clock_off_by_a_step_is_told_beside_stiffer_beads():
    record = changes.clock(made(STIFFER, seed=5)[0], -math.log(0.25))
    v = session.discover(record).verdict
    ((fault, run, value),) = [(f.fault, f.run, f.value) for f in v.faults if f.probability > 0.9]
    assert (fault, run, value) == ("clock", None, 0.25)
    assert v.named == ["dynamic-modulus"]
    assert v.probabilities["dynamic-modulus"] > 0.9


@pytest.mark.long
def test_beside_a_clock_off_by_any_factor_no_effect_that_moves_times_is_sure():
    record = changes.clock(made(STIFFER, seed=5)[0], -math.log(0.3))
    v = session.discover(record).verdict
    assert "clock" in {f.fault for f in v.faults}
    wrong = [p for name, p in v.probabilities.items() if "striker-error" in name]
    assert sum(wrong) < 0.7


def test_steps_are_asked_for_as_far_as_effects_move_times():
    assert clocks.steps_near(0.177) == pytest.approx([0.08, 0.1, 0.125, 0.2, 0.25, 0.4, 0.5])
    assert 1.0 not in clocks.steps_near(1.4)


def test_effects_that_act_alike_share_what_one_of_them_has():
    told = {"none": 0.1, "striker-error + wall-compliance": 0.8, "wall-compliance": 0.1}
    found = SimpleNamespace(probabilities=told, reasons=[])
    clocks.share(found, CATALOGUE)
    assert told == pytest.approx(
        {
            "none": 0.1,
            "striker-error + wall-compliance": 0.4,
            "dynamic-modulus + wall-compliance": 0.4,
            "wall-compliance": 0.1,
        }
    )
    assert len(found.reasons) == 1
    assert clocks.alike(CATALOGUE) == {"dynamic-modulus", "striker-error"}


def test_a_step_is_likelier_than_any_factor():
    assert clocks.log_prior(None) == 0.0
    judged = SimpleNamespace(slip=SimpleNamespace(fault="clock"), size=-1.73, gain=2e7)
    assert clocks.log_prior(judged) == pytest.approx(5.8, abs=0.2)
