"""Measured data: read, check, write, and turn into the chains that a simulation needs.

A record is a folder: `record.yaml` (closed schema, `blocks`) and a CSV file of traces for each run that has
any (`signals`). `read` gives a `Record`, in SI; `assemble` and `predict` say what a model makes of it.
"""

from sonicvacuum.records.reader import read
from sonicvacuum.records.record import Gauge, Observable, Record, Run, Striker, check_records
from sonicvacuum.records.signals import Signals
from sonicvacuum.records.writer import write

__all__ = ["Gauge", "Observable", "Record", "Run", "Signals", "Striker", "check_records", "read", "write"]
