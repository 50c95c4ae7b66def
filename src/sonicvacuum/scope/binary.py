"""Binary files of recorders through two well-kept libraries: npTDMS for .tdms, RigolWFM for all others.

Both are in the optional extra `scope`. Nothing is ever unpickled or evaluated.
"""

from pathlib import Path

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.scope.recording import Channel, Recording
from sonicvacuum.scope.roles import unique
from sonicvacuum.scope.timebase import tidy
from sonicvacuum.scope.units import unit_of

_WAVEFORMS = (".wfm", ".trc", ".isf", ".bin", ".wvf", ".hdr")
# Relative rounding error of a four-byte number, doubled.
FLOAT_ERROR = 1.2e-7
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
    try:
        with TdmsFile.open(path) as file:
            channels = [(g.name, c, c[:]) for g in file.groups() for c in g.channels() if len(c)]
    except Exception as error:
        raise InputError(f"{path}: not a sound .tdms file: {error}; export it again") from None
    numeric = [
        (g, c, np.asarray(v, dtype=float)) for g, c, v in channels if np.asarray(v).dtype.kind in "iufb"
    ]
    if not numeric:
        raise InputError(f"{path}: holds no channel of numbers; export the traces again")
    return Recording(path, "tdms", tuple(_timed(numeric)))


def _timed(numeric):
    """Channels of a TDMS file, with a time channel of the same group and length where there is one."""
    names = unique([c.name for _, c, _ in numeric])
    times = {(g, len(v)): v for g, c, v in numeric if _is_time(c)}
    for name, (group, channel, values) in zip(names, numeric, strict=True):
        if _is_time(channel):
            continue
        properties, notes = channel.properties, []
        said = str(properties.get("unit_string") or properties.get("NI_UnitDescription") or "")
        unit = unit_of(said)
        if not unit:
            notes.append(
                f"The unit {said} is not known; numbers are as written." if said else "No unit given."
            )
        interval = properties.get("wf_increment")
        start = float(properties.get("wf_start_offset") or 0.0) if interval else None
        clock = times.get((group, len(values)))
        if not interval and clock is not None and len(clock) > 1:
            start, interval = float(clock[0]), tidy(float(clock[-1] - clock[0]) / (len(clock) - 1))
            notes.append("Times are those of the channel of times in the group, in s.")
        if not interval:
            notes.append("No time: the file has no wf_increment; give --interval.")
        values = values * (unit.factor if unit else 1.0)
        base = unit.base if unit else said
        yield Channel(name, base, values, start, float(interval) if interval else None, tuple(notes))


def _is_time(channel):
    return channel.name.strip().lower() in ("time", "zeit", "t", "time (s)", "time [s]", "times")


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
    for channel in waveform.channels:
        if channel.volts is None or channel.times is None or not len(channel.volts):
            continue
        times = np.asarray(channel.times, dtype=float)
        count = len(times)
        interval = _interval(times, channel.seconds_per_point) if count > 1 else None
        name = channel.name.replace(" ", "")
        unit = {"v": "V", "a": "A", "w": "W"}.get(getattr(channel.unit, "name", ""), "V")
        values, shots = np.asarray(channel.volts, dtype=float), _shots(path)
        if count % shots:
            shots = 1
        for k, part in enumerate(values.reshape(shots, -1)):
            yield Channel(name, unit, part, tidy(float(times[0])), interval, (), k + 1)


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
