"""Teledyne LeCroy text files: model, segments, one line per segment, then Time and Ampl."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout("lecroy", r"^\W*LECROY|^.?Segments?\b.*SegmentSize")
