"""Numbers of a record that its nominal model does not show.

A model that shows no such number predicts none: every effect, or slip of the laboratory, that makes one
explains the record by far, whatever the value.
"""

from sonicvacuum.records.predict import predict
from sonicvacuum.records.record import Record


def unshown(record: Record) -> list[str]:
    """One sentence for each run, quantity and reason, beginning with the place that it concerns."""
    if not any(run.observables for run in record.runs):
        return []
    try:
        predicted = predict(record)
    except (FloatingPointError, ValueError):
        return []  # what such a record lacks is told where it is read
    found: dict[tuple[str, str, str], list[float]] = {}
    for run, shown in zip(record.runs, predicted, strict=True):
        for one, told in zip(run.observables, shown.observables, strict=True):
            if not told.known:
                gauges = "–".join(one.options[key] for key in ("from", "to", "sensor") if key in one.options)
                found.setdefault((run.id, f"{one.quantity} {gauges}".rstrip(), told.reason), []).append(
                    one.value
                )
    return [
        f"run {run}: {len(values)} × {what}: the nominal model shows none ({reason})"
        for (run, what, reason), values in found.items()
    ]
