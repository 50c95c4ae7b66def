"""MATLAB's .mat files: which variable is what, in every version that is read; what is wrong with others."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from odd_files import PULSE, SECOND, TIMES
from scipy.io import loadmat, savemat

from sonicvacuum.files import InputError
from sonicvacuum.scope import matfile, read
from sonicvacuum.scope.importing import import_files
from sonicvacuum.scope.options import options


def saved(folder, variables, **how):
    savemat(folder / "shot.mat", variables, **how)
    return folder / "shot.mat"


VERSIONS = [{"format": "4"}, {"format": "5"}, {"format": "5", "do_compression": True}]


@pytest.mark.parametrize("how", VERSIONS, ids=["4", "6", "7"])
def test_vectors_are_channels_over_the_vector_of_times(tmp_path, how):
    names = {"time_us": 1e6 * TIMES, "F_N": PULSE, "hammer_mV": 1e3 * SECOND}
    found = read(saved(tmp_path, names, **how)).channels
    assert [(c.name, c.unit) for c in found] == [("F", "N"), ("hammer", "V")]
    for channel, values in zip(found, (PULSE, SECOND), strict=True):
        assert channel.values == pytest.approx(values)
        assert (channel.interval_s, channel.notes) == (pytest.approx(TIMES[1] - TIMES[0]), ())
        assert channel.start_s == pytest.approx(TIMES[0])


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"])
@pytest.mark.parametrize("order", ["<", ">"])
def test_numbers_are_those_that_another_reader_finds(tmp_path, kind, order):
    rng = np.random.default_rng(1)
    array = rng.integers(0, 100, (7, 3)).astype(order + kind)
    file = saved(tmp_path, {"array": array, "one": 2.5, "rec": {"inner": {"a": array[:, 0]}, "who": "me"}})
    own, other = matfile.read(file.read_bytes()), loadmat(file)
    assert own["array"].tolist() == other["array"].tolist() == array.tolist()
    assert own["one"] == other["one"] == 2.5
    assert own["rec"]["inner"]["a"].ravel().tolist() == array[:, 0].tolist()
    assert own["rec"]["who"] == matfile.LeftOut("text")


def test_what_picoscope_writes_is_in_volts(tmp_path):
    values = {"A": PULSE.astype("f4"), "B": SECOND.astype("f4"), "Tinterval": 1e-6, "Tstart": -1e-4}
    more = {"Length": np.int32(len(PULSE)), "ExtraSamples": 0, "Version": "6.14"}
    found = read(saved(tmp_path, values | more))
    assert [(c.name, c.unit, c.interval_s, c.start_s) for c in found.channels] == [
        ("A", "V", 1e-6, -1e-4), ("B", "V", 1e-6, -1e-4),
    ]  # fmt: skip
    assert found.channels[0].notes == ("No unit given; V assumed.",)
    assert found.notes == ("Left out: Version (text).",)


def test_columns_of_a_matrix_are_channels_whichever_way_they_lie(tmp_path):
    for matrix in (np.c_[PULSE, SECOND], np.r_[[PULSE], [SECOND]]):
        found = read(saved(tmp_path, {"data": matrix, "fs": 1e6})).channels
        assert [(c.name, c.interval_s) for c in found] == [("data_1", 1e-6), ("data_2", 1e-6)]
        assert found[1].values == pytest.approx(SECOND)
    (channel,) = read(saved(tmp_path, {"data": np.c_[TIMES, PULSE]})).channels
    assert (channel.name, channel.interval_s) == ("data_2", pytest.approx(TIMES[1] - TIMES[0]))


def test_structures_have_their_own_times_or_those_around_them(tmp_path):
    own = {"t": TIMES[:50] * 2.0, "G": PULSE[:50]}
    inner = {"values": SECOND, "label": "far"}
    found = read(saved(tmp_path, {"out": {"time": TIMES, "signals": inner}, "rec": own})).channels
    step = TIMES[1] - TIMES[0]
    assert {c.name: c.interval_s for c in found} == {
        "out.signals.values": pytest.approx(step), "rec.G": pytest.approx(2.0 * step),
    }  # fmt: skip


def test_what_is_no_trace_is_told(tmp_path):
    several = np.array([(1.0,), (2.0,)], dtype=[("a", "O")])
    odd = {"c": np.array([1, "b"], dtype=object), "z": PULSE + 1j, "flags": PULSE > 0.0, "many": several}
    found = read(saved(tmp_path, {"t": TIMES, "CH1": PULSE, "cube": np.zeros((9, 9, 2))} | odd))
    assert [c.name for c in found.channels] == ["CH1"]
    told = "cube (more than two dimensions), c (cell), z (complex), flags (logical)"
    assert found.notes == (f"Left out: {told}, many (structure of several).",)


REFUSED = [
    ({"t": TIMES, "time": 2.0 * TIMES, "CH1": PULSE}, "t and time may each be the times; save one of them"),
    ({"t": TIMES}, "has times but no channel beside them; save the traces too"),
    ({"gain": 12.5, "who": "me"}, r"no variable is a trace \(it holds gain, who \(text\)\); save the traces"),
]


@pytest.mark.parametrize(("variables", "said"), REFUSED)
def test_refused_with_the_variables(tmp_path, variables, said):
    with pytest.raises(InputError, match=rf"shot\.mat: {said}"):
        read(saved(tmp_path, variables))


def test_without_times_the_import_names_what_they_would_be_called(tmp_path):
    file = saved(tmp_path, {"CH1": PULSE})
    with pytest.raises(InputError, match=r"channel CH1: No time: no variable is called .* give --interval"):
        import_files([file], tmp_path / "r", options())
    import_files([file], tmp_path / "r", options(interval="1us"))


def test_days_are_no_seconds_here_either(tmp_path):
    (channel,) = read(saved(tmp_path, {"time": 738_000.4 + TIMES / 86.4, "CH1": PULSE})).channels
    assert channel.interval_s is None and "numbers of days" in channel.notes[0]


@pytest.mark.parametrize("name", ["shot.mat", "shot.dat"])
def test_version_7_3_is_refused_with_how_to_save_it(tmp_path, name):
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512) + b"\x89HDF\r\n\x1a\n" + bytes(500)
    (tmp_path / name).write_bytes(head)
    with pytest.raises(InputError, match=r"version 7\.3 \(HDF5\).* '-v7'\)"):
        read(tmp_path / name)


def test_text_of_that_name_is_text(tmp_path):
    np.savetxt(tmp_path / "shot.mat", np.c_[TIMES, PULSE])
    (channel,) = read(tmp_path / "shot.mat").channels
    assert channel.values == pytest.approx(PULSE)


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sound")
    content = {"t": TIMES, "rec": {"F": PULSE, "who": "me"}, "n": 3.0}
    flat = {"t": TIMES, "F": PULSE}
    return [saved(folder, flat if how["format"] == "4" else content, **how).read_bytes() for how in VERSIONS]


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_any_damage_is_refused_or_read(tmp_path, sound, data):
    """A library ended the process with some of these."""
    content = bytearray(data.draw(st.sampled_from(sound)))
    for _ in range(data.draw(st.integers(0, 4))):
        place = data.draw(st.integers(0, min(len(content), 700) - 1) | st.integers(0, len(content) - 1))
        content[place] = data.draw(st.integers(0, 255))
    (tmp_path / "shot.mat").write_bytes(content[: data.draw(st.integers(1, len(content)))])
    try:
        assert read(tmp_path / "shot.mat").channels
    except InputError as error:
        assert "shot.mat: " in str(error)
