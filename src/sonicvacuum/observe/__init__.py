"""From contact forces to what gauges read, and from readings to the quantities that experiments report.

The package `gauges` turns a recorded motion into readings; `trace`, `pulse` and `shape` find the pulses of
one reading between its samples; `run` keeps the wall's reflection out; `quantities` is the list of all that
is measured, of which `contacts` (one contact) and `sweep` (many runs) hold what needs something else than
readings.
"""
