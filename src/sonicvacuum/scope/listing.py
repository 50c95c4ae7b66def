"""What is in recorders' files, as data (`--list --json`) and as a table for reading."""

from pathlib import Path
from typing import Any

import numpy as np

from sonicvacuum.files import InputError, in_one_line
from sonicvacuum.scope.reader import read
from sonicvacuum.scope.recording import Channel
from sonicvacuum.scope.timebase import tidy


def listing(files) -> list[dict[str, Any]]:
    """One entry per file: `file`, `layout` and `channels`, or `file` and `refused` with the reason."""
    return [_entry(Path(f)) for f in files]


def _entry(path):
    try:
        recording = read(path)
    except InputError as error:
        return {"file": str(path), "refused": str(error)}
    return {
        "file": str(path),
        "layout": recording.layout,
        "notes": list(recording.notes),
        "channels": [_channel(c, recording.segments) for c in recording.channels],
    }


def _channel(channel: Channel, segments):
    finite = channel.values[np.isfinite(channel.values)]
    entry = {
        "name": channel.name,
        "unit": channel.unit or None,
        "samples": channel.samples,
        "interval_s": channel.interval_s,
        "start_s": channel.start_s,
        "minimum": tidy(float(finite.min())) if len(finite) else None,
        "maximum": tidy(float(finite.max())) if len(finite) else None,
        "notes": list(channel.notes),
    }
    return entry | ({"segment": channel.segment} if segments > 1 else {})


def text(entries: list[dict[str, Any]]) -> str:
    """The same for reading; minimum and maximum in the channel's unit, times in s."""
    lines = []
    for entry in entries:
        if "refused" in entry:
            lines.append(f"refused: {entry['refused']}")
            continue
        lines.append(f"{entry['file']}: {entry['layout']}" + "".join(f"; {n}" for n in entry["notes"]))
        rows = [_row(c) for c in entry["channels"]]
        heads = ("channel", "unit", "samples", "interval s", "start s", "minimum", "maximum")
        widths = [max(len(r[k]) for r in (heads, *rows)) for k in range(len(heads))]
        lines += [
            "  " + "  ".join(c.ljust(w) for c, w in zip(r, widths, strict=True)) for r in (heads, *rows)
        ]
        said = dict.fromkeys(n for c in entry["channels"] for n in c["notes"])
        lines += [f"    note: {n}" for n in said]
    return "\n".join(in_one_line(line.rstrip()) for line in lines)


def _row(channel):
    name = channel["name"] + (f" #{channel['segment']}" if "segment" in channel else "")
    keys = ("interval_s", "start_s", "minimum", "maximum")
    numbers = ["unknown" if channel[k] is None else f"{channel[k]:.7g}" for k in keys]
    return (name, channel["unit"] or "?", str(channel["samples"]), *numbers)
