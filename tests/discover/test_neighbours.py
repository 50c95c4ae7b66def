"""How noise is correlated: few samples at rest say little of it, third differences of all of them more."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from made_records import made
from made_slips import altered, unstated

from sonicvacuum.discover.model.noise import _correlation, _neighbours, _of_gauge, noise
from sonicvacuum.discover.model.ripples import ripple, swing
from sonicvacuum.gauges import Gauge
from sonicvacuum.records import Signals

COUNT, REST, SIGMA, PEAK = 480, 100, 0.02, 4.0
PULSE = PEAK / np.cosh((np.arange(COUNT) - 250.0) / 20.0) ** 2
KNOWN, UNKNOWN = Gauge("g", "wall", sigma=SIGMA), Gauge("g", "wall", sigma=0.0)


def drawn(rho, seed, count=COUNT):
    """Stationary noise of neighbours correlated by `rho`."""
    white = np.random.default_rng(np.random.SeedSequence((20, seed))).normal(size=count)
    result = white.copy()
    for k in range(1, count):
        result[k] = rho * result[k - 1] + math.sqrt(1.0 - rho**2) * white[k]
    return SIGMA * result


def seen(trace, gauge=KNOWN, sigma=SIGMA):
    """Correlation and worth of a trace that rests at first, and the same of that rest alone."""
    quiet = [trace[:REST]]
    return _neighbours([trace], gauge, quiet, sigma), (_correlation(quiet), REST)


@pytest.mark.parametrize("rho", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("gauge", [KNOWN, UNKNOWN], ids=["stated", "not stated"])
def test_all_samples_tell_more_than_those_at_rest(rho, gauge):
    errors, worth = [], []
    for seed in range(60):
        trace = PULSE + drawn(rho, seed)
        sigma = SIGMA if gauge is KNOWN else math.sqrt(float(np.mean(trace[:REST] ** 2)))
        (both, count), (alone, _) = seen(trace, gauge, sigma)
        errors.append((both - rho, alone - rho))
        worth.append(count)
    both, alone = np.sqrt(np.mean(np.square(errors), axis=0))
    # 380 samples more: two thirds of the error at rest where σ is stated, and 9 % for 60 draws.
    assert both < (0.8 if gauge is KNOWN else 1.05) * alone
    claimed = math.sqrt(float(np.mean((1.0 - rho**2) / np.array(worth))))
    assert both == pytest.approx(claimed, rel=0.5)  # of 60 draws 9 %; few are left to those at rest


def test_what_third_differences_show_is_the_correlation():
    noise_ = drawn(0.6, 1, 200_000)
    shown, variance = ripple([noise_], SIGMA, 0.0)
    assert shown == pytest.approx(0.6, abs=4.0 * math.sqrt(variance))
    assert math.sqrt(variance) < 0.003  # one in √200 000, times 1.1
    assert ripple([noise_[:3]], SIGMA, 0.0)[1] == math.inf


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.93])
def test_higher_differences_tell_it_beside_steep_pulses_and_short_rests(rho):
    """A pulse of a dozen samples shows in third differences of quiet noise, and stretches of 13 samples look
    less correlated than they are: 0.93 was taken for 0.6."""
    pulse = 100.0 * SIGMA / np.cosh((np.arange(COUNT) - 30.0) / 3.5) ** 2
    noise_ = [drawn(rho, seed) for seed in range(5)]
    assert abs(ripple(noise_, SIGMA, 0.0)[0] - rho) < 0.1
    both, worth = _neighbours([pulse + one for one in noise_], KNOWN, [one[:13] for one in noise_], SIGMA)
    assert both == pytest.approx(rho, abs=4.0 * math.sqrt((1.0 - rho**2) / worth) + 0.02)
    assert worth > 1000.0


def test_differences_do_not_win_where_rest_contradicts_them():
    """Nor where a rest is unlikely by what they show: half as loud as stated and correlated by less."""
    noise_ = [0.4 * drawn(0.5, seed) for seed in range(5)]
    quiet = [one[:REST] for one in noise_]
    assert not math.isinf(ripple(noise_, SIGMA, 0.0)[1])
    assert _neighbours(noise_, KNOWN, quiet, SIGMA) == (_correlation(quiet), 5 * REST)


def rising(rho, seed, first=16):
    """Two traces of which few samples precede the pulse."""
    place = np.arange(160.0) - first
    pulse = np.sin(np.pi * np.clip(place / 40.0, 0.0, 1.0)) ** 3
    return [PEAK * pulse + drawn(rho, 2 * seed + k, 160) for k in range(2)]


@pytest.mark.parametrize("rho", [0.5, 0.8])
def test_few_samples_at_rest_tell_how_correlated_noise_is_that_nobody_stated(rho):
    """It was taken for white noise, of 0.62 and 0.35 times its size: by what samples flicker."""
    found = [_of_gauge(tuple(t.tobytes() for t in rising(rho, seed)), UNKNOWN, 0.0) for seed in range(40)]
    flickers, own, worth, rests = np.transpose(found)
    assert np.mean(flickers) < 0.75 * SIGMA
    assert not rests.any()
    errors = (own - rho) * np.sqrt(worth)
    assert np.sqrt(np.mean(errors**2)) < 1.5  # of 40 draws 11 %
    assert np.median(own) == pytest.approx(rho, abs=0.1)
    sizes = [float(swing(rising(rho, seed), rho)) for seed in range(40)]
    assert np.mean(sizes) == pytest.approx(SIGMA, rel=0.05)


def in_noise(rho, first):
    """A record that does not state its correlated noise, drawn from a first seed on."""
    record, seeds = unstated(made(noise=0.0)[0]), itertools.count(first)
    for gauge in record.gauges:
        record = altered(record, gauge.id, lambda y: y + drawn(rho, next(seeds), len(y)))
    return record


def test_all_samples_tell_the_size_of_correlated_noise_that_nobody_stated():
    """Some 200 samples at rest, worth 44 where neighbours are alike by 0.8, know it to a tenth."""
    found = [noise((in_noise(0.8, 6 * k),))[0] / SIGMA - 1.0 for k in range(20)]
    assert np.sqrt(np.mean(np.square(found))) < 0.08  # it was 0.1; 0.06 now


def test_a_gauge_with_hardly_a_rest_is_as_correlated_as_the_others_and_louder_than_it_flickers():
    record = in_noise(0.8, 0)
    begun = {}
    for run, read in record.signals.items():
        first = int((read.readings["g4"] > 5.0 * SIGMA).argmax()) - 12
        begun[run] = Signals(read.time_us[first:], {k: y[first:] for k, y in read.readings.items()})
    sigma, rho = noise((replace(record, signals=begun),))
    assert rho == pytest.approx(0.8, abs=0.1)
    assert sigma[0] == pytest.approx(SIGMA, rel=0.3)  # by what it flickers 0.35


def test_few_samples_at_rest_make_no_correlation_of_white_noise_or_of_a_pulse():
    for seed in range(40):
        # A pulse that has begun when the record does.
        foot = PEAK / np.cosh((np.arange(160.0) - 45.0) / 12.0) ** 2
        begun = [foot + drawn(0.0, 3 * seed + k, 160) for k in range(3)]
        for traces in (rising(0.0, seed), rising(0.0, seed, 8), begun):
            _, own, worth, _ = _of_gauge(tuple(t.tobytes() for t in traces), UNKNOWN, 0.0)
            assert own * math.sqrt(worth) < 4.0
    assert noise((unstated(made()[0]),))[1].tolist() == [0.0, 0.0, 0.0]
    assert _of_gauge((np.zeros(30).tobytes(),), UNKNOWN, 0.0)[1:3] == (0.0, 0.0)


@pytest.mark.parametrize("kind", ["steps", "smooth noise", "spikes", "sharp pulse", "louder", "no rest"])
def test_where_third_differences_show_something_else_those_at_rest_count(kind):
    trace, gauge, sigma = PULSE + drawn(0.3, 2), KNOWN, SIGMA
    if kind == "steps":
        trace = SIGMA * np.round(trace / SIGMA)
    elif kind == "smooth noise":
        slow = np.convolve(drawn(0.0, 3), (1.0, 4.0, 6.0, 4.0, 1.0), mode="same")
        trace = PULSE + SIGMA * slow / slow.std()
    elif kind == "spikes":
        trace[::40] += 10.0 * SIGMA
    elif kind == "sharp pulse":
        trace = trace + PEAK * (np.arange(COUNT) // 4 % 2) * (np.arange(COUNT) > REST)
    elif kind == "louder":
        gauge, sigma = Gauge("g", "wall", sigma=0.5 * SIGMA), SIGMA
    both, alone = seen(trace, gauge, sigma)
    if kind == "no rest":
        assert _neighbours([trace], gauge, [], sigma) == (0.0, 0)
    else:
        assert both == alone
