"""Elsys TranAX exports."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout("elsys", r"TranAX|Elsys|TraNET", unit="V")
