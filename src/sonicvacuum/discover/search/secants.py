"""Starts of finite strength: an effect tried all over its range beside a model, judged after projection.

In a chain without preload a slightly lighter bead does not do the opposite of a slightly heavier one, so that
slopes at off mislead even for small strengths; of a strong effect they tell little in any chain. A finite
change Δ of the data gains 2 b − G, with b its score and G its squared length once the model's own columns are
projected out. What a law of damping changes grows nearly as its strength does: between the strengths tried it
gains b²/G. As tried they would be ranked by how near each comes to one of these by chance.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, of_one_strength, variants
from sonicvacuum.discover.model.parameters import Coordinate, shape_grid
from sonicvacuum.discover.search import directions as ways
from sonicvacuum.discover.search import screen
from sonicvacuum.discover.search.directions import Direction, Family
from sonicvacuum.effects import Effect, Setup

RATIOS = (0.01, 0.03, 0.08, 0.2, 0.5)
STRENGTHS = (0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
# The same where what was found leaves much, and no start may be missed.
FINE_RATIOS, FINE_STRENGTHS = np.geomspace(0.005, 0.8, 10), np.geomspace(0.01, 30.0, 16)
PLACES = ("bead", "contact")
# Halfway from one strength to the next in the logarithm.
HALFWAY = 10.0**0.25


def applies(effect: Effect) -> bool:
    """Whether slopes mislead at any strength: effects at one bead or contact, and those that say so."""
    return effect.places in PLACES or any(p.tried_at_once for p in effect.parameters)


def local(effect: Effect) -> bool:
    """Whether an effect sits at one bead, contact or gauge; one of a material acts all along the chain."""
    return effect.places not in (None, "material")


@dataclass(frozen=True)
class Secant:
    """One trial.

    Attributes:
        free: names of the parameters that are free, the strength first.
        place: where the effect sits, None where it has no place.
        u: (free,) its coordinates.
        gain: the χ² that it should gain.
        beside: (p,) coordinates of the model it is tried beside, as they follow.
        nu: (q,) nuisances, as they follow.
    """

    free: tuple[str, ...]
    place: int | None
    u: np.ndarray
    gain: float
    beside: np.ndarray
    nu: np.ndarray


def search(
    forward: Forward, fit: Fit, effect: Effect, setup: Setup, most: int = 5, sparse: bool = False
) -> list[Secant]:
    """The most promising trials of an effect beside a fitted model, best first; none where slopes do.

    `sparse`: every other strength.
    """
    if not applies(effect):
        return []
    options = list(filter(of_one_strength, variants(effect, setup)))
    free = next((v for v in options if v[0].parameter.tried_at_once), options[0])
    return tried(forward, fit, Component(effect, free), setup, most, coarsely(free[0], sparse))


def tried(
    forward: Forward,
    fit: Fit,
    component: Component,
    setup: Setup,
    most: int,
    sizes: np.ndarray,
    places: Sequence[int] | None = None,
) -> list[Secant]:
    """The most promising trials of any effect with one strength, its shapes and places included.

    `sizes` (n,) are coordinates of the strength, see `coarsely` and `finely`; `places` are all that the
    effect may have, unless given.
    """
    free = component.free
    rows = places_and_sizes(component, setup, sizes, places)
    if not rows:
        return []
    directions, columns = changes(forward, fit, component, rows)
    base = forward.columns(fit.hypothesis, fit.u[None], fit.nu[None], precise=True)
    seen = screen.from_columns(forward, fit, directions, base, columns)
    score, squared = seen.projected[0], np.diag(seen.projected[1])
    share = _shares(component, score, squared)
    gain = share * (2.0 * score - share * squared)
    order = np.argsort(-gain, kind="stable")[:most]
    names = tuple(c.parameter.name for c in free)
    ends = [(rows[k][0], scaled(free[0], rows[k][1], share[k])) for k in order]
    return [
        Secant(names, *end, float(gain[k]), *seen.moved(k, share[k]))
        for k, end in zip(order, ends, strict=True)
    ]


def components(setup: Setup, present: Sequence[str]) -> list[Component]:
    """Every effect of the catalogue but those present, once for each of its strengths."""
    return [
        Component(effect, free)
        for effect in setup.catalogue.candidates(setup, present)
        for free in filter(of_one_strength, variants(effect, setup))
    ]


def places_and_sizes(
    component: Component, setup: Setup, sizes: np.ndarray, places: Sequence[int] | None = None
) -> list[tuple[int | None, np.ndarray]]:
    """Places and coordinates at which an effect is tried, its shapes included; see `tried`."""
    effect, free = component.effect, component.free
    if places is None:
        places = effect.candidates(setup) if effect.places else (None,)
    return [
        (place, u)
        for place in places
        for shape in shape_grid(effect)
        for size in sizes
        if _inside(free, u := np.array([size, *(c.inverse(shape[c.parameter.name]) for c in free[1:])]))
    ]


def _shares(component: Component, score, squared) -> np.ndarray:
    """(n,) what each change is taken times, no farther than halfway to the next strength; 1 of effects that
    do not damp.
    """
    if not (component.effect.dissipative and component.free[0].endless):
        return np.ones(len(score))
    best = np.divide(score, squared, out=np.ones(len(score)), where=squared > 0.0)
    return best.clip(1.0 / HALFWAY, HALFWAY)


def scaled(strength: Coordinate, u: np.ndarray, share: float) -> np.ndarray:
    """Coordinates of an effect with so many times its strength, the first of them."""
    if share == 1.0:
        return u
    moved = u[0] + np.log(share) if strength.endless else u[0] * share
    return np.array([np.clip(moved, strength.low, strength.high), *u[1:]])


def one_a_place(trials: Sequence[Secant]) -> list[Secant]:
    """The best trial of each place, best first."""
    best = {t.place: t for t in sorted(trials, key=lambda t: t.gain)}
    return sorted(best.values(), key=lambda t: -t.gain)


def coarsely(c: Coordinate, sparse: bool = False) -> np.ndarray:
    """Coordinates of a strength at which it is tried."""
    step = 1 + sparse
    return _sizes(c, np.array(RATIOS[sparse::step]), np.array(STRENGTHS[sparse::step]))


def finely(c: Coordinate) -> np.ndarray:
    """The same where no start may be missed."""
    return _sizes(c, FINE_RATIOS, FINE_STRENGTHS)


def _sizes(c, ratios, strengths):
    if c.endless:
        return np.log(strengths)
    steps = ratios if c.kind == "ratio" else strengths
    return np.concatenate([steps, -steps]) if c.two_sided else steps * (1.0 if c.high > 0.0 else -1.0)


def _inside(free, u) -> bool:
    shapes = all(c.low <= x <= c.high for c, x in zip(free[1:], u[1:], strict=True))
    return shapes and free[0].low < u[0] < free[0].high


def changes(
    forward: Forward, fit: Fit, component: Component, rows: Sequence[tuple[int | None, np.ndarray]]
) -> tuple[tuple[Direction, ...], list[np.ndarray]]:
    """A direction for each trial, and for each run the changes (n, M) of the whitened data that the trials
    make beside a fit.
    """
    effect, free = component.effect, component.free
    where = np.array([place for place, _ in rows])
    values = {c.parameter.name: c.value(np.array([u[k] for _, u in rows])) for k, c in enumerate(free)}
    strength = free[0].parameter

    def change(setup, index, strengths):
        given = {name: value[index] for name, value in values.items()}
        off = strength.off_in(setup)
        given[strength.name] = np.where(strengths > 0.0, given[strength.name], off)
        if effect.places:
            given[effect.places] = where[index]
        return effect.apply(setup, **given)

    family = Family(tuple(Direction(effect.id, strength.name, place=p) for p, _ in rows), change)
    return family.directions, ways.finite(forward, fit.hypothesis, fit.u, fit.nu, family)
