"""Real files of recorders, where their folder is present: all of them are read, and to the right numbers.

The folder is named by the environment variable SONICVACUUM_SCOPE_CORPUS, or lies beside the repository as
../shared/scope; without it these tests are skipped, and say so.
"""

import os
from pathlib import Path

import numpy as np
import pytest

from sonicvacuum.scope import read

CORPUS = Path(
    os.environ.get("SONICVACUUM_SCOPE_CORPUS") or Path(__file__).resolve().parents[3] / "shared" / "scope"
)
_NI = "Excitation (Trigger)|Response (Trigger)"
# file → layout, channels, samples, interval and start in s, smallest and largest value of the first channel:
# read off the files by eye.
KNOWN = {
    "keysight_scope_0.csv": ("keysight", "1 2", 2000, 1e-9, -1e-6, -6.03015069e-3, -2.0100502e-4),
    "keysight_scope_1.csv": ("keysight", "1", 2000, 1e-5, -1e-2, -6.23291466, -5.16758804),
    "ni_long_hammer_head.lvm": ("lvm", "F m_1 m_2", 3978, 0.000977, 0.0, -18.032922, 0.495539),
    "ni_multi_time_column.lvm": ("lvm", "Voltage Acceleration", 3, 1.953125e-5, 0.0, -0.035229, -0.034191),
    "ni_no_decimal_separator.lvm": ("lvm", "ax ay az", 4, 0.00025, 0.0, -0.025979, 0.059248),
    "ni_short.lvm": ("lvm", _NI, 10, 3.90625e-5, 0.0, 0.39407, 1.046658),
    "ni_short_new_line_end.lvm": (
        "lvm", _NI, 10, 3.90625e-5, 0.0, 0.39407, 1.046658
    ),
    "ni_with_comments.lvm": ("lvm", "Pressão ABS.|Temperatura|Volume (ml)", 9,
                             1.215409375, 0.0, 1520220.0, 1893370.0),
    "ni_with_empty_fields.lvm": ("lvm", "Dev0/Ai0|Dev0/Ai2|Dev0/Ai0 1", 7, 0.001, 0.0, -0.020074, -0.009206),
    "rigol_DS1052E.csv": ("rigol", "CH 1|CH 2", 8192, 2e-9, 0.0, -4.6, 1.88),
    "rigol_DS1054Z-A.csv": ("rigol", "CH1 CH2 CH3 CH4", 1200, 5e-10, -3e-7, 2.0, 4.08),
    "rigol_DS1074Z-A.csv": ("rigol", "CH1 CH2 CH3", 1200, 2e-5, -2e-3, -0.054, 0.1),
    "rigol_DS1102D-A.csv": ("rigol", "CH 1|CH 2", 1024, 1.0009775e-5, -4.688e-3, 0.16, 8.08),
    "rigol_DS1204B-F.csv": ("rigol", "CH2 CH4", 8192, 4e-6, -1.6384e-2, -15.6, 20.8),
    "rigol_DS2072A-5.csv": ("rigol", "CH1 CH2", 1400, 1e-8, -2.52e-6, -0.002, 0.302),
    "rohdeschwarz_rtp_02.Wfm.csv": ("rohde-schwarz", "CH1 CH2", 4000, None, None, -0.063241109, 1.0750989),
    "tek_DPO7000_hopkinson_Ch1_head.csv": (
        "tektronix", "CH1", 5200, 8e-9, -8e-5, -0.0509375002, 0.0275000009),
    "tek_MSO2014_head.csv": ("tektronix", "CH1|CH1 Peak Detect", 4984, 1.6e-6, -0.1, -0.18, 0.68),
    "tek_MSO64_analog_head.csv": ("tektronix", "REF7", 3986, 4e-11, -9.99966406e-7, -0.152, -0.128),
}  # fmt: skip
FILES = sorted(p.name for p in CORPUS.glob("*") if p.suffix in (".csv", ".lvm")) if CORPUS.is_dir() else []
present = pytest.mark.skipif(not CORPUS.is_dir(), reason=f"{CORPUS}: no such folder of real files")


@present
def test_the_folder_holds_every_file_of_known_numbers():
    assert set(KNOWN) <= set(FILES)


@present
@pytest.mark.parametrize("name", FILES)
def test_every_real_file_is_read(name):
    channels = read(CORPUS / name).channels
    assert all(c.samples >= 3 and np.isfinite(c.values).all() for c in channels)


@present
@pytest.mark.parametrize("name", KNOWN)
def test_real_files_hold_what_is_seen_in_them(name):
    layout, names, samples, interval, start, low, high = KNOWN[name]
    recording = read(CORPUS / name)
    first = recording.channels[0]
    assert recording.layout == layout
    assert [c.name for c in recording.channels] == (
        names.split("|") if "|" in names or "(" in names else names.split()
    )
    assert (first.samples, first.start_s) == (samples, start)
    assert first.interval_s == (interval if interval is None else pytest.approx(interval, rel=1e-6))
    assert (first.values.min(), first.values.max()) == pytest.approx((low, high), rel=1e-12)
