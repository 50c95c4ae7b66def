"""Slips that cannot come to what would decide are left on the way: they take few chains, and what decides is
judged as if nothing were left.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from made_records import made

from sonicvacuum.discover.faults import changes, policy
from sonicvacuum.discover.faults.competition import Search
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.judged import excess
from sonicvacuum.discover.faults.judging import Judge
from sonicvacuum.discover.faults.slips import hypotheses
from sonicvacuum.discover.faults.weights import ALIKE, least_gain
from sonicvacuum.effects import CATALOGUE

# d′ of some 35: more than any slip explains.
STRONG = (("kuwabara-kono", {"time_us": 1.0}),)


@pytest.fixture(scope="module")
def damped():
    """Search and nominal model of a record with a strong effect."""
    record, _ = made(STRONG, speeds=(0.3, 0.9), seed=5)
    one = Search(Bench(record), CATALOGUE, 1, [])
    return one, one.nominal()


def followed(one, model, least=None, reach=True):
    """Slips with a size, followed from where slopes have them, and the chains it took."""
    judge = Judge(model, one.judged, least=least)
    if not reach:
        judge._reach = lambda slip, forward: np.inf
    slips = [s for s in hypotheses(model.bench.record) if s.continuous]
    found = judge.follow_all(sorted(judge.look_at(slips), key=lambda j: -j.gain)[:6])
    return {j.slip.at: j.gain for j in found}, judge.simulations


def test_sizes_that_take_little_of_a_large_misfit_away_take_few_chains(damped):
    one, model = damped
    (whole, chains), (left, fewer) = followed(one, model, reach=False), followed(one, model)
    most = excess(model)
    assert most > 2.0 * policy.SURE_GAIN
    assert fewer < 0.8 * chains
    for at, gain in whole.items():
        if gain > policy.PART * most:
            # Fits come to rest within 0.02 of their least χ², from other steps.
            assert left[at] == pytest.approx(gain, abs=0.5)
        else:
            assert left[at] < policy.PART * most


def test_a_slip_that_explains_the_record_is_followed_to_its_end():
    record, _ = made(seed=3)
    off = changes.gains(record, -0.3)
    one = Search(Bench(off), CATALOGUE, 1, [])
    model = one.nominal()
    own = excess(model)
    assert own > policy.SURE_GAIN
    (whole, _), (left, _) = followed(one, model, reach=False), followed(one, model, least=0.8 * own)
    best = max(whole, key=whole.get)
    assert whole[best] > policy.SHARE * own
    assert max(left, key=left.get) == best
    assert left[best] == pytest.approx(whole[best], abs=0.5)  # as above


def found(objective, part, left=False):
    """An investigation whose effects leave so much of 1000, a part of them so much."""
    null, final, rest = (SimpleNamespace(objective=value) for value in (1000.0, objective, part))
    named = ("one", "unknown") if left else ("one",)
    return SimpleNamespace(null=null, final=final, named=named), rest


def test_what_counts_is_what_effects_have_gained(monkeypatch):
    monkeypatch.setattr(
        "sonicvacuum.discover.faults.weights.unexplained", lambda found: "unknown" in found.named
    )
    effects, rest = found(200.0, 500.0)
    assert least_gain(effects, effects.null) == policy.SHARE * 800.0 - 2.0 * ALIKE
    assert least_gain(effects, rest) == policy.SHARE * 800.0 - 500.0 - 2.0 * ALIKE
    assert least_gain(effects, effects.final) == 0.0
    effects, rest = found(200.0, 500.0, left=True)
    assert least_gain(effects, rest) is None
    effects.final = effects.null
    assert least_gain(effects, rest) is None
