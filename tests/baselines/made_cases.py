"""Cases made by hand, as the tables of `discover` would give them."""

import math

from sonicvacuum_blind.baselines.cases import Case, Cell, Single
from sonicvacuum_blind.score import Row

BLANK = dict.fromkeys(
    ("brier", "place", "closed", "before", "chi2", "errors_before", "errors_after", "seconds"), math.nan
)


def row(id="a", kind="single", effects="tsuji", **changes):
    base = {
        "id": id,
        "kind": kind,
        "design": "traces",
        "noise": "white",
        "effects": effects,
        "d_prime": 10.0,
        "reached": 10.0,
        "leftover": 9.0 if kind == "foreign" else 0.0,
        "nearest": "gravity",
        "ideal": 0.9 if kind == "single" else math.nan,
        "named": effects,
        "top": effects,
        **dict.fromkeys(("confidence", "stated"), 0.9),
        **dict.fromkeys(("exact", "class_level"), 1),
        **dict.fromkeys(("false_alarm", "says_unknown", "wrong", "confident_wrong", "slip"), 0),
        **BLANK,
        **dict.fromkeys(("credible", "credible_size", "held", "limits", "simulations"), 0),
        **dict.fromkeys(("cells_right", "cells_wrong", "cells_seen", "cells_large"), 0),
    }
    return Row(**(base | changes))


def case(singles=(), cells=(), data=1000, misfit=1.5, record=None, **changes):
    return Case(row(**changes), tuple(singles), data, misfit, tuple(cells), record, None)


def single(effect, gain, parameters=1, cosine=math.nan):
    return Single(effect, gain, parameters, cosine)


def cell(run, sensor, feature, z, size=0.1):
    return Cell(run, sensor, feature, z, size)
