"""Raw files of an oscilloscope, made from the nominal model: volts, 10 bit, an offset, sampled too finely."""

from pathlib import Path

import numpy as np
from made_files import table

from sonicvacuum.records import Record, Signals, write
from sonicvacuum.records.predict import predict
from sonicvacuum.records.reader import parse

STRIKER = {
    "shape": "flat", "material": "alumina", "mass_g": 0.47, "speed_m_s": 0.44, "speed_rel_sigma": 0.01
}  # fmt: skip
CONTENT = {
    "format": 1,
    "title": "Ten steel beads",
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
    ],
    "trigger_sigma_us": 1.0,
    "runs": [
        {"id": "slow", "striker": STRIKER | {"speed_m_s": 0.2}, "signals": "slow.csv"},
        {"id": "fast", "striker": STRIKER, "signals": "fast.csv"},
    ],
}
# Sensitivities in V/N; noise of one raw sample in V; the recorder's clock at the impact in us.
GAINS = {"near": 0.08, "far": 0.05}
NOISE_V = 0.004
IMPACT_US = 30.0
STEP_V = 8.0 / 1024
TIME = -30.0 + 0.1 * np.arange(3000)


def true_record() -> Record:
    """The record with traces of the nominal model, without noise."""
    quiet = {"near": np.zeros(len(TIME)), "far": np.zeros(len(TIME))}
    block = parse(CONTENT)
    record = Record(block, {r.id: Signals(TIME, quiet) for r in block.runs}, "made-up")
    found = zip(record.runs, predict(record), strict=True)
    return Record(block, {r.id: Signals(TIME, dict(p.readings)) for r, p in found}, "made-up")


TRUE = true_record()


def raw_files(folder: Path) -> tuple[list[Path], Path]:
    """One file per run with both gauges in volts, and the folder of the record they are like."""
    random, files = np.random.default_rng(5), []
    for run, signals in TRUE.signals.items():
        volts = [
            0.3 + GAINS[g] * signals.readings[g] + random.normal(0.0, NOISE_V, len(TIME))
            for g in ("near", "far")
        ]
        volts = [np.round(v / STEP_V) * STEP_V for v in volts]
        head = ["Model,TBS1202C", "Sample Interval,1e-07", "Vertical Units,V,V", "TIME,CH1,CH2"]
        files.append(folder / f"{run}.csv")
        files[-1].write_bytes(table(head, ((TIME + IMPACT_US) * 1e-6, *volts), form="{:.8e}"))
    write(TRUE, folder / "like")
    return files, folder / "like"
