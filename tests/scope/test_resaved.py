"""Files that a spreadsheet has written again: other marks between cells, decimal commas, quotes."""

import re

import numpy as np
import pytest
from odd_files import PULSE, TIMES, recording, rows

COUNTS = np.round(PULSE * 125.0)
# Counts of a GW Instek scope at 0.2 V to a division of 25, and times of a Tektronix scope.
INSTEK = (
    "Memory Length,200,\nTrigger Level,4.600E-01,\nSource,CH1,\nVertical Units,V,\n"
    "Vertical Scale,2.000E-01,\nHorizontal Units,s,\nSampling Period,1.000E-06,\nWaveform Data,\n"
) + rows(COUNTS, form="{:.0f},")
TEKTRONIX = "TIME,CH1\n" + rows(TIMES, PULSE, form="{:.7f}")


def german(text):
    return re.sub(r"(?<=\d)\.(?=\d)", ",", text.replace(",", ";"))


def quoted(text):
    return "\n".join(",".join(f'"{c}"' if c else c for c in line.split(",")) for line in text.split("\n"))


WAYS = {
    "semicolons": lambda text: text.replace(",", ";"),
    "tabs": lambda text: text.replace(",", "\t"),
    "blanks": lambda text: text.replace(",", " , "),
    "german": german,
    "german, tabs": lambda text: german(text).replace(";", "\t"),
    "quotes": quoted,
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("text", "layout"), [(INSTEK, "gw-instek"), (TEKTRONIX, "tektronix")])
def test_files_written_again_hold_the_same(tmp_path, way, text, layout):
    first, second = recording(tmp_path, text, "a.csv"), recording(tmp_path, WAYS[way](text), "b.csv")
    assert first.layout == second.layout == layout
    for one, other in zip(first.channels, second.channels, strict=True):
        assert (one.name, one.unit, one.interval_s, one.start_s) == (
            other.name, other.unit, other.interval_s, other.start_s
        )  # fmt: skip
        assert np.array_equal(one.values, other.values)
    if layout == "gw-instek":
        assert first.channels[0].values == pytest.approx(COUNTS * 0.2 / 25.0, rel=1e-12)


def test_counts_without_a_scale_are_told(tmp_path):
    (channel,) = recording(tmp_path, INSTEK.replace("Vertical Scale", "Scale of old")).channels
    assert any("may be counts of the converter" in n for n in channel.notes)
    assert np.array_equal(channel.values, COUNTS)
