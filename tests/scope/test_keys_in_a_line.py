"""Several keys in one line of a header, each with its value, above several channels without times."""

import pytest
from odd_files import PULSE, SECOND, recording, rows


@pytest.mark.parametrize(
    ("head", "start"),
    [
        ("dt = 1 us, t0 = -100 us", -1e-4),
        ("Sampling interval [us]: 1; Pretrigger samples: 100", -1e-4),
        ("fs: 1000 kHz; bits: 12; range: 10 V", 0.0),
        ("fs: 1000 kHz, bits: 12", 0.0),
        ("Sample Interval: CH1:1us, CH2:1us", 0.0),
        ("Sample rate,1000000,Hz,Samples,200", 0.0),
        ("Sample rate,1000000,Hz,pretrigger,100,samples", -1e-4),
        ("fs,1000 kHz,bits,12,range,10", 0.0),
        ("Interval,0.001,ms,200,points", 0.0),
        ("Time increment,1E-6,Start,-1E-4", -1e-4),
    ],
)
def test_several_keys_in_a_line_are_of_all_channels(tmp_path, head, start):
    found = recording(tmp_path, f"{head}\nF (N),G (N),H (N)\n" + rows(PULSE, SECOND, PULSE)).channels
    assert [c.interval_s for c in found] == pytest.approx([1e-6] * 3, rel=1e-9)
    assert [c.start_s for c in found] == pytest.approx([start] * 3, rel=1e-9)


@pytest.mark.parametrize("values", ["1e-6,2e-6,4e-6", "CH1:1us,CH2:2us,CH3:4us"])
def test_values_of_one_key_are_of_the_channels_in_order(tmp_path, values):
    found = recording(tmp_path, f"Sample Interval,{values}\nF (N),G (N),H (N)\n" + rows(PULSE, SECOND, PULSE))
    assert [c.interval_s for c in found.channels] == pytest.approx([1e-6, 2e-6, 4e-6], rel=1e-9)
