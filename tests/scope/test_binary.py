"""Binary files, made here: .tdms of LabVIEW, .trc of LeCroy, .isf of Tektronix; what is missing is named."""

import struct
import sys

import numpy as np
import pytest
from made_files import PULSE, START, STEP, TIMES
from nptdms import ChannelObject, TdmsWriter

from sonicvacuum.files import InputError
from sonicvacuum.scope import read
from sonicvacuum.scope.binary import ENVELOPE
from sonicvacuum.scope.timebase import SECONDS


def tdms(path, channels):
    with TdmsWriter(str(path)) as writer:
        writer.write_segment(channels)
    return path


def isf(path, counts, gain, units=("V", "s")):
    """A Tektronix .isf with the words of a preamble and 16-bit counts, the high byte first."""
    data = np.asarray(counts, dtype=">i2").tobytes()
    words = {
        "BYT_NR": 2, "BIT_NR": 16, "ENCDG": "BINARY", "BN_FMT": "RI", "BYT_OR": "MSB",
        "WFID": '"Ch1, DC coupling"', "NR_PT": len(counts), "PT_FMT": "Y",
        "XUNIT": f'"{units[1]}"', "XINCR": f"{STEP:.6E}", "XZERO": f"{START:.6E}", "PT_OFF": 0,
        "YUNIT": f'"{units[0]}"', "YMULT": f"{gain:.6E}", "YOFF": "0.0E+0", "YZERO": "0.0E+0",
    }  # fmt: skip
    head = ":WFMPRE:" + ";".join(f"{k} {v}" for k, v in words.items()) + ";:CURVE "
    length = str(len(data))
    path.write_bytes(head.encode() + f"#{len(length)}{length}".encode() + data + b"\n")
    return path


def trc(path, counts, gain, units=(b"V", b"S")):
    """A LeCroy .trc: WAVEDESC of template LECROY_2_3, 346 bytes, and 16-bit counts.

    Places of the fields: LeCroy, Template of LECROY_2_3 (MAUI Automation Manual).
    """
    head = bytearray(346)
    fields = {
        0: b"WAVEDESC", 16: b"LECROY_2_3", 32: struct.pack("<hh", 1, 1), 36: struct.pack("<i", 346),
        60: struct.pack("<i", 2 * len(counts)), 76: b"LECROYWR610Zi", 116: struct.pack("<i", len(counts)),
        120: struct.pack("<i", len(counts)), 128: struct.pack("<i", len(counts) - 1),
        136: struct.pack("<i", 1), 144: struct.pack("<i", 1), 156: struct.pack("<ff", gain, 0.0),
        164: struct.pack("<ff", 32767.0, -32768.0), 172: struct.pack("<h", 16), 174: struct.pack("<h", 1),
        176: struct.pack("<f", STEP), 180: struct.pack("<dd", START, START), 196: units[0], 244: units[1],
        328: struct.pack("<f", 1.0), 344: struct.pack("<h", 1),
    }  # fmt: skip
    for place, data in fields.items():
        head[place : place + len(data)] = data
    path.write_bytes(bytes(head) + np.asarray(counts, dtype="<i2").tobytes())
    return path


def test_tdms(tmp_path):
    timed = {"wf_increment": STEP, "wf_start_offset": START, "unit_string": "mV"}
    channels = [
        ChannelObject("shot", "g9", 1e3 * PULSE, properties=timed),
        ChannelObject("shot", "g5", PULSE, properties=timed | {"unit_string": "N"}),
    ]
    recording = read(tdms(tmp_path / "a.tdms", channels))
    assert [(c.name, c.unit) for c in recording.channels] == [("g9", "V"), ("g5", "N")]
    for channel in recording.channels:
        assert (channel.start_s, channel.interval_s) == (START, STEP)
        assert channel.values == pytest.approx(PULSE, rel=1e-12)  # scaled by a power of ten and back


def test_tdms_with_a_channel_of_times(tmp_path):
    channels = [ChannelObject("shot", "Time", TIMES), ChannelObject("shot", "g9", PULSE)]
    (channel,) = read(tdms(tmp_path / "a.tdms", channels)).channels
    assert channel.interval_s == pytest.approx(STEP, rel=1e-9)  # kept to twelve digits
    assert any("No unit given" in n for n in channel.notes)


def test_trc(tmp_path):
    counts = np.round(PULSE / 1e-4).astype(int)
    recording = read(trc(tmp_path / "C2--00000.trc", counts, 1e-4))
    (channel,) = recording.channels
    assert (recording.layout, channel.unit, channel.samples) == ("trc", "V", len(PULSE))
    assert channel.interval_s == pytest.approx(STEP, rel=1e-6)  # a float of four bytes in the file
    assert channel.values == pytest.approx(PULSE, abs=1e-6)  # so is the gain


@pytest.mark.parametrize(
    ("label", "unit", "factor"), [("Time", "ms", 1e3), ("Time [ms]", "", 1e3), ("Zeit", "us", 1e6)]
)
def test_tdms_times_have_a_unit(tmp_path, label, unit, factor):
    channels = [
        ChannelObject("shot", label, factor * TIMES, properties={"unit_string": unit}),
        ChannelObject("shot", "g9", PULSE),
    ]
    (channel,) = read(tdms(tmp_path / "a.tdms", channels)).channels
    assert (channel.start_s, channel.interval_s) == pytest.approx((START, STEP), rel=1e-9)


@pytest.mark.parametrize(
    ("label", "said", "name", "unit", "factor"),
    [
        ("F (kN)", "", "F", "N", 1e3),
        ("acc [g]", "", "acc", "g", 1.0),
        ("F (kN)", "N", "F (kN)", "N", 1.0),  # what the properties say counts
        ("Dev1/ai0", "", "Dev1/ai0", "", 1.0),
    ],
)
def test_tdms_names_bear_units_where_nothing_else_does(tmp_path, label, said, name, unit, factor):
    properties = {"wf_increment": STEP, "unit_string": said}
    (channel,) = read(
        tdms(tmp_path / "a.tdms", [ChannelObject("shot", label, PULSE, properties=properties)])
    ).channels
    assert (channel.name, channel.unit) == (name, unit)
    assert channel.values == pytest.approx(factor * PULSE, rel=1e-12)


def test_tdms_times_without_a_unit_are_told(tmp_path):
    channels = [ChannelObject("shot", "Time", 1e6 * TIMES), ChannelObject("shot", "g9", PULSE)]
    (channel,) = read(tdms(tmp_path / "a.tdms", channels)).channels
    assert SECONDS in channel.notes


def test_tdms_times_that_run_backwards_are_none(tmp_path):
    channels = [ChannelObject("shot", "Time", -TIMES), ChannelObject("shot", "g9", PULSE)]
    (channel,) = read(tdms(tmp_path / "a.tdms", channels)).channels
    assert channel.interval_s is None and any("run backwards" in n for n in channel.notes)


def test_tdms_increments_have_a_unit(tmp_path):
    timed = {"wf_increment": 1e6 * STEP, "wf_start_offset": 1e6 * START}
    across = [
        ChannelObject("shot", u, PULSE, properties=timed | {"wf_xunit_string": u}) for u in ("us", "Hz")
    ]
    first, second = read(tdms(tmp_path / "a.tdms", across)).channels
    assert (first.start_s, first.interval_s) == pytest.approx((START, STEP), rel=1e-9)
    assert second.interval_s is None and any("wf_xunit_string is 'Hz'" in n for n in second.notes)


@pytest.mark.parametrize(("unit", "base", "factor"), [("V", "V", 1.0), ("g", "g", 1.0), ("mN", "N", 1e-3)])
@pytest.mark.parametrize("kind", ["isf", "trc"])
def test_waveforms_have_the_unit_that_they_bear(tmp_path, kind, unit, base, factor):
    counts = np.round(PULSE / 1e-4).astype(int)
    if kind == "isf":
        path = isf(tmp_path / "a.isf", counts, 1e-4, (unit, "s"))
    else:
        path = trc(tmp_path / "a.trc", counts, 1e-4, (unit.encode(), b"S"))
    (channel,) = read(path).channels
    assert (channel.unit, channel.samples) == (base, len(PULSE))
    assert channel.values == pytest.approx(factor * PULSE, abs=1e-6)
    assert channel.interval_s == pytest.approx(STEP, rel=1e-6)


@pytest.mark.parametrize("kind", ["isf", "trc"])
def test_a_spectrum_has_no_times(tmp_path, kind):
    if kind == "isf":
        path = isf(tmp_path / "a.isf", [1, 2, 3] * 20, 1e-4, ("dB", "Hz"))
    else:
        path = trc(tmp_path / "a.trc", [1, 2, 3] * 20, 1e-4, (b"dB", b"HZ"))
    (channel,) = read(path).channels
    assert channel.interval_s is None and "No time: the unit across is" in channel.notes[0]


def test_an_envelope_is_told(tmp_path):
    path = isf(tmp_path / "a.isf", np.arange(600), 1e-4)
    path.write_bytes(path.read_bytes().replace(b"PT_FMT Y", b"PT_FMT ENV"))
    (channel,) = read(path).channels
    assert ENVELOPE in channel.notes


def test_a_waveform_that_is_cut_off_is_told(tmp_path):
    path = isf(tmp_path / "a.isf", np.arange(600), 1e-4)
    path.write_bytes(path.read_bytes()[:-701])
    (channel,) = read(path).channels
    assert f"The header announces 600 samples, the file holds {channel.samples}." in channel.notes


@pytest.mark.parametrize(("name", "module"), [("a.tdms", "nptdms"), ("a.trc", "RigolWFM")])
def test_a_missing_library_is_named(name, module, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, module, None)
    (tmp_path / name).write_bytes(b"TDSm" if name.endswith("tdms") else b"WAVEDESC")
    with pytest.raises(InputError, match=r"sonicvacuum\[scope\]"):
        read(tmp_path / name)


@pytest.mark.parametrize("name", ["bad.tdms", "bad.trc", "bad.wfm"])
def test_damaged_files_are_refused(name, tmp_path):
    (tmp_path / name).write_bytes(b"TDSm" + b"\x01\x02\x03" * 40)
    with pytest.raises(InputError, match=name):
        read(tmp_path / name)


def test_what_the_library_finds_odd_is_told_with_the_file_and_not_by_itself(tmp_path, capfd):
    whole = tdms(tmp_path / "a.tdms", [ChannelObject("shot", "g9", PULSE)]).read_bytes()
    (tmp_path / "cut.tdms").write_bytes(whole[:40])
    with pytest.raises(InputError, match=r"channel of numbers \(Last segment metadata is incomplete\)"):
        read(tmp_path / "cut.tdms")
    odd = tmp_path / "odd.tdms"
    odd.write_bytes(whole[:8] + b"\xff\xff\x00\x00" + whole[12:])  # of a version that does not exist
    assert read(odd).notes == ("npTDMS: Unrecognised version number: 65535",)
    assert capfd.readouterr().err == ""
