"""Which files and channels make one run: by what the user says, else by the names of files and channels."""

import os
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.scope.options import Options
from sonicvacuum.scope.reader import read
from sonicvacuum.scope.recording import Channel, Recording
from sonicvacuum.scope.timebase import FINE, NO_TRIGGER, SECONDS

# A channel's number in the name of a file, as in F0000CH1, C2Trace00001, shot_Ch3, shot-channel4.
_MARK = re.compile(r"(?<![A-Za-z])(?:ch(?:an(?:nel)?)?|kanal|c)[ _-]?([1-8])(?!\d)", re.IGNORECASE)
# Intervals differing by less are the same; starts within this part of an interval are the same.
SAME = 1e-6
TOGETHER = 0.01
# Longest interval in s that times without a unit may have as seconds: a contact of solid balls is over within
# some ms, at most (`laboratory.ranges.LONGEST_INTERVAL`).
COARSEST = 0.01
# Samples of the shortest trace.
FEWEST = 16


@dataclass(frozen=True, eq=False)
class Shot:
    """One run's channels by gauge, as read, and their files; `notes` say how they were put together."""

    id: str
    channels: dict[str, Channel]
    notes: tuple[str, ...]
    files: dict[str, Path]


def shots(files: list[Path], options: Options) -> list[Shot]:
    """The runs in files, in the order of the files; InputError for what does not fit together."""
    if (options.interval_s or 0.0) > COARSEST:
        raise InputError(
            f"--interval: is {options.interval_s:g} s, and a contact is over within some ms; give the time "
            "between samples with its unit, as in 2us"
        )
    for group in (files, *options.runs.values()):
        _once(group)
    named = {f for group in options.runs.values() for f in group}
    recordings = {f: read(f) for f in dict.fromkeys((*files, *named))}
    groups = [(run, [recordings[f] for f in group]) for run, group in options.runs.items()]
    groups += _grouped([recordings[f] for f in files if f not in named])
    found = [s for run, group in groups for s in _segments(run, group, options)]
    used = [s.id for s in found]
    for twice in {u for u in used if used.count(u) > 1}:
        raise InputError(f"two runs are called {twice}; name them by --run NAME=FILE")
    _all_mapped(found, options, [c.name for r in recordings.values() for c in r.channels])
    return found


def _once(files):
    """Refuse a file that is given twice, under whatever path."""
    places = [os.path.realpath(f) for f in files]
    twice = next((f for f, p in zip(files, places, strict=True) if places.count(p) > 1), None)
    if twice is not None:
        raise InputError(f"{twice}: is given twice; give it once")


def _grouped(recordings):
    """Files of one channel each whose names differ in the channel's number only are one run."""
    groups = {}
    for r in recordings:
        single = len({c.name for c in r.channels}) == 1
        name = _name(r.file)
        stem = _MARK.sub("", name, count=1) if single and _MARK.search(name) else None
        groups.setdefault((r.file.parent, stem) if stem is not None else (r.file, None), []).append(r)
    return [
        (_id(stem if stem is not None and len(group) > 1 else _name(group[0].file)), group)
        for (_, stem), group in groups.items()
    ]


def _name(file):
    """What a file is called without its ending, which at Rohde & Schwarz is `.Wfm.csv`."""
    return re.sub(r"\.wfm$", "", file.stem, flags=re.IGNORECASE)


def _id(text):
    """A run's or gauge's id from a name: other characters become `_`."""
    return re.sub(r"[^A-Za-z0-9_.+-]+", "_", text).strip("_.+-") or "run"


def _segments(run, group: list[Recording], options):
    """One run per shot of the files; shots are numbered where there are several."""
    group = [_beside(r, len(group) > 1, options) for r in group]
    count = max(r.segments for r in group)
    if any(r.segments != count for r in group):
        raise InputError(f"run {run}: its files hold different numbers of shots; import them one by one")
    for k in range(1, count + 1):
        channels, notes, files = {}, [], {}
        for recording in group:
            for channel in (c for c in recording.channels if c.segment == k):
                gauge = _gauge(channel, recording, len(group) > 1, options)
                if gauge in channels:
                    raise InputError(
                        f"run {run}: two channels are {gauge}; tell them apart by --channel FILE:NAME=GAUGE"
                    )
                if gauge:
                    channels[gauge], files[gauge] = _timed(channel, recording, options), recording.file
            notes.append(f"{recording.file.name}: layout {recording.layout}.")
            notes += recording.notes
        if not channels:
            names = ", ".join(c.name for r in group for c in r.channels)
            raise InputError(f"run {run}: none of its channels ({names}) is named by --channel")
        yield Shot(run if count == 1 else f"{run}-{k}", channels, tuple(notes), files)


def _beside(recording: Recording, several, options) -> Recording:
    """The recording with channels that the user says read the same gauge as shots of their own.

    Tables often hold one column for each shot. Every gauge must then have as many columns.
    """
    named = [(c, _gauge(c, recording, several, options)) for c in recording.channels]
    gauges = [g for _, g in named if g]
    count = gauges.count(gauges[0]) if gauges else 1
    alike = all(gauges.count(g) == count for g in gauges)
    if not options.channels or recording.segments > 1 or count < 2 or not alike:
        return recording
    seen: dict[str, int] = {}
    channels = []
    for channel, gauge in named:
        if gauge:
            seen[gauge] = seen.get(gauge, 0) + 1
            channels.append(replace(channel, segment=seen[gauge]))
    note = "Columns that read the same gauge are shots of their own, numbered in the order of the file."
    return replace(recording, channels=tuple(channels), notes=(*recording.notes, note))


def _plain(name):
    """`CH 1`, `Channel 1`, `1` and `ch1` are the same channel."""
    bare = re.sub(r"[\s_-]", "", name.lower())
    return re.sub(r"^(channel|kanal|chan|ch|c)(?=\w{1,2}$)", "", bare)


def _gauge(channel, recording, several, options):
    """The gauge that a channel reads, None for one that is left out."""
    mark = _MARK.search(recording.file.stem)
    single = len({c.name for c in recording.channels}) == 1
    names = [channel.name] + ([f"CH{mark.group(1)}"] if mark and single and several else [])
    for key, gauge in options.channels.items():
        file, colon, own = key.rpartition(":")
        if colon and file in (str(recording.file), recording.file.name, recording.file.stem):
            if _plain(own) == _plain(channel.name):
                return gauge
        elif _plain(key) in map(_plain, names):
            return gauge
    return None if options.channels else _id(names[-1])


def _all_mapped(found, options, names):
    """Every channel and gauge that an option names must be there."""
    gauges = {g for s in found for g in s.channels}
    for key, gauge in options.channels.items():
        if gauge not in gauges:
            raise InputError(
                f"--channel {key}={gauge}: no channel is called {key!r}; there are "
                f"{', '.join(dict.fromkeys(names))}"
            )
    for option, wanted in (("--scale", options.scales), ("--place", options.places)):
        for gauge in wanted:
            if gauge not in gauges:
                raise InputError(
                    f"{option}: no channel is {gauge!r}; there are {', '.join(sorted(gauges))}: "
                    "look with --list how the channels are called"
                )
    ids = {s.id for s in found}
    for option, wanted in (("--speed", options.speeds), ("--impact-at", options.impacts)):
        for run in wanted:
            if run and run not in ids:
                raise InputError(f"{option}: no run is {run!r}; there are {', '.join(sorted(ids))}")


def _timed(channel, recording, options):
    """The channel with its time base, that of the user before that of the file."""
    given, own = options.interval_s, channel.interval_s
    if own is None and given is None:
        why = next((n for n in channel.notes if n.startswith("No time")), "No time; give --interval.")
        raise InputError(f"{recording.file}: channel {channel.name}: {why.rstrip('.')}")
    if own is None:
        notes = ["Interval as given."] + ([] if options.start_s is not None else [NO_TRIGGER])
        return replace(channel, interval_s=given, start_s=options.start_s or 0.0).noting(*notes)
    if SECONDS in channel.notes and given is not None:
        channel = replace(channel, notes=tuple(n for n in channel.notes if n != SECONDS))
    elif SECONDS in channel.notes and own > COARSEST:
        raise InputError(
            f"{recording.file}: channel {channel.name}: its times have no unit and are no seconds, for the "
            f"samples would be {own:g} s apart; write the unit into the header, as in Time (us), or give the "
            f"interval, as in --interval {own:g}us"
        )
    if given is not None and abs(given / own - 1.0) > SAME:
        # Whatever the file counts in, its start is counted in it too.
        start = (channel.start_s or 0.0) * given / own
        said = (
            f"Interval as given, {given:g} s, in place of the file's {own:g} s; its start is scaled likewise."
        )
        channel = replace(channel, interval_s=given, start_s=start, times_s=None).noting(said)
    if options.start_s is not None and options.start_s != channel.start_s:
        said = f"Start as given, {options.start_s:g} s, in place of the file's {channel.start_s:g} s."
        later = options.start_s - channel.start_s
        times = None if channel.times_s is None else channel.times_s + later
        channel = replace(channel, start_s=options.start_s, times_s=times).noting(said)
    return channel


def common_grid(shot: Shot) -> tuple[float, float, dict[str, np.ndarray], list[str]]:
    """Start and interval in s of one grid for all channels, their samples on it, and remarks.

    Channels on other times are interpolated linearly onto those of the coarsest one.
    """
    for gauge, channel in shot.channels.items():
        if channel.samples < FEWEST:
            raise InputError(
                f"{shot.files[gauge]}: channel {channel.name} holds {channel.samples} samples, less than the "
                f"{FEWEST} that a trace needs; export a longer stretch, or leave the channel out"
            )
    coarsest = max(shot.channels.values(), key=lambda c: c.interval_s)
    step, begin, end = coarsest.interval_s, coarsest.start_s, np.inf
    same = all(_together(c, coarsest) for c in shot.channels.values())
    begin = max(c.start_s for c in shot.channels.values()) if not same else begin
    end = min(float(_times(c)[-1]) + 0.5 * c.interval_s for c in shot.channels.values())
    count = int(np.floor((end - begin) / step)) + 1
    if count < FEWEST:
        raise InputError(
            f"run {shot.id}: its channels share less than {FEWEST} samples in time; look with --list when "
            "each begins and ends, and leave out those of other times"
        )
    if same:
        longest = max(c.samples for c in shot.channels.values())
        said = f"Cut from {longest} to {count} samples, those of the shortest channel."
        cut = {g: c.values[:count] for g, c in shot.channels.items()}
        return begin, step, cut, [said] if longest > count else []
    times = begin + step * np.arange(count)
    samples = {g: _between(times, c) for g, c in shot.channels.items()}
    return begin, step, samples, ["Channels were interpolated linearly onto common, even times."]


def _between(times, channel):
    """(T,) samples of a channel at other times; lost between its own where whole rows are missing there."""
    own, step = _times(channel), channel.interval_s
    samples, steps = np.interp(times, own, channel.values), np.diff(own) / step
    if channel.times_s is None or np.abs(steps - np.round(steps)).max() > FINE:
        return samples
    after = np.searchsorted(own, times - TOGETHER * step).clip(1, len(own) - 1)
    inside = (times > own[after - 1] + TOGETHER * step) & (times < own[after] - TOGETHER * step)
    return np.where(inside & (steps[after - 1] > 1.0 + FINE), np.nan, samples)


def _together(one, other):
    return (
        one.times_s is None
        and abs(one.interval_s / other.interval_s - 1.0) < SAME
        and abs(one.start_s - other.start_s) < TOGETHER * other.interval_s
    )


def _times(channel):
    if channel.times_s is not None:
        return channel.times_s
    return channel.start_s + channel.interval_s * np.arange(channel.samples)
