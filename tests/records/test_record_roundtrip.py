"""What is written reads back bit for bit, and no corruption of a file ends in anything but a message."""

import contextlib
import string
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from record_cases import BALL, CONTENT, SCALARS, content, made, put

from sonicvacuum.files import InputError
from sonicvacuum.records import Record, Signals, read, signals, write
from sonicvacuum.records.reader import parse
from sonicvacuum.records.writer import dump

CASES = {
    "traces": {},
    "scalars": {"runs__1__observables": SCALARS, "runs__1__signals": None},
    "coated": {"chain__bead__coating_um": 30.0, "chain__bead__core": "tungsten-carbide"},
    "two strikers": {
        "runs__0__striker": {
            "shape": "sphere",
            "diameter_mm": 5.0,
            "material": "brass",
            "mass_g": 0.55,
            "speed_m_s": 0.3,
        }
    },
    "told fully": {
        "tolerances": {"coating_rel": 0.1},
        "sensors__0__droop_us": 1000.0,
        "runs__1__observables": [
            SCALARS[0] | {"shared": {"places": 0.041}},
            SCALARS[1] | {"bound": "at_most"},
        ],
    },
    "no source": {"source": None, "materials": None, "trigger_sigma_us": None},
}


def same(one, other):
    return one.block == other.block and all(one.signals[r].equals(t) for r, t in other.signals.items())


@pytest.mark.parametrize("name", CASES)
def test_what_is_written_reads_back(tmp_path, name):
    record = made(**CASES[name])
    write(record, tmp_path / "first")
    again = read(tmp_path / "first")
    assert same(again, record)
    write(again, tmp_path / "second")
    for file in (tmp_path / "first").iterdir():
        assert (tmp_path / "second" / file.name).read_bytes() == file.read_bytes()


def test_one_ball_reads_back(tmp_path):
    record = made(BALL)
    write(record, tmp_path)
    assert read(tmp_path).block == record.block


def test_the_file_itself_may_be_named_and_strangers_beside_it_are_ignored(tmp_path):
    folder = put(tmp_path)
    (folder / "notes.txt").write_bytes(b"\xff\xfe not a record")
    (folder / "photos").mkdir()
    assert same(read(folder / "record.yaml"), read(folder))
    assert read(folder).name == tmp_path.name


numbers = st.floats(-1e300, 1e300, allow_nan=False, allow_subnormal=True)


@given(st.lists(st.tuples(numbers, numbers), min_size=16, max_size=30), st.floats(-50.0, 50.0))
def test_any_forces_read_back(rows, start):
    time = start + 0.5 * np.arange(len(rows))
    forces = np.array(rows)
    trace = Signals(time, {"a": forces[:, 0], "b": forces[:, 1]})
    with tempfile.TemporaryDirectory() as folder:
        signals.write(trace, Path(folder) / "x.csv")
        assert signals.read(Path(folder) / "x.csv", ["b", "a"]).equals(trace)


@given(
    beads=st.integers(7, 100),
    force=st.just(0.0) | st.floats(1e-15, 1e3),  # what is nearer to 0 is refused
    value=st.floats(1.0, 6000.0),
    sigma=st.floats(1e-9, 1e3),
    title=st.text(
        st.characters(codec="utf-8", exclude_categories=["Cc", "Cf", "Cs", "Zl", "Zp"]), max_size=30
    ),
)
@settings(max_examples=50)
def test_any_numbers_and_titles_read_back(beads, force, value, sigma, title):
    block = parse(
        content(
            title=title,
            chain__beads=beads,
            chain__static_force_N=force,
            runs__0__signals=None,
            runs__0__observables=[SCALARS[0] | {"value": value, "sigma": sigma}],
            runs__1__signals=None,
        )
    )
    with tempfile.TemporaryDirectory() as folder:
        write(Record(block), folder)
        assert read(folder).block == block


@given(data=st.data(), file=st.sampled_from(["record.yaml", "fast.csv"]))
@settings(max_examples=150)
def test_corruption_ends_in_one_message(data, file):
    """Bytes are cut out, put in or exchanged: the record still reads, or one line names the file at fault."""
    with tempfile.TemporaryDirectory() as place:
        folder = put(Path(place) / "record")
        raw = (folder / file).read_bytes()
        start = data.draw(st.integers(0, len(raw)))
        gone = data.draw(st.integers(0, 40))
        put_in = data.draw(
            st.text("\n\r\t,;:-[]{}'\"#&*!|>%@`.eEnN0123456789 \x00é" + string.ascii_lowercase, max_size=6)
        )
        (folder / file).write_bytes(raw[:start] + put_in.encode() + raw[start + gone :])
        with contextlib.suppress(UnicodeEncodeError):
            read_or_complain(folder)


def read_or_complain(folder):
    try:
        read(folder)
    except InputError as error:
        assert "\n" not in str(error), str(error)
        assert any(name in str(error) for name in ("record.yaml", ".csv")), str(error)


@given(data=st.data())
@settings(max_examples=200)
def test_any_value_in_any_place_ends_in_one_message(data):
    """One value of record.yaml becomes something else of any YAML type."""
    whole = content(CONTENT, runs__1__observables=SCALARS)
    places = list(leaves(whole))
    path = data.draw(st.sampled_from(places))
    scalars = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5)
    value = data.draw(
        scalars | st.lists(scalars, max_size=2) | st.dictionaries(st.text(max_size=3), scalars, max_size=2)
    )
    parent = whole
    for key in path[:-1]:
        parent = parent[key]
    parent[path[-1]] = value
    try:
        parse(whole, "record.yaml")
    except InputError as error:
        assert str(error).startswith("record.yaml: ")
        assert "\n" not in str(error)


def leaves(tree, path=()):
    """Paths of all places of a mapping or list, inner ones included."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in items:
        yield (*path, key)
        yield from leaves(value, (*path, key))


def test_a_record_that_would_not_read_is_not_written(tmp_path):
    good = made()
    bad = Record(parse(content(runs__0__signals="fast.csv")), good.signals)
    with pytest.raises(InputError, match="own file name"):
        write(bad, tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InputError, match="choose a folder that can be written"):
        write(made(BALL), tmp_path / "file")


def test_defaults_are_left_out_and_keys_keep_the_order_of_the_contract():
    written = dump(made(**CASES["scalars"]))
    assert list(written["chain"]) == ["beads", "orientation", "bead", "wall", "static_force_N"]
    assert list(written["runs"][1]["observables"][0]) == ["quantity", "from", "to", "value", "sigma", "unit"]
    assert "bead" not in written["sensors"][2]


def test_a_record_that_cannot_be_written_to_its_end_leaves_the_old_one(tmp_path, monkeypatch):
    record = made()
    write(record, tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    put, done = signals.write, []

    def once(traces, path):
        if done:
            raise OSError(28, "No space left on device")
        done.append(path)
        put(Signals(traces.time_s + 1.0, traces.readings), path)

    monkeypatch.setattr(signals, "write", once)
    with pytest.raises(OSError, match="No space left"):
        write(record, tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
