"""Hantek scopes: # keys or columns with mV."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout("hantek", r"Hantek|^nr\W+time\W+ch1|^#CHANNEL\b|^#CLOCK\b|^#TIMEBASE")
