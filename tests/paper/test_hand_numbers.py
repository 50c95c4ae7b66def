"""Theory, printed numbers, geometry and simulated cases against numbers worked out by hand."""

import re

import numpy as np
import pytest
from msgspec.structs import replace

from sonicvacuum import config, simulation
from sonicvacuum.materials import MATERIALS
from sonicvacuum.physics.layered import Layer, solve
from sonicvacuum_paper.metrics import card_rows

THEORY = {
    "eq2_over_eq1": (1.0, 1e-12),
    "eq4_over_eq1": (1.0, 1e-12),
    "eq6_over_eq45": (1.0, 1e-12),
    "eq7_over_eq6_limit": (1.0, 1e-6),  # the limit is approached as the cube root of 1e-12, squared
    "c0_over_linear_chain": (1.0, 1e-12),
    "eq7_over_c0_limit": (1.0, 1e-5),  # F_m is 1e-6 above F_0
    "soliton_width": (4.967, 1e-3),
    "speed_slope": (1 / 6, 1e-6),
    "speed_ratio_millionth_force": (0.1, 1e-9),
    "speed_change_narrow": (0.0699, 1e-4),  # four digits by hand
    "gravity_above_vacuum": (1.0, 0.0),
    "heavy_core_slowing": (2.38, 5e-3),
    "long_wave_speed_deviation": (1 - 0.6802 / 0.6887, 2e-4),  # constants printed with four digits
}
PAPER = {
    "coated_diameter_large": 4.86,
    "coated_diameter_small": 2.48,
    "small_core_diameter": 2.38,
    "mass_ratio_light": 1.0682,
    "mass_ratio_heavy": 2.7955,
    "mass_ratio_fig6a": 0.9,
    "mass_ratio_fig6b": 3.075,
    "speed_error_alignment": 0.10288,
    "width_from_duration": 5.2695,
    "modulus_ratio": 5.4348,
    "membrane_over_handbook": 1.7210,
    "stiffening_factor_ratio": 1.8116,
    "matched_over_nylon_modulus": 4.4185,
    "adjusted_parameters_fig4a": 1.0,
    "ptfe_speed_low_amplitude": 111.0,
    "mach_low_speed_matched": 0.978,
    "modulus_from_low_speed": 9.83,
    "speed_over_eq7_matched": 0.8685,
    "speed_over_eq7_handbook": 1.527,
}
AUDIT = {
    "bead_mass_large": 0.4452,
    "bead_mass_small": 0.05625,
    "striker_mass_steel_ball": 0.03267,
    "striker_mass_ptfe_ball": 0.12254,
    "mass_over_geometry_small": 0.7111,
    "mass_over_geometry_steel_ball": 1.1019,
    "mass_ratio_fig6a": 0.5808,
    "mass_ratio_fig6b": 2.178,
    "core_density_large": 7.709,
    "offset_over_radius": 0.4115,
    "lateral_play_angle_large": 1.651,
    "lateral_play_angle_steel": 2.89,
}


@pytest.mark.parametrize("name", THEORY)
def test_theory(metrics, name):
    value, tolerance = THEORY[name]
    assert metrics.at("theory", name).value == pytest.approx(value, abs=tolerance)


@pytest.mark.parametrize("name", PAPER)
def test_printed_numbers(metrics, name):
    assert metrics.at("paper", name).value == pytest.approx(
        PAPER[name], rel=1e-3
    )  # three or more digits by hand


@pytest.mark.parametrize("name", AUDIT)
def test_geometry(metrics, name):
    assert metrics.at("audit", name).value == pytest.approx(AUDIT[name], rel=1e-3)  # as above


@pytest.mark.parametrize(("column", "newton"), [("handbook", 76.0), ("matched", 410.0)])
def test_force_that_brings_cores_together(metrics, column, newton):
    # two digits by hand
    assert metrics.find("theory", column, "core_contact_force").value == pytest.approx(newton, rel=0.01)


def test_steel_striker_is_crossed_fast(metrics):
    # 24 us over 1.65 us by hand, two digits
    found = metrics.find("audit", "matched", "contact_time_over_striker_transit").value
    assert found == pytest.approx(24.0 / 1.65, rel=0.1)


# An independent simulation by hand, gauges without discharge: speeds between them (m/s), peaks at the
# upper one (N).
HAND = {
    "fig3b.nominal": (570.0, 12.9),
    "fig3a.matched": (220.0, 4.8),
    "fig3a.membrane": (140.0, 3.1),
    "fig3a.handbook": (113.0, 2.5),
}


@pytest.mark.parametrize("card", HAND)
def test_speeds_and_peaks_of_the_hand_simulation(cases, card):
    speed, peak = HAND[card]
    ideal = config.card(cases, "fig3a", "ideal").sensors
    found = simulation.simulate(replace(config.card(cases, *card.split(".")), sensors=ideal))
    rows = {(r.quantity, r.sensor): r.value for r in card_rows(found)}
    assert rows["speed", "g9-g5"] == pytest.approx(speed, rel=0.005)  # asked for: 0.5 %
    assert rows["amplitude", "g9"] == pytest.approx(peak, abs=0.05)  # given with one decimal


@pytest.mark.parametrize(
    "card", ["fig4a.matched-horizontal", "fig4a.handbook-horizontal", "fig4b.horizontal"]
)
def test_without_gravity_speed_grows_as_the_sixth_root(metrics, card):
    # 1e-4: the wave still forms over the first twelve beads
    assert metrics.at(card, "speed_slope").value == pytest.approx(1 / 6, abs=1e-4)
    # Eq. 7 without preload is Eq. 6, whose constant is 1.2 % below that of the discrete chain
    assert metrics.at(card, "theory_deviation").value == pytest.approx(0.6887 / 0.6802 - 1, abs=5e-4)


def test_without_gravity_a_gauge_reads_0707_of_the_contact(metrics):
    # 0.70732 for the exact wave; 1e-3: at 4.9 N its shape still settles
    found = metrics.at("fig4a.matched-horizontal@0.4", "gauge_over_contact", "g9").value
    assert found == pytest.approx(0.70732, abs=1e-3)


def test_constants_told_of_what_the_paper_leaves_out_are_those_of_the_table(pytestconfig):
    text = (pytestconfig.rootpath / "workflow/resources/claims.md").read_text(encoding="utf-8")
    told = re.findall(r"(alumina|brass|PTFE|steel) ([\d.]+) GPa, (\d\.\d+)", text)
    assert len(told) == 4
    for name, modulus, poisson in told:
        material = MATERIALS["stainless-steel" if name == "steel" else name.lower()]
        assert (float(modulus) * 1e9, float(poisson)) == pytest.approx((material.modulus, material.poisson))


def test_the_layer_would_ask_for_more_than_hertz_to_be_pressed_through():
    coating, steel = (e / (1 - nu**2) for e, nu in ((2.76e9, 0.388), (193e9, 0.3)))
    found = solve(Layer(0.388, coating / steel, 0.3), np.array([9.0, 9.3, 9.6]))
    # Two layers of 50 um give way by 100 um; Hertz's force of the coating there is 75.5 N.
    chi = (2.43e-3 / 2 * 100e-6) ** 0.5 / 50e-6
    assert 75.5 * np.interp(chi, found.width, found.factor) == pytest.approx(1.43e3, rel=0.01)
