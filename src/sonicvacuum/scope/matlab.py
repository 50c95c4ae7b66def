"""MATLAB's .mat files, versions 4 to 7: variables by their names and shapes, as columns of a table are read.

Vectors are channels or times by their names (`t`, `time_us`, `F_N`), matrices hold a channel a column,
scalars called as the keys of a header give interval and start (`Tinterval` and `Tstart` of PicoScope, `fs`,
`dt`), and structures are looked into. Objects are left out, and nothing of a file is evaluated.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.scope import keys as header_keys
from sonicvacuum.scope import matfile, roles
from sonicvacuum.scope.dialect import Dialect
from sonicvacuum.scope.labels import TIME, split_unit
from sonicvacuum.scope.recording import Channel, Recording
from sonicvacuum.scope.text import encoding_of
from sonicvacuum.scope.timebase import TimeBase, from_column, from_header
from sonicvacuum.scope.units import Unit

LAYOUT = "matlab"
_HDF5 = b"\x89HDF\r\n\x1a\n"
# Vectors of fewer numbers are settings, not traces.
FEWEST = 8
# Names of times that as often are another quantity: they count where nothing is called plainly.
_VAGUE = ("x", "in")


@dataclass(frozen=True, eq=False)
class _Variable:
    """Numbers of one name: `within` is the structure that holds it, "" for none; `array` (N,) or (N, K)."""

    within: str
    name: str
    array: np.ndarray

    @property
    def label(self) -> str:
        return f"{self.within}.{self.name}" if self.within else self.name


def is_matlab(path: Path) -> bool:
    """Whether a file is MATLAB's, by its beginning, or by its name where it is no text (`save -ascii`)."""
    with open(path, "rb") as stream:
        head = stream.read(4096)
    named = path.suffix.lower() == ".mat" and encoding_of(head) is None
    return named or head.startswith((b"MATLAB 5.0 MAT", b"MATLAB 7.3 MAT"))


def read_matlab(path: Path) -> Recording:
    """Channels of a .mat file.

    Raises:
        InputError: for version 7.3, for a file that is damaged or holds no traces, and where two vectors may
            be the times of the others; it names the variables.
    """
    found = _variables(path)
    plain: list[_Variable] = []
    said: list[str] = []
    for name, value in found.items():
        _unfold("", name, value, plain, said)
    traces = [v for v in plain if len(v.array) >= FEWEST]
    if not traces:
        held = ", ".join([v.label for v in plain] + said) or "no variables"
        raise InputError(f"{path}: no variable is a trace (it holds {held}); save the traces as vectors")
    channels = tuple(_channels(path, traces, _settings(plain)))
    names = roles.unique([c.name for c in channels])
    channels = tuple(replace(c, name=n) for c, n in zip(channels, names, strict=True))
    if not channels:
        raise InputError(f"{path}: has times but no channel beside them; save the traces too")
    return Recording(path, LAYOUT, channels, (f"Left out: {', '.join(said)}.",) if said else ())


def _variables(path):
    with open(path, "rb") as stream:
        head = stream.read(520)
    if head.startswith(b"MATLAB 7.3") or _HDF5 in (head[:8], head[512:]):
        raise InputError(
            f"{path}: a .mat file of version 7.3 (HDF5), which is not read here; save it in MATLAB with "
            "save('name.mat', …, '-v7')"
        )
    try:
        return matfile.read(path.read_bytes())
    except ValueError as error:
        raise InputError(f"{path}: not a sound .mat file: {error}; save it again") from None


def _unfold(within, name, value, plain, said):
    """Numbers of a variable, of its fields where it is a structure; what is neither is told of."""
    label = f"{within}.{name}" if within else name
    if isinstance(value, dict):
        for field, own in value.items():
            _unfold(label, field, own, plain, said)
    elif isinstance(value, matfile.LeftOut):
        said.append(f"{label} ({value.kind})")
    elif value.size:
        plain.append(_Variable(within, name, _upright(value)))


def _upright(array):
    """A vector as (N,), a matrix with its samples downwards, which are more than its channels."""
    if 1 in array.shape:
        return array.ravel()
    return array.T if array.shape[1] > array.shape[0] else array


def _settings(plain):
    """What single numbers say of time, as the rows of a header."""
    rows = [[v.name, f"{v.array[0]:.17g}"] for v in plain if v.array.shape == (1,)]
    return header_keys.read(rows, Dialect(",", "."))


def _channels(path, traces, keys) -> Iterator[Channel]:
    clocks = _clocks(path, traces)
    assumed = _unit_of_recorder(traces, keys)
    for one in traces:
        if any(one is clock for clock in clocks.values()):
            continue
        clock = next((clocks[p] for p in _around(one) if p in clocks), None)
        name, unit = split_unit(one.name)
        name = f"{one.within}.{name}" if one.within else name
        columns = one.array[:, None] if one.array.ndim == 1 else one.array
        base = _base(clock, keys)
        first = 0
        if clock is None and base.interval_s is None and columns.shape[1] > 1 and roles.even(columns[:, 0]):
            base, first = from_column(columns[:, 0], None, keys), 1
        for k in range(first, columns.shape[1]):
            own = name if columns.shape[1] == 1 else f"{name}_{k + 1}"
            yield _channel(own, columns[:, k], unit or assumed, base, unit is None and assumed is not None)


def _around(one):
    """Where the times of a variable may stand: in its structure, in those around that, in none."""
    parts = one.within.split(".") if one.within else []
    return [(".".join(parts[:k]), len(one.array)) for k in range(len(parts), -1, -1)]


def _channel(name, values, unit, base, assumed):
    said = f"No unit given; {unit.base} assumed." if assumed else "No unit given."
    notes = base.notes if unit and not assumed else (*base.notes, said)
    base_unit, factor = (unit.base, unit.factor) if unit else ("", 1.0)
    return Channel(name, base_unit, values * factor, base.start_s, base.interval_s, notes, 1, base.times_s)


def _unit_of_recorder(traces, keys):
    """Volts of what PicoScope writes: Tinterval, Tstart, Length and a vector for each of its inputs."""
    named = keys.rows.get("interval", [""])[0] == "Tinterval"
    return Unit("V") if named and all(len(v.name) == 1 and v.name.isupper() for v in traces) else None


def _clocks(path, traces):
    """(Structure, length) → its times; InputError where two may be."""
    found: dict[tuple[str, int], list[_Variable]] = {}
    for one in traces:
        name, unit = split_unit(one.name)
        told = TIME.fullmatch(name) and (unit is None or unit.base == "s")
        if one.array.ndim == 1 and told and (np.diff(one.array) >= 0.0).mean() > 0.5:
            found.setdefault((one.within, len(one.array)), []).append(one)
    clocks = {}
    for place, those in found.items():
        plain = [v for v in those if v.name.lower() not in _VAGUE] or those
        if len(plain) > 1:
            names = " and ".join(v.label for v in plain)
            raise InputError(f"{path}: {names} may each be the times; save one of them only with the traces")
        clocks[place] = plain[0]
    return clocks


def _base(clock, keys) -> TimeBase:
    if clock is None:
        why = "no variable is called as times are (time, t, time_us) or as their step (dt, fs, Tinterval)"
        return from_header(keys, 0, 0, why)
    return from_column(clock.array, split_unit(clock.name)[1], keys)
