"""Tables of values without traces, made by the simulator itself."""

from dataclasses import replace

import msgspec
import numpy as np
from made_records import block

from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse

# Relative standard error of every value.
ERROR = 0.005
_BALL = {"diameter_mm": 10.0, "mass_g": 4.0, "material": "stainless-steel"}
# With values that a reader would believe; the model's own stand in their place.
REBOUND = {"quantity": "restitution", "unit": "1", "value": 0.9}
CONTACT = {"quantity": "contact_duration", "unit": "us", "value": 50.0}
PEAKS = [{"quantity": "amplitude", "sensor": id, "unit": "N", "value": 1.0} for id in ("g4", "g7", "wall")]
SPEEDS = [
    {"quantity": "speed", "from": a, "to": b, "unit": "m/s", "value": 200.0}
    for a, b in (("g4", "g7"), ("g7", "wall"))
]


def ball(speeds=(0.1, 0.18, 0.33, 0.6, 1.1, 2.0), seed=1) -> Record:
    """Rebounds and contact times of one ball on a wall."""
    content = {
        "format": 1,
        "title": "Steel ball on a steel wall",
        "chain": {"beads": 0, "orientation": "vertical", "bead": _BALL, "wall": {"material": "brass"}},
        "sensors": [],
        "runs": [
            {"id": f"v{k}", "striker": {**_BALL, "shape": "sphere", "speed_m_s": v, "speed_rel_sigma": 0.01}}
            for k, v in enumerate(speeds)
        ],
    }
    return filled(content, [REBOUND, CONTACT], seed)


def chain(speeds=(0.2, 0.35, 0.6), seed=1, departures=(), speed_error=0.01) -> Record:
    """Peaks and speeds in ten beads, with `departures` as in `filled`."""
    content = block(speeds)
    for run in content["runs"]:
        del run["signals"]
        run["striker"]["speed_rel_sigma"] = speed_error
    for sensor in content["sensors"]:
        del sensor["sigma_N"]
    return filled(content, [*PEAKS, *SPEEDS], seed, departures)


def filled(content, wanted, seed, departures=()) -> Record:
    """A record with the model's values of what is wanted, and noise.

    `departures` (what, place, ratio) change stiffness or mass at places.
    """
    for run in content["runs"]:
        run["observables"] = [{**one, "sigma": one["value"]} for one in wanted]
    empty = Record(parse(content), {}, "table")
    forward = Forward(experiment(empty))
    none = np.zeros((1, 0)), np.zeros((1, forward.layout.size))

    def change(setup, _):
        chain = setup.chain
        for what, place, ratio in departures:
            chain = chain.with_defect(what, place, ratio)
        return replace(setup, chain=chain)

    shown = forward.sampled(Hypothesis(), *none, change=change)
    random, runs = np.random.default_rng(seed), []
    for run, values in zip(empty.block.runs, shown, strict=True):
        # SI values come in units of the errors, which are those of the record's own units.
        exact = values[0] * [one["value"] for one in wanted]
        noisy = exact * random.normal(1.0, ERROR, len(wanted))
        own = [
            msgspec.structs.replace(o, value=float(x), sigma=float(ERROR * v))
            for o, v, x in zip(run.observables, exact, noisy, strict=True)
        ]
        runs.append(msgspec.structs.replace(run, observables=own))
    return replace(empty, block=msgspec.structs.replace(empty.block, runs=runs))


def changed(record: Record, run: int, place: int, **keys) -> Record:
    """The record with one row's keys changed by functions of what stands there."""
    runs = list(record.block.runs)
    own = list(runs[run].observables)
    own[place] = msgspec.structs.replace(
        own[place], **{key: change(getattr(own[place], key)) for key, change in keys.items()}
    )
    runs[run] = msgspec.structs.replace(runs[run], observables=own)
    return replace(record, block=msgspec.structs.replace(record.block, runs=runs))
