"""Upper limits on all effects that a verdict does not name, and which of them its data cannot test."""

from sonicvacuum.discover import verdict
from sonicvacuum.discover.fit.goodness import Goodness
from sonicvacuum.discover.fit.heldout import per_datum
from sonicvacuum.discover.judge import degenerate, explanations
from sonicvacuum.discover.judge.degenerate import Elsewhere, Limit
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.search import directions, screen, singles

# Explanations less probable than this move no limit: beyond one lie 5 % of all.
FAINT = 1e-3


def screened(found: Investigation) -> screen.Screen:
    """The catalogue, less what the final model has, screened at that; what is smooth counts as noise."""
    view = found.counted or found
    if view.final is found.null:
        return found.scores
    present = (*view.final.hypothesis.ids, *view.forward.experiment.excluded)
    families = directions.catalogue(singles.setup_of(view.forward), present)
    return screen.screen(view.forward, view.final, families)


def limits(
    found: Investigation, fit: Goodness, scores: screen.Screen
) -> tuple[list[Limit], list[str], float]:
    """Limits, effects that the data cannot test, and the factor on the limits' errors.

    What is smooth is in the noise already; for the rest errors grow with the residual (Birge, Phys. Rev. 40,
    207, 1932). Beside something unknown no limit is stated: what is left may hide an effect, or make up for
    it.

    Args:
        found: effects and their evidence.
        fit: goodness of fit of the final model.
        scores: of `screened`.
    """
    view = found.counted or found
    setup = singles.setup_of(view.forward)
    excess = per_datum(view.final.normal.chi2.sum(), found.sizes.sum())
    wider = max(1.0, excess**0.5) if fit.failed else 1.0
    all_of_them = degenerate.limits(scores, setup, wider, _elsewhere(found))
    untestable = sorted({one.effect for one in all_of_them if not one.testable})
    if explanations.UNKNOWN in found.named:
        return [], untestable, 1.0
    return all_of_them, untestable, wider


def _elsewhere(found):
    """(effect, parameter) → what the explanations other than the named one say of it."""
    told: dict[tuple[str, str], list[Elsewhere]] = {}
    fits = {c.effect: c.fit for c in found.candidates}
    fits |= {explanations.key(c.effects): c.fit for c in found.combinations}
    for name, fit in fits.items():
        probability = found.probabilities.get(name, 0.0)
        if probability > FAINT and name != explanations.key(found.named):
            for effect, values in verdict.parameters(fit).items():
                for parameter, v in values.items():
                    told.setdefault((effect, parameter), []).append(Elsewhere(probability, v.value, v.sigma))
    return told
