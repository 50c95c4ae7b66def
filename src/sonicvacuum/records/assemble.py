"""From a record to the chains that the stepper integrates: one lane for each run.

Runs whose strikers are alike in shape, size and material share a batch; masses and speeds differ from lane to
lane. The engine takes one striker radius and one striker material for a batch: the name of a material decides
which contacts an effect on that material moves.
"""

import math
from dataclasses import dataclass

import numpy as np

from sonicvacuum.card import CardMaterial
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.contact import contact_time
from sonicvacuum.records.ranges import impact_scales
from sonicvacuum.records.record import Record, Run

# Simulated beyond the last instant asked for, in standard errors of the trigger: shifts need no new run.
TRIGGER_ROOM = 6.0
# Scalars without traces: time for the pulse to cross the chain, with room for softer contacts; and to come
# back, where pulses are counted until then.
CROSSINGS, COUNTING = 2.5, 5.0
# A solitary wave passes one bead in about this many contact times (m²/(K² v))^{1/5} of the impact.
_PASSAGE = 1.5
# Sampling interval of a simulation in contact times 3.21 (m²/(K² v))^{1/5}. The rebound of one ball follows
# from the sum of its force over samples, which is good to 1e-7 when so fine.
SAMPLING = 1.0 / 60.0
SAMPLING_BALL = 1.0 / 600.0


@dataclass(frozen=True, eq=False)
class Batch:
    """Runs that are integrated together.

    Attributes:
        runs: places in `record.runs`; lane k of the chain is run `runs[k]`.
        chain: the nominal model, without effects.
    """

    runs: tuple[int, ...]
    chain: Chain


def assemble(record: Record) -> tuple[Batch, ...]:
    """The nominal chains of a record in as few batches as its strikers allow, in the order of first runs."""
    groups: dict[tuple, list[int]] = {}
    for k, run in enumerate(record.runs):
        groups.setdefault((run.striker.radius_m, run.striker.surface), []).append(k)
    return tuple(
        Batch(tuple(places), chain_of(record, [record.runs[k] for k in places])) for places in groups.values()
    )


def chain_of(record: Record, runs: list[Run]) -> Chain:
    """The nominal chains of runs whose strikers are alike in shape, size and material, one lane each."""
    striker = runs[0].striker
    return Chain(
        beads=record.beads,
        bodies=Body(
            surface=_elastic(record.surface),
            mass=record.bead_mass_kg,
            radius=record.diameter_m / 2.0,
            coating=record.coating_m,
        ),
        striker=_elastic(striker.surface),
        wall=_elastic(record.wall),
        striker_radius=striker.radius_m,
        striker_mass=np.array([r.striker.mass_kg for r in runs]),
        speed=np.array([r.striker.speed_m_s for r in runs]),
        gravity=record.gravity_m_s2,
        static_force=record.static_force_N,
    )


def duration_of(record: Record, runs: list[Run], chain: Chain) -> float:
    """Time in s to simulate: the runs' traces and room for the trigger, or what their scalars need."""
    ends = [r.signals.time_s[-1] + TRIGGER_ROOM * record.trigger_sigma_s for r in runs if r.signals]
    if any(r.observables for r in runs):
        counted = any(o.quantity == "pulse_count" for r in runs for o in r.observables)
        ends.append(passage_of(chain, COUNTING if counted else CROSSINGS))
    return max(ends)


def interval_of(record: Record, runs: list[Run], chain: Chain) -> float:
    """Sampling interval in s: the traces' own divided by a whole number, or `sampling_of` without any."""
    fine = sampling_of(chain)
    own = min((r.signals.interval_s for r in runs if r.signals), default=fine)
    return own / max(1, math.ceil(own / fine))


def sampling_of(chain: Chain) -> float:
    """Sampling interval in s that resolves the shortest pulse of a batch."""
    stiffness = chain.stiffness if chain.beads else chain.striker_stiffness
    mass = chain.lightest if chain.beads else chain.striker_mass
    fraction = SAMPLING if chain.beads else SAMPLING_BALL
    return fraction * 3.21 * float(contact_time(mass, stiffness, chain.speed).min())


def passage_of(chain: Chain, crossings: float = COUNTING) -> float:
    """Time in s in which the slowest pulse crosses the chain so many times; COUNTING for one ball."""
    contact = impact_scales(chain)[1]
    if chain.beads == 0:
        return COUNTING * contact
    heavy = max(1.0, float((chain.striker_mass / chain.lightest).max()))
    return crossings * (_PASSAGE / 3.21 * chain.beads + 2.0 * heavy) * contact


def _elastic(material: CardMaterial) -> Elastic:
    return Elastic(material.name, material.modulus_Pa, material.poisson)
