"""Where an effect sits, as far as the data tell: the same effects with one of them at another place.

A gap at one contact does nearly what a wider one does at the next, and few scalars may not tell the beads
of half a chain apart. Each place that may be is fitted from its neighbour's fit, on and on while one is
probable; what it weighs is its evidence (`evidence`), places being equally likely before. In a set the
strengths of an effect that has several may stand for one another as well (`strengths`); those of one effect
alone are weighed where it is fitted.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import evidence, places
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.judge.rivals import LEAST, Rival
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import strengths
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.effects import Effect, Setup

# Strengths tried at another place, over that of the neighbour: alike, or the other way round.
FACTORS = (0.6, 1.0, 1.6, -1.0)
KEEP, ITERATIONS = 4, 8
# What is this much behind in χ² weighs less than what rivals are left aside for.
BEHIND = -2.0 * np.log(LEAST)
# A place less probable than this beside the one that is told need not be said.
SURE = 0.95


def spread(forward: Forward, told: Fit, setup: Setup) -> list[Rival]:
    """What is told, first, and the same effects with one of them elsewhere, or of several with another of its
    strengths; their shares sum to 1.
    """
    fits = [told, *(strengths.others(forward, told, setup) if _of_several(told, setup) else ())]
    for k, component in enumerate(told.hypothesis.components):
        if component.effect.places:
            fits += _elsewhere(forward, told, setup, k)
    logs = np.array([_log_weight(told, one) for one in fits])
    shares = np.exp(logs - np.logaddexp.reduce(logs))
    return [Rival(float(p), one) for p, one in zip(shares, fits, strict=True) if one is told or p > LEAST]


def among(rivals: Sequence[Rival], forward: Forward, told: Fit) -> list[Rival]:
    """Rivals, what is told standing once for each of the places where its effects may sit, and of the
    strengths that one may have.
    """
    setup = setup_of(forward)
    if not (any(c.effect.places for c in told.hypothesis.components) or _of_several(told, setup)):
        return list(rivals)
    others = [r for r in rivals if not same(r.fit, told)]
    own = sum(r.probability for r in rivals if same(r.fit, told))
    sits = spread(forward, told, setup)
    return [*(replace(r, probability=r.probability * (own or 1.0)) for r in sits), *others]


def _of_several(told, setup):
    """Whether strengths may stand for one another in a set."""
    return len(told.hypothesis.components) > 1 and strengths.several(told, setup)


def same(one: Fit, other: Fit) -> bool:
    """Whether two fits are of the same effects with the same parameters free, wherever they sit."""
    return _what(one) == _what(other)


def _what(one):
    return {(c.effect.id, *(f.parameter.name for f in c.free)) for c in one.hypothesis.components}


def of_each(rivals: Iterable[Rival], told: Fit) -> list[tuple[Effect, np.ndarray, np.ndarray]]:
    """Each effect that has a place: places where it may sit, the told one first, and their shares."""
    own, result = [r for r in rivals if same(r.fit, told)], []
    for component in told.hypothesis.components:
        if component.effect.places:
            share = {component.place: 0.0}
            for r in own or [Rival(1.0, told)]:
                at = next(c.place for c in r.fit.hypothesis.components if c.effect.id == component.effect.id)
                share[at] = share.get(at, 0.0) + r.probability
            weight = np.array(list(share.values()))
            result.append((component.effect, np.array(list(share)), weight / weight.sum()))
    return result


def doubts(rivals: Sequence[Rival], told: Fit, e: Experiment) -> list[str]:
    """What is said of both: `unsure` and `instead`."""
    return [*unsure(rivals, told, e), *instead(rivals, told)]


def called(effect: Effect, place: int, e: Experiment) -> int | str:
    """What a place of an effect is called: name of a gauge or material, number of a bead or contact."""
    if effect.places == "material":
        return e.materials[place]
    return e.gauges[place].id if effect.places == "sensor" else place


def unsure(rivals: Iterable[Rival], told: Fit, e: Experiment) -> list[str]:
    """What is said of effects whose place the data leave open, a gauge or material by its name; of those of
    one material of several, of which it is.
    """
    lines = []
    for effect, at, share in of_each(rivals, told):
        sure, material = share[0] >= SURE, effect.places == "material"
        if material and sure:
            lines.append(f"{effect.id}: of {called(effect, at[0], e)}")
        if not sure:
            names = [called(effect, place, e) for place in at]
            order = [0, *(1 + np.argsort(-share[1:], kind="stable"))]
            likely = [f"{names[k]} ({share[k]:.2f})" for k in order if share[k] >= 0.005]
            where = "gauge" if effect.places == "sensor" else effect.places
            sits = ": of" if material else f" sits at {where}"
            lines.append(f"{effect.id}{sits} {' or '.join(likely)}")
    return lines


def instead(rivals: Iterable[Rival], told: Fit) -> list[str]:
    """What is said of what is told where another strength of an effect explains the data as well."""
    rivals = [r for r in rivals if set(r.fit.hypothesis.ids) == set(told.hypothesis.ids)]
    total, lines = sum(r.probability for r in rivals), []
    for r in rivals:
        for one, other in zip(_values(told), _values(r.fit), strict=True):
            if one[1].keys() != other[1].keys() and r.probability > policy.TOLD * total:
                share = r.probability / total
                lines.append(
                    f"{one[0]}: {_words(other)} instead of {_words(one)}, with probability {share:.2f}"
                )
    return lines


def _values(one):
    """Each effect and its free parameters, in the order of the names."""
    values, free = one.hypothesis.values(one.u), {c.effect.id: c.free for c in one.hypothesis.components}
    return [(k, {f.parameter.name: values[k][f.parameter.name] for f in free[k]}) for k in sorted(free)]


def _words(effect):
    return " and ".join(f"{name} {value:.3g}" for name, value in effect[1].items())


def where_open(rivals: Iterable[Rival], told: Fit) -> list[Rival]:
    """What is told at each of its places, the told one first; [] where that is as good as sure."""
    rivals = list(rivals)
    sure = all(share[0] >= SURE for _, _, share in of_each(rivals, told))
    return [] if sure else [r for r in rivals if same(r.fit, told)]


def named(one: Fit, e: Experiment) -> dict[str, int | str]:
    """Effect → where it sits: number of its bead or contact, or name of its gauge or material."""
    at = [(c.effect, c.place) for c in one.hypothesis.components if c.place is not None]
    return {effect.id: called(effect, place, e) for effect, place in at}


def _log_weight(told, one):
    """Log of the evidence of a fit over that of what is told; strengths have one prior at all places."""
    gain = max(told.objective, 1.0)
    shapes = evidence.occam(one, gain) - evidence.occam(told, gain)
    return 0.5 * (told.objective - one.objective) + shapes


def _elsewhere(forward, told, setup, k):
    """Fits with effect k at other places that are not far behind."""
    component = told.hypothesis.components[k]
    possible, enough = component.effect.candidates(setup), told.objective + BEHIND
    known, edge = {component.place: told}, {component.place: told}

    def follow(branch, start):
        return _fitted(branch, *start, k, enough)

    while edge:
        wanted = {
            place: (one, place)
            for at, one in edge.items()
            for place in _near(component.effect, possible, at)
            if place not in known
        }
        found = dict(zip(wanted, abreast.each(forward, follow, list(wanted.values())), strict=True))
        known |= found
        edge = {place: one for place, one in found.items() if one.objective < enough}
    return [one for one in known.values() if one is not told and one.objective < enough]


def _near(effect, possible, at):
    """Places next to one and next but one; a gauge is next to all others."""
    if effect.places not in places.ALONG:
        return possible
    middle = possible.index(at)
    return possible[max(middle - 2, 0) : middle + 3]


def _fitted(forward, one, place, k, enough):
    """The best fit with effect k of a fit at another place."""
    column = one.hypothesis.columns[k].start
    free = one.hypothesis.coordinates[column]
    factors = [factor for factor in FACTORS if factor > 0.0 or free.two_sided]
    u = np.repeat(one.u[None], len(factors), axis=0)
    u[:, column] = [places.stronger(free, one.u[column], factor) for factor in factors]
    at = np.tile([c.place or 0 for c in one.hypothesis.components], (len(factors), 1))
    at[:, k] = place
    # The last steps move χ² by less than a tenth, and places weigh by whole ones.
    return fit(forward, one.hypothesis, u, one.nu[None], at, KEEP, ITERATIONS, finish=False, reach=enough)
