"""What a file of a recorder holds, whatever its layout: channels in base units with their time base."""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np


@dataclass(frozen=True, eq=False)
class Channel:
    """One trace of one shot.

    Attributes:
        name: as the file calls it.
        unit: base unit of the values (V, N, m/s …), "" where the file does not say and none was assumed.
        values: (S,) readings in that unit; NaN where lost, ±inf where the recorder says "over range".
        start_s, interval_s: time of the first sample and between samples in s, None where the file is silent.
        notes: what was assumed and what contradicts itself, in whole sentences.
        segment: number of the shot within the file, from 1.
        times_s: (S,) times in s where they are not evenly spaced, else None.
    """

    name: str
    unit: str
    values: np.ndarray
    start_s: float | None
    interval_s: float | None
    notes: tuple[str, ...] = ()
    segment: int = 1
    times_s: np.ndarray | None = None

    @property
    def samples(self) -> int:
        """Number of samples."""
        return len(self.values)

    def noting(self, *notes: str) -> "Channel":
        """The channel with further notes."""
        return replace(self, notes=(*self.notes, *notes))


@dataclass(frozen=True, eq=False)
class Recording:
    """One file.

    Attributes:
        file: its path.
        layout: name of the layout recognised.
        channels: in the order of the file, segment after segment.
        notes: what concerns all channels.
    """

    file: Path
    layout: str
    channels: tuple[Channel, ...]
    notes: tuple[str, ...] = field(default=())

    @property
    def segments(self) -> int:
        """Number of shots in the file."""
        return max((c.segment for c in self.channels), default=0)
