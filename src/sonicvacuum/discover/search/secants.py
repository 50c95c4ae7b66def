"""Starts for effects that sit at one body: finite strengths tried everywhere, judged after projection.

In a chain without preload a slightly lighter bead does not do the opposite of a slightly heavier one, so that
slopes at off mislead even for small strengths. A finite change Δ of the data gains 2 b − G, with b its score
and G its squared length once the model's own columns are projected out.
"""

from dataclasses import dataclass

import numpy as np

from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.parameters import coordinate
from sonicvacuum.discover.search import directions as ways
from sonicvacuum.discover.search import screen
from sonicvacuum.discover.search.directions import Direction, Family
from sonicvacuum.effects import Effect, Setup

RATIOS = (0.01, 0.03, 0.08, 0.2, 0.5)
STRENGTHS = (0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
PLACES = ("bead", "contact")


def applies(effect: Effect) -> bool:
    """Whether an effect is tried at finite strength: those at one bead or contact, and those that say so."""
    return effect.places in PLACES or any(p.tried_at_once for p in effect.parameters)


@dataclass(frozen=True)
class Secant:
    """One trial: place and coordinate of the strength, the χ² it should gain, and the nuisances that
    follow.
    """

    place: int | None
    u: float
    gain: float
    nu: np.ndarray


def search(
    forward: Forward, fit: Fit, effect: Effect, setup: Setup, most: int = 5, sparse: bool = False
) -> list[Secant]:
    """The most promising trials of an effect beside a fitted model, best first; none where none are needed.

    `sparse`: every other strength.
    """
    if not applies(effect):
        return []
    places = effect.candidates(setup) if effect.places else (None,)
    c = coordinate(_strength(effect), setup)
    ratios, strengths = RATIOS[sparse :: 1 + sparse], STRENGTHS[sparse :: 1 + sparse]
    sizes = np.array([*ratios, *(-r for r in ratios)]) if c.two_sided else np.log(strengths)
    trials = [(place, float(u)) for place in places for u in sizes if c.low < u < c.high]
    if not trials:
        return []
    seen = _screened(forward, fit, effect, c, trials)
    gain = 2.0 * seen.projected[0] - np.diag(seen.projected[1])
    order = np.argsort(-gain, kind="stable")[:most]
    return [Secant(*trials[k], float(gain[k]), seen.moved(k, 1.0)[1]) for k in order]


def _strength(effect):
    """The parameter that is tried."""
    switches = [p for p in effect.parameters if p.switches]
    return next((p for p in switches if p.tried_at_once), switches[0])


def _screened(forward, fit, effect, c, trials):
    """The screen whose directions are the finite changes themselves."""
    where = np.array([t[0] for t in trials])
    values = np.asarray(c.value(np.array([t[1] for t in trials])))

    def change(setup, index, strengths):
        off = c.parameter.off_in(setup)
        value = np.where(strengths > 0.0, values[index], off)
        place = {effect.places: where[index]} if effect.places else {}
        return effect.apply(setup, **{c.parameter.name: value, **place})

    family = Family(tuple(Direction(effect.id, c.parameter.name, place=p) for p, _ in trials), change)
    base = forward.columns(fit.hypothesis, fit.u[None], fit.nu[None], precise=True)
    columns = ways.finite(forward, fit.hypothesis, fit.u, fit.nu, family)
    return screen.from_columns(forward, fit, family.directions, base, columns)
