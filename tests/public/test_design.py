"""Where to put gauges: against what is known beforehand of a wall, a gain and a loss."""

import json
import math
import sys

import numpy as np
import pytest

import sonicvacuum as sv
from sonicvacuum import cli
from sonicvacuum.figures import design as picture
from sonicvacuum.prediction.design import _OPTIONS, GAIN, STRENGTH, TARGET, _place
from sonicvacuum.prediction.design_text import content, text
from sonicvacuum.prediction.setup import card_of
from sonicvacuum.simulation import set_up

SET_UP = dict.fromkeys(_OPTIONS) | {
    "orientation": "horizontal", "striker": "sphere", "diameter": "5mm", "material": "brass", "speed": 0.5,
    "aim": None,
}  # fmt: skip
CHAIN = {"beads": 12, "diameter": "5mm", "material": "bearing-steel", "speed": 0.5}


@pytest.fixture(scope="module")
def droop_or_loss():
    """A gauge that discharges against beads that lose energy."""
    return sv.design(effects="sensor-droop,kuwabara-kono", **CHAIN)


def test_before_the_echo_only_the_wall_gauge_feels_the_wall():
    """What is above hears nothing of a contact that the wave has not reached."""
    found = sv.design(effects="wall-compliance", **CHAIN, gauges="2,wall", echo=False)
    # Ahead of the wave a contact is felt only as far as the simulation errs: a thousandth of σ is none.
    assert found.single["2"] < 1e-3
    assert found.single["wall"] > 1.0
    assert "wall" in found.advised.gauges


def test_the_echo_brings_the_wall_to_the_beads():
    found = sv.design(effects="wall-compliance", **CHAIN, gauges="2,wall")
    assert found.single["2"] > 1.0


def test_a_gain_is_told_from_none_no_better_than_it_is_known():
    """The effect moves what the record states with an error: so many standard errors of the gain, no more."""
    found = sv.design(effects="sensor-gain", **CHAIN, gauges="6")
    (pair,) = (one.apart for one in found.best if len(one.speeds_m_s) == 1)
    scale = next(p for p in sv_effect("sensor-gain").parameters if p.switches).scale
    known = math.log1p(STRENGTH * scale) / GAIN
    assert 0.9 * known < pair["sensor-gain", "none"] <= known * 1.02  # noise is added, slopes are linear
    assert not found.enough
    assert f"{TARGET:g} are wanted" in text(found)


def sv_effect(name):
    """An effect of the catalogue."""
    from sonicvacuum.effects import CATALOGUE

    return CATALOGUE.effect(name)


def test_more_gauges_and_more_runs_tell_more(droop_or_loss):
    """χ² adds up over gauges and runs, and no nuisance is free, so the best never gets worse."""
    least = {(len(one.gauges), len(one.speeds_m_s)): one.least for one in droop_or_loss.best}
    for gauges in (1, 2, 3):
        assert least[gauges, 2] > least[gauges, 1]
        assert gauges == 1 or least[gauges, 1] > least[gauges - 1, 1]


def test_a_loss_shows_the_further_from_the_striker_the_better(droop_or_loss):
    """A pulse decays along the chain, and a gauge that discharges reads as wrongly everywhere."""
    single = {int(g): v for g, v in droop_or_loss.single.items() if g != "wall"}
    order = sorted(single)
    assert [single[b] for b in order] == sorted(single.values())
    assert droop_or_loss.enough


@pytest.mark.parametrize(
    ("effect", "changes"),
    [("contact-gap", {"beads": 1, "gauges": "wall"}), ("sensor-offset", {"gauges": "wall,5"})],
)
def test_an_effect_sits_where_it_can(effect, changes):
    """The only bead's contact, and a gauge in a bead though the first one is at the wall."""
    found = sv.design(effects=effect, **CHAIN | changes)
    assert found.advised.least > 0.0


@pytest.mark.parametrize("beads", [1, 2, 11, 12])
def test_a_place_is_in_the_middle(beads):
    setup = set_up(card_of(**SET_UP | {"beads": beads, "gauges": "wall"}), np.array([0.5]))
    assert _place(sv_effect("mass-defect"), setup) == beads // 2 + 1
    assert _place(sv_effect("contact-gap"), setup) == max(1, beads // 2)
    assert _place(sv_effect("sensor-gain"), setup) == 0
    assert _place(sv_effect("kuwabara-kono"), setup) is None


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"effects": "sensor-drop"}, "is not in the catalogue; did you mean sensor-droop?"),
        ({"effects": "tsuji,foo"}, "'foo' is not in the catalogue; the catalogue holds dynamic-modulus, "),
        ({"effects": "coating-thickness"}, "effects: coating-thickness cannot be in this chain"),
        ({"effects": []}, "effects: none is given"),
        ({"most": 0}, "most: is 0; from 1 to 4"),
        ({"most": "3"}, "most: is '3'; from 1 to 4"),
        ({"most": 2.5}, "most: is 2.5; from 1 to 4"),
        ({"noise": -1.0}, "noise: is -1.0; it must be a positive number, at most 1"),
        ({"strength": None}, "strength: is None; it must be a positive number"),
        ({"effects": 5}, "effects: is 5; write ids of the catalogue"),
        ({"beads": "10"}, "beads: is '10'; write a whole number, as in 10"),
        ({"beads": "10", "gauges": "3"}, "beads: is '10'; write a whole number, as in 10"),
        ({"beads": 0}, "beads: is 0; a chain has at least 1"),
        ({"gauges": [[1]]}, "gauges: '[1]' is no bead from 1 to 12"),
        ({"gauges": "13"}, "gauges: '13' is no bead from 1 to 12"),
        ({"colour": "red"}, "colour: design takes no such argument"),
        ({"speed": None}, "speed: missing"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(changes, said):
    with pytest.raises(sv.InputError) as refused:
        sv.design(**{"effects": "sensor-droop"} | CHAIN | changes)
    assert said in str(refused.value)


def test_the_command_prints_text_json_and_a_picture(monkeypatch, capsys, tmp_path):
    words = ["--effects", "wall-compliance", "--beads", "8", "--diameter", "5mm", "--material", "brass"]
    words += ["--speed", "0.5", "--gauges", "3,wall", "--most", "1"]
    expected = sv.design(
        effects="wall-compliance",
        beads=8,
        diameter="5mm",
        material="brass",
        speed="0.5",
        gauges="3,wall",
        most=1,
    )
    for more, wanted in ((["--json"], content(expected)), ([], text(expected))):
        picture = tmp_path / "design.svg"
        monkeypatch.setattr(sys, "argv", ["sonicvacuum", "design", *words, *more, "--out", str(picture)])
        cli.main()
        told = capsys.readouterr().out
        assert (json.loads(told) if more else told) == (
            json.loads(json.dumps(wanted)) if more else wanted + "\n"
        )
        assert "<svg" in picture.read_text()


def test_the_picture_says_what_its_line_and_band_mean(monkeypatch, droop_or_loss):
    drawn = []
    monkeypatch.setattr(picture, "save", lambda figure, path: drawn.append(figure))
    picture.write(droop_or_loss, "seen.png")
    (told,) = drawn[0].legends
    words = [text.get_text() for text in told.get_texts()]
    assert words == [f"{TARGET:g}: from here on effects count as told apart", "less: not told apart"]
    low, high = told.get_window_extent().get_points()[:, 1]
    assert all(high < axes.get_tightbbox().y0 for axes in drawn[0].axes) and low > 0.0
