"""Records made up for the tests: one with traces, one with scalars of every kind, one ball on a wall."""

import copy

import numpy as np
import yaml

from sonicvacuum.records import signals
from sonicvacuum.records.predict import predict
from sonicvacuum.records.reader import parse
from sonicvacuum.records.record import Record
from sonicvacuum.records.signals import Signals

STRIKER = {
    "shape": "flat", "material": "alumina", "mass_g": 0.47, "speed_m_s": 0.44, "speed_rel_sigma": 0.01
}  # fmt: skip

CONTENT = {
    "format": 1,
    "title": "Ten steel beads",
    "source": {"citation": "nobody", "doi": "10.0/x", "licence": "CC0-1.0", "note": "made up: µ, °, ×"},
    "chain": {
        "beads": 10,
        "orientation": "vertical",
        "bead": {"diameter_mm": 4.76, "mass_g": 0.44, "material": "stainless-steel"},
        "wall": {"material": "stainless-steel"},
        "static_force_N": 0.5,
    },
    "materials": {"stainless-steel": {"modulus_GPa": 195.0, "modulus_rel_sigma": 0.03}},
    "sensors": [
        {"id": "near", "kind": "embedded", "bead": 3, "sigma_N": 0.05, "gain_rel_sigma": 0.02},
        {"id": "far", "kind": "embedded", "bead": 6, "sigma_N": 0.05, "gain_rel_sigma": 0.02},
        {"id": "wall", "kind": "wall", "sigma_N": 0.1, "gain_rel_sigma": 0.02},
    ],
    "trigger_sigma_us": 1.0,
    "runs": [
        {"id": "slow", "striker": STRIKER | {"speed_m_s": 0.2}, "signals": "slow.csv"},
        {
            "id": "fast",
            "striker": STRIKER,
            "signals": "fast.csv",
            "observables": [
                {
                    "quantity": "speed",
                    "from": "near",
                    "to": "far",
                    "value": 580.0,
                    "sigma": 6.0,
                    "unit": "m/s",
                }
            ],
        },
    ],
}

SCALARS = [
    {"quantity": "speed", "from": "near", "to": "far", "value": 580.0, "sigma": 6.0, "unit": "m/s"},
    {"quantity": "amplitude", "sensor": "near", "value": 13.0, "sigma": 0.3, "unit": "N"},
    {"quantity": "duration", "sensor": "near", "level": 0.05, "value": 32.0, "sigma": 1.0, "unit": "us"},
    {
        "quantity": "width", "from": "near", "to": "far", "sensor": "near", "value": 4.9, "sigma": 0.2,
        "unit": "diameters",
    },
    {"quantity": "pulse_count", "sensor": "near", "threshold": 0.1, "value": 1, "sigma": 0, "unit": 1},
    {"quantity": "decay", "from": "near", "to": "far", "value": 0.98, "sigma": 0.02, "unit": "1"},
    {
        "quantity": "speed_at_amplitude", "amplitude_N": 2.0, "sensor": "near", "value": 430.0, "sigma": 5.0,
        "unit": "m/s",
    },
    {"quantity": "restitution", "value": 0.1, "sigma": 0.05, "unit": "1"},
]  # fmt: skip

BALL = {
    "format": 1,
    "title": "A steel ball on a steel wall",
    "chain": {
        "beads": 0,
        "orientation": "horizontal",
        "bead": {"diameter_mm": 10.0, "mass_g": 4.1, "material": "bearing-steel"},
        "wall": {"material": "bearing-steel"},
    },
    "materials": {"bearing-steel": {"modulus_rel_sigma": 0.02}},
    "sensors": [],
    "runs": [
        {
            "id": f"v{k}",
            "striker": {
                "shape": "sphere", "diameter_mm": 10.0, "material": "bearing-steel", "mass_g": 4.1,
                "speed_m_s": v,
            },
            "observables": [
                {"quantity": "restitution", "value": 0.95, "sigma": 0.01, "unit": "1"},
                {"quantity": "contact_duration", "value": 40.0, "sigma": 1.0, "unit": "us"},
            ],
        }
        for k, v in enumerate((0.1, 1.0))
    ],
}  # fmt: skip

TIME = -10.0 + 0.25 * np.arange(800)


def content(base=CONTENT, **changes):
    """A deep copy of a record's content; keys are paths like `chain__bead__mass_g`, None removes one."""
    result = copy.deepcopy(base)
    for path, value in changes.items():
        *parents, last = (int(p) if p.isdigit() else p for p in path.split("__"))
        place = result
        for part in parents:
            place = place[part]
        if value is None:
            del place[last]
        else:
            place[last] = copy.deepcopy(value)
    return result


def traces(block, noise_seed=3):
    """Signals of the nominal model with white noise, for every run that names a file."""
    quiet = {n: np.zeros(len(TIME)) for n in ("near", "far", "wall")}
    named = {r.id: Signals(TIME, quiet) for r in block.runs if r.signals}
    record = Record(block, named, "made-up")
    random = np.random.default_rng(noise_seed)
    result = {}
    for run, prediction in zip(record.runs, predict(record), strict=True):
        if run.signals is not None:
            noisy = {
                g.id: prediction.readings[g.id] + random.normal(0.0, g.sigma, len(TIME))
                for g in record.gauges
            }
            result[run.id] = Signals(TIME, noisy)
    return result


def made(base=CONTENT, **changes):
    """A record with traces of the nominal model."""
    block = parse(content(base, **changes))
    return Record(block, traces(block), "made-up")


def put(folder, base=CONTENT, **changes):
    """Write content as it is, right or wrong, with the traces of the unchanged record."""
    folder.mkdir(parents=True, exist_ok=True)
    text = yaml.safe_dump(content(base, **changes), sort_keys=False, allow_unicode=True)
    (folder / "record.yaml").write_text(text, encoding="utf-8")
    if base is CONTENT:
        for run, trace in TRACES.items():
            signals.write(trace, folder / f"{run}.csv")
    return folder


TRACES = made().signals
