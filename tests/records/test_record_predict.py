"""What the nominal model makes of a record: runs in lanes, shifts in time, scalars as they are defined."""

import math
from dataclasses import replace

import numpy as np
import pytest
from record_cases import BALL, CONTENT, SCALARS, STRIKER, TIME, content, made

from sonicvacuum.effects import effect
from sonicvacuum.forward.amplitude import speeds_at_amplitudes
from sonicvacuum.observe.quantities import measure
from sonicvacuum.physics.run import simulate
from sonicvacuum.physics.solitary import SolitaryWave
from sonicvacuum.records import Record
from sonicvacuum.records.assemble import assemble
from sonicvacuum.records.predict import Conditions, at_times, predict
from sonicvacuum.records.reader import parse

SPHERE = {"shape": "sphere", "diameter_mm": 5.0, "material": "brass", "mass_g": 0.55, "speed_m_s": 0.3}


@pytest.fixture(scope="module")
def record():
    return made()


def scalar_record(base=CONTENT, **changes):
    return Record(parse(content(base, **changes)))


def test_runs_of_one_kind_of_striker_are_lanes_of_one_batch():
    record = made(runs__0__striker=STRIKER | {"mass_g": 1.23})
    (batch,) = assemble(record)
    assert batch.runs == (0, 1)
    assert batch.chain.striker_mass == pytest.approx([1.23e-3, 0.47e-3])
    assert batch.chain.striker_radius == math.inf


def test_unlike_strikers_make_batches_of_their_own():
    record = made(runs__0__striker=SPHERE)
    first, second = assemble(record)
    assert (first.runs, second.runs) == ((0,), (1,))
    assert first.chain.striker_radius == pytest.approx(2.5e-3)
    assert (first.chain.striker.name, second.chain.striker.name) == ("brass", "alumina")


def test_batching_does_not_change_a_run(record):
    alone = made(runs=[CONTENT["runs"][1]])
    together, single = predict(record)[1], predict(alone)[0]
    # Lanes share the step of the fastest of them: differences are those of the step, 1e-6 of the peak.
    for sensor, reading in single.readings.items():
        assert together.readings[sensor] == pytest.approx(reading, abs=1e-5 * reading.max())


def test_what_a_chain_is_made_of_comes_from_the_record():
    record = scalar_record(
        chain__bead={
            "diameter_mm": 4.86, "mass_g": 0.44, "material": "parylene-c", "coating_um": 50, "core": "brass",
        },
        materials={"parylene-c": {"modulus_GPa": 3.0, "modulus_rel_sigma": 0.1}},
        runs__0__signals=None, runs__0__observables=SCALARS[:1], runs__1__signals=None,
    )  # fmt: skip
    (batch,) = assemble(record)
    assert batch.chain.first.surface.modulus == pytest.approx(3e9)
    assert batch.chain.first.surface.poisson == 0.388
    assert batch.chain.first.coating == pytest.approx(50e-6)
    assert batch.chain.gravity == pytest.approx(9.81)
    assert batch.chain.static_force == pytest.approx(0.5)
    assert record.modulus_rel_sigma("parylene-c") == 0.1
    assert record.modulus_rel_sigma("brass") is None  # not stated is not the same as exact


def test_readings_at_the_record_s_times_are_the_simulation_s(record):
    (batch,) = assemble(record)
    history = simulate(batch.chain, (10,), 200e-6, 0.25e-6)
    shown = predict(record)[1].readings["wall"]
    inside = TIME >= 0.0
    wanted = history.of(10)[:, 1][: inside.sum()]
    # Cubic interpolation of a smooth pulse at 0.25 us, and another step: 1e-5 of the peak.
    assert shown[inside] == pytest.approx(wanted, abs=1e-5 * wanted.max())
    assert np.all(shown[~inside] == 0.0)


def test_a_late_trigger_shifts_all_gauges_of_its_run_alone(record):
    on_time = predict(record)
    late = predict(record, Conditions(shift_s=np.array([0.0, 10 * 0.25e-6])))
    for sensor in ("near", "far", "wall"):
        assert np.array_equal(late[0].readings[sensor], on_time[0].readings[sensor])
        before, after = on_time[1].readings[sensor], late[1].readings[sensor]
        # Ten samples later; the spline is the same, so only rounding of the times remains.
        assert after[10:] == pytest.approx(before[:-10], abs=1e-9 * before.max())


def test_shifts_between_samples_are_interpolated():
    time = np.arange(0.0, 200.0)
    pulse = np.exp(-(((time - 100.0) / 15.0) ** 2))
    wanted = np.exp(-(((time - 0.3 - 100.0) / 15.0) ** 2))
    found = at_times(time, np.arange(0.0, 260.0), np.concatenate([pulse, np.zeros(60)]), 0.3)
    # Error of a cubic spline: 5/384 of the fourth derivative, 12/15^4 here; twice that for the ends.
    assert found == pytest.approx(wanted, abs=5 / 384 * 12 / 15**4 * 2)


def test_a_simulation_too_short_is_not_extrapolated():
    with pytest.raises(ValueError, match="the simulation ends"):
        at_times(np.arange(10.0), np.arange(8.0), np.zeros(8))


def test_gains_multiply_one_sensor_in_all_runs(record):
    plain, raised = predict(record), predict(record, Conditions(gain={"far": 1.05}))
    for one, other in zip(plain, raised, strict=True):
        assert np.array_equal(other.readings["near"], one.readings["near"])
        assert other.readings["far"] == pytest.approx(1.05 * one.readings["far"], rel=1e-12)  # rounding


def test_striker_speed_may_differ_from_the_record(record):
    fast = predict(record, Conditions(speed_ratio=np.array([2.2, 1.0])))[0]
    usual = predict(record)[1]
    for sensor, reading in usual.readings.items():
        # 2.2 times 0.2 m/s are 0.44 m/s; steps differ, see above.
        assert fast.readings[sensor] == pytest.approx(reading, abs=1e-5 * reading.max())


def test_effects_enter_the_prediction(record):
    damped = predict(record, Conditions(model=lambda s: effect("kuwabara-kono").apply(s, time_us=1.0)))
    slow = predict(record, Conditions(model=lambda s: effect("sensor-lowpass").apply(s, tau_us=3.0)))
    for changed in (damped, slow):
        assert changed[1].readings["far"].max() < 0.95 * predict(record)[1].readings["far"].max()


def test_scalars_are_the_quantities_of_the_readings():
    record = made(runs__1__observables=SCALARS[:6])
    shown = predict(record)[1]
    readings = {s: np.where(TIME < 0.0, 0.0, r) for s, r in shown.readings.items()}
    for wanted, found in zip(record.runs[1].observables, shown.observables, strict=True):
        options = dict(wanted.options)
        direct = measure(wanted.quantity, readings, TIME * 1e-6, record.geometry, **options)
        # Read from samples 0.25 us apart instead of finer ones: 1e-3, at the level of 5 % of the peak.
        assert found.value == pytest.approx(direct.value, rel=1e-3)


def test_speed_at_amplitude_is_that_of_the_exact_solitary_wave():
    """A long horizontal chain without preload carries the travelling wave of the discrete Hertz chain."""
    record = scalar_record(
        chain__beads=40, chain__orientation="horizontal", chain__static_force_N=0.0,
        sensors=[{"id": "near", "kind": "embedded", "bead": 24}],
        runs=[{"id": "a", "striker": STRIKER | {"mass_g": 0.44}, "observables": [SCALARS[6]]}],
    )  # fmt: skip
    (batch,) = assemble(record)
    (found,) = predict(record)[0].observables
    wave = SolitaryWave.compute()
    contact = SCALARS[6]["amplitude_N"] / wave.gauge_ratio
    exact = wave.speed(contact, batch.chain.stiffness[0], record.specimen.first.diameter_m, 0.44e-3)
    # The wave is not quite alone after 24 beads, and speeds are interpolated between strikers: 1e-3.
    assert found.value == pytest.approx(exact, rel=1e-3)


def test_speeds_at_an_amplitude_are_those_of_each_chain_alone():
    record = scalar_record()
    one = assemble(record)[0].chain.take([0])
    chains = one.take(np.zeros(3, dtype=int)).stiffened(one.first.surface.name, np.array([0.8, 1.0, 1.3]))
    gauge = replace(record.gauges[0], gain=np.array([1.0, 1.1, 0.9]))
    diameters, force = record.specimen.diameters, 1.0

    def found(lanes):
        (speeds,) = speeds_at_amplitudes(chains.take(lanes), diameters, gauge.take(lanes), [force])
        return [x.value for x in speeds]

    # Strikes end at amplitudes within 3 % of the one wanted, by other steps beside other chains.
    alone = [found(np.array([k]))[0] for k in range(3)]
    assert found(np.arange(3)) == pytest.approx(alone, rel=2e-4)
    # A stiffer chain is faster by the cube root, at a given force; a gain is a force, to the sixth root.
    assert alone[2] / alone[0] == pytest.approx((1.3 / 0.8) ** (1 / 3) * (1.0 / 0.9) ** (1 / 6), rel=0.02)


def test_an_elastic_ball_rebounds_at_its_speed_after_the_hertz_time():
    record = scalar_record(BALL)
    for run, shown in zip(record.runs, predict(record), strict=True):
        restitution, duration = (o.value for o in shown.observables)
        chain = assemble(record)[0].chain
        stiffness, mass = float(chain.striker_stiffness[0]), run.striker.mass_kg
        depth = (1.25 * mass * run.striker.speed_m_s**2 / stiffness) ** 0.4
        # Johnson, Contact Mechanics (1985), Eq. (11.24); ends of the contact are located to about 1e-4.
        assert duration == pytest.approx(2.9432 * depth / run.striker.speed_m_s, rel=3e-4)
        assert restitution == pytest.approx(1.0, abs=1e-6)  # sum of the force over 600 samples and more


def test_a_falling_ball_loses_nothing_to_gravity_either():
    record = scalar_record(BALL, chain__orientation="vertical")
    for shown in predict(record):
        # Work of gravity cancels over the contact, which begins and ends at zero compression.
        assert shown.observables[0].value == pytest.approx(1.0, abs=1e-5)


def test_a_damped_ball_rebounds_slower():
    record = scalar_record(BALL)
    damped = Conditions(model=lambda s: effect("kuwabara-kono").apply(s, time_us=1.0))
    slow, fast = (p.observables[0].value for p in predict(record, damped))
    assert fast < slow < 0.99  # Kuwabara-Kono: losses grow as v^(1/5)


def test_a_mute_scalar_says_why():
    record = scalar_record(
        chain__beads=2,
        sensors=[{"id": "near", "kind": "embedded", "bead": 1}, {"id": "far", "kind": "embedded", "bead": 2}],
        runs=[{"id": "a", "striker": STRIKER, "observables": [SCALARS[0]]}],
    )
    (found,) = predict(record)[0].observables
    assert math.isnan(found.value)
    assert found.reason


def test_pulses_are_counted_before_the_reflection_without_gauges_that_tell():
    """A single wall gauge, as in the paper's Fig. 6: the simulation knows when the reflection is back."""
    wall = CONTENT["sensors"][2]
    counted = SCALARS[4] | {"sensor": "wall"}
    record = scalar_record(sensors=[wall], runs=[{"id": "a", "striker": STRIKER, "observables": [counted]}])
    assert predict(record)[0].observables[0].value == 1.0
