"""The table of metrics: its columns, what survives writing and reading, and what is refused."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum.files import InputError
from sonicvacuum_paper.rows import Row, absent, number, read_rows, write_absent, write_rows

NAMES = st.text("abcdefghij0123456789._-@", min_size=1, max_size=8)
ROWS = st.lists(
    st.builds(
        Row,
        case=NAMES,
        quantity=NAMES,
        sensor=st.sampled_from(["", "g9", "wall", "g9-g5"]),
        value=st.floats(allow_nan=False, allow_infinity=False),
        unit=st.sampled_from(["1", "N", "m/s"]),
        numerical_error=st.floats(0.0, 1.0),
    ),
    unique_by=lambda r: r.key,
)


@given(rows=ROWS)
def test_what_is_written_is_read_back(tmp_path_factory, rows):
    path = tmp_path_factory.mktemp("rows") / "metrics.csv"
    write_rows(rows, path)
    back = read_rows(path)
    assert [r.key for r in back] == sorted(r.key for r in rows)
    values = {r.key: r for r in rows}
    for row in back:
        # 12 digits are written
        assert row.value == pytest.approx(values[row.key].value, rel=1e-11, abs=0.0)
        assert row.unit == values[row.key].unit


@given(rows=ROWS)
def test_order_of_rows_does_not_change_the_bytes(tmp_path_factory, rows):
    folder = tmp_path_factory.mktemp("order")
    write_rows(rows, folder / "one.csv")
    write_rows(rows[::-1], folder / "other.csv")
    assert (folder / "one.csv").read_bytes() == (folder / "other.csv").read_bytes()


def test_columns_are_the_promised_ones(tmp_path):
    rows = [Row("fig3a.matched", "speed", "g9-g5", 219.74, "m/s", 1e-6)]
    write_rows(rows, tmp_path / "m.csv", reasons=False)
    assert (tmp_path / "m.csv").read_text().splitlines() == [
        "case,quantity,sensor,value,unit,numerical_error",
        "fig3a.matched,speed,g9-g5,219.74,m/s,1e-06",
    ]


def test_absent_value_is_empty_and_its_reason_is_kept_beside(tmp_path):
    rows = [
        absent("c.v", "duration", "g9", "us", "merged: too close"),
        Row("c.v", "arrival", "g9", 1.0, "us"),
    ]
    write_rows(rows, tmp_path / "m.csv", reasons=False)
    write_absent(rows, tmp_path / "a.csv")
    assert "c.v,duration,g9,,us," in (tmp_path / "m.csv").read_text()
    assert (tmp_path / "a.csv").read_text() == (
        "case,quantity,sensor,reason\nc.v,duration,g9,merged: too close\n"
    )
    known, gone = read_rows(tmp_path / "m.csv", tmp_path / "a.csv")
    assert known.known and known.reason == ""
    assert math.isnan(gone.value) and gone.reason == "merged: too close"


def test_a_metric_stands_once(tmp_path):
    with pytest.raises(ValueError, match="two rows for c/q/s"):
        write_rows([Row("c", "q", "s", 1.0, "1"), Row("c", "q", "s", 2.0, "1")], tmp_path / "m.csv")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("case,value\n", "the first line must read case,quantity,sensor,value,unit,numerical_error"),
        ("", "the first line must read"),
        ("case,quantity,sensor,value,unit,numerical_error\na,b,c,fast,m/s,\n", "line 2: 'fast' or ''"),
        ("case,quantity,sensor,value,unit,numerical_error\na,b,c\n", "line 2: 3 cells, expected 6"),
    ],
)
def test_a_foreign_table_is_refused(tmp_path, text, message):
    path = tmp_path / "m.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_rows(path)


def test_zero_has_one_spelling():
    assert number(-0.0) == number(0.0) == "0"
    assert number(math.nan) == ""
