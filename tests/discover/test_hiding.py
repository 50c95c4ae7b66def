"""What may hide behind the named effects is told by slopes, and where these promise what no fit keeps, by the
fit.
"""

from dataclasses import replace

import pytest

from sonicvacuum.discover import hidden as hiding
from sonicvacuum.discover import upper
from sonicvacuum.discover.judge import behind
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.rounds import investigate
from sonicvacuum.discover.search import pairs

LOWPASS, TOGETHER = "sensor-lowpass", "kuwabara-kono + sensor-lowpass"


@pytest.fixture(scope="module")
def found(hidden):
    """The search in a record with Kuwabara–Kono damping alone."""
    one = investigate(experiment(hidden))
    assert one.named == ["kuwabara-kono"]
    return one


def told(found, monkeypatch, odds, promised):
    """Where slopes give a low-pass beside the damping such odds, and promise so much more in χ²."""
    start = pairs.beside

    def beside(*given):
        return [replace(s, gain=s.gain + promised) for s in start(*given)]

    monkeypatch.setattr(behind, "odds", lambda *_: {LOWPASS: odds})
    monkeypatch.setattr(pairs, "beside", beside)
    return hiding.told(found, upper.screened(found))[0]


def test_what_slopes_promise_and_no_fit_keeps_is_not_named(found, monkeypatch):
    # Of a wall and a droop of d' 50 each, a low-pass of 0.09 us had a z of 3.7 once time zeros were taken
    # out, and one of any size gained 0.8 in chi2: all three were named.
    one = told(found, monkeypatch, 2.0, promised=13.5)
    assert one.named == ["kuwabara-kono"]
    assert (
        one.probabilities[TOGETHER] < 0.05
    )  # 0.67 by slopes; a strength that gains nothing has odds of 1:30
    assert sum(one.probabilities.values()) == pytest.approx(1.0, abs=1e-12)  # rounding


def test_what_slopes_promise_rightly_keeps_their_odds(found, monkeypatch):
    one = told(found, monkeypatch, 0.5, promised=0.0)
    ratio = one.probabilities[TOGETHER] / one.probabilities["kuwabara-kono"]
    assert ratio == pytest.approx(0.5, rel=1e-9)  # no evidence of its own: a set that hides has a wide prior
