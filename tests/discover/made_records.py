"""Small records for the tests of inference, made by the simulator itself: truth and model agree, so that
what the statistics say can be checked. (Data from an independent integrator are the blind study's.)
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.reader import parse

SIGMA = 0.02
# us, of the contacts in the record with hidden Kuwabara–Kono damping.
DAMPING = 0.3
BEADS = 10


def block(speeds, orientation="horizontal", sensors=None):
    """A chain of ten coated beads with two gauges and the wall, or with these sensors."""
    gauges = [
        {"id": f"g{b}", "kind": "embedded", "bead": b, "sigma_N": SIGMA, "gain_rel_sigma": 0.02}
        for b in (4, 7)
    ]
    wall = {"id": "wall", "kind": "wall", "sigma_N": 2.0 * SIGMA, "gain_rel_sigma": 0.02}
    striker = {"shape": "flat", "material": "alumina", "mass_g": 0.47, "speed_rel_sigma": 0.01}
    return {
        "format": 1,
        "title": "made",
        "chain": {
            "beads": BEADS,
            "orientation": orientation,
            "bead": {"diameter_mm": 4.86, "mass_g": 0.44, "material": "parylene-c"},
            "wall": {"material": "stainless-steel"},
        },
        "materials": {"parylene-c": {"modulus_rel_sigma": 0.05}},
        "sensors": sensors or [*gauges, wall],
        "trigger_sigma_us": 1.0,
        "runs": [
            {"id": f"v{k}", "striker": {**striker, "speed_m_s": v}, "signals": f"v{k}.csv"}
            for k, v in enumerate(speeds)
        ],
    }


def made(
    effects=(),
    seed=0,
    speeds=(0.3, 0.9),
    noise=1.0,
    departures=(),
    sensors=None,
    catalogue=CATALOGUE,
    given=None,
):
    """A record with hidden effects ((id, parameters), ...) of a catalogue, nuisances and white noise drawn;
    the nuisances.

    `given` is the record's content, in place of `block`.
    `departures` (what, place, ratio) change stiffness or mass at places, whatever the catalogue says of it.
    """
    content = parse(given or block(speeds, sensors=sensors))
    rng = np.random.default_rng(np.random.SeedSequence(seed))
    time = np.arange(0.0, 700.0, 1.0)
    ids = [s.id for s in content.sensors]
    empty = {r.id: Signals(time, {i: np.zeros(len(time)) for i in ids}) for r in content.runs}
    forward = Forward(experiment(Record(content, empty, "made")))
    nu = noise * rng.normal(size=(1, forward.layout.size))

    def change(setup, index):
        for name, given in effects:
            given = {k: np.full(setup.chain.lanes, v) for k, v in given.items()}
            setup = catalogue.effect(name).apply(setup, **given)
        chain = setup.chain
        for what, place, ratio in departures:
            chain = chain.with_defect(what, place, ratio)
        return replace(setup, chain=chain)

    found = forward.sampled(Hypothesis(), np.zeros((1, 0)), nu, change=change)
    sigma = np.array([g.sigma for g in Record(content).gauges])[:, None]
    signals = {}
    for run, value in zip(content.runs, found, strict=True):
        clean = value[0].reshape(len(ids), -1) * forward.experiment.sigma[:, None]
        noisy = clean + noise * sigma * rng.normal(size=clean.shape)
        signals[run.id] = Signals(time, dict(zip(ids, noisy, strict=True)))
    return Record(content, signals, "made"), nu[0]


TOLERANCES = {
    "bead_mass_rel": 0.01,
    "bead_diameter_rel": 0.005,
    "striker_mass_rel": 0.01,
    "speed_common_rel": 0.02,
    "gain_common_rel": 0.03,
}


def with_keys(record: Record, sensors=None, materials=None, **keys) -> Record:
    """The record with other errors: `sensors` go to every gauge, `materials` are added."""
    content = block([r.striker.speed_m_s for r in record.block.runs])
    content["sensors"] = [{**s, **(sensors or {})} for s in content["sensors"]]
    content["materials"] |= materials or {}
    return Record(parse({**content, **keys}), record.signals, "other")
