"""From a model of one ball to its export: the record or the ball, the law, the reference impact, each
simulator."""

import math
from collections.abc import Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.verdict import Model, Verdict
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.effects.base import Setup
from sonicvacuum.export import SIMULATORS
from sonicvacuum.export.bounce import Subject, ball_of, subject
from sonicvacuum.export.nearest import match
from sonicvacuum.export.result import Export, Reference, for_simulator
from sonicvacuum.export.table import coefficients, limits, measured
from sonicvacuum.files import InputError
from sonicvacuum.laboratory import ranges
from sonicvacuum.laboratory.blocks import material_of
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.laboratory.ranges import LaboratoryError
from sonicvacuum.laboratory.specimen import Bead, Specimen, Striker
from sonicvacuum.materials import MATERIALS
from sonicvacuum.physics.assemble import assemble
from sonicvacuum.physics.chain import Chain
from sonicvacuum.records import Record
from sonicvacuum.records.assemble import chain_of
from sonicvacuum.records.predict import Conditions
from sonicvacuum.schema_errors import likely

# A record of one speed says nothing of others; laws are then compared this far on either side of it.
ALONE = 3.0


@dataclass(frozen=True)
class Asked:
    """What is exported: a law of one ball, where it is from and the speeds that matter.

    Attributes:
        name: of the record, or of the ball.
        nominal: the ball without effects, one lane.
        effects: effect → parameters.
        speeds: in m/s.
        record, model, verdict: the data behind it, None where the law was given by hand.
    """

    name: str
    nominal: Chain
    effects: dict[str, dict[str, float]]
    speeds: tuple[float, ...]
    record: Record | None = None
    model: Model | None = None
    verdict: Verdict | None = None


def export(
    asked: Asked, to: Sequence[str] = tuple(SIMULATORS), error: float = 0.01, catalogue: Catalogue = CATALOGUE
) -> Export:
    """The law of one ball, written for simulators.

    Args:
        asked: see there.
        to: ids of the simulators.
        error: of restitution within which the nearest law counts as agreeing.
        catalogue: knows the effects.

    Raises:
        InputError: for a chain of beads, parameters, speeds or an error without meaning, or a ball that does
            not rebound.
    """
    if not 0.0 < error <= 1.0:  # nan too
        raise InputError(f"--error: is {error:g}; give an error of the restitution, above 0 and at most 1")
    _check_speeds(asked.speeds)
    one = subject(asked.nominal, asked.effects, catalogue)
    low, high = min(asked.speeds), max(asked.speeds)
    ball = ball_of(one.chain, math.sqrt(low * high))
    span = (low, high) if high > low else (low / ALONE, high * ALONE)
    found = {name: match(SIMULATORS[name], one, ball, span, error) for name in to}
    return Export(
        record=asked.name,
        effects=list(asked.effects),
        moot=one.moot,
        reference=Reference(
            speed_m_s=ball.speed, restitution=ball.restitution, contact_duration_us=ball.duration * 1e6
        ),
        coefficients=coefficients(one, asked.verdict, catalogue),
        limits=limits(asked.verdict, catalogue),
        measured=measured(asked.record, _conditions(asked, one, catalogue)) if asked.record else [],
        simulators=[for_simulator(SIMULATORS[name], found[name], error) for name in to],
    )


def of_record(
    record: Record, model: Model | None, effects: dict[str, dict[str, float]], verdict: Verdict | None = None
) -> Asked:
    """A record of one ball with a model of `discover`, or with effects given by hand (model None).

    Raises:
        InputError: for a record of a chain of beads, or of balls of several kinds.
    """
    name = record.name or record.title
    if record.beads:
        raise InputError(f"{name}: chain.beads: is {record.beads}; export takes one ball (beads: 0)")
    strikers = {(r.striker.radius_m, r.striker.mass_kg) for r in record.runs}
    if len(strikers) > 1:
        raise InputError(f"{name}: runs: {len(strikers)} balls of different size or mass; export takes one")
    chain = chain_of(record, [record.runs[0]])
    if model:
        chain = chain.stiffened(record.specimen.first.surface.name, model.modulus_ratio)
    speeds = tuple(r.striker.speed_m_s for r in record.runs)
    return Asked(name, chain, model.effects if model else effects, speeds, record, model, verdict)


def by_hand(
    mass_g: float, diameter_mm: float, material: str, wall: str, speeds: tuple[float, ...], effects
) -> Asked:
    """A ball described on the command line.

    Raises:
        InputError: for a material that is not in the table, or a size, mass or speed that no ball has.
    """
    for option, name in (("material", material), ("wall", wall)):
        if name not in MATERIALS:
            meant = likely(name, list(MATERIALS)) or f"known are {', '.join(sorted(MATERIALS))}"
            raise InputError(f"--{option}: {name!r} is not in the table of materials; {meant}")
    with _options():
        ranges.DIAMETER.check("diameter_mm", diameter_mm)
        ranges.check_mass("ball", mass_g, diameter_mm)
    _check_speeds(speeds)
    surface, flat = (material_of(n, {}, "") for n in (material, wall))
    bead = Bead(diameter_m=diameter_mm / 1e3, mass_kg=mass_g / 1e3, surface=surface)
    striker = Striker(surface, mass_g / 1e3, speeds[0], radius_m=diameter_mm / 2e3)
    chain = assemble(Specimen(0, Bodies((bead,)), flat), [striker])
    return Asked(f"{diameter_mm:g} mm ball of {material} on {wall}", chain, effects, speeds)


@contextmanager
def _options():
    """What no laboratory has is told by the name of the option that gave it."""
    try:
        yield
    except LaboratoryError as error:
        option = error.key.rpartition(".")[2]
        raise InputError(f"--{option}{str(error).removeprefix(error.key)}") from None


def _check_speeds(speeds):
    with _options():
        for speed in speeds:
            ranges.SPEED.check("speeds", speed)


def _conditions(asked: Asked, one: Subject, catalogue) -> Conditions:
    """The model under which the record's numbers are predicted, with its nuisances."""
    model, record = asked.model, asked.record
    ratio = model.modulus_ratio if model else 1.0
    speed = [(model.speed_ratio if model else {}).get(r.id, 1.0) for r in record.runs]

    def applied(setup: Setup) -> Setup:
        chain = setup.chain.stiffened(record.specimen.first.surface.name, ratio)
        made = Setup(chain, setup.sensors)
        for name, parameters in asked.effects.items():
            if name not in one.moot:
                made = catalogue.effect(name).apply(made, **parameters)
        return made

    return Conditions(model=applied, speed_ratio=np.array(speed))
