"""Single effects beside a slip: where one leaves noise, sets of effects need not be asked for without it.

A gauge a bead off, or a bead more, beside a strong effect is no slip that explains all there is, and no
effect of the record as it is: to find that out by sets of effects takes minutes.
"""

import math

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.judged import Judged, Model
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.discover.search import directions, screen, singles


def alone(model: Model) -> list[Candidate]:
    """The effects of the catalogue, each by itself beside a model."""
    forward = model.forward
    known = directions.catalogue(singles.setup_of(forward), forward.experiment.excluded)
    return singles.fit_all(forward, model.fit, screen.screen(forward, model.fit, known))


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
            before = model.forward.chains
            self._model, self._found = model, alone(model)
            self.simulations += model.forward.chains - before
        return self._found

    def at_hand(self, model: Model) -> list[Candidate] | None:
        """They, None where another model was asked for last."""
        return self._found if self._model is model else None


def beside_one_effect(ranked: list[Judged], model: Model, found: list[Candidate]) -> Judged | None:
    """The slip without a size beside which an effect leaves noise, where there is one such slip and, as the
    record is, every effect leaves far more; `found` are those of the record as it is.
    """
    size = data(model.forward)
    if _left(found, size) < policy.GROSS * size:
        return None
    noise = policy.SUSPICIOUS * math.sqrt(2.0 * size)
    fitting = [j for j in wholes(ranked) if _left(alone(j.model), data(j.model.forward)) < noise]
    return fitting[0] if len(fitting) == 1 else None


def wholes(ranked: list[Judged]) -> list[Judged]:
    """The first slips without a size: a place, an exchange, a number of beads."""
    return [j for j in ranked if not j.slip.continuous and not j.slip.of_values][: policy.FOLLOWED]


def _left(found, size):
    """χ² above the number of data that the best effect leaves."""
    return min((c.fit.objective for c in found), default=math.inf) - size
