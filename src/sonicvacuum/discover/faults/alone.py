"""Single effects beside a slip: where one leaves noise, sets of effects need not be asked for without it.

A gauge a bead off, or a bead more, beside a strong effect is no slip that explains all there is, and no
effect of the record as it is: to find that out by sets of effects takes minutes.
"""

import math
from collections.abc import Iterable, Sequence, Set
from dataclasses import replace

import numpy as np

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.judged import Judged, Model, excess, scatter
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.discover.fit.refit import Fit, finished, fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import directions, screen, singles

# Effects that explain most of the record as it is: which of them leaves noise beside a slip is asked.
LEADING = 4
# Steps after which it shows whether one of these comes nearer to the data beside a slip.
STEPS = 6


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
    one = finished(forward, model.fit)
    found = singles.fit_all(forward, one, screen.screen(forward, one, known))
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

    def explained(
        self, ranked: Sequence[Judged], model: Model, behind: Sequence[Judged] = ()
    ) -> Judged | None:
        """The slip without a size beside which an effect leaves noise, where there is one such slip and, as
        the record is, every effect leaves far more.

        Args:
            ranked: slips that gain by themselves, the likeliest first.
            model: of the record as it is.
            behind: some that do not: asked where none of the others will do, and what is left is gross, or
                traces show them.
        """
        found, size = self.beside(model), data(model.forward)
        left, leading = _left(found, size), {c.effect for c in found[:LEADING]}
        shown = [j for j in wholes([*ranked, *behind]) if j.slip.shown][: policy.FOLLOWED]
        if left < max((scatter(size) if shown else policy.GROSS * size), policy.SURE_GAIN):
            return None
        slips = wholes(ranked)[: policy.FOLLOWED] if left > policy.GROSS * size else shown
        # What explains the record as it is says little of what acts beside a slip that explains most of it.
        most = slips[:1] if slips and slips[0].gain > policy.MOSTLY * excess(model) else []
        fitting = self._leaving_noise(most, frozenset(), size)
        fitting += self._leaving_noise(
            self._promising(slips[len(most) :], found, model.forward), leading, size
        )
        if not fitting and left > policy.GROSS * size:
            buried = left > policy.BURIED * size
            rest = [j for j in wholes(behind) if buried or j.slip.shown]
            fitting = self._leaving_noise(self._promising(rest, found, model.forward), leading, size)
        return fitting[0] if len(fitting) == 1 else None

    def _promising(self, slips, found, before):
        """Those of some slips beside which a leading effect explains more than it does of the record as it
        is: beside a slip that is none it explains less.
        """
        near = []
        for judged in slips:
            better, chains = nearer(before, judged.model.forward, [c.fit for c in found[:LEADING]])
            self.simulations += chains
            near += [judged] if better else []
        return near

    def _leaving_noise(self, slips, leading, size):
        """Those of some slips beside which an effect leaves no more than noise: a leading one, or any."""
        fitting = []
        for judged in slips:
            beside, chains = alone(judged.model, leading)
            self.simulations += chains
            fitting += [judged] if _left(beside, data(judged.model.forward)) < scatter(size) else []
        return fitting

    def at_hand(self, model: Model) -> list[Candidate] | None:
        """They, None where another model was asked for last."""
        return self._found if self._model is model else None


def nearer(before: Forward, forward: Forward, fits: Iterable[Fit]) -> tuple[bool, int]:
    """Whether one of some fits to a record comes nearer to it put right, followed there from where it stands,
    and from nuisances as stated; chains that were simulated for it. One that has no meaning there, of other
    nuisances or at a bead that is none, may.
    """
    chains, setup = forward.chains, singles.setup_of(forward)
    for one in fits:
        known = all(
            c.place is None or c.place in c.effect.candidates(setup) for c in one.hypothesis.components
        )
        if not known or one.nu.size != forward.layout.size:
            return True, forward.chains - chains
        # A slip may be that something is known far less: nuisances stand in units of their errors.
        errors, own = before.nuisance_sigma, forward.nuisance_sigma
        nu = np.divide(one.nu * errors, own, out=np.zeros_like(own), where=own > 0.0)
        starts = np.stack([nu, 0.0 * nu])
        u = np.repeat(one.u[None], 2, axis=0)
        other = fit(forward, one.hypothesis, u, starts, None, 2, STEPS, finish=False)
        if other.objective < one.objective:
            return True, forward.chains - chains
    return False, forward.chains - chains


def wholes(slips: Iterable[Judged]) -> list[Judged]:
    """Slips without a size: a place, an exchange, a number of beads."""
    return [j for j in slips if not j.slip.continuous and not j.slip.of_values]


def _left(found, size):
    """χ² above the number of data that the best effect leaves."""
    return min((c.fit.objective for c in found), default=math.inf) - size
