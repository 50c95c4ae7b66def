"""Binary files in which zeros are frequent: pictures of the screen, sounds, workbooks, other data files."""

import pytest
from odd_files import PULSE, TIMES, recording, rows

from sonicvacuum.files import InputError

BEGINNINGS = {
    "png": b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR",
    "bmp": b"BM6\x10\x0e\x00\x00\x00\x00\x006\x00\x00\x00(\x00",
    "wav": b"RIFF\x24\x08\x00\x00WAVEfmt \x10\x00\x00\x00\x01\x00",
    "h5": b"\x89HDF\r\n\x1a\n\x00\x00\x00\x00\x00\x08\x08\x00",
    "xlsx": b"PK\x03\x04\x14\x00\x06\x00\x08\x00\x00\x00",
}


@pytest.mark.parametrize("kind", BEGINNINGS)
@pytest.mark.parametrize("rest", [bytes(4000), b"\x01\x00\x02\x00" * 1000, bytes(range(256)) * 16])
def test_a_binary_file_is_called_so(tmp_path, kind, rest):
    with pytest.raises(InputError, match="is a binary file of no kind that is read here"):
        recording(tmp_path, BEGINNINGS[kind] + rest, f"t.{kind}")


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("minus", ["-", "\u2212"])
def test_wide_text_without_a_mark_is_still_read(tmp_path, encoding, minus):
    text = "Time (s)\tCH1 (V)\r\n" + rows(TIMES, PULSE, cell="\t").replace("\n", "\r\n").replace("-", minus)
    found = recording(tmp_path, text.encode(encoding))
    assert (found.channels[0].unit, found.channels[0].samples) == ("V", 200)
