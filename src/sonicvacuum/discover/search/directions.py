"""Small deviations from a model, one for each way in which it may lack something: what the screen projects
on.

A direction is an effect of the catalogue at a place and with a shape, at a strength small enough for the
readings to answer in proportion, and large enough to stand clear of numerical error.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.model.differences import changes, second
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.parameters import coordinate, shape_grid
from sonicvacuum.discover.model.slopes import among
from sonicvacuum.effects import Effect, Setup

# The change of all data, in standard errors, that is aimed at, and the strength (typical deviations) that
# about changes them by as much as they are: what comes nearest to the one is tried first.
AIM, TRIAL = 6.0, 2.0
WEAKEST, STRONGEST = 1e-5, 0.5
# So much less or more than what is aimed at will do; where a ranking or a test is all that is asked for.
NEAR, ROUGHLY = (0.3, 5.0), (0.1, 10.0)


@dataclass(frozen=True)
class Direction:
    """One column of the screen.

    Attributes:
        effect: id; of a direction outside the catalogue, the family it belongs to.
        strength: name of the parameter that departs from off.
        shape: values of the parameters that only shape.
        place: where it sits, None where it has no place.
        two_sided: whether it may depart either way.
        unit: typical deviation of the strength.
    """

    effect: str
    strength: str
    shape: tuple[tuple[str, float], ...] = ()
    place: int | None = None
    two_sided: bool = False
    unit: float = 1.0


@dataclass(frozen=True)
class Family:
    """Directions that are simulated in one call: their change is one function of strengths.

    Attributes:
        directions: K of them.
        change: (setup, lane index, (lanes,) strengths) → setup, lane k departing in direction k.
        trial: strength that about changes the data by as much as they are, for the first trial.
        least: smallest strength at which the change is what it is called (a gap opens at once).
        acts_like: the nuisance that the strength moves exactly as, see `effects.Parameter`; None for none.
    """

    directions: tuple[Direction, ...]
    change: Callable[[Setup, np.ndarray, np.ndarray], Setup]
    trial: float = TRIAL
    least: float = WEAKEST
    acts_like: str | None = None


def of_effect(effect: Effect, setup: Setup) -> list[Family]:
    """The families of one effect: one for each of its strengths, and of effects of one material for each of
    these: the modulus of one may be known exactly while that of another is a nuisance (`like_nuisance`).
    """
    places = effect.candidates(setup) if effect.places else (None,)
    groups = [(place,) for place in places] if effect.places == "material" else [places]
    families = []
    switches = [p for p in effect.parameters if p.switches]
    for strength, group in itertools.product(switches, groups):
        two_sided = coordinate(strength, setup).two_sided
        grid = [(place, shape) for place in group for shape in shape_grid(effect)]
        directions = tuple(
            Direction(effect.id, strength.name, tuple(shape.items()), place, two_sided, strength.scale)
            for place, shape in grid
        )
        if directions:
            least = max(strength.least_strength, WEAKEST)
            change = _change(effect, strength, grid)
            families.append(Family(directions, change, TRIAL, least, strength.acts_like))
    return families


def _change(effect, strength, grid):
    places = np.array([g[0] for g in grid])
    shapes = {name: np.array([g[1][name] for g in grid]) for name in grid[0][1]}

    def change(setup, index, strengths):
        given = {name: values[index] for name, values in shapes.items()}
        given[strength.name] = _at(strength, strengths, setup)
        if effect.places:
            given[effect.places] = places[index].astype(int)
        return effect.apply(setup, **given)

    return change


def _at(parameter, strength, setup):
    """`Parameter.at` for an array of positive strengths."""
    off = parameter.off_in(setup)
    if np.all(np.isinf(off)):
        with np.errstate(divide="ignore"):
            return parameter.scale / strength
    towards = np.where(off + parameter.scale > parameter.high, -1.0, 1.0)
    value = off + towards * strength * parameter.scale
    return np.clip(value, min(parameter.low, np.min(off)), max(parameter.high, np.max(off)))


def catalogue(setup: Setup, present: tuple[str, ...] = ()) -> list[Family]:
    """Families of all effects of the setup's catalogue that can act in it, but those in force."""
    return [family for e in setup.catalogue.candidates(setup, present) for family in of_effect(e, setup)]


def like_nuisance(forward: Forward, family: Family, base: list[np.ndarray], free: int):
    """Slopes of directions that act exactly as a nuisance does, from its column; None for all others.

    Differences of simulations would leave a trace of such a direction where nothing of it is left.
    """
    if family.acts_like is None or (forward.experiment.coupled and family.acts_like == "speed"):
        return None  # where runs are coupled, speeds of all of them move the data of each
    unit = family.directions[0].unit
    places = np.array([d.place or 0 for d in family.directions])
    found = [forward.slopes.nuisance_column(family.acts_like, run, places) for run in range(len(base))]
    if any(f is None for f in found):
        return None
    return [
        unit / sigma * columns[0, 1 + free + among(forward.local(run), places)]
        for run, (columns, (places, sigma)) in enumerate(zip(base, found, strict=True))
    ]


def simulate(forward: Forward, hypothesis: Hypothesis, u, nu, family: Family, rough: bool = False):
    """For each run, the slopes (K, M) of the whitened data with the strengths of a family; (K,) strengths
    used.

    `rough`: from one difference instead of two, enough for a ranking. Strengths that served a family before
    are where it starts.
    """
    what = ("slopes", family.directions, rough)
    return forward.memory.recalled(
        hypothesis, u, nu, what, lambda: _simulated(forward, hypothesis, u, nu, family, rough)
    )


def _simulated(forward, hypothesis, u, nu, family, rough):
    """The same, simulated."""
    count = len(family.directions)

    def sloped(strengths, some):
        """For each run the changes (K', M) with some directions, and their slopes."""
        both = strengths if rough else np.concatenate([strengths, 2.0 * strengths])
        once, slopes, each = [], [], len(some)
        values = _displaced(forward, hypothesis, u, nu, family, both, some)
        for value, run in zip(values, forward.experiment.runs, strict=True):
            change, over = changes(value[-1], value[:-1], len(run.scalars))
            once.append(change[:each])
            parts = once[-1], 0.5 * change[each:], over[:each], over[each:]
            slopes.append((once[-1] if rough else second(*parts)) / strengths[:, None])
        return once, slopes

    trial = forward.strengths.get(family.directions)
    if trial is None:
        first = family.trial * AIM / max(forward.norm, 1e-9)
        trial = np.full(count, np.clip(first, family.least, STRONGEST))
    once, slopes = sloped(trial, np.arange(count))
    size = np.sqrt(sum(np.square(c).sum(axis=1) for c in once))
    strengths = np.clip(trial * AIM / np.maximum(size, 1e-9), family.least, STRONGEST)
    less, more = ROUGHLY if rough else NEAR
    far = np.flatnonzero((more * strengths < trial) | (strengths * less > trial))
    near = trial.copy()
    near[far] = strengths[far]
    forward.strengths[family.directions] = near
    if len(far):
        for slope, again in zip(slopes, sloped(near[far], far)[1], strict=True):
            slope[far] = again
    for run, slope in enumerate(slopes):
        slope[:, forward.counts(run)] = 0.0
    return slopes, near


def finite(forward: Forward, hypothesis: Hypothesis, u, nu, family: Family, strengths=None, some=None):
    """For each run, the changes (n K, M) of the whitened data when each direction takes its strength.

    `strengths` are (n K,), one for each direction and then the next for each; None: (K,) of 1. `some` are the
    places (K,) of the directions in the family; None: all.
    """
    return [v[:-1] - v[-1] for v in _displaced(forward, hypothesis, u, nu, family, strengths, some)]


def _displaced(forward, hypothesis, u, nu, family, strengths, some):
    """For each run, the data (n K + 1, M) with each direction, and with none."""
    some = np.arange(len(family.directions)) if some is None else some
    strengths = np.append(np.ones(len(some)) if strengths is None else strengths, 0.0)
    lanes = len(strengths)
    which = np.append(np.resize(some, lanes - 1), some[-1])
    many_u, many_nu = np.repeat(u[None], lanes, axis=0), np.repeat(nu[None], lanes, axis=0)

    def change(setup, index):
        setup = hypothesis.change(many_u)(setup, index)
        return family.change(setup, which[index], strengths[index])

    return forward.sampled(hypothesis, many_u, many_nu, change=change)
