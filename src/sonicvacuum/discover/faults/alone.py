"""Single effects beside a slip: where one leaves noise, sets of effects need not be asked for without it.

A gauge a bead off, or a bead more, beside a strong effect is no slip that explains all there is, and no
effect of the record as it is: to find that out by sets of effects takes minutes.
"""

import math
from collections.abc import Set
from dataclasses import replace

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.judged import Judged, Model
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.discover.search import directions, screen, singles

# Effects that explain most of the record as it is: which of them leaves noise beside a slip is asked.
LEADING = 4


def alone(model: Model, only: Set[str] = frozenset()) -> tuple[list[Candidate], int]:
    """The effects of the catalogue, or `only` these, each by itself beside a model, best first; chains that
    were simulated for it.
    """
    forward = model.forward
    if only:
        experiment = forward.experiment
        others = [id for id in experiment.catalogue.ids if id not in only]
        asked = replace(experiment, excluded=(*experiment.excluded, *others))
        forward = forward.of(asked)
    before = forward.chains
    known = directions.catalogue(singles.setup_of(forward), forward.experiment.excluded)
    found = singles.fit_all(forward, model.fit, screen.screen(forward, model.fit, known))
    return found, forward.chains - before


class Kept:
    """The single effects beside the model that was asked for last.

    Attributes:
        simulations: chains simulated for all that was asked for.
    """

    def __init__(self):
        self.simulations = 0
        self._model: Model | None = None
        self._found: list[Candidate] = []

    def beside(self, model: Model) -> list[Candidate]:
        """They, fitted where they are not at hand."""
        if self._model is not model:
            self._model, (self._found, chains) = model, alone(model)
            self.simulations += chains
        return self._found

    def explained(self, ranked: list[Judged], model: Model) -> Judged | None:
        """The slip without a size beside which an effect leaves noise, where there is one such slip and, as
        the record is, every effect leaves far more.
        """
        found, size = self.beside(model), data(model.forward)
        if _left(found, size) < max(policy.GROSS * size, policy.SURE_GAIN):
            return None
        leading = {c.effect for c in found[:LEADING]}
        noise = policy.SUSPICIOUS * math.sqrt(2.0 * size)
        fitting = []
        for judged in wholes(ranked):
            beside, chains = alone(judged.model, leading)
            self.simulations += chains
            fitting += [judged] if _left(beside, data(judged.model.forward)) < noise else []
        return fitting[0] if len(fitting) == 1 else None

    def at_hand(self, model: Model) -> list[Candidate] | None:
        """They, None where another model was asked for last."""
        return self._found if self._model is model else None


def wholes(ranked: list[Judged]) -> list[Judged]:
    """The first slips without a size: a place, an exchange, a number of beads."""
    return [j for j in ranked if not j.slip.continuous and not j.slip.of_values][: policy.FOLLOWED]


def _left(found, size):
    """χ² above the number of data that the best effect leaves."""
    return min((c.fit.objective for c in found), default=math.inf) - size
