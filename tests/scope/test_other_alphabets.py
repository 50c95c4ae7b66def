"""Labels of times in the encodings of other alphabets, which are no Latin-1 and are read as such."""

import pytest
from odd_files import PULSE, TIMES, recording, rows

HEADS = [
    ("Время, мс;Сила, Н\n", "cp1251"),
    ("Время;Сила\nмс;Н\n", "cp1251"),
    ("时间;力\n毫秒;N\n", "gbk"),
    ("時間(ミリ秒);力(N)\n", "shift-jis"),
]


@pytest.mark.parametrize(("head", "encoding"), HEADS)
def test_times_of_an_unread_unit_are_no_seconds(tmp_path, head, encoding):
    body = rows(1e3 * TIMES, PULSE, cell=";")
    (channel,) = recording(tmp_path, head.encode(encoding) + body.encode()).channels
    assert channel.interval_s is None
    assert any(n.startswith("No time: the unit of time, ") and "--interval" in n for n in channel.notes)
    (channel,) = recording(tmp_path, head.encode() + body.encode()).channels
    assert channel.interval_s == pytest.approx(1e-6, rel=1e-9)


@pytest.mark.parametrize("label", ["Time", "Time (\xb5s)", "Zeit_in_\xb5s"])
def test_latin_labels_are_read(tmp_path, label):
    head = f"{label};F\xfchler (N)\n".encode("latin-1")
    factor = 1e6 if "\xb5" in label else 1.0
    (channel,) = recording(tmp_path, head + rows(factor * TIMES, PULSE, cell=";").encode()).channels
    assert (channel.name, channel.interval_s) == ("F\xfchler", pytest.approx(1e-6, rel=1e-9))
