"""A model.json with numbers that are finite and absurd is refused in one line, or done within seconds."""

import json
import random

import pytest
from made_records import made

import sonicvacuum as sv
from sonicvacuum.discover.compare import read_model
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.effects.parameter import FAINTEST, FAR
from sonicvacuum.files import InputError

NUISANCES = {"speed_ratio": {"r1": 1.0}, "trigger_us": {"r1": 0.0}, "gain": {"g": 1.0}, "modulus_ratio": 1.0}
EFFECTS = (*CATALOGUE, CATALOGUE.effect("free-form"))
PARAMETERS = [(one, p) for one in EFFECTS for p in one.parameters]


def model(path, effects, **nuisances):
    """Path of a model.json with these effects."""
    whole = {"format": 1, "record": "made", "effects": effects} | NUISANCES | nuisances
    path.write_text(json.dumps(whole))
    return path


def alone(one, p, value):
    """One effect with one parameter said, those that only shape at their typical values."""
    given = {q.name: q.scale for q in one.parameters if q.off is None} | {p.name: value}
    return {one.id: given | ({one.places: 1} if one.places else {})}


@pytest.mark.parametrize(("one", "p"), PARAMETERS, ids=lambda x: getattr(x, "name", None))
def test_a_parameter_beyond_any_meaning_is_refused_with_its_limits(tmp_path, one, p):
    least, most = p.limits
    for value in [1e-320, -1e308] + ([] if most == float("inf") else [1e308, 1.01 * most]):
        path = model(tmp_path / "model.json", alone(one, p, value))
        with pytest.raises(InputError) as refused:
            read_model(path)
        told = str(refused.value)
        assert told.startswith(
            f"{path}: effects.{one.id}.{p.name}: is {value:g}; use a value from {least:g} to"
        )


@pytest.mark.parametrize(("one", "p"), PARAMETERS, ids=lambda x: getattr(x, "name", None))
def test_what_a_search_may_find_is_read(tmp_path, one, p):
    for value in (p.low, p.high):
        read_model(model(tmp_path / "model.json", alone(one, p, value)))
    assert p.limits[1] >= min(p.most, 1e4 * p.high)  # fits at a bound go on for four decades
    assert FAR > 1e4
    assert 1e-3 * FAINTEST > 0.0


@pytest.mark.parametrize("value", [1e-320, 1e308, -1.0, -1e308])
@pytest.mark.parametrize("key", ["modulus_ratio", "speed_ratio", "gain"])
def test_a_ratio_beyond_any_meaning_is_refused(tmp_path, key, value):
    given = {key: value if key == "modulus_ratio" else {"one": value}}
    with pytest.raises(
        InputError, match=rf"model.json: {key}(\.one)?: is .*, outside .*; correct the number"
    ):
        read_model(model(tmp_path / "model.json", {}, **given))


def test_a_time_zero_beyond_any_meaning_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"model.json: trigger_us.r1: is 1e\+308 us, outside"):
        read_model(model(tmp_path / "model.json", {}, trigger_us={"r1": 1e308}))


@pytest.mark.parametrize("place", [-1.0, 0.5, 1e308, 1e-320])
def test_a_place_is_a_whole_number(tmp_path, place):
    effects = {"mass-defect": {"mass_ratio": 2.0, "bead": place}}
    with pytest.raises(InputError, match=r"model.json: effects.mass-defect.bead: is .*; give a whole number"):
        read_model(model(tmp_path / "model.json", effects))


@pytest.fixture(scope="module")
def record():
    return made([], seed=3, speeds=(0.5,))[0]


def test_a_model_whose_steps_would_never_end_is_refused_before_the_first(tmp_path, record):
    strong = alone(CATALOGUE.effect("kuwabara-kono"), CATALOGUE.effect("kuwabara-kono").parameters[0], 1.9e6)
    stiff = {"dynamic-modulus": {"modulus_ratio": 5e5}}
    with pytest.raises(InputError, match=r"made: the model of made does not fit .* asks for .* steps of"):
        sv.compare(model(tmp_path / "model.json", strong | stiff), record, threads=1)


def test_an_effect_that_cannot_act_on_the_beads_of_a_record_is_refused_by_the_names_of_both(tmp_path, record):
    layer = next(one for one in CATALOGUE if one.stated)
    path = model(tmp_path / "model.json", alone(layer, layer.parameters[0], 50.0))
    told = rf"the model of made does not fit .*{layer.id}: layer_thickness_um is 50, but no coating is stated"
    with pytest.raises(InputError, match=told):
        sv.compare(path, record, threads=1)


def test_any_number_between_the_smallest_and_the_largest_is_scored_or_refused(tmp_path, record):
    draw = random.Random(5)  # the same numbers every time
    for _ in range(12):
        one, p = draw.choice([(one, p) for one, p in PARAMETERS if one.id != "free-form"])
        value = 10.0 ** draw.uniform(-320.0, 308.0)
        try:
            score = sv.compare(model(tmp_path / "model.json", alone(one, p, value)), record, threads=1)
        except InputError:
            continue
        assert score.chi2 >= 0.0
