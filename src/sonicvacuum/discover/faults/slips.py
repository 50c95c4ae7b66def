"""The hypotheses: every slip that a record may hide and that only the model can tell."""

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial

from sonicvacuum.discover.faults import changes, policy
from sonicvacuum.discover.faults.found import Finding
from sonicvacuum.records import Record

# Prior widths of continuous slips: logarithms of ratios, shifts in microseconds. Scales and light gates err
# by a few percent, a clock by a few parts in a thousand; tails are those of a Cauchy distribution.
WIDTH = {
    "bead-mass": 0.05,
    "bead-size": 0.03,
    "striker-mass": 0.1,
    "speed-common": 0.05,
    "gain-common": 0.1,
    "gauge-gain": 1.0,
    "run-off": 0.1,
    "clock": 0.01,
    "gauge-delayed": 20.0,
    "time-zero": 20.0,
}


# Gauges among which cables may have gone round: three have two ways of it, four eight.
MOST_CYCLED = 4


@dataclass(frozen=True)
class Slip:
    """One hypothesis.

    Attributes:
        fault: key of `table.FAULTS`.
        change: (record, size) → the record put right; sizes as in `changes`.
        run, sensor: where, as in `Finding`.
        alternatives: of the same kind in this record, this one among them.
        width: prior width of the size; 0: there is no size, the change is whole.
        step: for finite differences of the size.
        value: size → value that is said.
        occam: log of the prior's price for what the change itself took from the data.
        start: size from which the search starts.
        instead: kind of the run's nuisance that has followed the slip so far, "" where none is like it.
        lost: (samples lost before, record, size) → those that are lost in the record put right.
        quantity: of a table, where it concerns one.
        of_values: whether it changes values or their errors only, and nothing of what is simulated.
        plain: whether the values show it by themselves, whatever acts in them.
        seen: fitted model → value that is said, where the size does not tell it.
        known: whether it was put right already, and only its size is asked for once more.
        each: gauge → value, where several gauges are each told of.
        shown: whether traces show by themselves, before anything is fitted, that it may have been made: it is
            asked for beside effects as well where it gains nothing without them.
        expected: size that other numbers of the record speak for; 0 where none do.
        undo: (record put right) → as it was, whatever else was put right since; None where nobody asks.
    """

    fault: str
    change: Callable[[Record, float], Record]
    run: str | None = None
    sensor: str | tuple[str, ...] | None = None
    alternatives: int = 1
    width: float = 0.0
    step: float = 1e-4
    value: Callable[[float], float | None] = math.exp
    occam: float = 0.0
    start: float = 0.0
    instead: str = ""
    lost: Callable[[changes.Lost, Record, float], changes.Lost] = lambda lost, _record, _size: lost
    quantity: str | None = None
    of_values: bool = False
    plain: bool = False
    seen: Callable[..., float | None] | None = None
    known: bool = False
    each: Mapping[str, float] = field(default_factory=dict)
    shown: bool = False
    expected: float = 0.0
    undo: Callable[[Record], Record] | None = None

    @property
    def log_prior(self) -> float:
        """Log of its prior odds."""
        if self.known:
            return 0.0
        return policy.EXPECTED if self.expected else policy.log_prior(self.alternatives)

    @property
    def continuous(self) -> bool:
        """Whether it has a size."""
        return self.width > 0.0

    @property
    def far(self) -> bool:
        """Whether one run is so far off that the model's nuisances have followed it, or cannot."""
        return bool(self.instead and self.start)

    @property
    def at(self) -> tuple:
        """What it is and where."""
        return self.fault, self.run, self.sensor, self.quantity

    def findings(self, size: float, probability: float = 1.0) -> list[Finding]:
        """What is said of it."""
        if self.each:
            return [Finding(self.fault, self.run, id, v, probability) for id, v in self.each.items()]
        value = self.value(size)
        return [Finding(self.fault, self.run, self.sensor, value, probability, quantity=self.quantity)]


def hypotheses(record: Record) -> list[Slip]:
    """All slips of a record, except those of time zero, which need the model's readings."""
    return [*_discrete(record), *_sizes(record)]


def chain_slips(record: Record) -> list[Slip]:
    """Those of them that values without traces show as well: numbers of beads, speeds of single runs."""
    embedded = [g for g in record.gauges if g.bead is not None]
    return [*_counts(record, embedded), *_runs_off(record)]


def _discrete(record):
    embedded = [g for g in record.gauges if g.bead is not None]
    ids = [g.id for g in record.gauges]
    yield from swaps(ids)
    yield from _cycles(ids)
    yield from _counted_otherwise(record, embedded)
    moves = [(g, by) for g in embedded for by in (-1, 1) if 1 <= g.bead + by <= record.beads]
    taken = {g.bead for g in embedded}
    for g, by in moves:
        if g.bead + by in taken:
            continue
        yield Slip(
            "gauge-misplaced",
            partial(ignoring, changes.gauge_moved, g.id, by),
            sensor=g.id,
            alternatives=len(moves),
            value=partial(constant, float(g.bead + by)),
        )
    yield from _counts(record, embedded)
    yield from _exchanged(record)


def swaps(ids):
    """Every two gauges in each other's place."""
    pairs = list(itertools.combinations(ids, 2))
    for one, two in pairs:
        change = partial(ignoring, changes.gauges_swapped, one, two)
        yield Slip("gauges-swapped", change, None, (one, two), len(pairs), value=partial(constant, None))


def _cycles(ids):
    """Three gauges whose cables went round, either way; of many gauges there are too many to ask."""
    if len(ids) > MOST_CYCLED:
        return
    rounds = [(a, *rest) for a, b, c in itertools.combinations(ids, 3) for rest in ((b, c), (c, b))]
    for one, two, three in rounds:
        change = partial(ignoring, changes.gauges_renamed, {one: two, two: three, three: one})
        value = partial(constant, None)
        yield Slip("gauges-swapped", change, None, (one, two, three), 2 * len(rounds), value=value)


def _counted_otherwise(record, embedded):
    """All gauges a bead further or nearer, as where counting began with 0, or the striker was counted; or
    counted from the wall.
    """
    stated = {g.id: g.bead for g in embedded}
    ways = [{id: bead + by for id, bead in stated.items()} for by in (1, -1)] if len(stated) > 1 else []
    ways.append({id: record.beads + 1 - bead for id, bead in stated.items()})
    for beads in ways:
        inside = all(1 <= bead <= record.beads for bead in beads.values())
        moved = {id: bead for id, bead in beads.items() if bead != stated[id]}
        # A gauge alone that is a bead off is one of its own.
        if not inside or set(beads.values()) == set(stated.values()):
            continue
        if len(moved) == 1 and all(abs(bead - stated[id]) == 1 for id, bead in moved.items()):
            continue
        yield Slip(
            "gauge-misplaced",
            partial(ignoring, changes.gauges_at, moved),
            sensor=tuple(moved),
            alternatives=len(ways),
            value=partial(constant, float(next(iter(moved.values())))),
            each={id: float(bead) for id, bead in moved.items()},
        )


def _counts(record, embedded):
    single = record.specimen.bodies.exceptions
    # A bead more or less is one of the chain's own kind, at the end from which nothing is counted.
    ends = (False, True) if embedded or single else (False,)
    ends = [from_wall for from_wall in ends if (1 if from_wall else record.beads) not in single]
    if record.beads < 2:
        return
    for by, from_wall in itertools.product((-1, 1), ends):
        places = [g.bead + (by if from_wall else 0) for g in embedded]
        if all(1 <= p <= record.beads + by for p in places):
            change = partial(ignoring, changes.bead_count, by, from_wall)
            value = partial(constant, float(record.beads + by))
            yield Slip("bead-count", change, alternatives=2 * len(ends), value=value)


def _exchanged(record):
    pairs = [
        (a, b)
        for a, b in itertools.combinations(record.block.runs, 2)
        if a.signals and b.signals and a.striker != b.striker
    ]
    for a, b in pairs:
        change = partial(ignoring, changes.runs_swapped, a.id, b.id)
        value = partial(constant, None)
        yield Slip("runs-swapped", change, f"{a.id} and {b.id}", None, len(pairs), value=value)


def _sizes(record):
    one = _sized
    yield one("bead-mass", partial(_keyed, changes.beads, "mass_g"))
    yield one("bead-size", partial(_keyed, changes.beads, "diameter_mm"))
    yield one("striker-mass", partial(_keyed, changes.strikers, "mass_g"))
    yield one("speed-common", partial(_keyed, changes.strikers, "speed_m_s"))
    yield from _runs_off(record)
    if record.signals:
        yield one("gain-common", changes.gains)
        yield one("clock", changes.clock, step=1e-3)
    ids = [g.id for g in record.gauges] if record.signals else []
    for id in ids if len(ids) > 1 else []:
        given = {"sensor": id, "step": 0.05, "value": float, "lost": partial(_lost_late, id)}
        yield one("gauge-delayed", partial(_late, id), len(ids), **given)


def _sized(fault, change, alternatives=1, **where):
    return Slip(fault, change, alternatives=alternatives, width=WIDTH[fault], **where)


def _runs_off(record):
    runs = [r.id for r in record.block.runs]
    if len(runs) > 1:
        for run in runs:
            yield _sized("run-off", partial(_one_speed, run), len(runs), run=run, instead="speed")


def ignoring(change: Callable[..., Record], *given) -> Record:
    """A change of a record by what was given; last come the record and a size, which does not exist."""
    *arguments, record, _ = given
    return change(record, *arguments)


def _keyed(change, key, record, size):
    return change(record, key, size)


def _one_speed(run, record, size):
    return changes.strikers(record, "speed_m_s", size, (run,))


def _late(id, record, size):
    return changes.delayed(record, id, size)


def _lost_late(id, lost, record, size):
    return changes.lost_by_delay(lost, record, id, size)


def constant(value: float | None, _: float) -> float | None:
    """The value that is said of a slip whatever its size; None where none is."""
    return value
