"""What slips change of the values of a table.

The last argument of each change is the size of the slip, of which these have none.
"""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

import msgspec

from sonicvacuum.discover.faults.foremost import Place
from sonicvacuum.records import Record


def _edited(record, edits):
    """The record with some numbers of its values changed: (run, place) → field → number."""
    runs = list(record.block.runs)
    by_run = defaultdict(dict)
    for (k, j), given in edits.items():
        by_run[k][j] = given
    for k, changed in by_run.items():
        own = [
            msgspec.structs.replace(o, **changed[j]) if j in changed else o
            for j, o in enumerate(runs[k].observables)
        ]
        runs[k] = msgspec.structs.replace(runs[k], observables=own)
    return replace(record, block=msgspec.structs.replace(record.block, runs=runs))


def unsupported(k: int, j: int, factor: float, record: Record, _: float) -> Record:
    """The record with the error of value j of run k so many times as large."""
    own = record.block.runs[k].observables[j]
    return _edited(record, {(k, j): {"sigma": own.sigma * factor}})


def exchange(pairs: Sequence[tuple[Place, Place]], record: Record, _: float) -> Record:
    """Values and errors of pairs of rows, each in the other's place."""
    edits = {}
    for a, b in pairs:
        for here, there in ((a, b), (b, a)):
            other = record.block.runs[there[0]].observables[there[1]]
            edits[here] = {"value": other.value, "sigma": other.sigma}
    return _edited(record, edits)


def rescaled(places: Sequence[Place], factor: float, record: Record, _: float = 0.0) -> Record:
    """The record with the errors of some values so many times as large."""
    own = record.block.runs
    edits = {(k, j): {"sigma": own[k].observables[j].sigma * factor} for k, j in places}
    return _edited(record, edits)
