"""What is said of a chain before it is measured: against the exact solitary wave, and in the user's words."""

import json
import math
import sys

import pytest

import sonicvacuum as sv
from sonicvacuum import cli
from sonicvacuum.figures import prediction
from sonicvacuum.materials import MATERIALS
from sonicvacuum.prediction.setup import in_si
from sonicvacuum.prediction.text import content, text

STEEL = {"beads": 16, "diameter": "20mm", "material": "bearing-steel"}


@pytest.fixture(scope="module")
def seen():
    return sv.predict(**STEEL, speed=0.5, gauges="6,11,wall")


def test_the_wave_is_the_exact_solitary_wave_of_the_chain(seen):
    """Speed from force, pulse from speed, gauge from contact, all of `physics.solitary`."""
    steel, diameter = MATERIALS["bearing-steel"], 20e-3
    mass = steel.density * math.pi / 6.0 * diameter**3
    stiffness = sv.theory.hertz_stiffness(steel.modulus, steel.poisson, diameter)
    wave = sv.solitary.SolitaryWave.compute()
    gauge = seen.gauges[1]
    assert seen.bead_mass_g == pytest.approx(mass * 1e3, rel=1e-12)  # the same arithmetic
    # A struck chain's pulse is still settling by some thousandths after ten beads.
    assert gauge.reading_N / gauge.contact_force_N == pytest.approx(wave.gauge_ratio, rel=5e-3)
    force = gauge.reading_N / wave.gauge_ratio
    assert seen.wave_speed_m_s == pytest.approx(wave.speed(force, stiffness, diameter, mass), rel=3e-3)
    half = wave.gauge_width(0.5) * diameter / seen.wave_speed_m_s
    assert gauge.duration_half_us == pytest.approx(half * 1e6, rel=1e-2)


def test_arrivals_window_and_sampling_fit_together(seen):
    first, second, wall = seen.gauges
    apart_us = 5 * 20e-3 / seen.wave_speed_m_s * 1e6
    assert second.arrival_us - first.arrival_us == pytest.approx(apart_us, rel=1e-12)  # its definition
    assert first.onset_us < first.arrival_us < second.arrival_us < wall.arrival_us
    assert seen.window_us[0] < 0.0 < wall.arrival_us < seen.window_us[1] < seen.echo_until_us
    assert seen.sampling_us == min(g.duration_half_us for g in seen.gauges) / 10


def test_the_echo_has_passed_when_it_has_passed_the_gauge_farthest_from_the_wall(seen):
    """What a gauge at the wall reads next has been at the top of the chain, and is no echo of the wall."""
    first, _, wall = seen.gauges
    back = 2.0 * wall.arrival_us - first.arrival_us  # at one speed both ways
    assert seen.echo_until_us == pytest.approx(back + first.duration_us, rel=1e-9)
    assert sv.predict(**STEEL, speed=0.5, gauges="wall").echo_until_us is None


def test_the_picture_shades_first_pulses_and_the_echo_apart(seen):
    first, echo = prediction._shaded(seen)
    assert first[0] == seen.window_us and echo[0] == (seen.window_us[1], seen.echo_until_us)
    assert first[1] > echo[1] and "first pulses" in first[2] and "echo" in echo[2]
    assert "for a rest and the first pulse at every gauge; to" in text(seen)


def test_the_aim_is_reached_and_its_speed_told():
    found = sv.predict(**STEEL, aim="wall=0.5kN", gauges=[8, "wall"])
    again = sv.predict(**STEEL, speed=found.striker_speed_m_s, gauges=[8, "wall"])
    # The search aims with the highest sample; peaks are read by a fit to the top, skewed at the wall.
    assert found.gauges[1].reading_N == pytest.approx(500.0, rel=1e-3)
    assert again == found


def test_a_coated_bead_weighs_core_and_shell_and_its_wave_is_slower(seen):
    coated = sv.predict(
        **STEEL | {"material": "parylene-c"}, coating=50e-6, core="stainless-steel", speed=0.5
    )
    core, shell = 4 / 3 * math.pi * 9.95e-3**3, 4 / 3 * math.pi * (10e-3**3 - 9.95e-3**3)
    assert coated.bead_mass_g == pytest.approx(1e3 * (8000 * core + 1289 * shell), rel=1e-9)  # rounding
    assert coated.wave_speed_m_s < 0.6 * seen.wave_speed_m_s


def test_a_gauge_on_which_the_reflection_lies_is_told_as_such():
    last = sv.predict(beads=10, diameter="5mm", material="bearing-steel", speed=1, gauges=[10]).gauges[0]
    assert last.reading_N > 0.0
    assert "reflection" in last.note


@pytest.mark.parametrize(
    ("name", "given", "si"),
    [("diameter", "20mm", 0.02), ("mass", "33 g", 0.033), ("mass", "0.5kg", 0.5),
     ("striker_mass", "440mg", 4.4e-4),
     ("coating", "50µm", 5e-5), ("speed", "0.5", 0.5), ("speed", "50cm/s", 0.5), ("aim", "5mN", 5e-3),
     ("diameter", 0.02, 0.02)],
)  # fmt: skip
def test_units_take_their_prefixes(name, given, si):
    assert in_si(name, given) == pytest.approx(si, rel=1e-12)  # one product


WRONG = [
    ({"diameter": "20"}, "diameter: is '20'; write a number with its unit, as in 20mm"),
    ({"diameter": "20 kg"}, "diameter: is '20 kg'"),
    ({"diameter": "20m"}, "diameter: is 20000 mm, outside"),
    ({"diameter": "1e308mm"}, "diameter: is 1e+308 mm, outside 0.02 to 500 mm"),
    ({"striker_diameter": "1e308mm"}, "striker_diameter: is 1e+308 mm, outside 0.02 to 500 mm"),
    ({"mass": "33kg"}, "mass: is 33000 g, which at a diameter of 20 mm"),
    ({"mass": "-3g"}, "mass: is '-3g'; it must be a positive number"),
    ({"material": "bearing-stel"}, "did you mean bearing-steel?"),
    ({"wall": "cheese"}, "wall: 'cheese' is not in the table"),
    ({"coating": "50um"}, "core: missing beside coating"),
    ({"coating": "11mm", "core": "brass"}, "coating: is 0.011 m on a bead of 0.02 m"),
    ({"striker": "flat"}, "striker_mass: missing"),
    ({"gauges": "3,17"}, "gauges: '17' is no bead from 1 to 16"),
    ({"gauges": "top"}, "gauges: 'top' is no bead"),
    ({"speed": None}, "speed: missing"),
    ({"aim": "5N", "gauges": "3", "speed": "0.5 N"}, "speed: is '0.5 N'"),
    ({"aim": "9=5N", "gauges": "3,wall"}, "aim: '9' is none of the gauges 3, wall"),
    ({"aim": "900MN"}, "aim: 9e+08 N needs a striker"),
    ({"beads": 0}, "beads: is 0"),
    ({"beads": 10**9}, "beads: the chain asks for 1e+09 beads"),
    ({"beads": 10_000}, "beads: the chain asks for"),
    ({"beads": "10"}, "beads: is '10'; write a whole number"),
    ({"gauges": []}, "gauges: none is given"),
    ({"gauges": 17}, "gauges: '17' is no bead from 1 to 16"),
    ({"gauges": [[1]]}, "gauges: '[1]' is no bead from 1 to 16; as in 3,7,wall"),
    ({"diameter": [0.02]}, "diameter: is [0.02]; it must be a positive number, as in 20mm"),
    ({"diameter": None}, "diameter: missing"),
    ({"speed": 10**400}, "speed: is 1000"),
    ({"material": ["brass"]}, "material: is ['brass']; write the name of a material"),
    ({"material": None}, "material: missing"),
    ({"wall": 7}, "wall: is 7; write the name of a material"),
    ({"aim": ["5N"]}, "aim: is ['5N']; it must be a positive number, as in 5N"),
]


@pytest.mark.parametrize(("changes", "said"), WRONG)
def test_what_cannot_be_is_refused_in_one_line(changes, said):
    with pytest.raises(sv.InputError) as refused:
        sv.predict(**STEEL | {"speed": "0.5"} | changes)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def call(monkeypatch, *arguments):
    """Exit code of the command."""
    monkeypatch.setattr(sys, "argv", ["sonicvacuum", "predict", *arguments])
    try:
        cli.main()
    except SystemExit as end:
        return end.code or 0
    return 0


def test_what_elastic_laws_leave_out_is_told():
    """A steel ball at 5 m/s presses beads far beyond their yield strength, one at 1 cm/s does not."""
    chain = {"beads": 5, "diameter": "5mm", "material": "stainless-steel", "gauges": "3"}
    hard = sv.predict(**chain, speed=5.0)
    assert any("times the yield strength" in told for told in hard.warnings)
    assert f"beware: {hard.warnings[0]}" in text(hard)
    assert content(hard)["warnings"] == hard.warnings
    assert sv.predict(**chain, speed=0.01).warnings == ()


def test_the_command_prints_text_json_and_a_picture(monkeypatch, capsys, tmp_path):
    asked = [
        "--beads",
        "8",
        "--diameter",
        "5mm",
        "--material",
        "brass",
        "--speed",
        "0.5",
        "--gauges",
        "3,wall",
    ]
    assert call(monkeypatch, *asked, "--json", "--out", str(tmp_path / "seen.svg")) == 0
    told = json.loads(capsys.readouterr().out)
    expected = sv.predict(beads=8, diameter="5mm", material="brass", speed=0.5, gauges=[3, "wall"])
    assert told == json.loads(json.dumps(content(expected)))
    assert "<svg" in (tmp_path / "seen.svg").read_text()
    assert call(monkeypatch, *asked) == 0
    assert capsys.readouterr().out == text(expected) + "\n"
    assert call(monkeypatch, *asked, "--out", str(tmp_path / "seen.doc")) == 2
    assert "choose one of these endings" in capsys.readouterr().err


def test_a_coating_acts_as_the_layer_that_it_is():
    """As the paper's chain does with the printed layer (the ledger: 226.8 m/s; 120 m/s as a half-space)."""
    seen = sv.predict(
        beads=21,
        diameter="4.86mm",
        mass="0.44g",
        material="parylene-c",
        coating="50um",
        core="stainless-steel",
        wall="brass",
        orientation="vertical",
        speed=0.44,
        striker="flat",
        striker_mass="0.47g",
        striker_material="alumina",
        gauges=[13, 17],
    )
    assert seen.coating_um == pytest.approx(50.0)
    # Gauges there discharge in 1 ms, which moves the peaks by some tenths of a microsecond.
    assert seen.wave_speed_m_s == pytest.approx(226.8, rel=0.01)
    assert not any("coating" in warning for warning in seen.warnings)


def test_a_thick_coating_is_a_half_space():
    soft = {"beads": 12, "diameter": "20mm", "mass": "30g", "material": "parylene-c", "speed": 0.01}
    coated = sv.predict(**soft, coating="2mm", core="stainless-steel", wall="parylene-c")
    solid = sv.predict(**soft)
    # The contact radius is 0.05 of the thickness: stiffer by 7 %, faster by a fifth of twice that at most.
    assert solid.wave_speed_m_s < coated.wave_speed_m_s < 1.03 * solid.wave_speed_m_s
