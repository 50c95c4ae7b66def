"""Folders as discover writes them, made by hand: one for each kind of outcome."""

import csv
from pathlib import Path

import numpy as np

from sonicvacuum.discover.verdict import Gap, Gaps, Model, Next, Value, Verdict, Where, write_json

HEADERS = {
    "where": "run,sensor,feature,z_before,p_before,q_before,size,z_after",
    "candidates": "effects,delta_chi2,log10_bayes,probability,parameters,flags",
    "gap": "run,data,before,after,held_out_before,held_out_after,floor",
    "limits": "effect,parameter,limit_95,estimate,testable,place",
    "quantities": "run,quantity,bound,unit,measured,sigma,nominal,extended,held_out",
    "traces": "run,sensor,time_us,measured_N,nominal_N,extended_N,sigma_N",
}
CELL = Where(run="fast", sensor="g1", feature="amplitude", z=-12.0, p=1e-30)
PROPOSAL = Next(change={"striker.speed_m_s": 1.25}, separates=["kuwabara-kono", "tsuji"], delta_chi2=25.0)
KUWABARA = {"time_us": Value(value=1.98, sigma=0.06)}
DEFECT = {"mass_ratio": Value(value=1.2, sigma=0.01), "bead": Value(value=6.0, sigma=0.0)}
SPREAD = {"none": 0.0, "unknown": 0.01, "kuwabara-kono": 0.97, "tsuji": 0.02}


def verdict(**changes):
    """The verdict of one effect named with confidence, changed."""
    content = {
        "record": "made",
        "named": ["kuwabara-kono"],
        "probabilities": SPREAD,
        "confusable": [],
        "parameters": {"kuwabara-kono": KUWABARA},
        "gap": gaps(83.1, 1.02, (80.7, 1.05)),
        "where": [CELL],
        "upper_limits": {"viscous-drag": {"rate_per_s": 15.0}},
        "not_testable": ["gravity"],
        "next_experiment": PROPOSAL,
        "reasons": ["kuwabara-kono leaves nothing significant"],
        "alarms": {"single": 0.4},
        "timing_s": {"total": 12.345},
        "simulations": 2140,
    }
    return Verdict(**{**content, **changes})


def gaps(before, after, held_out=None):
    """Fitted and held-out gaps, the closed share as discover gives it."""

    def one(first, last):
        closed = 1.0 - (last - 1.0) / (first - 1.0)
        return Gap(before=first, after=last, floor=1.0, closed=closed)

    return Gaps(fitted=one(before, after), held_out=one(*held_out) if held_out else None)


EMPTY = {"parameters": {}, "where": [], "gap": gaps(0.98, 0.98, (0.99, 0.99)), "confusable": []}
SCALAR = Where(run="fast", sensor="", feature="restitution", z=-14.0, p=1e-40)
KINDS = {
    "none": verdict(
        **EMPTY,
        named=[],
        probabilities={"none": 0.91, "unknown": 0.01, "tsuji": 0.08},
        next_experiment=None,
        reasons=["no single effect passes the threshold"],
        alarms={"none": 0.6},
    ),
    "single": verdict(),
    "class": verdict(
        confusable=[["kuwabara-kono", "tsuji"]],
        probabilities={"none": 0.0, "unknown": 0.01, "kuwabara-kono": 0.6, "tsuji": 0.39},
    ),
    "pair": verdict(
        named=["mass-defect", "kuwabara-kono"],
        probabilities={"none": 0.0, "unknown": 1.0},
        parameters={"mass-defect": DEFECT, "kuwabara-kono": KUWABARA},
        confusable=[["kuwabara-kono", "tsuji"]],
    ),
    "unknown": verdict(
        named=["unknown"], probabilities={"none": 0.0, "unknown": 1.0}, parameters={}, next_experiment=None
    ),
    "scalars": verdict(where=[SCALAR], gap=gaps(29.6, 0.94), next_experiment=None),
    "ball": verdict(
        where=[SCALAR], named=["hunt-crossley"], probabilities={"none": 0.0, "hunt-crossley": 0.996},
        parameters={"hunt-crossley": {"damping_s_per_m": Value(value=0.027, sigma=0.0014)}},
        next_experiment=None,
    ),
}  # fmt: skip
WITHOUT_TRACES = ("scalars", "ball")


def write(folder: Path, kind: str) -> Path:
    """A folder with the verdict of that kind and tables to match."""
    folder.mkdir(parents=True)
    gauges = ("",) if kind in WITHOUT_TRACES else ("g1", "wall")
    features = ("restitution",) if kind in WITHOUT_TRACES else ("amplitude", "delay")
    found = {(cell.run, cell.sensor, cell.feature) for cell in KINDS[kind].where}
    cells = [
        (r, g, f, -12.0 if r == "fast" else 0.5, 1e-3, 1e-9 if (r, g, f) in found else 0.5, 1.0, 0.3)
        for r in ("slow", "fast") for g in gauges for f in features
    ]  # fmt: skip
    write_json(KINDS[kind], folder / "verdict.json")
    write_json(model(KINDS[kind]), folder / "model.json")
    tables = {
        "where": cells,
        "candidates": [
            ("kuwabara-kono", 5000.0, 1080.0, 0.97, "kuwabara-kono time_us 1.98", ""),
            ("mass-defect+kuwabara-kono", 5600.0, 1200.0, "", "mass-defect bead 6", ""),
        ],
        "gap": [
            ("slow", 100, 2.0, 1.0, 2.0, 1.0, 1),
            ("all", 200, 83.1, 1.02, 80.7, 1.05, 1),
            ("round 0: nominal", 200, "", 83.1, "", "", 1),
            ("round 1: kuwabara-kono", 200, "", 1.02, "", "", 1),
        ],
        "limits": [("viscous-drag", "rate_per_s", 15.0, 1.0, 1, ""), ("gravity", "fraction", 0, 1, 0, "")],
        "traces": [] if kind in WITHOUT_TRACES else list(_traces()),
    }
    if kind in WITHOUT_TRACES:
        tables["quantities"] = [
            ("slow", "restitution", "", "1", 0.9, 0.01, 0.99, 0.91, 0.92),
            ("fast", "restitution", "at_most", "1", 0.85, 0.01, 0.99, 0.84, ""),
        ]
    for name, rows in tables.items():
        with open(folder / f"{name}.csv", "w", newline="") as stream:
            csv.writer(stream, lineterminator="\n").writerows([HEADERS[name].split(","), *rows])
    return folder


def _traces():
    time = np.linspace(0.0, 400.0, 200)
    pulse = np.exp(-(((time - 200.0) / 30.0) ** 2))
    for run in ("slow", "fast"):
        for gauge in ("g1", "wall"):
            for t, f in zip(time, pulse, strict=True):
                yield run, gauge, t, f + 0.01, f, f + 0.005, 0.02


def model(of: Verdict) -> Model:
    """A model with its nuisances moved a little."""
    effects = {k: {n: v.value for n, v in given.items()} for k, given in of.parameters.items()}
    return Model(
        record=of.record,
        effects=effects,
        speed_ratio={"slow": 1.004},
        trigger_us={"slow": 0.5},
        gain={"g1": 1.0},
        modulus_ratio=1.0,
    )
