"""The registry of layouts: what single makers' files have of their own, beyond what any table has.

Each module describes one family. Another one is one module with its `LAYOUT` and one line here; the first
whose signature fits is taken, `table` fits all.
"""

import re

from sonicvacuum.scope.layouts import (
    dewesoft,
    digilent,
    elsys,
    gw_instek,
    hantek,
    keysight,
    lecroy,
    lvm,
    phyphox,
    picoscope,
    rigol,
    rohde_schwarz,
    siglent,
    table,
    tektronix,
    yokogawa,
)
from sonicvacuum.scope.layouts.base import Layout

LAYOUTS: tuple[Layout, ...] = (
    lvm.LAYOUT,
    digilent.LAYOUT,
    lecroy.LAYOUT,
    yokogawa.LAYOUT,
    gw_instek.LAYOUT,
    dewesoft.LAYOUT,
    elsys.LAYOUT,
    siglent.LAYOUT,
    tektronix.LAYOUT,
    rohde_schwarz.LAYOUT,
    rigol.LAYOUT,
    keysight.LAYOUT,
    hantek.LAYOUT,
    picoscope.LAYOUT,
    phyphox.LAYOUT,
    table.LAYOUT,
)


def recognise(head: str, path) -> Layout:
    """The layout whose signature the head of a file, or the file's name, bears.

    Spreadsheets write files again with other marks between the cells, or with quotes around them.
    """
    first = next(layout for layout in LAYOUTS if layout.fits(head, str(path)))
    if first is not table.LAYOUT:
        return first
    plain = re.sub(r'[ "]*[,;\t][ "]*', ",", head)
    return next(layout for layout in LAYOUTS if layout.fits(plain, str(path)))
