"""Noise of traces whose pulse is weak, whose steps are coarse, or which are far from what is stated."""

import numpy as np
import pytest
from made_records import SIGMA, made
from made_slips import altered, unstated

from sonicvacuum.discover.faults import traces
from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.faults.heard import at_rest, heard
from sonicvacuum.discover.fit.goodness import goodness
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.noise import noise
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import together

SEED = np.random.SeedSequence(31)
TIME = np.arange(700.0)


@pytest.fixture(scope="module")
def model(empty):
    """What the nominal model reads."""
    return predicted(together((empty,)))


def test_noise_that_is_not_stated_is_heard(empty):
    """Whatever a trace rests at, however it drifts, and though one was recorded in another range."""
    stated, quiet = heard(empty), {"g4": SIGMA, "g7": SIGMA, "wall": 2.0 * SIGMA}
    assert stated == quiet
    record = altered(unstated(empty), "g4", lambda y: y + 0.5 + TIME / 700.0)
    record = altered(record, "wall", lambda y: 10.0 * y, "v1")
    for one in (heard(unstated(empty)), heard(record)):
        assert one == pytest.approx(quiet, rel=0.1)  # two traces of 700 samples know it to a twentieth
    raised = altered(unstated(empty), "g7", lambda y: y + 3.0 * SIGMA)
    assert at_rest(raised, bare=True) == pytest.approx(
        quiet, rel=0.15
    )  # two stretches of 100 samples and more
    still = altered(unstated(empty), "g7", np.zeros_like)
    assert 0.0 < heard(still)["g7"] < 1e-9


def test_a_dead_gauge_whose_neighbours_are_alike_is_dead(empty, model):
    """They flicker by a quarter of what it swings."""
    noise = np.random.default_rng(SEED).normal(size=900)
    smooth = SIGMA * np.convolve(noise, 0.9 ** np.arange(200), "valid")[:700] * np.sqrt(1.0 - 0.9**2)
    record = unstated(altered(empty, "g7", lambda _: smooth))
    assert 2.0 * heard(record)["g7"] < at_rest(record)["g7"]
    assert ("gauge-dead", "g7") in [(f.fault, f.sensor) for f in examine(record, model)[1]]


@pytest.mark.parametrize("height", [3.0, 4.0, 6.0, 9.0])
@pytest.mark.parametrize("stated", [True, False])
def test_a_weak_pulse_is_no_noise(empty, height, stated):
    """It shows in no sample of its own, or by its crest only."""
    rng = np.random.default_rng(SEED)

    def faint(_):
        swing = np.sin(np.pi * np.clip((TIME - 250.0) / 200.0, 0.0, 1.0)) ** 2
        return SIGMA * (height * swing + rng.normal(size=700))

    record = altered(empty, "g7", faint)
    assert examine(record)[1] == []
    sigma, correlation = noise([record if stated else unstated(record)])
    assert sigma[1] == pytest.approx(SIGMA, rel=0.15)  # two stretches of 175 samples know it to a twentieth
    assert correlation[1] == 0.0


@pytest.mark.parametrize("stated", [True, False])
def test_the_foot_of_a_pulse_is_no_noise(empty, stated):
    """A weak pulse comes in steps, the first below what ends the quiet stretch, and a gauge that discharges
    lies below rest behind it."""
    rng = np.random.default_rng(SEED)

    def stepwise(_):
        foot = 3.0 * np.clip((TIME - 150.0) / 40.0, 0.0, 1.0) * (TIME < 330.0)
        crest = 9.0 * np.sin(np.pi * np.clip((TIME - 300.0) / 80.0, 0.0, 1.0)) ** 2
        behind = -2.0 * np.exp(-(TIME - 360.0) / 300.0) * (TIME > 360.0)
        return SIGMA * (foot + crest + behind + rng.normal(size=700))

    record = altered(empty, "g7", stepwise)
    sigma, correlation = noise([record if stated else unstated(record)])
    # As stated, with the floor of the model; samples of two runs know it to a twentieth.
    assert sigma[1] == pytest.approx(SIGMA, rel=1e-3 if stated else 0.1)
    assert correlation[1] == 0.0


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("share", [0.0, 0.3])
def test_a_pulse_that_begins_is_no_drift(empty, seed, share):
    """It rises with the square of time, below what ends the quiet stretch; a drift does so from the start."""
    rng = np.random.default_rng(np.random.SeedSequence([34, seed]))
    rise = 60.0 * np.clip((TIME - 200.0 * share) / 250.0, 0.0, None) ** 2 * (TIME < 250.0)
    for slip, trace in (None, rise), ("drift", 8.0 * TIME / 250.0 - 4.0), ("baseline", np.full(700, 3.0)):
        pulse = 60.0 * np.sin(np.pi * np.clip((TIME - 250.0) / 200.0, 0.0, 1.0)) ** 2

        def read(y, trace=trace, pulse=pulse):
            return SIGMA * (trace + pulse + rng.normal(size=len(y)))

        told = {f.fault for f in examine(altered(empty, "g7", read))[1]}
        assert told == ({slip} if slip else set())


@pytest.mark.parametrize("ratio", [1.3, 3.0])
def test_louder_noise_is_believed(empty, ratio):
    rng = np.random.default_rng(SEED)
    louder = altered(empty, "g7", lambda y: y + np.sqrt(ratio**2 - 1.0) * SIGMA * rng.normal(size=700))
    assert noise([louder])[0][1] == pytest.approx(ratio * SIGMA, rel=0.15)


def stepped(share, seed=0):
    """The nominal model's readings in a recorder's steps; noise is this share of one."""
    rng = np.random.default_rng(np.random.SeedSequence([33, seed]))
    record = made(noise=0.0)[0]
    for gauge in record.gauges:
        step = gauge.sigma / np.hypot(share, 12.0**-0.5)
        record = altered(
            record, gauge.id, lambda y, s=step: s * np.round(y / s + share * rng.normal(size=len(y)))
        )
    return record


@pytest.mark.parametrize("share", [0.1, 0.05, 0.25])
def test_noise_below_a_recorders_step_is_not_told(share):
    """All samples before the pulse read the same."""
    record = stepped(share)
    assert examine(record, predicted(together((record,))))[1] == []


@pytest.mark.parametrize(("share", "asked"), [(0.1, False), (1.0, True)])
def test_what_is_left_of_a_recorders_steps_is_no_misfit(share, asked):
    forward = Forward(together((stepped(share),)))
    null = fit(forward, Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))
    found = goodness(forward, null)
    assert not found.failed
    assert any(cell.whiteness < 1.0 for cell in found.cells) is asked


def test_noise_far_above_the_stated_one_is_told_of_all_runs(empty, model):
    """A gain set ten times too high: no sample before the pulse is quiet by the stated noise."""
    record = altered(empty, "g7", lambda y: 10.0 * y)
    _, (one,) = examine(record, model)
    assert (one.fault, one.run, one.sensor) == ("noise-misstated", None, "g7")
    assert one.value == pytest.approx(10.0, rel=0.1)
    assert noise([record])[0][1] == pytest.approx(10.0 * SIGMA, rel=0.1)


def stretch(n, size=1.0, seed=0):
    return size * np.random.default_rng(np.random.SeedSequence([32, seed])).normal(size=n)


def test_short_stretches_are_judged_together():
    def told(*sizes):
        short = {f"v{k}": stretch(30, size, k) for k, size in enumerate(sizes)}
        return traces.misstated(short, 1.0)

    assert told(3.0, 3.0, 3.0) == dict.fromkeys(("v0", "v1", "v2"), pytest.approx(3.0, rel=0.2))
    assert told(1.0, 1.0, 1.0) == told(3.0, 1.0, 1.0) == told(1.0, 1.0, 5.0) == {}
    assert traces.misstated({"v0": stretch(30, 3.0)}, 1.0) == traces.misstated({}, 1.0) == {}


@pytest.mark.parametrize("rho", [0.8, 0.93])
@pytest.mark.parametrize("n", [13, 25, 35])
def test_what_a_line_leaves_of_noise_that_remembers_more_than_a_stretch_is_not_called_small(rho, n):
    """0.4 to 0.6 of the noise: of 100 gauges up to 83 were told of noise that is stated too large."""
    rng = np.random.default_rng(np.random.SeedSequence([35, n, int(100 * rho)]))
    told = 0
    for _ in range(100):
        long = rng.normal(size=(5, n))
        for k in range(1, n):
            long[:, k] = rho * long[:, k - 1] + np.sqrt(1.0 - rho**2) * long[:, k]
        told += bool(traces.misstated(dict(zip("abcde", long, strict=True)), 1.0))
    assert told <= 3  # one in 100 to 250 is expected
    white = {f"v{k}": stretch(n, 1.0 / 3.0, k) for k in range(5)}
    assert set(traces.misstated(white, 1.0)) == set(white)


@pytest.mark.parametrize(
    ("short", "told"), [(stretch(20, 3.0), True), (stretch(5), True), (stretch(20), False)]
)
def test_a_short_stretch_is_as_the_long_ones_unless_it_says_the_contrary(short, told):
    found = traces.misstated({"v0": stretch(100, 3.0, 1), "v1": short}, 1.0)
    assert set(found) == ({"v0", "v1"} if told else {"v0"})
