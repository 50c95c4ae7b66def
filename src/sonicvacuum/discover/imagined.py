"""Runs that a laboratory could make next: its last one with one quantity changed, or two."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from sonicvacuum.discover.model.experiment import Batch, Experiment, RunData
from sonicvacuum.gauges import Gauge
from sonicvacuum.laboratory.next_run import FASTEST, MASSES, PRELOADS, SLOWEST, SPEEDS, gauge_beads
from sonicvacuum.laboratory.ranges import likely_ball
from sonicvacuum.laboratory.specimen import GRAVITY
from sonicvacuum.physics.chain import Chain

# What is changed in one run together: how it is struck, how it is pressed, where it is measured. A chain that
# is hung the other way is another one.
TOGETHER = {"striker.speed_m_s", "striker.mass_g", "chain.static_force_N", "sensors"}
# What of a chain a change may touch.
CHANGED = ("speed", "striker_mass", "static_force", "gravity")


@dataclass(frozen=True)
class Means:
    """What a laboratory can change, for the last of its runs.

    Attributes:
        speeds: of the striker in m/s.
        masses: of the striker in kg.
        preloads: static force in N.
        turned: whether the chain can be hung the other way.
        beads: that may hold the first embedded gauge.
    """

    speeds: tuple[float, ...]
    masses: tuple[float, ...]
    preloads: tuple[float, ...]
    turned: bool
    beads: tuple[int, ...]


def means(experiment: Experiment, chain: Chain) -> Means:
    """What the record's `apparatus` allows, or what most laboratories can do where it has none."""
    speed, mass, force = (float(x[0]) for x in (chain.speed, chain.striker_mass, chain.static_force))
    given = experiment.record.block.apparatus if experiment.record is not None else None
    if given is None:
        return Means(
            speeds=tuple(speed * f for f in SPEEDS if SLOWEST <= speed * f <= FASTEST),
            masses=tuple(mass * f for f in MASSES),
            preloads=tuple(force + more for more in PRELOADS),
            turned=True,
            beads=tuple(gauge_beads(experiment.beads)),
        )
    slow, fast = given.speed_m_s or (speed, speed)
    speeds = {slow, fast, *(speed * f for f in SPEEDS if slow <= speed * f <= fast)} - {speed}
    other = "horizontal" if chain.gravity[0] > 0.0 else "vertical"
    return Means(
        speeds=tuple(sorted(speeds)),
        masses=tuple(m / 1e3 for m in given.striker_mass_g if abs(m / 1e3 - mass) > 1e-9 * mass),
        preloads=tuple(f for f in given.static_force_N if f != force),
        turned=other in given.orientation,
        beads=tuple(given.gauge_beads),
    )


@dataclass(frozen=True)
class Change:
    """One quantity of a run that is changed.

    Attributes:
        key, value: as a verdict states them.
        chain: the chain of the run → what it is then.
        gauges: of the record then; None where they stay.
        faster: speed of the striker then, over what it was.
    """

    key: str
    value: float | int | str
    chain: Callable[[Chain], Chain] = lambda chain: chain
    gauges: tuple[Gauge, ...] | None = None
    faster: float = 1.0


def changes(experiment: Experiment) -> Iterator[tuple[dict, Experiment]]:
    """(change, experiment with that one run) for every run with one quantity of the last one changed."""
    for one in _offers(experiment, *_last(experiment)):
        yield _imagined(experiment, one)


def changes_of_two(experiment: Experiment) -> Iterator[tuple[dict, Experiment]]:
    """The same with two quantities changed."""
    offers = [c for c in _offers(experiment, *_last(experiment)) if _kind(c) in TOGETHER]
    for one, other in combinations(offers, 2):
        if _kind(one) != _kind(other):
            yield _imagined(experiment, one, other)


def together(imagined: Sequence[Experiment]) -> Experiment:
    """Runs that were imagined one by one as runs of one experiment, which are simulated side by side: those
    with the same gauges for as long as any of them is watched.
    """
    batches: dict[tuple, list[int]] = {}
    for k, one in enumerate(imagined):
        batches.setdefault(one.gauges, []).append(k)
    made = []
    for gauges, runs in batches.items():
        (alone,) = imagined[runs[0]].batches
        own = [imagined[k].batches[0] for k in runs]
        numbers = {n: np.concatenate([getattr(b.chain, n) for b in own]) for n in CHANGED}
        chain = replace(alone.chain.take(np.zeros(len(runs), dtype=int)), **numbers)
        longest = max(b.duration for b in own)
        made.append(Batch(chain, tuple(runs), alone.interval, longest, gauges))
    runs = tuple(one.runs[0] for one in imagined)
    return replace(imagined[0], runs=runs, batches=tuple(made))


def _kind(change):
    return "sensors" if change.key.startswith("sensors.") else change.key


def _last(experiment):
    """The batch of the last run with traces, and the place of that run in it."""
    batch = next(b for b in experiment.batches if experiment.runs[b.runs[0]].has_signals)
    return batch, len(batch.runs) - 1


def _offers(experiment, batch, lane) -> Iterator[Change]:
    chain = batch.chain.take([lane])
    speed = float(chain.speed[0])
    can = means(experiment, chain)
    for value in can.speeds:
        yield Change("striker.speed_m_s", round(value, 4), _struck_at(value), faster=value / speed)
    for mass in can.masses:
        # The contact keeps its radius, so that a ball keeps its size.
        if likely_ball(mass, float(np.max(chain.striker_radius))):
            yield Change("striker.mass_g", round(mass * 1e3, 4), _with("striker_mass", mass))
    for force in can.preloads:
        yield Change("chain.static_force_N", float(force), _with("static_force", force))
    if can.turned:
        upright = bool(chain.gravity[0] > 0.0)
        turned = _with("gravity", 0.0 if upright else GRAVITY)
        yield Change("chain.orientation", "horizontal" if upright else "vertical", turned)
    embedded = [k for k, g in enumerate(experiment.gauges) if g.kind == "embedded"]
    for bead in can.beads if embedded else ():
        gauge = experiment.gauges[embedded[0]]
        if bead != gauge.bead:
            moved = [replace(g, bead=bead) if g is gauge else g for g in experiment.gauges]
            yield Change(f"sensors.{gauge.id}.bead", bead, gauges=tuple(moved))


def _struck_at(value):
    return lambda chain: chain.struck_at(np.full_like(chain.speed, value))


def _with(name, value):
    return lambda chain: replace(chain, **{name: np.full_like(getattr(chain, name), value)})


def _imagined(experiment, *made: Change) -> tuple[dict, Experiment]:
    """What is changed, and the experiment of that one run; slower pulses are watched for longer."""
    batch, lane = _last(experiment)
    run, chain, faster = experiment.runs[batch.runs[lane]], batch.chain.take([lane]), 1.0
    gauges = experiment.gauges
    for one in made:
        chain, faster = one.chain(chain), faster * one.faster
        gauges = one.gauges or gauges
    longer = max(1.0, faster**-0.2)
    step = run.interval
    samples = int(len(run.time) * longer)
    time = run.time[0] + step * np.arange(samples)
    data = RunData("next", time, np.zeros((len(gauges), samples)), (), run.speed_rel_sigma)
    new = Batch(chain, (0,), batch.interval, batch.duration + step * (samples - len(run.time)))
    parts = {"runs": (data,), "batches": (new,), "gauges": gauges, "smooth": None, "slow": None}
    return {one.key: one.value for one in made}, replace(experiment, **parts)
