"""Files damaged at random are read or refused with one message, in listings and in imports."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_files import LAYOUTS, PULSE, TIMES
from odd_files import recording, rows

from sonicvacuum.files import InputError
from sonicvacuum.scope.importing import import_files
from sonicvacuum.scope.listing import listing, text
from sonicvacuum.scope.options import options

WHOLE = {m.file: m.maker(TIMES, PULSE) for m in LAYOUTS if m.file != "long.csv"}
PIECES = [
    b",",
    b";",
    b"\t",
    b"\n",
    b"\r",
    b'"',
    b"NaN",
    b"1e400",
    b"overrange",
    b"\xff",
    b"\x00",
    b"-inf",
    b"=",
    b"0.0,",
]
edits = st.lists(
    st.tuples(
        st.floats(0.0, 0.999), st.sampled_from(["insert", "delete", "cut", "repeat"]), st.sampled_from(PIECES)
    ),
    min_size=1,
    max_size=5,
)


def damaged(data, changes):
    """The bytes with pieces put in, taken out, repeated, or the end cut off, at fractions of the length."""
    for place, kind, piece in changes:
        k = int(place * len(data))
        if kind == "insert":
            data = data[:k] + piece + data[k:]
        elif kind == "delete":
            data = data[:k] + data[k + 30 :]
        elif kind == "repeat":
            data = data[:k] + data[k : k + 50] + data[k:]
        else:
            data = data[: k + 1]
    return data


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(sorted(WHOLE)), edits)
def test_damaged_files(tmp_path, name, changes):
    path = tmp_path / name
    path.write_bytes(damaged(WHOLE[name], changes))
    (entry,) = listing([path])
    assert name in text([entry])
    try:
        import_files([path], tmp_path / "record", options(interval="1us"), force=True)
    except InputError as error:
        assert "\n" not in str(error)


@pytest.mark.parametrize("name", sorted(WHOLE))
def test_every_layout_is_imported(name, tmp_path):
    (tmp_path / name).write_bytes(WHOLE[name])
    said = "\n".join(import_files([tmp_path / name], tmp_path / "record", options()))
    assert "arrives at" in said


def test_no_breaking_blanks_behind_one_column(tmp_path):
    text = "CH1 (V)\n" + rows(PULSE, form="{:.4f}").replace(".", ",").replace("\n", "\u00a0\n")
    (channel,) = recording(tmp_path, text).channels
    assert channel.values == pytest.approx(PULSE, abs=1e-4)


def test_numbers_cut_within_their_commas_are_refused(tmp_path):
    lines = [f",0,0{k:03d}" if k % 3 else "," for k in range(200)]
    with pytest.raises(InputError, match=r"t.csv: .*export"):
        recording(tmp_path, ",Rate,1M\n,CH1 (V)\n" + "\n".join(lines) + "\n,\n" * 20)


def test_rows_of_marks_alone_are_blank(tmp_path):
    text = ",Time (s),CH1 (V)\n" + rows([""] * 200, TIMES, PULSE).replace("\n", "\n,,\n")
    (channel,) = recording(tmp_path, text).channels
    assert (channel.samples, channel.interval_s) == (200, pytest.approx(1e-6, rel=1e-6))
