"""Any other table of numbers."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout("table", unit="")
