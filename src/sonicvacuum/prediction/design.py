"""Where to put how many gauges, and which runs to make, so that named effects can be told apart.

Everything is simulated beforehand: each effect in turn is the truth, at a part of its typical strength, and
every other one, or none, has to follow it with its own parameters and with what a laboratory does not know
exactly (speeds, time zeros, gains, modulus). What it cannot follow, in standard errors, is how well the two
are told apart: √χ² of `discover.next_experiment.separations`, for all sets of gauges and runs at once, since
χ² adds up over gauges and runs before the unknowns are taken out (Box & Hill, Technometrics 9, 57, 1967).
"""

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from numbers import Integral, Real

import numpy as np

from sonicvacuum.discover.model.experiment import Batch, Experiment, RunData
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis
from sonicvacuum.discover.model.parameters import coordinate
from sonicvacuum.effects import CATALOGUE, Effect, Setup
from sonicvacuum.files import InputError
from sonicvacuum.laboratory.next_run import FASTEST, SLOWEST
from sonicvacuum.materials import MODULUS_REL_SIGMA
from sonicvacuum.physics.scales import COUNTING, passage_of, sampling_of
from sonicvacuum.prediction.setup import card_of, check_beads, check_size
from sonicvacuum.simulation import set_up

NONE = "none"
# What is told apart with so many standard errors counts as told apart.
TARGET = 5.0
# How far an effect is from off, over its typical deviation.
STRENGTH = 0.3
# Crossings of the chain in a record that ends when the slowest pulse is at the wall.
_TO_WALL = 0.9
# Speeds that are tried, of the one given.
SPEEDS = (0.5, 1.0, 2.0)
# Standard errors that a record of a good laboratory states: relative noise, gains, speeds, time zeros in s.
NOISE, GAIN, SPEED, TRIGGER_S = 0.01, 0.03, 0.01, 1e-6


@dataclass(frozen=True)
class Layout:
    """One choice of gauges and runs.

    Attributes:
        gauges: beads, as texts, and `wall`.
        speeds_m_s: of the striker, one for each run.
        apart: (truth, rival) → standard errors by which the two differ.
    """

    gauges: tuple[str, ...]
    speeds_m_s: tuple[float, ...]
    apart: dict[tuple[str, str], float]

    @property
    def least(self) -> float:
        """The separation of the pair that is told apart worst."""
        return min(self.apart.values())


@dataclass(frozen=True)
class Design:
    """What to build.

    Attributes:
        effects: that are to be told apart, and from none.
        beads: number of beads.
        advised: the least choice that tells all apart, or the best there is.
        enough: whether it does.
        best: for each number of gauges the best choice with one run, then with two.
        single: gauge → least separation with it alone, in the run at the given speed.
    """

    effects: tuple[str, ...]
    beads: int
    advised: Layout
    enough: bool
    best: tuple[Layout, ...]
    single: dict[str, float]


def design(
    *,
    effects: str | Iterable[str],
    beads: int,
    diameter: str | float,
    material: str,
    speed: str | float,
    gauges: str | Sequence[int | str] | None = None,
    most: int = 3,
    strength: float = STRENGTH,
    noise: float = NOISE,
    echo: bool = True,
    **chain: str | float | None,
) -> Design:
    """Where to put how many gauges and which runs to make, to tell effects apart and from none.

    Args:
        effects: ids of the catalogue, as `sensor-droop,kuwabara-kono` or a list; one is told from none.
        beads: as in `predict`.
        diameter: as in `predict`.
        material: as in `predict`.
        speed: as in `predict`.
        gauges: places that can be had; by default five beads along the chain and the wall.
        most: the largest number of gauges.
        strength: how strong the effects are, in their typical deviations (`sonicvacuum effects`).
        noise: of one sample, over the largest reading of the gauge that reads most.
        echo: whether the record goes on until the wall's reflection has passed every gauge; without, it
            ends when the slowest pulse is at the wall.
        **chain: what else `predict` takes: mass, coating, core, wall, orientation, preload, striker and its
            mass, diameter, material.

    Returns:
        The gauges and runs that tell the effects apart, and by how many standard errors (`single`: gauge by
        gauge).

    Raises:
        InputError: naming the argument, its value and the cure.

    Examples:
        >>> import sonicvacuum as sv
        >>> steel = {"beads": 8, "diameter": "5mm", "material": "bearing-steel"}
        >>> found = sv.design(effects="wall-compliance", **steel, speed=0.5, echo=False)
        >>> max(found.single, key=found.single.get)
        '7'
    """
    _check(most, strength, noise)
    check_beads(beads)
    places = _places(beads) if gauges is None else gauges
    asked = dict.fromkeys(_OPTIONS) | {"orientation": "horizontal", "striker": "sphere"} | chain
    if unknown := set(chain) - set(_OPTIONS):
        raise InputError(f"{min(unknown)}: design takes no such argument; known are {', '.join(_OPTIONS)}")
    card = card_of(
        beads=beads, diameter=diameter, material=material, speed=speed, gauges=places, aim=None, **asked
    )
    check_size(card, "fewer beads")
    own = card.striker.speeds_m_s[0]
    speeds = [own * factor for factor in SPEEDS if SLOWEST <= own * factor <= FASTEST]
    setup = set_up(card, np.array(speeds))
    wanted = _effects(effects, setup)
    forward = Forward(_experiment(card, setup, speeds, noise, COUNTING if echo else _TO_WALL))
    blocks = _Blocks(forward, wanted, strength)
    return _advice(blocks, [g.id for g in setup.sensors], speeds, speeds.index(own), most, beads)


_OPTIONS = (
    *("mass", "coating", "core", "wall", "orientation", "preload"),
    *("striker", "striker_mass", "striker_diameter", "striker_material"),
)


def _check(most, strength, noise):
    if not (isinstance(most, Integral) and 1 <= most <= 4):
        raise InputError(f"most: is {most!r:.100}; from 1 to 4 gauges are tried, write a whole number")
    for name, value, high in (("strength", strength, 10.0), ("noise", noise, 1.0)):
        if not (isinstance(value, Real) and 0.0 < value <= high):
            raise InputError(f"{name}: is {value!r:.100}; it must be a positive number, at most {high:g}")


def _places(beads):
    """Five beads along the chain, and the wall."""
    inside = {max(1, round(part * beads)) for part in (0.15, 0.35, 0.5, 0.65, 0.85)}
    return [*sorted(inside), "wall"]


def _effects(given, setup: Setup) -> tuple[Effect, ...]:
    if not isinstance(given, Iterable):
        raise InputError(
            f"effects: is {given!r:.100}; write ids of the catalogue, as in 'sensor-droop,tsuji'"
        )
    names = given.split(",") if isinstance(given, str) else list(given)
    names = list(dict.fromkeys(str(name).strip() for name in names))
    if not names:
        raise InputError("effects: none is given; name one to tell from none, or several")
    lacking = CATALOGUE.left_out(setup)
    for name in names:
        if name not in CATALOGUE:
            raise InputError(f"effects: {name!r} is not in the catalogue; {CATALOGUE.meant(name, own=False)}")
        if name in lacking:
            raise InputError(f"effects: {name} cannot be in this chain: {lacking[name]}; leave it out")
    return tuple(CATALOGUE.effect(name) for name in names)


def _experiment(card, setup: Setup, speeds, noise, crossings) -> Experiment:
    """A data set without data: one run for each speed, all gauges in place, noise as stated."""
    chain, gauges = setup.chain, setup.sensors
    interval, duration = sampling_of(chain), passage_of(chain, crossings)
    time = interval * np.arange(int(duration / interval))
    runs = [RunData(f"{v:g}", time, np.zeros((len(gauges), len(time))), (), SPEED) for v in speeds]
    count = len(gauges)
    empty = Experiment(
        "design",
        tuple(runs),
        (Batch(chain, tuple(range(len(runs))), interval, duration),),
        gauges,
        np.ones(count),
        np.zeros(count),
        np.full(count, GAIN),
        TRIGGER_S,
        MODULUS_REL_SIGMA,
        card.specimen.diameters,
    )
    return _with_noise(empty, noise)


def _with_noise(empty: Experiment, noise) -> Experiment:
    """Noise of each gauge: a share of the largest reading in its unit, in the run that is struck hardest."""
    seen = Forward(empty).columns(Hypothesis(), np.zeros((1, 0)), np.zeros(Forward(empty).layout.size))
    largest = np.max([run[0, 0].reshape(len(empty.gauges), -1).max(axis=1) for run in seen], axis=0)
    units = [g.unit for g in empty.gauges]
    tops = [max(v for v, u in zip(largest, units, strict=True) if u == unit) for unit in units]
    return replace(empty, sigma=noise * np.array(tops))


class _Blocks:
    """Sums of squares of each pair, gauge by gauge and run by run, from which any choice is added up."""

    def __init__(self, forward: Forward, effects: tuple[Effect, ...], strength: float):
        self.forward, self.names = forward, tuple(e.id for e in effects)
        experiment = forward.experiment
        self.gauges, self.runs = len(experiment.gauges), len(experiment.runs)
        setup = forward.nominal(experiment.batches[0], np.zeros((1, forward.layout.size)))
        zero = np.zeros(forward.layout.size)
        nominal = forward.columns(Hypothesis(), np.zeros((1, 0)), zero)
        seen = {e.id: _seen(forward, e, setup, strength, zero) for e in effects}
        # Against none a name has to move the data; against another, to move them otherwise.
        truths = {
            name: [c[0, 0] - n[0, 0] for c, n in zip(seen[name], nominal, strict=True)] for name in seen
        }
        rivals = {
            name: [_columns(c[0], n[0]) for c, n in zip(seen[name], nominal, strict=True)] for name in seen
        }
        rivals[NONE] = [n[0, 1:] for n in nominal]
        self.pairs = {
            (truth, rival): [self._grams(truths[truth][r], rivals[rival][r], r) for r in range(self.runs)]
            for truth, rival in itertools.product(truths, rivals)
            if truth != rival
        }

    def _grams(self, truth, columns, run):
        """(gauges, n, n) products of truth and columns, in places that all runs share."""
        free = len(columns) - (3 + self.gauges)  # modulus, speed, time zero, gains
        size = 1 + free + 1 + 2 * self.runs + self.gauges
        own = [0, *range(1, 2 + free), 2 + free + run, 2 + free + self.runs + run]
        own += range(2 + free + 2 * self.runs, size)
        rows = np.vstack([truth, columns]).reshape(len(own), self.gauges, -1)
        grams = np.zeros((self.gauges, size, size))
        for g in range(self.gauges):
            grams[g][np.ix_(own, own)] = rows[:, g] @ rows[:, g].T
        return grams

    def apart(self, gauges, runs) -> dict[tuple[str, str], float]:
        """Standard errors between the pairs of effects with some gauges in some runs."""
        found = {}
        for pair, grams in self.pairs.items():
            total = sum(grams[r][list(gauges)].sum(axis=0) for r in runs)
            # Nuisances are known to one of their standard errors; parameters of the rival are free.
            free = len(total) - 1 - (1 + 2 * self.runs + self.gauges)
            prior = np.diag([0.0] * free + [1.0] * (len(total) - 1 - free))
            cross = total[0, 1:]
            followed = cross @ np.linalg.lstsq(total[1:, 1:] + prior, cross, rcond=1e-12)[0]
            found[pair] = math.sqrt(max(float(total[0, 0] - followed), 0.0))
        return found


def _seen(forward, effect, setup, strength, zero):
    """Columns of every run with an effect at its strength."""
    free = tuple(coordinate(p, setup) for p in effect.parameters)
    component = Component(effect, free, place=_place(effect, setup))
    values = [float(np.ravel(c.parameter.at(strength, setup))[0]) for c in free]
    u = np.array([[c.inverse(v) for c, v in zip(free, values, strict=True)]])
    return forward.columns(Hypothesis((component,)), u, zero)


def _place(effect, setup):
    """Where an effect sits that has a place: the first gauge, the middle bead, the contact behind which half
    the beads are; None for one without.
    """
    possible = effect.candidates(setup)
    if not possible:
        return None
    middle = len(possible) // 2
    return possible[{"sensor": 0, "contact": max(0, middle - 1)}.get(effect.places, middle)]


def _columns(with_effect, nominal):
    """What a rival can do: be there more or less, change its parameters, and the nuisances."""
    return np.vstack([with_effect[:1] - nominal[:1], with_effect[1:]])


def _advice(blocks, names, speeds, own, most, beads) -> Design:
    def layout(gauges, runs):
        chosen = tuple(names[g] for g in gauges), tuple(speeds[r] for r in runs)
        return Layout(*chosen, blocks.apart(gauges, runs))

    counts = range(1, min(most, len(names)) + 1)
    sets = [list(itertools.combinations(range(len(names)), n)) for n in counts]
    runs = {1: [(own,)], 2: [(own, r) for r in range(len(speeds)) if r != own]}
    best = []
    for gauges in sets:
        for made in (1, 2):
            tried = [layout(g, r) for g in gauges for r in runs[made]]
            best += [max(tried, key=lambda one: one.least)] if tried else []
    single = {names[g]: layout((g,), (own,)).least for g in range(len(names))}
    enough = [one for one in best if one.least >= TARGET]
    advised = enough[0] if enough else max(best, key=lambda one: one.least)
    return Design(blocks.names, beads, advised, bool(enough), tuple(best), single)
