"""A modulus off in one of a chain's materials, from the screen to the model that is read back."""

import json
from dataclasses import replace

import numpy as np
import pytest
from made_records import block, made

import sonicvacuum as sv
from sonicvacuum.card import ModelBlock
from sonicvacuum.discover import session, verdict, written
from sonicvacuum.discover.compare import compare, hypothesis, read_model
from sonicvacuum.discover.draws import PLACES, Draws
from sonicvacuum.discover.extended import extended
from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.judge import whereabouts
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import candidates, directions
from sonicvacuum.discover.search.screen import screen
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.discover.verdict import Model
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.files import InputError
from sonicvacuum.report import rows, words
from sonicvacuum.simulation import set_up

EFFECT = "dynamic-modulus"


def dimer(*materials, wall="stainless-steel", speeds=(0.3, 0.9)):
    """The content of a record of beads of several materials in turn."""
    given = block(speeds)
    size = {"diameter_mm": 4.86, "mass_g": 0.44}
    del given["chain"]["bead"]
    given["chain"] |= {"pattern": [{**size, "material": m} for m in materials], "wall": {"material": wall}}
    return {**given, "materials": {}}


def open_moduli(given) -> list[str]:
    """Materials whose modulus is a nuisance besides the first bead's."""
    record, _ = made(given=given, noise=0.0)
    return [one.of for one in experiment(record).shared if one.kind == "modulus"]


@pytest.fixture(scope="module")
def stiff():
    """A dimer of two polymers, the second 1.5 times as stiff as stated."""
    hidden = [(EFFECT, {"modulus_ratio": 1.5, "material": 1})]
    return made(hidden, seed=3, given=dimer("delrin", "parylene-c"))[0]


@pytest.fixture(scope="module")
def found(stiff):
    return session.discover(stiff, threads=1)


def test_the_material_is_named_with_the_effect(found):
    assert found.verdict.named == [EFFECT]
    told = found.verdict.parameters[EFFECT]
    assert (told["material"].value, told["material"].name) == (1.0, "parylene-c")
    # The stated error of its modulus, 5 %, is all that the ratio is known to.
    assert told["modulus_ratio"].value == pytest.approx(1.5, abs=3.0 * 1.5 * 0.05)
    assert f"{EFFECT}: of parylene-c" in found.verdict.reasons


def test_the_model_holds_the_material_by_its_name_and_is_read_back(found, stiff, tmp_path):
    written.write(found, tmp_path)
    model = read_model(tmp_path / "model.json")
    assert model.effects[EFFECT]["material"] == "parylene-c"
    score = compare(model, stiff, threads=1)
    assert score.gap.after == pytest.approx(found.verdict.gap.fitted.after, rel=1e-3)
    # In a chain that begins with the other material it is the same one.
    forward = Forward(experiment(made(given=dimer("parylene-c", "delrin"), noise=0.0)[0]))
    (one,) = hypothesis(model, setup_of(forward)).components
    assert (one.effect.places, one.place) == ("material", 0)
    # Where it is the only one the effect sits nowhere, and where it is none it is refused.
    alone = Forward(experiment(made(given=block((0.3,)), noise=0.0)[0]))
    (one,) = hypothesis(model, setup_of(alone)).components
    assert (one.effect.places, one.place) == (None, None)
    with pytest.raises(InputError, match="effect dynamic-modulus: material is parylene-c; possible here: br"):
        compare(model, made(given=dimer("brass", "delrin"))[0], threads=1)


def test_a_material_in_a_model_is_a_name_or_a_whole_number(tmp_path):
    rest = {"record": "r", "speed_ratio": {}, "trigger_us": {}, "gain": {}, "modulus_ratio": 1.0}
    path = tmp_path / "model.json"
    path.write_text(json.dumps({**rest, "effects": {EFFECT: {"modulus_ratio": 2.0, "material": 0.5}}}))
    with pytest.raises(InputError, match=r"material: is 0\.5; give the material's name or a whole number"):
        read_model(path)
    path.write_text(json.dumps({**rest, "effects": {"mass-defect": {"mass_ratio": 2.0, "bead": "three"}}}))
    with pytest.raises(InputError, match="bead: is 'three'; give a whole number"):
        read_model(path)
    path.write_text(json.dumps({**rest, "effects": {EFFECT: {"modulus_ratio": 2.0}}}))
    old = read_model(path)
    forward = Forward(experiment(made(given=dimer("brass", "delrin"), noise=0.0)[0]))
    assert hypothesis(old, setup_of(forward)).components[0].place == 0  # the first bead's, as ever


def test_every_material_is_one_direction_and_acts_as_its_own_nuisance(stiff):
    forward = Forward(experiment(stiff))
    null = wide.nominal(forward)
    setup = setup_of(forward)
    families = directions.of_effect(setup.catalogue.effect(EFFECT), setup)
    assert [d.place for family in families for d in family.directions] == [0, 1]
    base = forward.columns(null.hypothesis, null.u[None], null.nu[None], precise=True)
    for family, place in zip(
        families, (forward.layout.modulus, *forward.layout.other("modulus")), strict=False
    ):
        (slopes, _) = directions.like_nuisance(forward, family, base, 0)
        at = forward.local(0).tolist().index(place)
        np.testing.assert_allclose(slopes[0], base[0][0, 1 + at] * 0.5 / 0.05)  # scale over stated error
    # Within the errors of the moduli there is nothing left to be found.
    scores = screen(forward, null, families)
    assert np.abs(scores.z).max() > 3.0


def test_places_share_the_prior_of_the_effect(stiff):
    forward = Forward(experiment(stiff))
    null = wide.nominal(forward)
    setup = setup_of(forward)
    scores = screen(forward, null, directions.catalogue(setup))
    effect = setup.catalogue.effect(EFFECT)
    assert len(candidates.by_direction(scores, effect, 10.0)) == 2
    own = candidates.candidate(forward, null, scores, effect, candidates.Effort(True, 14))
    assert own.fit.hypothesis.components[0].place == 1
    sits = whereabouts.spread(forward, own.fit, setup)
    assert sum(r.probability for r in sits) == pytest.approx(1.0, abs=0.01)  # that may be left aside
    assert whereabouts.named(own.fit, forward.experiment) == {EFFECT: "parylene-c"}
    # Without names, as limits ask for it, and with them.
    assert verdict.parameters(own.fit)[EFFECT]["material"].value == 1.0


def test_a_uniform_chain_has_no_material_to_choose():
    record, _ = made([(EFFECT, {"modulus_ratio": 1.5})], seed=3)
    data = experiment(record)
    assert data.catalogue.effect(EFFECT).places is None
    forward = Forward(data)
    null = wide.nominal(forward)
    scores = screen(forward, null, directions.catalogue(setup_of(forward)))
    own = candidates.candidate(
        forward, null, scores, data.catalogue.effect(EFFECT), candidates.Effort(True, 14)
    )
    assert list(verdict.parameters(own.fit)[EFFECT]) == ["modulus_ratio"]


def test_moduli_that_any_contact_shows_are_open():
    """Beads of steel between polymers hardly bend, but the last one does on a wall of steel."""
    assert open_moduli(dimer("ptfe", "bearing-steel")) == ["bearing-steel", "stainless-steel"]
    assert "bearing-steel" not in open_moduli(dimer("ptfe", "bearing-steel", wall="ptfe"))
    assert "bearing-steel" in open_moduli(dimer("ptfe", "bearing-steel", "bearing-steel", wall="ptfe"))


def test_materials_that_the_data_do_not_tell_apart_are_told_with_their_odds(stiff, found):
    told, e = found.found.final, experiment(stiff)
    other = replace(told, hypothesis=told.hypothesis.with_places([0]))
    rivals = [Rival(0.6, told), Rival(0.4, other)]
    assert whereabouts.unsure(rivals, told, e) == [f"{EFFECT}: of parylene-c (0.60) or delrin (0.40)"]
    assert [whereabouts.named(r.fit, e)[EFFECT] for r in rivals] == ["parylene-c", "delrin"]
    assert words.placed(EFFECT, {EFFECT: "delrin"}).endswith("dynamic modulus of delrin")


def test_the_page_has_the_material_by_its_name(found):
    odds = {
        (EFFECT, "material"): Draws(EFFECT, "material", PLACES, np.array([1.0, 0.0]), np.array([0.6, 0.4]))
    }
    assert "What is missing: Dynamic modulus of parylene-c (" in words.headline(found.verdict)
    (one,) = rows.effects(found.verdict, CATALOGUE, odds, materials=("delrin", "parylene-c"))
    row = one["parameters"][-1]
    assert (row["name"], row["value"]) == ("material", "parylene-c")
    assert "delrin\N{NO-BREAK SPACE}(0.40)" in row["interval"]
    told = rows.placed(f"{EFFECT} material 1", (), CATALOGUE, ("delrin", "parylene-c"))
    assert told == f"{EFFECT} material parylene-c"


def test_a_card_takes_the_modulus_of_that_material():
    big, small = (sv.bead(diameter_mm=8.0, material=m) for m in ("bearing-steel", "ptfe"))
    chain = sv.chain(pattern=[big, small], beads=6, wall="ptfe")
    card = sv.case(chain, sv.striker(big, speed_m_s=0.5), [sv.gauge("wall")], duration_us=300.0)
    rest = {"record": "r", "speed_ratio": {}, "trigger_us": {}, "gain": {}, "modulus_ratio": 1.1}

    def taken(**given):
        return extended(card, Model(effects={EFFECT: {"modulus_ratio": 2.0, **given}}, **rest))

    def ratios(changed):
        moduli = zip((*changed.pattern, changed.wall), (*card.pattern, card.wall), strict=True)
        return [getattr(a, "surface", a).modulus_Pa / getattr(b, "surface", b).modulus_Pa for a, b in moduli]

    assert taken(material="ptfe").effects == {}
    assert ratios(taken(material="ptfe")) == pytest.approx([1.1, 2.0, 2.0])
    assert ratios(taken()) == pytest.approx([2.2, 1.0, 1.0])
    # A number stays an effect of the card, and does the same; what no bead is made of is refused.
    one, other = (set_up(taken(material=m)).chain.stiffnesses(7) for m in (1.0, "ptfe"))
    np.testing.assert_allclose(one, other, rtol=1e-12)  # rounding
    with pytest.raises(InputError, match="possible here: bearing-steel, ptfe"):
        set_up(taken(material="brass"))
    elsewhere = ModelBlock(record="r", specimen="other")
    brass = Model(effects={EFFECT: {"modulus_ratio": 2.0, "material": "brass"}}, **rest)
    assert extended(card, brass, elsewhere).effects == {}
