"""Dewesoft text export: names of file and rate, then columns with units in brackets."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout("dewesoft", r"dewesoft|^Data ?file.*\n(.*\n){0,6}.*Sample rate", unit="")
