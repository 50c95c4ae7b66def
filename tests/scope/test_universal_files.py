"""Universal files (UFF), whose samples run on over the lines: as a table they would be six channels."""

import pytest
from odd_files import PULSE, recording

from sonicvacuum.files import InputError

HEAD = """    -1
{:>6}
Force
NONE
NONE
02-Mar-20 10:11:12
NONE
    1         0    1         0       NONE         1   3       NONE         1   3
         2       200         1 -1.00000e-04  1.00000e-06  0.00000e+00
        17    0    0    0                 Time                    s
        13    0    0    0                Force                    N
"""


@pytest.mark.parametrize("dataset", ["58", "151", "58b"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_universal_file_is_refused(tmp_path, dataset, end):
    lines = ["".join(f"{v:13.5e}" for v in PULSE[k : k + 6]) for k in range(0, len(PULSE), 6)]
    text = HEAD.format(dataset) + "\n".join([*lines, "    -1"]) + "\n"
    with pytest.raises(InputError, match=r"t\.csv: is a universal file .*export the traces as a table"):
        recording(tmp_path, text.replace("\n", end).encode())


def test_numbers_that_begin_with_minus_one_are_no_such_file(tmp_path):
    text = "".join(f"{v:6d}\n" for v in [-1, *range(58, 97)])
    assert recording(tmp_path, text).channels[0].samples == 40
