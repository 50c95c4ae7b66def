"""Files whose parts are as recorders write them, but not where or how they usually stand."""

import pandas as pd
import pytest
from odd_files import PULSE, SECOND, TIMES, recording, rows

from sonicvacuum.files import InputError
from sonicvacuum.scope import numbers
from sonicvacuum.scope.importing import import_files
from sonicvacuum.scope.options import options


def test_names_behind_channel_titles(tmp_path):
    head = "Interval=\t1e-06 s\nDateFormat=\t\nChannelTitle=\tForce\tWall\nRange=\t5.000 V\t2.000 V\n"
    found = recording(tmp_path, 2 * (head + rows(TIMES, PULSE, SECOND, cell="\t")), "t.txt").channels
    assert [(c.name, c.segment) for c in found] == [("Force", 1), ("Wall", 1), ("Force", 2), ("Wall", 2)]
    assert [c.interval_s for c in found] == [pytest.approx(1e-6, rel=1e-6)] * 4


def test_segments_with_times_for_each_channel(tmp_path):
    lead = "LabVIEW Measurement\t\nSeparator\tTab\nX_Columns\tMulti\n***End_of_Header***\t\n\t\n"
    head = "Channels\t2\t\t\t\nDelta_X\t1E-6\t\t1E-6\t\t\n***End_of_Header***\t\t\t\t\n"
    head += "X_Value\tnear\tX_Value\tfar\tComment\n"
    part = head + rows(TIMES, PULSE, TIMES, SECOND, cell="\t")
    found = recording(tmp_path, lead + part + "\t\n" + part, "t.lvm").channels
    assert [(c.name, c.segment) for c in found] == [("near", 1), ("far", 1), ("near", 2), ("far", 2)]
    assert found[3].values == pytest.approx(SECOND, abs=1e-6)


def test_too_many_columns_are_refused(tmp_path):
    row = ",".join("1" for _ in range(numbers._WIDEST + 50)) + "\n"
    with pytest.raises(InputError, match=r"t.csv: the table has more than 10000 columns; export"):
        recording(tmp_path, row * 8)


def test_traces_in_rows_are_refused(tmp_path):
    lines = ["Time," + ",".join(f"{t:.7g}" for t in TIMES), "CH1," + ",".join(f"{v:.5f}" for v in PULSE)]
    with pytest.raises(InputError, match=r"t.csv: holds \d+ columns of 2 numbers, as where each"):
        recording(tmp_path, "\n".join(lines) + "\n")


def test_a_loop_of_links_is_no_folder(tmp_path):
    (tmp_path / "shot.csv").write_text("Time (s),CH1 (V)\n" + rows(TIMES, PULSE))
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with pytest.raises(InputError, match=r"a/shot.csv: .*loop of links; choose another folder for --out"):
        import_files([tmp_path / "shot.csv"], tmp_path / "a", options())


def test_an_interruption_that_pandas_hides_is_one(tmp_path, monkeypatch):
    def interrupted(*_, **__):
        raise pd.errors.ParserError("Error tokenizing data. C error: Calling read(nbytes) on source failed.")

    monkeypatch.setattr(numbers.pd, "read_csv", interrupted)
    with pytest.raises(KeyboardInterrupt):
        recording(tmp_path, "Time (s),CH1 (V)\n" + rows(TIMES, PULSE))


# Cells of the second column that are no numbers, from the line on in which the first of them stands.
CELLS = [
    ("Time (us),CH1 (%)\n", ",", lambda k: f"{k % 7}.5%", 2, "0.5%"),
    ("Time (us),CH1\n", ",", lambda k: f"{(65535 - k % 7) if k > 1 else k:04X}", 4, "FFFD"),
    ("Time (ms);F (N)\n", ";", lambda k: f"0,{k % 7}512", 2, "0,0512"),
]


@pytest.mark.parametrize(("head", "cell", "form", "line", "word"), CELLS)
def test_a_channel_that_is_no_numbers_is_named(tmp_path, head, cell, form, line, word):
    text = head + "".join(f"{k / 2 + 0.5:.2f}{cell}{form(k)}\n" for k in range(60))
    said = rf"no channel beside them: line {line}, column 2: '{word}' is no number.*; export plain numbers"
    with pytest.raises(InputError, match=said):
        recording(tmp_path, text)


def test_times_that_are_no_numbers_are_named(tmp_path):
    text = "Zeit (ms);F (N)\n" + "".join(
        f"{0.001 * k - 0.1:.3f};".replace(".", ",") + f"{v}\n" for k, v in enumerate(PULSE)
    )
    (channel,) = recording(tmp_path, text).channels
    assert channel.notes[0].startswith(
        "No time: the column of times is not read: line 2, column 1: '-0,100' is"
    )


def test_the_first_gap_in_the_times_is_named(tmp_path):
    text = "Time (s),CH1 (V),CH2 (V)\n" + rows(TIMES, PULSE, SECOND) + ",30.1,20.5\n"
    for channel in recording(tmp_path, text).channels:
        assert channel.interval_s is None
        assert channel.notes[0].startswith("No time: the column of times has gaps, the first at sample 201;")
