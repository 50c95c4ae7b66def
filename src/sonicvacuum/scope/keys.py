"""What the rows above (or beside) the samples say: keys and values, whatever marks stand between them."""

import re
from dataclasses import dataclass, field
from itertools import pairwise, takewhile, zip_longest

from sonicvacuum.scope.dialect import Dialect
from sonicvacuum.scope.units import quantity, unit_of

# Meaning → the keys that recorders write for it, in lower case without marks and blanks.
MEANINGS = {
    "interval": {"sampleinterval", "samplinginterval", "sampleperiod", "samplingperiod", "increment", "xinc",
                 "xincrement", "xincr", "deltax", "dx", "dt", "deltat", "hresolution", "horizontalresolution",
                 "resolution", "timestep", "tinc", "timeincrement", "timeinterval", "sampletime", "interval",
                 "horizinterval", "horizontalinterval", "horinterval", "abtastintervall", "timeresolution",
                 "timepersample", "timebaseinterval", "clock", "signalresolution", "xaxisdelta", "xaxisstep",
                 "xdelta", "tsample", "tinterval"},
    "rate": {"samplerate", "samplingrate", "samplefrequency", "samplingfrequency", "sampfreq", "fs", "rate",
             "abtastrate", "samplespersecond", "samplingclock", "abtastfrequenz", "acquisitionrate",
             "sampleratehz", "scanrate", "sampling"},
    "start": {"start", "x0", "xorg", "xorigin", "xorigine", "xstart", "xzero", "hoffset", "t0", "starttime",
              "timeoffirstpoint", "firstsampletime", "horizoffset", "signalxstart",
              "firstpointtime", "xoffset", "xaxisstart", "tstart"},
    "stop": {"xstop", "stoptime", "signalxstop"},
    "trigger": {"triggerpoint", "triggeraddress", "zeroindex", "triggersample", "pretriggersamples",
                "triggerposition", "triggerindex", "pretrigger"},
    "count": {"recordlength", "samples", "points", "numberofdatapoints", "memorylength", "blocksize", "size",
              "numberofsamples", "numberofpoints", "datapoints", "segmentsize", "signalrecordlength"},
    "unit": {"verticalunits", "verticalunit", "vunit", "yunitlabel", "yunits", "yunit", "units", "unit",
             "verticalunitlabel", "einheit", "dataunits", "unitname", "unitnames", "channelunits",
             "yaxisunit", "yaxisunits"},
    "time unit": {"horizontalunits", "horizontalunit", "hunit", "xunits", "xunit", "timeunits", "timeunit",
                  "xunitlabel", "xaxisunit", "xaxisunits"},
    "name": {"source", "tracename", "channeldata", "channel", "channels", "trace", "channelname",
             "channelnames", "channeltitle", "labels", "waveformsource", "kanal", "ch", "multichannelsource"},
    "format": {"ptfmt", "ptformat", "pointformat"},
    "scale": {"verticalscale", "voltsdiv", "voltdiv", "vscale"},
    "factor": {"scalefactor", "scalingfactor", "multiplier", "calibrationfactor", "conversionfactor", "gain",
               "sensitivity", "factor", "faktor", "kalibrierfaktor", "skalierungsfaktor"},
}  # fmt: skip
# Rows above samples that only say where these begin.
MARKER = re.compile(r"\W*((waveform|measured|raw) )?(data|values|daten|messwerte)\W*|\*+end.*", re.IGNORECASE)
# Keys that mean other things too; another key of the same meaning overrules them.
_VAGUE = {"start", "interval", "samples", "points", "size", "units", "unit", "labels", "channel", "channels",
          "ch", "resolution", "clock", "sampling", "rate", "dx", "t0", "starttime"}  # fmt: skip
# A key and its value in one cell.
_INLINE = re.compile(r"([A-Za-z][\w ]*?(?:\s*[(\[][^()\[\]]*[)\]])?)\s*[:=]\s*(.+)$")
# A number with a decimal comma, which none of thousands can be.
_DECIMAL = re.compile(r"[-+]?(?:\d+,(?:\d+[eE]|\d{1,2}(?!\d)|\d{4})|(?:0|\d{4,}),\d)")
# Meaning → base unit of the number that its value must be; anything else says nothing of it.
_BASE = {"interval": "s", "rate": "Hz", "start": "s", "stop": "s", "trigger": "", "count": "", "scale": "V"}
# A resolution of whole seconds is one of bits.
_BITS = "resolution"
_MEANING = {key: meaning for meaning, keys in MEANINGS.items() for key in keys}


@dataclass
class Keys:
    """Keys of a header by meaning.

    Attributes:
        values: meaning → values as written, one per channel or one for all.
        rows: meaning → the row of cells they stand in, which may be aligned with the columns below.
        vague: meanings that were taken from a key which may mean something else.
        units: meaning → unit written beside the key, as in `Time Scale (s/DIV) =`.
        odd: meaning → key and value as written where the value is no number of it.
        decimal: mark in numbers.
        channels: number of channels, as many as a row of values may have.
        width: cells in a row of samples, 0 where there are none.
    """

    decimal: str
    channels: int = 1
    values: dict[str, list[str]] = field(default_factory=dict)
    rows: dict[str, list[str]] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    vague: set[str] = field(default_factory=set)
    odd: dict[str, tuple[str, str]] = field(default_factory=dict)
    width: int = 0

    def text(self, meaning: str, place: int, column: int) -> str:
        """What is said of one channel: at its place, else in its column, else the one value for all."""
        row, found = self.rows.get(meaning, []), self.texts(meaning)
        if len(found) == 1 and (not row or row[1].strip()):
            return found[0]
        if not row:
            return found[place] if place < len(found) else ""
        # More values than channels stand in the columns of the samples, those of times among them. The key
        # itself takes the first cell, so channels that begin there are one cell further on.
        at = column if len(row) - 1 > self.channels and column > place else place + 1
        if meaning == "unit" and len(row) == self.width + 1 and _of_time(row[1]):
            # The key stands before the table, and the first of the units is that of its times.
            at = column + 1
        return row[at].strip() if at < len(row) else ""

    def number(self, meaning: str, base: str, place: int = 0, column: int = 0) -> float | None:
        """One channel's number as a multiple of a base unit, which is assumed where none is written."""
        text = self.text(meaning, place, column) or next(iter(self.texts(meaning)), "")
        return _number(text, base, self.units.get(meaning, ""), self.decimal)

    def bare(self, meaning: str) -> bool:
        """Whether a number stands there without any unit of its own."""
        got = [quantity(t, self.decimal) or quantity(t) for t in self.texts(meaning)[:1]]
        return not self.units.get(meaning) and any(q and q[1] is None for q in got)

    def texts(self, meaning: str) -> list[str]:
        """Values of a meaning that are not empty."""
        return [v for v in self.values.get(meaning, []) if v.strip()]

    def add(self, key: str, values: list[str], row: list[str]) -> None:
        """Take one key up; the first of a meaning that says something counts, a plain one before a vague."""
        name, unit = _name(key)
        meaning = _MEANING.get(name)
        parted = [w for v in values for w in _parted(v) if w]
        if not meaning or not parted:
            return
        if meaning in _BASE:
            parted, row = self._numbers(parted, _BASE[meaning], unit, row)
        if meaning in _BASE and not self._tells(name, parted, unit):
            self.odd.setdefault(meaning, (key.strip(), parted[0]))
            return
        better = meaning in self.vague and name not in _VAGUE
        if better or not self.values.get(meaning):
            (self.vague.add if name in _VAGUE else self.vague.discard)(meaning)
            self.values[meaning] = parted
            # Values that name their channels, as CH1:V, are in the order of these.
            plain = parted == [v.strip().strip('"').strip() for v in values if v.strip().strip('"').strip()]
            self.rows[meaning] = row if row[1:] == values and plain else []
            self.units[meaning] = unit

    def _numbers(self, values, base, unit, row):
        """The values of a key of numbers and their row, without the keys and words that follow the first."""
        first = quantity(values[0], self.decimal)
        if len(values) > 1 and first and first[1] is None and unit_of(values[1]):
            # A number and its unit in cells of their own.
            return [" ".join(values[:2])], []
        alike = all(_number(v, base, unit, self.decimal) is not None for v in values)
        return (values, row) if alike else (values[:1], [])

    def _tells(self, name, values, unit):
        """Whether the first value of a key is a number of what the key means."""
        base = _BASE[_MEANING[name]]
        if name == _BITS and not unit and values[0].strip().isdigit():
            return False
        return _number(values[0], base, unit, self.decimal) is not None

    def beside(self, other: "Keys") -> "Keys":
        """These keys, and those of another header where these are silent."""
        mine = {m for m, v in self.values.items() if v}
        merged = [
            {k: v for k, v in theirs.items() if k not in mine} | {k: v for k, v in own.items() if k in mine}
            for own, theirs in (
                (self.values, other.values),
                (self.rows, other.rows),
                (self.units, other.units),
            )
        ]
        vague = {m for m in self.vague if m in mine} | (other.vague - mine)
        return Keys(self.decimal, self.channels, *merged, vague, other.odd | self.odd, self.width)


def _of_time(text):
    unit = unit_of(text)
    return unit is not None and unit.base == "s"


def _number(text, base, unit, decimal):
    got = quantity(text, decimal) or quantity(text)
    if got is None and _DECIMAL.match(text.strip()):
        got = quantity(text, ",")
    if got is None and base == "Hz":
        # A bare prefix, as in 500k, counts samples in a second.
        got = quantity(text.strip() + "Hz", decimal)
    if got is None:
        return None
    found = got[1] or unit_of(unit)
    if found is not None and found.base != base:
        return None
    return got[0] * (found.factor if found else 1.0)


def meaning(text: str) -> str | None:
    """What a cell means as a key, None where it is none."""
    return _MEANING.get(_name(text)[0])


def is_key(text: str) -> bool:
    """Whether a cell is a key that says something of the samples."""
    return meaning(text) is not None


def keyed(line: str) -> list[str] | None:
    """A line of words parted by blanks as key and number, `fs 500 kHz`; None where it is none."""
    words = line.strip().lstrip("#%*\"' ").split()
    for k in range(min(4, len(words) - 1), 0, -1):
        # `Channel 1` is a name.
        if meaning(" ".join(words[:k])) in _BASE and re.match(r"[-+.\d]", words[k]):
            return [" ".join(words[:k]), " ".join(words[k:])]
    return None


def read(rows: list[list[str]], dialect: Dialect, channels: int = 1, width: int = 0) -> Keys:
    """Keys of rows of cells, above so many channels and rows of samples of so many cells."""
    keys = Keys(dialect.decimal, channels, width=width)
    rows = [_whole(row) for row in rows]
    for row, below in zip_longest(rows, rows[1:], fillvalue=()):
        alone = [c for c in row if c.strip()]
        if len(alone) == 1 and alone[0].rstrip().endswith(":") and is_key(alone[0]) and not _is_header(below):
            # A heading, whose values stand in the next line.
            keys.add(alone[0], list(below), [alone[0], *below])
            continue
        for key, values in _pairs(row):
            keys.add(key, values, row)
    return keys


def _whole(row):
    """A row without empty cells at its end, which would keep values from their columns."""
    return row[: max((k for k, c in enumerate(row, 1) if c.strip()), default=0)]


def _is_header(row):
    return any(c.rstrip().endswith(":") for c in row)


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
        # Groups of three digits behind a comma that a comma cuts, as in 500,000.
        thousands = re.fullmatch(r"[1-9]\d{0,2}", found.group(2)) and cells[1:]
        if thousands and all(re.fullmatch(r"\d{3}", c) for c in cells[1:]) and cells[1][0] == "0":
            yield found.group(1), ["".join([found.group(2), *cells[1:]])]
        elif re.fullmatch(r"[-+]?\d+", found.group(2)) and _decimals(found.group(2), cells[1:]):
            # A decimal comma that cuts a number, as in 1,5 us; 1,000 kHz may be one of thousands.
            mark = "," if re.match(r"\d{3}\D", cells[1]) else "."
            yield found.group(1), [f"{found.group(2)}{mark}{cells[1]}"]
        else:
            # Values of other channels may follow, and so may other keys with their own.
            value = found.group(2).rstrip(":")
            yield found.group(1), [value, *takewhile(lambda cell: _is_value(cell, value), cells[1:])]
    else:
        yield first, [c for c in cells[1:] if c != cells[0]]
    for key, value in pairwise(cells[1:]):
        if _name(key)[0] in _MEANING and re.search(r"[A-Za-z]", key) and key != cells[0]:
            yield key, [value]
    for cell in cells[1:]:
        inline = _INLINE.match(cell)
        if inline:
            yield inline.group(1), [inline.group(2)]


def _is_value(cell, first):
    """Whether a cell behind a value is one more, maybe behind its channel's name, and no key with its own."""
    inline = _INLINE.match(cell)
    return not inline or bool(_INLINE.match(first) and not is_key(inline.group(1)))


def _decimals(whole, cells):
    """Whether a cell, with which the row ends or behind which another key follows, is decimals: behind 0, or
    with their exponent or unit.
    """
    found = re.fullmatch(r"\d+([eE][-+]?\d+)?\s*(\D*)", cells[0]) if cells else None
    if not found or (len(cells) > 1 and not _INLINE.match(cells[1])):
        return False
    zero = whole.strip("+-") == "0"
    return bool(unit_of(found.group(2)) or (not found.group(2) and (found.group(1) or zero)))


def _parted(value):
    """`CH1:V CH2:V` and `Analog:14000` without what stands before the colon."""
    value = value.strip().strip('"').strip()
    parts = re.findall(r"[A-Za-z]\w*\s*:\s*([^\s:]+)", value)
    if parts and re.fullmatch(r"([A-Za-z]\w*\s*:\s*[^\s:]+[\s;]*)+", value):
        return parts
    return [value]
