"""Numbers with a decimal comma behind the keys of a header, whatever marks stand in the samples."""

import pytest
from odd_files import PULSE, SECOND, recording, rows

KEYS = ["Time increment: 1,0E-6", "Sampling Period = 1,00e-06 s", "Sample Interval (s): 0,000001",
        "Sample Interval (ms): 0,001", "Abtastrate: 1,0 MHz", "Sampling interval: 0,001 ms"]  # fmt: skip


@pytest.mark.parametrize("key", KEYS)
@pytest.mark.parametrize(("cell", "decimal"), [(";", ","), ("\t", ","), (";", "."), (",", ".")])
@pytest.mark.parametrize("further", ["", ", Gain = 1, Bits = 12"])
def test_a_number_is_not_cut_at_its_comma(tmp_path, key, cell, decimal, further):
    body = rows(PULSE, SECOND, cell="\t").replace(".", decimal).replace("\t", cell)
    found = recording(tmp_path, f"{key}{further}\nF (N){cell}G (N)\n{body}").channels
    assert [c.interval_s for c in found] == pytest.approx([1e-6, 1e-6], rel=1e-9)


def test_a_key_with_its_unit_in_brackets_within_a_line(tmp_path):
    head = "fs = 1000e3, Date = 2020-03-01, Start Time (s) = -1e-04, Operator = Me"
    found = recording(tmp_path, f"{head}\nF (N),G (N)\n{rows(PULSE, SECOND)}").channels
    assert [c.start_s for c in found] == pytest.approx([-1e-4, -1e-4], rel=1e-9)
