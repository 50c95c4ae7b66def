"""Balls whose contact has not opened when others have: followed until it does, and no number of 0 before."""

import msgspec
import numpy as np
import pytest
from made_tables import CONTACT, REBOUND, ball

from sonicvacuum.discover import session
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.effects import effect
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse

SPEEDS = (0.5, 1.0)


def measured(*observables, speeds=SPEEDS):
    """A ball that meets a wall at two speeds, each with the same numbers."""
    block = ball(speeds).block
    own = parse(
        {
            **msgspec.to_builtins(block, str_keys=True),
            "runs": [{**msgspec.to_builtins(run), "observables": list(observables)} for run in block.runs],
        }
    )
    return Record(own, {}, "ball")


def shown(record, name, **parameters):
    """(runs, n) numbers in SI that a ball with an effect gives."""
    forward = Forward(experiment(record))

    def change(setup, _):
        return effect(name).apply(setup, **{k: np.full(setup.chain.lanes, v) for k, v in parameters.items()})

    found = forward.sampled(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)), change=change)
    errors = [[one.sigma for one in run.scalars] for run in forward.experiment.runs]
    return np.array([own[0] for own in found]) * errors


def test_a_soft_wall_is_followed_until_it_lets_go():
    """It has lost nothing, and took six times as long as was simulated; both numbers were 0."""
    record = measured({**REBOUND, "sigma": 0.01}, {**CONTACT, "sigma": 0.5})
    for ratio in (0.006, 3e-4):
        hard, soft = (shown(record, "wall-compliance", stiffness_ratio=one) for one in (1.0, ratio))
        # Impulses of sampled forces have an error of a thousandth.
        np.testing.assert_allclose(soft[:, 0], 1.0, atol=5e-3)
        # Contacts last as the power −2/5 of their stiffness.
        np.testing.assert_allclose(soft[:, 1] / hard[:, 1], ratio**-0.4, rtol=0.05)


def test_a_ball_that_is_back_on_the_wall_has_rebounded():
    """As slow as this its flight is a hundredth of its contact: it bounces as ever, and had no number."""
    record = measured({**REBOUND, "sigma": 0.01}, speeds=(1e-5, 100.0))
    slow, fast = shown(record, "viscous-drag", rate_per_s=0.0)[:, 0]
    assert fast == pytest.approx(1.0, abs=1e-6)
    assert slow == pytest.approx(1.0, abs=0.05)  # of a flight of some seventy samples


@pytest.mark.parametrize(
    ("one", "bound"), [(REBOUND, None), (REBOUND, "at_least"), (CONTACT, "at_most"), (CONTACT, "at_least")]
)
def test_a_ball_that_is_never_let_go_explains_nothing(one, bound):
    """Gravity holds it down where a dashpot leaves it no speed."""
    limit = {"bound": bound} if bound else {}
    record = measured({**one, "sigma": 0.01 * one["value"], **limit})
    (run, _) = experiment(record).runs
    stuck = shown(record, "linear-dashpot", damping_kg_s=1e4)[:, 0]
    assert np.isfinite(stuck).all()
    assert (np.abs(stuck - run.scalars[0].value) > 1e4 * run.scalars[0].sigma).all()


def test_a_wall_that_holds_a_ball_longer_than_is_simulated_does_not_stop_it():
    """Balls that stay where they land were told as a soft wall, known to a part in a hundred million, with
    0.95, and its numbers as none.
    """
    record = measured({**REBOUND, "value": 0.0, "sigma": 0.01})
    v = session.discover(record, threads=1).verdict
    assert v.probabilities.get("wall-compliance", 0.0) < 0.01
    assert effect(v.named[0]).dissipative
    assert v.gap.fitted.after < 1.0
