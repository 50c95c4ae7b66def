"""Several values of a table that are off, or in each other's place, beside an effect.

Each alone leaves what the others make, so that none explains the record; and what an effect does to all
values of a quantity, together with a few that are off, looks like noise of another size as long as no effect
is known.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.alone import alone
from sonicvacuum.discover.faults.judged import Judged, Model, scatter
from sonicvacuum.discover.faults.ranking import Ranking
from sonicvacuum.discover.faults.weights import weight_beside, weight_of
from sonicvacuum.discover.fit import evidence
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.rounds import Investigation

NOISE = "noise-misstated"


def leaving_noise(ranking: Ranking, model: Model, most: int) -> list[Judged]:
    """Slips of values that leave nothing but noise beside the effects of a model, each beyond doubt and so
    many at most; none where the model leaves no more than that itself, or they leave more.
    """
    chosen: list[Judged] = []
    while not _explained(model):
        one = next(_of_values(ranking, model), None)
        if len(chosen) == most or one is None or one.gain < policy.SURE_VALUES:
            return []
        chosen.append(one)
        model = _anew(ranking, one.model)
    return chosen


def _explained(model: Model) -> bool:
    size = data(model.forward)
    return model.fit.objective < size + scatter(size)


def _of_values(ranking: Ranking, model: Model) -> Iterator[Judged]:
    """Slips of single values, or of two, beside a model, the likeliest first."""
    return (j for j in ranking.ranked(model) if j.slip.of_values and j.slip.fault != NOISE)


def _anew(ranking: Ranking, model: Model) -> Model:
    """The model, a single effect at the best of all places: what was off may have led it elsewhere."""
    effect, *others = [c.effect for c in model.fit.hypothesis.components]
    if others or effect.places is None:
        return model
    nominal = fit(model.forward, Hypothesis(), np.zeros((1, 0)), np.zeros((1, model.forward.layout.size)))
    found, chains = alone(replace(model, fit=nominal), {effect.id})
    ranking.simulations += chains
    return min([model, *(replace(model, fit=c.fit) for c in found)], key=lambda m: m.fit.objective)


def instead_of_errors(ranking: Ranking, found: Investigation, told: Judged, most: int) -> list[Judged] | None:
    """Slips, each beside those before it, that together are likelier than errors of another size: none where
    the effects are so by themselves. None where nothing is.

    Args:
        ranking: slips of the record as it is put right, errors of another size included.
        found: the effects in it.
        told: those errors, as they were judged.
        most: how many slips there may be instead.
    """
    best, more = _likeliest(found)
    bench = replace(ranking.bench, record=told.slip.undo(ranking.bench.record))
    forward = found.forward.of(ranking.judged(bench))
    u = np.repeat(best.u[None], 2, axis=0)
    model = Model(bench, forward, fit(forward, best.hypothesis, u, np.stack([best.nu, 0.0 * best.nu])))
    ranking.simulations += forward.chains
    gain = model.objective - Model(ranking.bench, found.forward, best).objective
    least = 0.5 * gain + told.slip.occam + told.slip.log_prior + more
    chosen: list[Judged] = []
    while len(chosen) < most and (one := next(_of_values(ranking, model), None)):
        chosen.append(one)
        model = one.model
    return chosen if sum(j.log_odds for j in chosen) > least else None


def _likeliest(found: Investigation) -> tuple[Fit, float]:
    """What is named, or the best effect where nothing is, and the log of how much likelier than that all
    explanations are together: beside that effect, slips of values may explain what hides it.
    """
    best = found.candidates[0] if found.candidates else None
    if found.final is not found.null or best is None:
        return found.final, 0.0
    own = weight_beside(found, explanations.key([best.effect]))
    return best.fit, weight_of(found) - np.log(evidence.PRIOR_NONE) - own
