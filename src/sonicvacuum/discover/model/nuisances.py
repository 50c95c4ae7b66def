"""What a laboratory does not know exactly, and what is no effect: nuisances, each with its standard error.

Every run has the speed of its striker and its time zero, every gauge its gain, the beads their modulus; these
always have a place. Besides, a record may leave open what all runs share (`Shared`): the modulus of every
other material, masses and sizes of all beads or of the striker, the speed of all runs and the gain of all
gauges together, the recorder's clock, the delay of a channel, an error that several observables have in
common. A nuisance is a natural logarithm of a ratio, or a time, in units of its standard error, so that its
Gaussian prior is N(0, 1); an error of 0 means exact, and costs nothing. Baseline and drift act linearly on
the readings, and are marginalised as noise (`slow`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from sonicvacuum.effects.coating_thickness import TERM as LAYER
from sonicvacuum.effects.free_form import TERM
from sonicvacuum.physics.chain import Chain
from sonicvacuum.records.record import Record, Tolerances

# Where a record does not say. Bodies are weighed and measured, and their sizes are what the record is about:
# a tolerance is the user's to state. A common error of the speeds or of the gains is part of the single ones,
# which the record states, unless it says that there is one.
DEFAULTS = Tolerances(
    bead_mass_rel=0.0,
    bead_diameter_rel=0.0,
    coating_rel=0.0,
    # A spring or a weight over a pulley is set rather than weighed, and no effect makes a preload less.
    static_force_rel=0.02,
    striker_mass_rel=0.0,
    speed_common_rel=0.0,
    gain_common_rel=0.0,
)
# A material whose modulus nobody stated an error of counts only if that error moves the stiffness of one of
# its contacts by more than this: steel between polymers does not, but before a wall of steel it does.
NEGLIGIBLE = 3e-3


# The kind of those that say how single beads differ in mass.
SCATTER = "bead-scatter"
# Kind of `Shared` → what it is, in words, where its name does not say.
WORDS = {
    "bead-mass": "mass of the beads",
    "bead-diameter": "diameter of the beads",
    SCATTER: "masses of single beads",
    "coating": "thickness of the coating",
    "static-force": "static force on the chain",
    "striker-mass": "mass of the striker",
    "speed-common": "speed of the striker, common to all runs",
    "gain-common": "calibration common to all gauges",
}


@dataclass(frozen=True)
class Shared:
    """One nuisance that all runs share.

    Attributes:
        kind: "modulus", "bead-mass", "bead-diameter", "bead-scatter", "coating", "static-force",
            "striker-mass", "speed-common", "gain-common", "clock", "delay", "shared" or "law".
        sigma: standard error: of the natural logarithm, of the clock's relative error, in s for delays; of a
            coefficient of the free-form law its prior width; 1 for an error that observables share, whose
            size stands with each of them.
        of: the material of a modulus, the gauge of a delay, the name of a shared error or of a coefficient.
        gauge: index of that gauge.
        weights: of single beads' masses, the first bead's first (`scatter`).
    """

    kind: str
    sigma: float
    of: str = ""
    gauge: int | None = None
    weights: tuple[float, ...] = ()

    @property
    def simulated(self) -> bool:
        """Whether it needs a simulation of its own; the common speed takes that of the single ones, and
        beads that weigh as stated take none.
        """
        empty = self.kind == SCATTER and not any(self.weights)
        return self.acts and self.kind != "speed-common" and not empty

    @property
    def acts(self) -> bool:
        """Whether it acts on the chain itself."""
        return self.kind == SCATTER or self.kind in CHANGES

    def change(self, chain: Chain, ratio) -> Chain:
        """The chains with the nuisance at a ratio (lanes,); as they are, where it acts on readings only."""
        if self.kind == SCATTER:
            return _unequal(chain, self.weights, ratio)
        return CHANGES[self.kind](chain, self.of, ratio) if self.kind in CHANGES else chain


def _heavier(chain, _, ratio):
    return replace(chain, bodies=chain.bodies.replaced(lambda b: replace(b, mass=b.mass * ratio)))


def _unequal(chain, weights, ratio):
    for bead, weight in enumerate(weights[: chain.beads], start=1):
        if weight and np.any(ratio != 1.0):
            chain = chain.with_defect("mass", bead, ratio**weight)
    return chain


def _larger(chain, _, ratio):
    return replace(chain, bodies=chain.bodies.replaced(lambda b: replace(b, radius=b.radius * ratio)))


def _thicker(chain, _, ratio):
    """The layer that acts in the contacts; a coating that does not act as one has no thickness to a chain."""
    own = [
        replace(a, parameters={name: value * ratio for name, value in a.parameters.items()})
        if a.term == LAYER
        else a
        for a in chain.actions
    ]
    return replace(chain, actions=tuple(own))


def _shaped(chain, name, ratio):
    """One coefficient of the free-form law; as a nuisance, that is a logarithm."""
    own = [
        replace(a, parameters={**a.parameters, name: np.log(ratio)}) for a in chain.actions if a.term == TERM
    ]
    return replace(chain, actions=(*(a for a in chain.actions if a.term != TERM), *own))


# Kind → (chains, material, ratio (lanes,)) → chains, for those that act on the chain itself.
CHANGES: dict[str, Callable] = {
    "modulus": lambda chain, name, ratio: chain.stiffened(name, ratio),
    "bead-mass": _heavier,
    "bead-diameter": _larger,
    "coating": _thicker,
    "static-force": lambda chain, _, ratio: replace(chain, static_force=chain.static_force * ratio),
    "striker-mass": lambda chain, _, ratio: replace(chain, striker_mass=chain.striker_mass * ratio),
    "speed-common": lambda chain, _, ratio: chain.struck_at(chain.speed * ratio),
    "law": _shaped,
}


@dataclass(frozen=True)
class Layout:
    """Where the nuisances stand in a vector of them: speeds, triggers, gains, modulus, others."""

    runs: int
    gauges: int
    others: tuple[Shared, ...] = ()

    @property
    def size(self) -> int:
        """Number of nuisances."""
        return 2 * self.runs + self.gauges + 1 + len(self.others)

    def speed(self, run):
        """Place of a run's speed."""
        return run

    def trigger(self, run):
        """Place of a run's trigger shift."""
        return self.runs + run

    @cached_property
    def gains(self) -> np.ndarray:
        """(S,) places of the gains."""
        return 2 * self.runs + np.arange(self.gauges)

    @property
    def modulus(self) -> int:
        """Place of the modulus."""
        return 2 * self.runs + self.gauges

    def other(self, kind: str) -> list[int]:
        """Places of the other shared ones of a kind."""
        return self._by_kind.get(kind, [])

    def named(self, place: int) -> str:
        """What the other shared one at a place is of."""
        return self.others[place - self.modulus - 1].of

    @cached_property
    def simulated(self) -> list[int]:
        """Places of those that take a simulation of their own each: moduli, masses, sizes."""
        own = [self.modulus + 1 + k for k, one in enumerate(self.others) if one.simulated]
        return [self.modulus, *own]

    @cached_property
    def scattered(self) -> list[int]:
        """Places of the directions in which beads may differ."""
        return [k for k in self.other(SCATTER) if k in self.simulated]

    @cached_property
    def empty(self) -> list[int]:
        """Places of those that change nothing."""
        return [k for k in self.other(SCATTER) if k not in self.simulated]

    @cached_property
    def of_chain(self) -> list[int]:
        """Places of the ratios of what the chain itself is, its striker's speeds among them."""
        own = [k for k, one in enumerate(self.others) if one.acts and one.kind != "law"]
        return [*range(self.runs), self.modulus, *(self.modulus + 1 + k for k in own)]

    @cached_property
    def _by_kind(self) -> dict[str, list[int]]:
        """Kind → places of the other shared ones."""
        found: dict[str, list[int]] = {}
        for place, one in enumerate(self.others, start=self.modulus + 1):
            found.setdefault(one.kind, []).append(place)
        return found

    @cached_property
    def shared(self) -> np.ndarray:
        """Places of what does not belong to one run, in the order in which they stand in `local`."""
        return np.array([self.modulus, *self.gains, *range(self.modulus + 1, self.size)])

    def local(self, run) -> np.ndarray:
        """(S + 3 + others,) places of the nuisances that touch one run: modulus, speed, trigger, gains,
        others.
        """
        return self._local[run]

    @cached_property
    def _local(self) -> list[np.ndarray]:
        """The same of all runs, which searches ask for all the time."""
        modulus, others = self.shared[:1], self.shared[1:]
        own = [[self.speed(run), self.trigger(run)] for run in range(self.runs)]
        return [np.concatenate([modulus, speeds, others]) for speeds in own]


def shared(record: Record, chains: Sequence[Chain]) -> tuple[Shared, ...]:
    """What the runs of a record share besides the beads' modulus and the gains; nothing that is exact.

    `chains` are its nominal chains: of each, strikers of one kind.
    """
    given, default, chain = record.tolerances, DEFAULTS, chains[0]
    pressed = any(np.any(one.static_force > 0.0) for one in chains)

    def tolerance(name):
        stated = getattr(given, name)
        return getattr(default, name) if stated is None else stated

    found = [
        *(Shared("modulus", sigma, name) for name, sigma in _moduli(record, chains).items()),
        *(Shared(kind, tolerance(kind.replace("-", "_") + "_rel")) for kind in _BODIES),
        *(Shared("coating", tolerance("coating_rel")) for a in chain.actions if a.term == LAYER),
        Shared("static-force", tolerance("static_force_rel") if pressed else 0.0),
        Shared("speed-common", tolerance("speed_common_rel")),
        Shared("gain-common", tolerance("gain_common_rel")),
        Shared("clock", record.clock_rel_sigma),
        *(Shared("delay", g.delay_sigma_s, g.id, k) for k, g in enumerate(record.gauges)),
        *(Shared("shared", 1.0, source) for source in _sources(record)),
    ]
    ball = ("bead-mass", "bead-diameter") if record.beads == 0 else ()
    return tuple(one for one in found if one.sigma > 0.0 and one.kind not in ball)


def _sources(record: Record) -> list[str]:
    """Errors that observables share, in the order of the record; one of size 0 is none."""
    observables = [o for run in record.runs for o in run.observables]
    return list(dict.fromkeys(s for o in observables for s, size in o.shared.items() if size > 0.0))


_BODIES = ("bead-mass", "bead-diameter", "striker-mass")
_SAID = {
    "bead-mass": "the beads' mass",
    "bead-diameter": "the beads' diameter",
    "striker-mass": "the striker's mass",
}


def exact(record: Record, given: tuple[Shared, ...]) -> str:
    """What of the bodies counts as exactly known, in words; "" where nothing does.

    `given` are the data set's `shared` nuisances.
    """
    bodies = _BODIES if record.beads else ("striker-mass",)
    open_ = {one.kind for one in given}
    words = [_SAID[kind] for kind in bodies if kind not in open_]
    return f"{', '.join(words)}: taken as exact, no tolerance being stated" if words else ""


def assumed(record: Record, chains: Sequence[Chain]) -> str:
    """How well the moduli of what touches in some chains, and a static force on them, are taken to be known
    where the record states no error of them, in words; "" where it states all.
    """
    names = dict.fromkeys(s.surface.name for chain in chains for s in chain.solids)
    unstated = [name for name in names if record.modulus_rel_sigma(name) is None]
    taken = [f"{name} {100.0 * record.taken_modulus_rel_sigma(name):g} %" for name in unstated]
    said = [f"errors of moduli taken, none being stated: {', '.join(taken)}"] if taken else []
    force = any(np.any(one.static_force > 0.0) for one in chains)
    if force and record.tolerances.static_force_rel is None:
        said.append(f"error taken, none being stated: static force {100.0 * DEFAULTS.static_force_rel:g} %")
    return "; ".join(said)


def stated(record: Record, kind: str, of: str = "") -> bool:
    """Whether the record itself states the error of a nuisance of some kind: those of moduli and of a static
    force are taken where it does not.
    """
    if kind == "modulus":
        return record.modulus_rel_sigma(of) is not None
    return kind != "static-force" or record.tolerances.static_force_rel is not None


def _moduli(record, chains) -> dict[str, float]:
    """Material → standard error of its modulus, for materials that touch, the first bead's left aside.

    Materials of some strikers only come last, by name: which chain is the first is no matter of theirs.
    """
    chain, many = chains[0], [{s.surface.name: s.surface for s in one.solids} for one in chains]
    common = [name for name in many[0] if all(name in own for own in many)]
    known = {name: surface for own in many for name, surface in own.items()}
    surfaces = {name: known[name] for name in [*common, *sorted(known.keys() - set(common))]}
    cores = {s.core.name: s.core for s in chain.solids if s.core}
    first = chain.first.surface.name
    del surfaces[first]
    shares = _shares(chains)
    found = {}
    for name in surfaces | cores:
        unstated, error = record.modulus_rel_sigma(name) is None, record.taken_modulus_rel_sigma(name)
        if name == first or (unstated and name not in surfaces):
            continue
        if unstated and shares.get(name, 0.0) * error < NEGLIGIBLE:
            continue
        found[name] = error
    return found


def _shares(chains) -> dict[str, float]:
    """Material → d log K / d log E of that contact in which it has most of the compliance.

    Any bead may be the last: the number of beads may be a slip, and nuisances are the same with and without.
    """
    shares: dict[str, float] = {}
    for chain in chains:
        bodies, wall = chain.bodies, len(chain.solids) - 1
        inner = bodies.neighbours(chain.beads + len(bodies.pattern)) if chain.beads else ()
        ends = [(0, bodies.kind(1) + 1), *((k, wall) for k in range(1, wall))] if chain.beads else [(0, wall)]
        for i, j in {*ends, *((i + 1, j + 1) for i, j in inner)}:
            one, other = chain.solids[i].surface, chain.solids[j].surface
            near, far = ((1.0 - s.poisson**2) / float(np.ravel(s.modulus)[0]) for s in (one, other))
            for surface, part in ((one, near), (other, far)):
                share = 1.0 if one.name == other.name else part / (near + far)
                shares[surface.name] = max(share, shares.get(surface.name, 0.0))
    return shares
