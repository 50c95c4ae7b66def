"""Whatever the marks between columns and in numbers, a table reads back as the numbers that were written."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sonicvacuum.scope import read
from sonicvacuum.scope.units import quantity, scale, unit_of

SEPARATORS = [
    (",", "."),
    (";", "."),
    (";", ","),
    ("\t", "."),
    ("\t", ","),
    (" ", "."),
    ("  ", ","),
    ("|", "."),
    (", ", "."),
]
FACTORS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}
VOLTS = {"V": 1.0, "mV": 1e-3, "uV": 1e-6, "kV": 1e3}
numbers = st.floats(-1e6, 1e6, allow_subnormal=False).map(lambda v: v if abs(v) > 1e-6 else 0.0)


@st.composite
def tables(draw):
    """A table as text in a random dialect, its columns, and factors of time and channels."""
    cell, decimal = draw(st.sampled_from(SEPARATORS))
    count, width = draw(st.integers(12, 40)), draw(st.integers(1, 4))
    columns = [draw(st.lists(numbers, min_size=count, max_size=count)) for _ in range(width)]
    time_unit, unit = draw(st.sampled_from(list(FACTORS))), draw(st.sampled_from(list(VOLTS)))
    bracket = draw(st.sampled_from(["({})", "[{}]"]))
    labels = [
        f"Time {bracket.format(time_unit)}",
        *(f"CH{k + 1} {bracket.format(unit)}" for k in range(width)),
    ]
    joint = {" ": "   ", "  ": "   "}.get(cell, cell)
    times = [-5.0 + 0.5 * k for k in range(count)]
    quoted = draw(st.booleans()) and cell.strip() != ""
    mark = '"' if quoted else ""
    rows = [
        cell.join(f"{mark}{v!r}{mark}".replace(".", decimal) for v in row)
        for row in zip(times, *columns, strict=True)
    ]
    comments = [f"Comment;{k}" for k in range(draw(st.integers(0, 5)))]
    close = draw(st.sampled_from(["", cell.strip()])) if cell.strip() else ""
    lines = [*comments, joint.join(labels), *(r + close for r in rows)]
    end = draw(st.sampled_from(["\n", "\r\n", "\r"]))
    encoding = draw(st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "latin-1"]))
    return end.join([*lines, ""]).encode(encoding), columns, FACTORS[time_unit], VOLTS[unit]


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(tables())
def test_a_table_reads_back_in_any_dialect(tmp_path, made):
    data, columns, second, volt = made
    path = tmp_path / "t.txt"
    path.write_bytes(data)
    channels = read(path).channels
    assert [c.name for c in channels] == [f"CH{k + 1}" for k in range(len(columns))]
    for channel, values in zip(channels, columns, strict=True):
        assert np.array_equal(channel.values, np.array(values) * volt)
        assert channel.interval_s == pytest.approx(0.5 * second, rel=1e-11)  # kept to twelve digits
        assert channel.start_s == pytest.approx(-5.0 * second, rel=1e-11)
        assert channel.unit == "V"


UNITS = [
    ("mV", "V", 1e-3), ("(µs)", "s", 1e-6), ("[ms]", "s", 1e-3), ("Volts", "V", 1.0), ("Newtons", "N", 1.0),
    ("m/s^2", "m/s^2", 1.0), ("m/s²", "m/s^2", 1.0), ("mm/s", "m/s", 1e-3), ("kN", "N", 1e3), ("S", "s", 1.0),
    ("Second", "s", 1.0), ("usec", "s", 1e-6), ("MSa/s", "Hz", 1e6), ("kHz", "Hz", 1e3), ("g", "g", 1.0),
    ("Âµs", "s", 1e-6), ("millivolts", "V", 1e-3), ("kPa", "Pa", 1e3), ("m/s/s", "m/s^2", 1.0),
]  # fmt: skip


@pytest.mark.parametrize(("text", "base", "factor"), UNITS)
def test_units(text, base, factor):
    unit = unit_of(text)
    assert (unit.base, unit.factor) == (base, factor)


@pytest.mark.parametrize("text", ["", "CH1", "Ampl", "Value", "counts", "2013/08/30", "Sequence"])
def test_what_is_no_unit(text):
    assert unit_of(text) is None


def test_numbers_with_units():
    assert quantity("1e+06Hz")[0] == 1e6
    assert quantity("4 ns")[1].factor == 1e-9
    assert quantity("1,5", ",")[0] == 1.5
    assert quantity("12 bananas") is None


@given(st.floats(1e-3, 1e3), st.sampled_from([1.0, -1.0]))
def test_a_sensitivity_and_its_inverse_are_one(value, sign):
    newton, volt = scale(f"{sign * value!r} N/V", "g"), scale(f"{sign / value!r} V/N", "g")
    assert newton.of("V") == (sign * value, "N")
    assert volt.of("V")[0] == pytest.approx(newton.of("V")[0], rel=1e-12)  # two roundings of a double


def test_sensitivities():
    assert scale("80mV/N", "g").of("V") == (pytest.approx(12.5), "N")
    assert scale("100mV/g", "a").of("V") == (pytest.approx(98.0665), "m/s^2")
    assert scale("2 m/s/V", "v").of("V") == (2.0, "m/s")
    assert scale("12.5N/V", "g").of("Pa") is None
