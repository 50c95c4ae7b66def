"""Speeds over amplitudes: the curve through strikes, and tables of such speeds from few strikes."""

import math

import numpy as np
import pytest
from record_cases import CONTENT, SCALARS, STRIKER, content

from sonicvacuum.effects import Setup, effect
from sonicvacuum.forward import amplitude
from sonicvacuum.forward.amplitude import speeds_at_amplitudes
from sonicvacuum.forward.curve import AMONG, BETWEEN, NEAR, STRIDE, Curve
from sonicvacuum.records import Record
from sonicvacuum.records.assemble import assemble
from sonicvacuum.records.reader import parse

TABLE = [1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 80.0]


def curve(*points):
    """A curve of which amplitudes, strikes and speeds are known."""
    made = Curve()
    for force, strike, speed in points:
        made.add(strike, force, speed)
    return made


def sound_to_solitary(force):
    """log speed of a chain under a static force, from sound to the power of a sixth of the force."""
    return math.log1p(math.exp(force)) / 6.0


def test_a_curve_is_exact_where_speeds_follow_a_power():
    found = curve(*((f, 0.8 * f, 0.2 * f + 5.0) for f in (0.0, 1.1, 2.3)))
    for force in (-0.05, 0.4, 1.1, 2.0, 2.35):
        assert found.tells(force)
        assert found.speed(force) == pytest.approx(0.2 * force + 5.0, abs=1e-12)  # rounding
        assert found.strike_for(force) == pytest.approx(0.8 * force, abs=1e-12)  # rounding


def test_a_curve_bends_from_sound_to_solitary_waves():
    found = curve(*((f, f, sound_to_solitary(f)) for f in np.arange(-3.0, 3.5, 1.0)))
    for force in np.arange(-2.9, 2.9, 0.05):
        # A cubic's remainder, 9/16 of the fourth derivative (0.125/6 at most) over 4!, at points 1 apart.
        assert found.speed(force) == pytest.approx(sound_to_solitary(force), abs=5e-4)


def test_a_curve_tells_no_more_than_it_knows():
    one = curve((0.0, 0.0, 0.0))
    assert not one.tells(0.0)
    two = curve((0.0, 0.0, 0.0), (1.0, 0.8, 0.2))
    assert two.tells(NEAR / 2) and not two.tells(2 * NEAR) and not two.tells(0.5)
    assert curve((0.0, 0.0, 0.0), (BETWEEN / 2, 0.1, 0.02)).tells(BETWEEN / 4)
    apart = curve((0.0, 0.0, 0.0), (1.0, 0.8, 0.2), (1.0 + 1.5 * AMONG, 2.5, 0.6))
    assert apart.tells(0.5) and not apart.tells(1.0 + 0.75 * AMONG)
    # Beyond the last point, which stands alone, no further than from a single one.
    assert not apart.tells(1.05 + 1.5 * AMONG)
    assert apart.tells(-0.05)


def test_crowded_points_do_not_bend_a_curve():
    exact = [(f, f, 0.2 * f) for f in (0.0, 1.0, 2.0)]
    noisy = curve(*exact, (1.0 + 3e-4, 1.0, 0.20006 + 1e-5), (1.0 - 3e-4, 1.0, 0.19994 - 1e-5))
    # What is off by 1e-5 is passed over: 6e-4 apart it would tilt the curve by 0.03.
    assert noisy.speed(1.6) == pytest.approx(0.32, abs=2e-5)


def test_silence_and_passages_are_told_apart():
    silent = curve((math.nan, 0.0, math.nan))
    assert silent.silent and silent.empty
    stuck = curve((0.0, 0.0, math.nan))
    assert not stuck.silent and stuck.empty


def test_strikes_go_no_further_than_a_stride():
    assert curve((0.0, 0.0, 0.0)).strike_for(9.0) == pytest.approx(STRIDE)


@pytest.fixture(scope="module")
def bench():
    """A chain of thirty beads with a gauge in it, diameters and gauge."""
    made = content(
        CONTENT, chain__beads=30, chain__orientation="horizontal", chain__static_force_N=0.0,
        sensors=[{"id": "near", "kind": "embedded", "bead": 18}],
        runs=[{"id": "a", "striker": STRIKER, "observables": [SCALARS[6]]}],
    )  # fmt: skip
    record = Record(parse(made))
    return assemble(record)[0].chain.take([0]), record.specimen.diameters, record.gauges[0]


@pytest.fixture
def struck(monkeypatch):
    """How many chains were struck so far."""
    counted = [0]
    once = amplitude._shown_by

    def counting(lanes, *rest):
        counted[0] += lanes.lanes
        return once(lanes, *rest)

    monkeypatch.setattr(amplitude, "_shown_by", counting)
    return counted


def changed(chain, gauge, name, **parameters):
    return effect(name).apply(Setup(chain, (gauge,)), **parameters).chain


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("static-preload", {"force_N": 5.0}),
        ("contact-exponent", {"exponent": 1.7}),
        ("viscous-drag", {"rate_per_s": 600.0}),
    ],
)
def test_a_table_is_what_its_values_are_one_by_one(bench, struck, name, parameters):
    chain, diameters, gauge = bench
    chain = changed(chain, gauge, name, **parameters)
    table = [m[0].value for m in speeds_at_amplitudes(chain, diameters, gauge, TABLE)]
    together = struck[0]
    alone = [speeds_at_amplitudes(chain, diameters, gauge, [a])[0][0].value for a in TABLE]
    # Either is good to some 4e-4, by the slope between two strikes or the curve through many.
    assert table == pytest.approx(alone, rel=8e-4)
    assert together <= 1.5 * len(TABLE) < struck[0] - together


def test_values_near_one_another_share_strikes(bench, struck):
    chain, diameters, gauge = bench
    dense = np.geomspace(1.0, 20.0, 25)
    speeds = [m[0].value for m in speeds_at_amplitudes(chain, diameters, gauge, dense)]
    assert struck[0] < 10
    # A Hertz chain without a static force: the sixth root of the force (Eq. (6) of the paper), the wave
    # still a little wider than the solitary one at either gauge: 1e-4.
    assert np.diff(np.log(speeds)) == pytest.approx(np.log(20.0) / 24 / 6, rel=5e-3)
    assert speeds[-1] / speeds[0] == pytest.approx(20.0 ** (1 / 6), rel=1e-4)


@pytest.mark.parametrize(
    ("name", "parameters"),
    [("static-preload", {"force_N": 5.0}), ("contact-exponent", {"exponent": 1.7})],
)
def test_a_table_of_many_values_takes_fewer_strikes(bench, struck, monkeypatch, name, parameters):
    chain, diameters, gauge = bench
    chain = changed(chain, gauge, name, **parameters)
    table = np.geomspace(0.5, 50.0, 14)
    few = [m[0].value for m in speeds_at_amplitudes(chain, diameters, gauge, table)]
    assert struck[0] <= 9
    monkeypatch.setattr(amplitude, "SPACED", 1e-3)  # each value by a strike of its own
    each = [m[0].value for m in speeds_at_amplitudes(chain, diameters, gauge, table)]
    # From sound to solitary waves a cubic through strikes an e-fold apart errs by 2e-4.
    assert few == pytest.approx(each, rel=4e-4)


@pytest.mark.parametrize(
    ("amplitude_shown", "reason"),
    [(math.nan, "absent: no pulse at near clear of the wall's reflection"), (5.0, "no passage")],
)
def test_what_no_strike_shows_has_a_reason(bench, monkeypatch, amplitude_shown, reason):
    def shown(lanes, *_):
        return np.stack([np.full(lanes.lanes, amplitude_shown), np.full(lanes.lanes, math.nan)])

    monkeypatch.setattr(amplitude, "_shown_by", shown)
    for (found,) in speeds_at_amplitudes(*bench, [1.0, 20.0]):
        assert math.isnan(found.value) and found.reason == reason


def test_an_amplitude_that_no_strike_makes_has_no_speed(bench, monkeypatch):
    monkeypatch.setattr(amplitude, "_shown_by", lambda lanes, *_: np.full((2, lanes.lanes), 5.0))
    ((found,),) = speeds_at_amplitudes(*bench, [20.0])
    assert math.isnan(found.value) and found.reason.startswith("outside")
