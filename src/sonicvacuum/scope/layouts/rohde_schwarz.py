"""Rohde & Schwarz scopes: RTB and HMO with `in s,CH1 in V`; RTO and RTP with values only.

The time base of the latter stands in a second file: `run.csv` (keys and values parted by colons) or the XML
text `run.bin` or `run.xml` beside the samples `run.Wfm.csv`.
"""

import re
from pathlib import Path

from sonicvacuum.files import InputError
from sonicvacuum.scope import text
from sonicvacuum.scope.layouts.base import Layout

_KEYS = ("Resolution", "XStart", "XStop", "RecordLength", "SignalRecordLength", "SignalResolution")


def _companion(path: Path) -> list[str]:
    """Lines `key,value` of the file that goes with a file of values, none where there is none."""
    stem = re.sub(r"\.wfm\.csv$", "", path.name, flags=re.IGNORECASE)
    if stem == path.name:
        return []
    for suffix in (".csv", ".CSV", ".bin", ".xml"):
        other = path.with_name(stem + suffix)
        if not other.is_file():
            continue
        try:
            content, _ = text.read(other)
        except InputError:
            continue
        marked = re.findall(r'Name="(\w+)"[^>]*? Value="([^"]*)"', content)
        return [f"{k},{v}" for k, v in marked if k in _KEYS] or _plain(content)
    return []


def _plain(content):
    """`Key:value:unit` of the CSV form."""
    lines = [line.split(":") for line in content.split("\n")[:400]]
    return [f"{cells[0]},{cells[1]}" for cells in lines if len(cells) > 1 and cells[1].strip()]


LAYOUT = Layout(
    "rohde-schwarz",
    r"^\W*in s[,;]|^\W*(in s|TIME)\W+(CH?\d in V)|HMO\d|Rohde|RTB2|RTM2",
    path=r"\.wfm\.csv$",
    companion=_companion,
)
