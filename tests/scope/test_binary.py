"""Binary files, made here: LabVIEW's .tdms and LeCroy's .trc; a missing library is named with its extra."""

import struct
import sys

import numpy as np
import pytest
from made_files import PULSE, START, STEP, TIMES
from nptdms import ChannelObject, TdmsWriter

from sonicvacuum.files import InputError
from sonicvacuum.scope import read


def tdms(path, channels):
    with TdmsWriter(str(path)) as writer:
        writer.write_segment(channels)
    return path


def trc(path, counts, gain):
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
        176: struct.pack("<f", STEP), 180: struct.pack("<dd", START, START), 196: b"V", 244: b"S",
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
