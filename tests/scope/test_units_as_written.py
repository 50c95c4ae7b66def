"""Units as meters, force gauges and journals write them."""

import pytest
from odd_files import PULSE, TIMES, recording, rows

from sonicvacuum.scope.units import STANDARD_GRAVITY, scale, unit_of


@pytest.mark.parametrize(
    ("unit", "base", "factor"),
    [
        ("VDC", "V", 1.0), ("Vdc", "V", 1.0), ("V DC", "V", 1.0), ("mVDC", "V", 1e-3), ("mV dc", "V", 1e-3),
        ("LBF", "N", 4.4482216152605), ("gn", "g", 1.0), ("g's", "g", 1.0),
        ("m·s⁻²", "m/s^2", 1.0), ("m s-2", "m/s^2", 1.0), ("m/sec²", "m/s^2", 1.0), ("m.s^-2", "m/s^2", 1.0),
        ("кН", "N", 1e3), ("мВ", "V", 1e-3), ("м/с²", "m/s^2", 1.0), ("мм/с", "m/s", 1e-3),
        ("m·s⁻¹", "m/s", 1.0), ("mm s-1", "m/s", 1e-3), ("m s^-1", "m/s", 1.0),
    ],
)  # fmt: skip
def test_a_unit_in_the_label_of_a_channel(tmp_path, unit, base, factor):
    (channel,) = recording(tmp_path, f"Time (s),F5 ({unit})\n" + rows(TIMES, PULSE)).channels
    assert (channel.name, channel.unit) == ("F5", base)
    assert channel.values == pytest.approx(factor * PULSE, rel=1e-12)


@pytest.mark.parametrize("unit", ["VAC", "ADC", "Vpp", "G", "ms-2", "g s-2"])
def test_what_may_mean_something_else_is_no_unit(unit):
    assert unit_of(unit) is None


def test_sensitivities_are_written_likewise():
    assert scale("12.5N/VDC", "g9") == scale("12.5N/V", "g9")
    assert scale("100mV/gn", "a").factor == pytest.approx(0.1 / STANDARD_GRAVITY)
