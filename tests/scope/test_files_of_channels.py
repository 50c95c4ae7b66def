"""Files of one channel each, whose names differ in the channel's number only, are one run."""

import pytest
from made_files import PULSE, TIMES, table

from sonicvacuum.scope.options import options
from sonicvacuum.scope.runs import shots


@pytest.mark.parametrize(
    ("names", "run"),
    [
        (("F0000CH1", "F0000CH2"), "F0000"),
        (("shot_Ch3", "shot_Ch4"), "shot"),
        (("v044-channel1", "v044-channel2"), "v044"),
        (("v044 Channel 1", "v044 Channel 2"), "v044"),
        (("v044_Kanal1", "v044_Kanal2"), "v044"),
        (("chan1_v044", "chan2_v044"), "v044"),
    ],
)
def test_channels_of_one_run(tmp_path, names, run):
    files = [tmp_path / f"{name}.csv" for name in names]
    for file in files:
        file.write_bytes(table(["Time (s),Volts"], (TIMES, PULSE)))
    (found,) = shots(files, options())
    assert found.id == run
    assert len(found.channels) == 2 and all(g.startswith("CH") for g in found.channels)


@pytest.mark.parametrize("names", [("march1", "march2"), ("a_ch10", "a_ch11"), ("run1", "run2")])
def test_other_numbers_are_of_runs(tmp_path, names):
    files = [tmp_path / f"{name}.csv" for name in names]
    for file in files:
        file.write_bytes(table(["Time (s),Volts"], (TIMES, PULSE)))
    assert [s.id for s in shots(files, options())] == list(names)
