"""The nominal fit: once more from running integrals where much is left, another only where it is less."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from sonicvacuum.discover.fit import wide

SIZE = 5000
# Three standard deviations of χ² of as many data, √(2N) each.
MUCH = 3.0 * np.sqrt(2.0 * SIZE)


@dataclass(frozen=True)
class Fitted:
    objective: float
    elsewhere: object = None


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

    experiment = SimpleNamespace(runs=[None], size=lambda run: SIZE)
    monkeypatch.setattr(wide, "fit", fit)
    found = wide.nominal(SimpleNamespace(experiment=experiment, layout=SimpleNamespace(size=3)))
    assert found.objective == SIZE + kept
    assert asked == [0, wide.COARSE][:tries]
