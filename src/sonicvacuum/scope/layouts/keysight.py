"""Agilent and Keysight InfiniiVision and Infiniium scopes."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout("keysight", r"^\W*x-axis,|^\W*XInc:|^\W*XOrg:|Agilent|Keysight|InfiniiVision")
