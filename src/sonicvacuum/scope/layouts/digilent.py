"""Digilent WaveForms: lines of # with rate and ranges, then names with units in brackets."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout("digilent-waveforms", r"^#?\s*Digilent WaveForms")
