"""What a layout can say of its own."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sonicvacuum.scope.keys import Keys

Reading = tuple[np.ndarray, str]


@dataclass(frozen=True)
class Layout:
    """One family of files.

    Attributes:
        name: as listings show it.
        signature: pattern in the first characters of the text that no other family has.
        path: pattern of the file's path, for files that bear no other sign.
        unit: of values where the file names none; "" where nothing may be assumed.
        companion: header lines from a file that goes with this one.
        readings: (numbers, keys, place of the channel) → readings and a remark, where numbers are counts.
    """

    name: str
    signature: str = ""
    path: str = ""
    unit: str = "V"
    companion: Callable[[Path], list[str]] | None = None
    readings: Callable[[np.ndarray, Keys, int], Reading] | None = None

    def fits(self, head: str, path: str) -> bool:
        """Whether a file is of this family."""
        by_text = self.signature and re.search(self.signature, head, re.IGNORECASE | re.MULTILINE)
        by_name = self.path and re.search(self.path, path, re.IGNORECASE)
        return bool(by_text or by_name or not (self.signature or self.path))
