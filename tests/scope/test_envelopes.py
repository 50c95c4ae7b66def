"""Text files of Tektronix scopes that hold the least and the most in turn, not samples."""

import pytest
from odd_files import PULSE, SECOND, TIMES, recording, rows

from sonicvacuum.scope.binary import ENVELOPE


@pytest.mark.parametrize(
    ("key", "row"), [("Point Format", "ENV,Y"), ("Pt Fmt", "ENV,Y"), ("Point Format", "Y,Y")]
)
def test_envelopes_are_told(tmp_path, key, row):
    head = f"Model,DPO3014\n{key},{row}\nVertical Units,V,V\nTIME,CH1,CH2\n"
    found = recording(tmp_path, head + rows(TIMES, PULSE, SECOND)).channels
    assert [ENVELOPE in c.notes for c in found] == [row.startswith("ENV"), False]


def test_an_envelope_of_one_channel_whose_header_stands_beside_its_samples(tmp_path):
    beside = [
        "Record Length,200,",
        "Sample Interval,1e-06,",
        "Pt Fmt,ENV,",
        "Source,CH1,",
        "Vertical Units,V,",
    ]
    beside += [",,"] * (len(TIMES) - len(beside))
    (channel,) = recording(tmp_path, rows(beside, TIMES, PULSE)).channels
    assert ENVELOPE in channel.notes
