"""Binary files of recorders through two well-kept libraries: npTDMS for .tdms, RigolWFM for all others.

Both are in the optional extra `scope`. Nothing is ever unpickled or evaluated.
"""

import re
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.scope.keys import Keys
from sonicvacuum.scope.labels import split_unit
from sonicvacuum.scope.recording import Channel, Recording
from sonicvacuum.scope.roles import unique
from sonicvacuum.scope.timebase import TimeBase, from_column, tidy
from sonicvacuum.scope.units import Unit, unit_of

_WAVEFORMS = (".wfm", ".trc", ".isf", ".bin", ".wvf", ".hdr")
# Relative rounding error of a four-byte number, doubled.
FLOAT_ERROR = 1.2e-7
# Said of what peak detection leaves, of which the library makes means or a zigzag.
ENVELOPE = "The file holds an envelope (peak detect), not samples: save the trace again in sample mode."
CURE = "python -m pip install 'sonicvacuum[scope]'"


def is_binary(path: Path) -> bool:
    """Whether a file is for one of the two libraries, by its beginning or its name."""
    with open(path, "rb") as stream:
        head = stream.read(64)
    if path.suffix.lower() == ".tdms" or head.startswith((b"TDSm", b"TDSh")):
        return True
    return path.suffix.lower() in _WAVEFORMS or b"WAVEDESC" in head or b":WFM#" in head


def read_binary(path: Path) -> Recording:
    """Channels of a binary file; InputError where the library is missing or cannot read it."""
    return _tdms(path) if _is_tdms(path) else _waveform(path)


def _is_tdms(path):
    with open(path, "rb") as stream:
        return path.suffix.lower() == ".tdms" or stream.read(4) in (b"TDSm", b"TDSh")


def _missing(path, package):
    return InputError(f"{path}: reading this kind of file needs {package}; install it: {CURE}")


def _tdms(path):
    try:
        from nptdms import TdmsFile
    except ImportError:
        raise _missing(path, "npTDMS") from None
    with _warnings() as told:
        try:
            with TdmsFile.open(path) as file:
                channels = [(g.name, c, c[:]) for g in file.groups() for c in g.channels() if len(c)]
        except Exception as error:
            raise InputError(f"{path}: not a sound .tdms file: {error}; export it again") from None
    numeric = [
        (g, c, np.asarray(v, dtype=float)) for g, c, v in channels if np.asarray(v).dtype.kind in "iufb"
    ]
    if not numeric:
        why = f" ({'; '.join(told)})" if told else ""
        raise InputError(f"{path}: holds no channel of numbers{why}; export the traces again")
    return Recording(path, "tdms", tuple(_timed(numeric)), tuple(f"npTDMS: {one}" for one in told))


@contextmanager
def _warnings():
    """What npTDMS finds odd in a file that it reads, a list; it would go to the terminal, whoever reads."""
    from nptdms.log import log_manager

    told: list[str] = []

    def keep(record):
        told.append(record.getMessage())
        return False

    log_manager.console_handler.addFilter(keep)
    try:
        yield told
    finally:
        log_manager.console_handler.removeFilter(keep)


def _timed(numeric):
    """Channels of a TDMS file, with a time channel of the same group and length where there is one."""
    labels = [(c.name, None) if _said(c) else split_unit(c.name) for _, c, _ in numeric]
    names = unique([name for name, _ in labels])
    times = {(g, len(v)): (c, v) for g, c, v in numeric if _is_time(c)}
    for name, (_, labelled), (group, channel, values) in zip(names, labels, numeric, strict=True):
        if _is_time(channel):
            continue
        said, unit, notes = _said(channel), unit_of(_said(channel)) or labelled, []
        if not unit:
            notes.append(
                f"The unit {said} is not known; numbers are as written." if said else "No unit given."
            )
        base = _stated(channel.properties)
        if base is None and (group, len(values)) in times:
            clock, column = times[group, len(values)]
            base = from_column(column, split_unit(clock.name)[1] or unit_of(_said(clock)), Keys("."))
            notes.append("Times are those of the channel of times in the group.")
        base = base or TimeBase(None, None, ("No time: the file has no wf_increment; give --interval.",))
        values = values * (unit.factor if unit else 1.0)
        notes = (*notes, *base.notes)
        yield Channel(
            name, unit.base if unit else said, values, base.start_s, base.interval_s, notes, 1, base.times_s
        )


def _said(channel):
    """The unit of a channel as written."""
    return str(channel.properties.get("unit_string") or channel.properties.get("NI_UnitDescription") or "")


def _stated(properties) -> TimeBase | None:
    """The time base of a waveform's properties, None where they have none."""
    interval, said = properties.get("wf_increment"), str(properties.get("wf_xunit_string") or "s")
    if not interval:
        return None
    unit = unit_of(said)
    if not unit or unit.base != "s":
        return TimeBase(None, None, (f"No time: wf_xunit_string is {said!r}; give --interval.",))
    if not float(interval) > 0.0:
        return TimeBase(None, None, (f"No time: wf_increment is {interval:g}; give --interval.",))
    start = float(properties.get("wf_start_offset") or 0.0)
    return TimeBase(_scaled(start, unit.factor), _scaled(float(interval), unit.factor))


def _scaled(number, factor):
    return number if factor == 1.0 else tidy(number * factor)


def _is_time(channel):
    name, unit = split_unit(channel.name)
    return name.lower() in ("time", "zeit", "t", "times") and (unit is None or unit.base == "s")


def _waveform(path):
    try:
        from RigolWFM import Wfm
    except ImportError:
        raise _missing(path, "RigolWFM") from None
    try:
        waveform = Wfm.from_file(str(path))
    except Exception as error:
        told = " ".join(str(error).split()) or type(error).__name__
        raise InputError(f"{path}: no waveform file that RigolWFM reads: {told}; export it as CSV") from None
    channels = tuple(_waveform_channels(waveform, path))
    if not channels:
        raise InputError(f"{path}: holds no channel that was switched on; export the traces again")
    return Recording(path, path.suffix.lower().lstrip(".") or "waveform", channels)


def _waveform_channels(waveform, path):
    upright, across, announced = _written(path)
    for channel in waveform.channels:
        if channel.volts is None or channel.times is None or not len(channel.volts):
            continue
        times = np.asarray(channel.times, dtype=float)
        count = len(times)
        interval = _interval(times, channel.seconds_per_point) if count > 1 else None
        start, notes = tidy(float(times[0])), []
        name = channel.name.replace(" ", "")
        unit = {"v": "V", "a": "A", "w": "W"}.get(getattr(channel.unit, "name", ""), "V")
        values = np.asarray(channel.volts, dtype=float)
        if upright:
            # The library writes V for any unit; numbers are as the file has them.
            known = unit_of(upright) or Unit(upright)
            unit, values = known.base, values * known.factor
        if across and not ((known := unit_of(across)) and known.base == "s"):
            start, interval = None, None
            notes.append(f"No time: the unit across is {across!r}; export the trace over time.")
        if announced < 0:
            notes.append(ENVELOPE)
        if announced > count:
            notes.append(f"The header announces {announced} samples, the file holds {count}.")
        shots = _shots(path)
        if count % shots:
            shots = 1
        for k, part in enumerate(values.reshape(shots, -1)):
            yield Channel(name, unit, part, start, interval, tuple(notes), k + 1)


def _written(path):
    """Units upright and across and the number of samples as the file writes them, "" and 0 where silent.

    The number is -1 where there are no samples, but the least and the most of each stretch.

    Places 196 and 244 of LeCroy's template LECROY_2_3, 188 and 508 of Tektronix' WFM#002 and #003 (manual
    077-0220), the words YUNIT, XUNIT and NR_PT, or their beginnings, of an .isf.
    """
    with open(path, "rb") as stream:
        head = stream.read(8192)
    if (begin := head.find(b"WAVEDESC")) >= 0:
        sure = b"LECROY_2_3" in head[begin : begin + 40]
        return (*(_text(head[begin + k : begin + k + 48]) for k in (196, 244)), 0) if sure else ("", "", 0)
    if head[2:10] in (b":WFM#002", b":WFM#003"):
        return *(_text(head[k : k + 20]) for k in (188, 508)), 0
    preamble = head.split(b":CURV")[0].decode("latin-1") if b":CURV" in head else ""
    units = [re.search(rf'\b{k}UN(?:IT)?\s+"([^"]*)"', preamble) for k in "YX"]
    count = re.search(r"\bNR_PT?\s+(\d+)", preamble)
    kept = re.search(r"\bPT_F(?:MT)?\s+(Y|ENV)", preamble)
    told = [u.group(1).strip() if u else "" for u in units]
    if kept and kept.group(1) == "ENV":
        return *told, -1
    return *told, int(count.group(1)) if count and kept else 0


def _text(data):
    text = data.split(b"\0")[0].decode("latin-1").strip()
    return text if text.isprintable() else ""


def _interval(times, stated):
    """Interval of the times; that of the file where they were stretched to include the end of the record."""
    interval = float(times[-1] - times[0]) / (len(times) - 1)
    if stated and abs(interval / stated - 1.0) < 1.5 / (len(times) - 1):
        interval = float(stated)
    # Many files hold four-byte numbers: the shortest text of one is what the recorder meant.
    short = float(str(np.float32(interval)))
    return short if abs(short / interval - 1.0) < FLOAT_ERROR else tidy(interval)


def _shots(path):
    """Number of shots that a LeCroy file holds one after the other: SUBARRAY_COUNT of its WAVEDESC.

    Place 144 of template LECROY_2_3 (LeCroy, MAUI Automation Manual); COMM_ORDER at 34 is 1 for the low byte
    first.
    """
    with open(path, "rb") as stream:
        head = stream.read(4096)
    begin = head.find(b"WAVEDESC")
    if begin < 0 or len(head) < begin + 148:
        return 1
    order = "little" if head[begin + 34] == 1 else "big"
    return max(1, int.from_bytes(head[begin + 144 : begin + 148], order, signed=True))
