"""What the rows above (or beside) the samples say: keys and values, whatever marks stand between them."""

import re
from dataclasses import dataclass, field
from itertools import pairwise

from sonicvacuum.scope.dialect import Dialect
from sonicvacuum.scope.units import quantity, unit_of

# Meaning → the keys that recorders write for it, in lower case without marks and blanks.
MEANINGS = {
    "interval": {"sampleinterval", "samplinginterval", "sampleperiod", "samplingperiod", "increment", "xinc",
                 "xincrement", "xincr", "deltax", "dx", "dt", "deltat", "hresolution", "horizontalresolution",
                 "resolution", "timestep", "tinc", "timeincrement", "timeinterval", "sampletime", "interval",
                 "horizinterval", "horizontalinterval", "horinterval", "abtastintervall", "timeresolution",
                 "timepersample", "timebaseinterval", "clock", "signalresolution"},
    "rate": {"samplerate", "samplingrate", "samplefrequency", "samplingfrequency", "sampfreq", "fs", "rate",
             "abtastrate", "samplespersecond", "samplingclock", "abtastfrequenz", "acquisitionrate",
             "sampleratehz", "scanrate", "sampling"},
    "start": {"start", "x0", "xorg", "xorigin", "xorigine", "xstart", "xzero", "hoffset", "t0", "starttime",
              "timeoffirstpoint", "firstsampletime", "horizoffset", "signalxstart",
              "firstpointtime", "xoffset"},
    "stop": {"xstop", "stoptime", "signalxstop"},
    "trigger": {"triggerpoint", "triggeraddress", "zeroindex", "triggersample", "pretriggersamples",
                "triggerposition", "triggerindex", "pretrigger"},
    "count": {"recordlength", "samples", "points", "numberofdatapoints", "memorylength", "blocksize", "size",
              "numberofsamples", "numberofpoints", "datapoints", "segmentsize", "signalrecordlength"},
    "unit": {"verticalunits", "verticalunit", "vunit", "yunitlabel", "yunits", "yunit", "units", "unit",
             "verticalunitlabel", "einheit", "dataunits"},
    "time unit": {"horizontalunits", "horizontalunit", "hunit", "xunits", "xunit", "timeunits", "timeunit"},
    "name": {"source", "tracename", "channeldata", "channel", "channels", "trace", "channelname",
             "channelnames", "labels", "waveformsource", "kanal", "ch", "multichannelsource"},
    "scale": {"verticalscale", "voltsdiv", "voltdiv", "vscale"},
}  # fmt: skip
# Keys that mean other things too; another key of the same meaning overrules them.
_VAGUE = {
    "start",
    "interval",
    "samples",
    "points",
    "size",
    "units",
    "unit",
    "labels",
    "channel",
    "channels",
    "ch",
}
_MEANING = {key: meaning for meaning, keys in MEANINGS.items() for key in keys}


@dataclass
class Keys:
    """Keys of a header by meaning.

    Attributes:
        values: meaning → values as written, one per channel or one for all.
        rows: meaning → the row of cells they stand in, which may be aligned with the columns below.
        vague: meanings that were taken from a key which may mean something else.
        units: meaning → unit written beside the key, as in `Time Scale (s/DIV) =`.
        decimal: mark in numbers.
    """

    decimal: str
    values: dict[str, list[str]] = field(default_factory=dict)
    rows: dict[str, list[str]] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    vague: set[str] = field(default_factory=set)

    def text(self, meaning: str, place: int, column: int) -> str:
        """What is said of one channel: in its column, else at its place, else the one value for all."""
        row, found = self.rows.get(meaning, []), self.texts(meaning)
        if column < len(row) and row[column].strip() and len(row) > 2:
            return row[column].strip()
        return found[place] if place < len(found) else found[0] if len(found) == 1 else ""

    def number(self, meaning: str, base: str, place: int = 0, column: int = 0) -> float | None:
        """One channel's number as a multiple of a base unit, which is assumed where none is written."""
        text = self.text(meaning, place, column) or next(iter(self.texts(meaning)), "")
        got = quantity(text, self.decimal) or quantity(text)
        if got is None:
            return None
        unit = got[1] or unit_of(self.units.get(meaning, ""))
        if unit is not None and unit.base != base:
            return None
        return got[0] * (unit.factor if unit else 1.0)

    def texts(self, meaning: str) -> list[str]:
        """Values of a meaning that are not empty."""
        return [v for v in self.values.get(meaning, []) if v.strip()]

    def add(self, key: str, values: list[str], row: list[str]) -> None:
        """Take one key up; the first of a meaning that says something counts."""
        name, unit = _name(key)
        meaning = _MEANING.get(name)
        parted = [w for v in values for w in _parted(v) if w]
        better = meaning in self.vague and name not in _VAGUE
        if meaning and parted and (better or not self.values.get(meaning)):
            (self.vague.add if name in _VAGUE else self.vague.discard)(meaning)
            self.values[meaning] = parted
            self.rows[meaning] = row if row[1:] == values and len(parted) <= len(values) else []
            self.units[meaning] = unit


def read(rows: list[list[str]], dialect: Dialect) -> Keys:
    """Keys of rows of cells."""
    keys = Keys(dialect.decimal)
    for row in rows:
        for key, values in _pairs(row):
            keys.add(key, values, row)
    return keys


def _name(key):
    """A key's letters and digits in lower case, and the unit in brackets behind it."""
    unit = re.search(r"[\[(]([^\])]*)[\])]", key)
    bare = re.sub(r"[\[(][^\])]*[\])]", "", key)
    return re.sub(r"[^a-z0-9]", "", bare.lower()), unit.group(1) if unit else ""


def _pairs(row):
    """Pairs of key and values in one row: `key,value…`, `key: value`, `# key = value`, several in a row."""
    cells = [c.strip() for c in row]
    while cells and not cells[-1]:
        cells.pop()
    if not cells:
        return
    first = cells[0].lstrip("#%*\"' ")
    found = re.match(r"([^:=]*?)\s*[:=]+\s*(.*)$", first)
    if found and found.group(1):
        yield found.group(1), [found.group(2).rstrip(":"), *cells[1:]]
    else:
        yield first, [c for c in cells[1:] if c != cells[0]]
    for key, value in pairwise(cells[1:]):
        if _name(key)[0] in _MEANING and re.search(r"[A-Za-z]", key) and key != cells[0]:
            yield key, [value]
    for cell in cells[1:]:
        inline = re.match(r"([A-Za-z][\w ]*?)\s*[:=]\s*(.+)$", cell)
        if inline:
            yield inline.group(1), [inline.group(2)]


def _parted(value):
    """`CH1:V CH2:V` and `Analog:14000` without what stands before the colon."""
    value = value.strip().strip('"').strip()
    parts = re.findall(r"[A-Za-z]\w*\s*:\s*([^\s:]+)", value)
    if parts and re.fullmatch(r"([A-Za-z]\w*\s*:\s*[^\s:]+[\s;]*)+", value):
        return parts
    return [value]
