"""Files in the layouts of many recorders come back as the same pulse; what is wrong with files is said."""

import numpy as np
import pytest
from made_files import COUNT, LAYOUTS, PULSE, STEP, TIMES, lecroy, table, tbs

from sonicvacuum.files import InputError
from sonicvacuum.scope import read


def put(folder, name, data):
    path = folder / name
    path.write_bytes(data)
    return path


@pytest.mark.parametrize("made", LAYOUTS, ids=lambda m: m.maker.__name__)
def test_layout(made, tmp_path):
    recording = read(put(tmp_path, made.file, made.maker(TIMES, PULSE)))
    assert recording.layout == made.layout
    assert [c.name for c in recording.channels] == list(made.channels)
    for channel in recording.channels:
        unit, factor = made.channels[channel.name]
        assert (channel.unit, channel.samples) == (unit, COUNT)
        assert channel.interval_s == pytest.approx(STEP, rel=1e-6)  # times are printed with seven digits
        assert channel.start_s == pytest.approx(made.start, rel=1e-6)
        finite = np.isfinite(channel.values)
        assert finite.all() != (channel.name == made.over)
        # Values are printed with at least five decimals of volts.
        assert channel.values[finite] == pytest.approx(factor * PULSE[finite], abs=2e-5)


def test_contradictions_are_told(tmp_path):
    names = {m.maker.__name__: m for m in LAYOUTS}
    for name, said in (("siglent_new", "although the header's unit says us"), ("contradicting", "says s")):
        made = names[name]
        notes = read(put(tmp_path, made.file, made.maker(TIMES, PULSE))).channels[0].notes
        assert any(said in n for n in notes), notes


def test_segments_are_shots(tmp_path):
    head = lecroy(TIMES, PULSE)
    again = table([], (TIMES, 2.0 * PULSE), form="{:.9g}")
    recording = read(put(tmp_path, "C1seg.txt", head + again + again))
    assert recording.segments == 3
    assert [c.samples for c in recording.channels] == [COUNT] * 3
    assert [c.values.max() for c in recording.channels] == pytest.approx([2.0, 4.0, 4.0], rel=0.02)


def test_further_headers_part_shots(tmp_path):
    made = next(m for m in LAYOUTS if m.file == "m.lvm")
    whole = made.maker(TIMES, PULSE)
    again = whole[whole.index(b"Channels") :]
    recording = read(put(tmp_path, "two.lvm", whole + b"\n" + again))
    assert [(c.name, c.segment, c.samples) for c in recording.channels] == [
        (name, k, COUNT) for k in (1, 2) for name in ("Hammer", "Gauge")
    ]


def test_values_alone_have_no_time(tmp_path):
    (channel,) = read(put(tmp_path, "v.csv", table([], (PULSE,)))).channels
    assert channel.interval_s is None and channel.start_s is None
    assert any("give --interval" in n for n in channel.notes)


def test_time_base_of_values_alone_from_the_file_beside(tmp_path):
    put(tmp_path, "run.csv", b"Resolution:1e-06:\nXStart:-1e-04:\nRecordLength:200:\n")
    (channel,) = read(put(tmp_path, "run.Wfm.csv", table([], (PULSE,)))).channels
    assert (channel.start_s, channel.interval_s) == (-1e-4, 1e-6)


def test_times_printed_with_few_digits(tmp_path):
    head = ["Model,MSO2014", "Sample Interval,1.6e-07", "TIME,CH1"]
    times = -1e-3 + 1.6e-7 * np.arange(3000)
    path = put(tmp_path, "few.csv", table(head, (times, np.resize(PULSE, 3000)), form="{:.4e}"))
    (channel,) = read(path).channels
    assert channel.interval_s == 1.6e-7
    assert channel.times_s is None


def test_uneven_times_are_kept(tmp_path):
    times = np.cumsum(np.random.default_rng(2).uniform(4e-3, 6e-3, COUNT))
    (channel,) = read(
        put(tmp_path, "u.csv", table(["Time (s),a (m/s^2)"], (times, PULSE), form="{:.9e}"))
    ).channels
    assert channel.times_s == pytest.approx(times)
    assert any("uneven" in n for n in channel.notes)


def test_a_slower_channel_with_empty_cells(tmp_path):
    rows = [
        f"{t:.6e},{v},{v if k % 4 == 0 else ''}" for k, (t, v) in enumerate(zip(TIMES, PULSE, strict=True))
    ]
    path = put(tmp_path, "two.csv", "\n".join(["time (s),fast (V),slow (V)", *rows]).encode())
    fast, slow = read(path).channels
    assert (fast.interval_s, slow.interval_s, slow.samples) == (1e-6, 4e-6, 50)


REFUSED = [
    (b"", "empty"),
    (b"hello world\nthis is text\n", "no columns of numbers"),
    (b"\x00\x01\x02\x03\x80\x81" * 50, "binary"),
    ("\n".join(f"{k},05,{k + 1},07" for k in range(30)).encode(), "both as decimal marks"),
    ("time (s)\n" + "\n".join(f"0.{k:03d}" for k in range(30)), "no channel beside"),
]


@pytest.mark.parametrize(("data", "said"), REFUSED)
def test_refused_with_the_reason(data, said, tmp_path):
    path = put(tmp_path, "bad.csv", data if isinstance(data, bytes) else data.encode())
    with pytest.raises(InputError, match=said):
        read(path)


def test_line_ends_and_encodings_do_not_matter(tmp_path):
    text = tbs(TIMES, PULSE).decode().replace("\r\n", "\n")
    first = None
    for end in ("\n", "\r\n", "\r", "\r\r\n"):
        for encoding in ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-32", "latin-1"):
            found = read(put(tmp_path, "e.csv", text.replace("\n", end).encode(encoding))).channels
            values = np.array([c.values for c in found])
            first = values if first is None else first
            assert np.array_equal(values, first), (end, encoding)
