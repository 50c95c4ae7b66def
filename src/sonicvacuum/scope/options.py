"""What the command line asks of an import, as `NAME=VALUE` texts, turned into numbers and names."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from sonicvacuum.files import InputError
from sonicvacuum.scope.units import Scale, quantity, scale

_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]*")
# Times that may count from 1970, also in ms; no striker is faster than light.
_LARGEST, _KIND = {"s": 1e14, "m/s": 3e8}, {"s": "time", "m/s": "speed"}
_PERCENT = re.compile(r"\s*(?:±|\+-|\+/-)\s*(\d+(?:\.\d*)?|\.\d+)\s*%\s*$")


@dataclass(frozen=True)
class Options:
    """How files become a record.

    Attributes:
        channels: name of a channel, or `FILE:name` → id of the gauge; empty: all channels under their names.
        scales: gauge → sensitivity; gain_rel_sigma: gauge → its relative standard error, where stated.
        runs: run → names of its files; files that no run names are runs of their own.
        places: gauge → number of its bead, or None for the wall.
        speeds: run, or "" for all → speed of the striker in m/s.
        speed_rel_sigma: run, or "" for all → its relative standard error, where stated.
        impacts: run, or "" for all → moment of impact in s on the recorder's clock.
        interval_s, start_s: time base of files that have none.
        keep_all: neither trim nor thin.
    """

    channels: dict[str, str] = field(default_factory=dict)
    scales: dict[str, Scale] = field(default_factory=dict)
    gain_rel_sigma: dict[str, float] = field(default_factory=dict)
    runs: dict[str, list[Path]] = field(default_factory=dict)
    places: dict[str, int | None] = field(default_factory=dict)
    speeds: dict[str, float] = field(default_factory=dict)
    speed_rel_sigma: dict[str, float] = field(default_factory=dict)
    impacts: dict[str, float] = field(default_factory=dict)
    interval_s: float | None = None
    start_s: float | None = None
    keep_all: bool = False


def options(
    channel=(), scale=(), run=(), place=(), speed=(), impact_at=(), interval=None, start=None, keep_all=False
) -> Options:
    """Options of the command line; InputError names the option, the value and the cure."""
    scales = _pairs("--scale", scale, "g9=12.5N/V")
    given = _pairs("--impact-at", _of_all(impact_at), "12us or v044=12us", "")
    speeds = _pairs("--speed", _of_all(speed), "0.44, v044=0.44 or v044=0.44±2%", "")
    return Options(
        {c: name("--channel", g) for c, g in _pairs("--channel", channel, "CH1=g9").items()},
        {g: _scale(g, _PERCENT.sub("", t)) for g, t in scales.items()},
        _errors(scales),
        {name("--run", r): _files(r, t) for r, t in _pairs("--run", run, "v044=A.csv,B.csv").items()},
        {g: _place(g, t) for g, t in _pairs("--place", place, "g9=13 or wall=wall").items()},
        {
            r: _positive("--speed", _number("--speed", _PERCENT.sub("", t), "m/s"), t)
            for r, t in speeds.items()
        },
        _errors(speeds),
        {r: _number("--impact-at", t, "s") for r, t in given.items()},
        None if interval is None else _positive("--interval", _number("--interval", interval, "s"), interval),
        None if start is None else _number("--start", start, "s"),
        keep_all,
    )


def _of_all(texts):
    """What names no run is of all."""
    return [t if "=" in t else f"={t}" for t in texts]


def _errors(texts):
    """Name → relative standard error, where a text ends in one."""
    return {k: float(m.group(1)) / 100.0 for k, t in texts.items() if (m := _PERCENT.search(t))}


def _scale(gauge, text):
    return scale(text, gauge)


def _pairs(option, texts: Iterable[str], example, empty=None):
    found = {}
    for text in texts:
        key, mark, value = text.partition("=")
        key, value = key.strip(), value.strip()
        if not mark or not value or (not key and empty is None):
            raise InputError(f"{option}: is {text!r}; write it as in {option} {example}")
        if key in found:
            raise InputError(f"{option}: {key!r} is given twice; give it once")
        found[key] = value
    return found


def name(option: str, text: str) -> str:
    """A gauge's or run's id as a record allows it."""
    if not _ID.fullmatch(text):
        raise InputError(f"{option}: is {text!r}; use letters, digits and _ . + - only")
    return text


def _files(run, text):
    files = [Path(p.strip()) for p in text.split(",") if p.strip()]
    if not files:
        raise InputError(f"--run {run}: names no file; write it as in --run v044=A.csv,B.csv")
    return files


def _place(gauge, text):
    if text.lower() == "wall":
        return None
    if not re.fullmatch("[0-9]{1,6}", text) or int(text) < 1:
        raise InputError(f"--place {gauge}: is {text!r}; give the number of its bead, or wall")
    return int(text)


def _number(option, text, base):
    found = quantity(text)
    if found is None or (found[1] and found[1].base != base):
        raise InputError(f"{option}: is {text!r}; give a number in {base}, or one with its unit")
    number = found[0] * (found[1].factor if found[1] else 1.0)
    if abs(number) > _LARGEST[base]:
        raise InputError(f"{option}: is {text!r}, which is no {_KIND[base]} of a recording; give another")
    return number


def _positive(option, number, text):
    if not number > 0.0:
        raise InputError(f"{option}: is {text!r}; it must be above 0")
    return number
