"""A nominal fit that has stopped short of its minimum: what it has missed is no effect's gain."""

import numpy as np
import pytest
from made_records import made

from sonicvacuum.blas import one_thread
from sonicvacuum.discover.fit.normal import linearise
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.fit.wide import leaves_much, nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.rounds import investigate
from sonicvacuum.discover.search import singles


@pytest.fixture(scope="module")
def short(empty):
    """The nominal model of an empty record, and one with its first speed off, which looks like noise too."""
    forward = Forward(experiment(empty))
    best = nominal(forward)
    nu = best.nu.copy()
    nu[0] += 0.5
    stopped = Fit(best.hypothesis, linearise(forward, best.hypothesis, best.u[None], nu[None]))
    assert stopped.objective - best.objective > 10.0
    assert not leaves_much(forward, stopped.objective)
    return best, stopped


def test_nothing_is_named_for_it(empty, short):
    best, stopped = short
    found = one_thread(investigate)(experiment(empty), null=stopped)
    assert found.named == []
    assert found.null.objective == pytest.approx(
        best.objective, abs=0.5
    )  # one minimum, see policy.SAME_MINIMUM
    assert np.allclose(found.null.nu, best.nu, atol=0.1)  # a tenth of a standard error


def test_a_little_that_was_missed_is_not_searched_for_anew(monkeypatch):
    """The minimum takes the place of the fit that had stopped short; gains are counted from it."""
    seen = experiment(made([("sensor-lowpass", {"tau_us": 1.5})], seed=6)[0])
    forward = Forward(seen)
    best = nominal(forward)
    nu = best.nu.copy()
    nu[0] += 0.05
    stopped = Fit(best.hypothesis, linearise(forward, best.hypothesis, best.u[None], nu[None]))
    assert 0.5 < stopped.objective - best.objective < 10.0 and not leaves_much(forward, stopped.objective)
    searches = []
    fit_all = singles.fit_all
    monkeypatch.setattr(singles, "fit_all", lambda *given: searches.append(1) or fit_all(*given))
    found = one_thread(investigate)(seen, null=stopped)
    assert len(searches) == 1
    assert found.named == ["sensor-lowpass"]
    lowest = min(best.objective, found.null.objective)
    assert found.null.objective == pytest.approx(lowest, abs=0.5)  # one minimum, see policy.SAME_MINIMUM
    gained = found.null.objective - found.candidates[0].fit.objective
    assert found.candidates[0].gain == pytest.approx(gained, rel=1e-9)  # rounding of sums
