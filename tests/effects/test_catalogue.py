"""The contract of the header, for every effect of the catalogue."""

import dataclasses
import importlib
import math

import numpy as np
import pytest
from effect_cases import PLACES, SWITCHES, nominal, place_of, run, values

from sonicvacuum.effects import CATALOGUE, IDS, effect
from sonicvacuum.effects.base import PLACES as KINDS_OF_PLACE
from sonicvacuum.effects.parameter import PRIORS
from sonicvacuum.gauges import Gauge

CANONICAL = [
    "dynamic-modulus",
    "contact-exponent",
    "coating-thickness",
    "plastic-contact",
    "linear-dashpot",
    "kuwabara-kono",
    "tsuji",
    "hunt-crossley",
    "velocity-power",
    "relaxing-contact",
    "viscous-drag",
    "guide-friction",
    "static-preload",
    "gravity",
    "contact-gap",
    "mass-defect",
    "wall-compliance",
    "striker-error",
    "sensor-lowpass",
    "sensor-droop",
    "sensor-gain",
    "sensor-offset",
]

# Unit at the end of a parameter's name → unit of its values.
UNITS = {"um": "um", "us": "us", "N": "N", "kg_s": "kg/s", "s_per_m": "s/m", "per_s": "1/s"}

every_effect = pytest.mark.parametrize("one", CATALOGUE, ids=IDS)
every_parameter = pytest.mark.parametrize(
    ("one", "p"), [(e, p) for e in CATALOGUE for p in e.parameters], ids=lambda x: getattr(x, "name", None)
)
every_switch = pytest.mark.parametrize(("id", "name"), SWITCHES)


def test_the_ids_are_the_canonical_ones_in_order():
    assert list(IDS) == CANONICAL


@every_effect
def test_the_header_is_complete_and_closed(one):
    texts = ("id", "title", "missing", "equation", "energy", "reference")
    texts += ("signature", "when_to_use", "when_not")
    for name in texts:
        assert getattr(one, name).strip() == getattr(one, name) != "", name
    assert "\n" not in one.missing
    assert one.places in KINDS_OF_PLACE
    assert (one.sits is None) == (one.choices is None)
    assert any(p.switches for p in one.parameters)


@every_effect
def test_an_effect_is_the_file_of_its_name(one):
    module = importlib.import_module(f"sonicvacuum.effects.{one.id.replace('-', '_')}")
    assert module.EFFECT is one
    assert module.__doc__.strip()


@every_parameter
def test_bounds_prior_and_scale_are_sane(one, p):
    assert p.prior in PRIORS
    assert p.help
    assert p.scale > 0.0
    assert p.least <= p.low < p.high <= p.most
    assert p.prior != "log-uniform" or p.low > 0.0
    typical = p.at(1.0, nominal())
    assert p.low <= typical <= p.high
    off = p.off_in(nominal())
    # Off lies within the bounds, or is the limit beneath (0) or above (infinity) them.
    assert off is None or off in (0.0, math.inf) or p.low <= off <= p.high
    ending = [u for end, u in UNITS.items() if p.name.endswith("_" + end)]
    assert not ending or p.unit == ending[-1]


@every_switch
def test_off_is_absent(id, name):
    setup = nominal()
    off = effect(id).apply(setup, **values(id, name, [0.0], setup), **place_of(id))
    assert off is setup
    np.testing.assert_array_equal(run(off)[1], run(nominal())[1])


@every_effect
def test_with_nothing_said_an_effect_is_off(one):
    setup = nominal()
    assert one.apply(setup) is setup


@every_parameter
def test_a_value_without_meaning_is_refused(one, p):
    bad = [math.nan, -math.inf] + [x for x in (p.least - 1.0, p.most + 1.0) if math.isfinite(x)]
    if p.off != math.inf:
        bad.append(math.inf)
    if one.dissipative:
        # Less than nothing would give energy to the chain.
        bad.append(-1e-9)
    for value in bad:
        with pytest.raises(ValueError, match=rf"{one.id}: {p.name} is .*use a value from"):
            one.apply(nominal(), **{p.name: value})


@every_parameter
def test_text_is_no_number(one, p):
    with pytest.raises(ValueError, match=rf"{p.name} is '2e0', not a number; .*write 2.0e\+0"):
        one.apply(nominal(), **{p.name: "2e0"})


@every_effect
def test_an_unknown_parameter_is_named(one):
    with pytest.raises(ValueError, match=rf"{one.id} has no parameter stength; it has"):
        one.apply(nominal(), stength=1.0)


@pytest.mark.parametrize("one", [e for e in CATALOGUE if e.places], ids=lambda e: e.id)
def test_a_place_is_asked_for_and_checked(one):
    setup = nominal()
    p = one.parameters[0]
    with pytest.raises(ValueError, match=f"needs the parameter {one.places}"):
        one.apply(setup, **{p.name: p.at(1.0, setup)})
    with pytest.raises(ValueError, match=f"{one.places} is 99; possible here"):
        one.apply(setup, **{p.name: p.at(1.0, setup), one.places: 99})
    if one.places == "sensor":
        gauges = ", ".join(setup.sensors[k].id for k in one.candidates(setup))
        with pytest.raises(ValueError, match=f"sensor is nobody; possible here: {gauges}"):
            one.apply(setup, **{p.name: p.at(1.0, setup), one.places: "nobody"})
    assert PLACES[one.places] in one.candidates(setup)


def test_candidates_fit_the_setup():
    setup = nominal()
    assert effect("mass-defect").candidates(setup) == (1, 2, 3, 4, 5, 6)
    assert effect("contact-gap").candidates(setup) == (1, 2, 3, 4, 5, 6)
    assert effect("sensor-gain").candidates(setup) == (0, 1)
    assert effect("sensor-offset").candidates(setup) == (0,)
    assert effect("tsuji").candidates(setup) == ()


def test_a_sensor_may_be_named_by_its_id():
    by_id = effect("sensor-gain").apply(nominal(), gain_ratio=1.2, sensor="wall")
    assert by_id == effect("sensor-gain").apply(nominal(), gain_ratio=1.2, sensor=1)
    assert [s.gain for s in by_id.sensors] == [1.0, 1.2]


@pytest.mark.parametrize("one", [e for e in CATALOGUE if e.id.startswith("sensor")], ids=lambda e: e.id)
def test_sensor_effects_change_the_sensors_of_observe(one):
    (p,) = one.parameters
    real = dataclasses.replace(nominal(), sensors=(Gauge("g3", "embedded", 3), Gauge("wall", "wall", None)))
    given = {p.name: p.at(1.0, real), **place_of(one.id)}
    assert one.apply(real, **given).sensors != real.sensors
    np.testing.assert_array_equal(run(one.apply(real, **given))[1], run(one.apply(nominal(), **given))[1])


@pytest.mark.parametrize("one", [e for e in CATALOGUE if e.why_not(nominal()) is None], ids=lambda e: e.id)
def test_effects_of_gauges_leave_the_chain_alone_and_no_others_do(one):
    setup = nominal()
    given = {p.name: p.at(1.0, setup) for p in one.parameters if p.switches} | place_of(one.id)
    assert one.of_gauges == (one.apply(setup, **given).chain is setup.chain)


def test_gravity_is_off_at_what_the_record_says():
    upright = dataclasses.replace(nominal(), chain=dataclasses.replace(nominal().chain, gravity=9.81))
    (fraction,) = effect("gravity").parameters
    assert fraction.off_in(upright) == 1.0
    assert fraction.at(1.0, upright) == 0.0
    assert effect("gravity").apply(upright, fraction=1.0) is upright
    assert np.all(effect("gravity").apply(upright, fraction=0.0).chain.gravity == 0.0)


def test_the_same_effect_twice_is_refused():
    once = effect("tsuji").apply(nominal(), alpha=0.1)
    with pytest.raises(ValueError, match="has tsuji already"):
        effect("tsuji").apply(once, alpha=0.1)


def test_an_unknown_effect_is_told_what_there_is():
    with pytest.raises(ValueError, match=r"no effect is called 'magnetism'.*tsuji"):
        effect("magnetism")
    with pytest.raises(ValueError, match=r"'linear-dash'; did you mean linear-dashpot\?$"):
        effect("linear-dash")
