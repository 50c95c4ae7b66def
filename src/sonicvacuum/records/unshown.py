"""Numbers of a record that its nominal model does not show.

A model that shows no such number predicts none: every effect, or slip of the laboratory, that makes one
explains the record by far, whatever the value.
"""

from collections import Counter

from sonicvacuum.records.predict import numbers
from sonicvacuum.records.record import Record


def unshown(record: Record) -> list[str]:
    """One sentence for each run, quantity and reason, beginning with the place that it concerns."""
    if not any(run.observables for run in record.runs):
        return []
    try:
        predicted = numbers(record)
    except (FloatingPointError, ValueError):
        return []  # what such a record lacks is told where it is read
    found = Counter(
        (run.id, one.quantity, _gauges(one.options), told.reason)
        for run, shown in zip(record.runs, predicted, strict=True)
        for one, told in zip(run.observables, shown, strict=True)
        if not told.known
    )
    return [
        f"run {run}: {count} × {quantity}{gauges}: the nominal model shows none ({reason})"
        for (run, quantity, gauges, reason), count in found.items()
    ]


def _gauges(options) -> str:
    named = "–".join(options[key] for key in ("from", "to", "sensor") if key in options)
    return f" {named}" if named else ""
