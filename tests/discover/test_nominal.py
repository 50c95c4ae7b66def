"""The nominal fit: once more from running integrals where much is left, another only where it is less."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.faults import judged
from sonicvacuum.discover.fit import descent, normal, refit, wide
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment

SIZE = 5000
# Three standard deviations of χ² of as many data, √(2N) each.
MUCH = 3.0 * np.sqrt(2.0 * SIZE)


@dataclass(frozen=True)
class Fitted:
    objective: float
    elsewhere: object = None
    settled: bool = True


@pytest.mark.parametrize(
    "left, again, kept, tries",
    [
        (0.9 * MUCH, 0.0, 0.9 * MUCH, 1),
        (1.1 * MUCH, 10.0, 10.0, 2),
        (1.1 * MUCH, 1.1 * MUCH - 0.1, 1.1 * MUCH, 2),
        (1.1 * MUCH, 2.0 * MUCH, 1.1 * MUCH, 2),
    ],
    ids=["little is left", "a lower minimum", "the same minimum", "a higher one"],
)
def test_a_nominal_fit_that_leaves_much_starts_once_more(monkeypatch, left, again, kept, tries):
    asked = []

    def fit(forward, hypothesis, u, nu, coarse=0):
        asked.append(coarse)
        return Fitted(SIZE + (again if coarse else left))

    alike = SimpleNamespace(chain=SimpleNamespace(bodies=SimpleNamespace(kinds=("bead",))))
    experiment = SimpleNamespace(runs=[None], size=lambda run: SIZE, batches=(alike,))
    monkeypatch.setattr(wide, "fit", fit)
    layout = SimpleNamespace(size=3, other=lambda kind: [], scattered=[])
    found = wide.nominal(SimpleNamespace(experiment=experiment, layout=layout))
    assert found.objective == SIZE + kept
    assert asked == [0, wide.COARSE][:tries]


@pytest.mark.parametrize("ratio", [0.25, 3.5])
def test_pulses_that_miss_each_other_are_brought_together(ratio):
    """With beads so much stiffer or softer χ² had no slope to where pulses meet: it stayed at 10 million."""
    record, _ = made([("dynamic-modulus", {"modulus_ratio": ratio})], seed=1)
    forward = Forward(experiment(record))
    found = wide.nominal(forward)
    at = forward.layout.modulus
    strain = (np.log(ratio) / forward.nuisance_sigma[at]) ** 2
    # What is left is noise, and what the modulus is off by: five standard deviations of χ².
    assert found.objective < data(forward) + strain + 5.0 * np.sqrt(2.0 * data(forward))
    assert found.nu[at] == pytest.approx(
        np.log(ratio) / forward.nuisance_sigma[at], rel=0.05
    )  # its pull to 0


def test_a_slip_does_not_explain_what_a_better_fit_does(empty):
    """From where pulses miss each other any slip leads: a gauge late by 0.1 us took away nine tenths."""
    forward = Forward(experiment(empty))
    there = np.zeros((1, forward.layout.size))
    there[0, forward.layout.modulus] = 0.8 / forward.nuisance_sigma[forward.layout.modulus]
    stuck, good = (
        refit.Fit(Hypothesis(), normal.linearise(forward, Hypothesis(), np.zeros((1, 0)), nu))
        for nu in (there, 0.0 * there)
    )
    slip = SimpleNamespace(model=SimpleNamespace(fit=good))
    lower = judged.without_slip(slip, judged.Model(None, forward, stuck))
    assert lower.fit.objective < data(forward) + 5.0 * np.sqrt(2.0 * data(forward))
    assert judged.without_slip(slip, lower) is None


@pytest.mark.parametrize(
    ("seed", "hidden"), [(9, ()), (11, [("gravity", {"fraction": 0.02})])], ids=["nothing", "a tilt"]
)
def test_the_nominal_fit_ends_where_fresh_slopes_promise_nothing(seed, hidden):
    """With slopes held from farther off it came to rest 0.3 and 2.6 in χ² above its minimum."""
    forward = Forward(experiment(made(hidden, seed=seed)[0]))
    found, nothing = wide.nominal(forward), Hypothesis()
    fresh, columns = normal.linearised(forward, nothing, found.normal.u, found.normal.nu)
    lower, *_ = descent.descend(forward, nothing, fresh, None, refit.ITERATIONS, columns)
    # The last steps are taken while they gain 0.1; each takes away all but a small share of what is left.
    assert 0.0 <= found.objective - lower.objective[0] < 0.02
