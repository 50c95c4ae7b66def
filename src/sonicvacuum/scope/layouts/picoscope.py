"""Pico Technology: names, units in brackets below, a blank line; infinities where out of range."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout(
    "picoscope",
    r"^\W*\S+([,;\t](Channel|Kanal|Canal|Voie|Average\(.*\)|Math)?\s?[A-H]\b)+.*\n\W*\([munµμ]?s\)|PicoScope|PicoLog",
)
