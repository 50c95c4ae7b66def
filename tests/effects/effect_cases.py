"""The small chain on which every effect is tried, and one batch of strengths per effect, run once."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from reference import Plain

from sonicvacuum.effects import CATALOGUE, Setup, effect
from sonicvacuum.gauges import Gauge, reading
from sonicvacuum.physics.chain import Body, Chain, Elastic
from sonicvacuum.physics.run import History, simulate

DURATION, INTERVAL = 6e-4, 2.5e-7
# Strengths of the lanes of one batch: off, typical, its neighbours at 1 % and 2 %, and two weak ones.
STRENGTHS = (0.0, 1.0, 0.99, 1.01, 0.98, 1.02, 0.02, 0.01)
OFF, TYPICAL, WEAK, WEAKER = 0, 1, 6, 7
PLACES = {"bead": 3, "contact": 3, "sensor": 0}
# Every effect with each of the parameters that switch it on.
SWITCHES = [(e.id, p.name) for e in CATALOGUE for p in e.parameters if p.switches]


@dataclass(frozen=True)
class Batch:
    """One effect at all strengths: what was applied and what came out."""

    setup: Setup
    parameters: dict
    place: dict
    history: History
    readings: np.ndarray


def nominal(p: Plain | None = None) -> Setup:
    """The setup of one plain chain with a gauge in bead 3 and one at the wall."""
    p = p or Plain()
    chain = Chain(
        beads=p.beads,
        bodies=Body(
            Elastic("soft", p.modulus, p.poisson),
            p.mass,
            p.radius,
            core=Elastic("core", p.core_modulus, p.core_poisson),
        ),
        striker=Elastic("hard", p.striker_modulus, p.striker_poisson),
        wall=Elastic("steel", p.wall_modulus, p.wall_poisson),
        striker_radius=np.inf,
        striker_mass=p.striker_mass,
        speed=p.speed,
        gravity=p.gravity,
        static_force=p.preload,
    )
    return Setup(chain, (Gauge("g3", "embedded", 3), Gauge("wall", "wall", None)))


def in_lanes(setup: Setup, lanes: int) -> Setup:
    """The setup with at least so many equal lanes."""
    if setup.chain.lanes == lanes:
        return setup
    return replace(setup, chain=setup.chain.take(np.zeros(lanes, dtype=int)))


def run(setup: Setup, **options) -> tuple[History, np.ndarray]:
    """History of all contacts and readings (samples, sensors, lanes), at a step a quarter of the default."""
    beads = setup.chain.beads
    options = {"refine": 4.0, **options}
    history = simulate(setup.chain, range(beads + 1), DURATION, INTERVAL, **options)
    return history, np.stack([reading(s, history, beads) for s in setup.sensors], axis=1)


def values(id: str, name: str, strengths, setup: Setup) -> dict:
    """Parameters of an effect with one of its switches at the given strengths."""
    chosen = [p for p in effect(id).parameters if p.name == name or not p.switches]
    return {p.name: np.array([p.at(s, setup) for s in strengths]) for p in chosen}


def place_of(id: str) -> dict:
    """Where the tests put an effect that sits somewhere."""
    places = effect(id).places
    return {places: PLACES[places]} if places else {}


@cache
def batch(id: str, name: str) -> Batch:
    """The runs of one effect at `STRENGTHS` of one of its switches, with audit."""
    setup, place = nominal(), place_of(id)
    parameters = values(id, name, STRENGTHS, setup)
    changed = in_lanes(effect(id).apply(setup, **parameters, **place), len(STRENGTHS))
    return Batch(changed, parameters, place, *run(changed, audit=True))


def size(signal) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(signal))))
