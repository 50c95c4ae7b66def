"""The search for effects in a record as far as it was put right, spikes that its pulses hide left out."""

from sonicvacuum.discover.faults.alone import Kept
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.judged import Model, scatter
from sonicvacuum.discover.faults.ranking import Ranking
from sonicvacuum.discover.faults.strays import Strays, masked, strays, told
from sonicvacuum.discover.faults.weights import unexplained
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.rounds import Investigation, investigate
from sonicvacuum.effects import Catalogue


class Searching(Ranking):
    """Slips of one record, and the effects in it."""

    def __init__(self, bench: Bench, catalogue: Catalogue, threads: int, plain: list[Finding]):
        super().__init__(bench, catalogue, threads, plain)
        self._nominal: Model | None = None
        self._alone = Kept()

    def _investigate(self) -> Investigation:
        """The effects; where spikes that a pulse hid are all that these leave, without them."""
        found = self._searched()
        if unexplained(found) and self._masks(strays(found.forward, found.final), found.final):
            return self._searched()
        return found

    def _spikes_beside_one(self, model: Model) -> bool:
        """Whether the model as it is, or the best effect alone, leaves noise and spikes, which are masked: no
        slip and no set of effects explains them. Where some show, in a trace or beside the model, others may
        hide.
        """
        if not self.bench.record.signals:
            return False
        hidden = strays(model.forward, model.fit)
        if self._masks(hidden, model.fit):
            return True
        shown = bool(hidden) or any(f.fault == "spikes" for f in self.findings)
        best = self._alone.beside(model)[:1] if shown else []
        return any(self._masks(strays(model.forward, c.fit), c.fit) for c in best)

    def _masks(self, hidden: Strays, one: Fit) -> bool:
        """Whether a fit leaves noise without some spikes, which are masked then; those of hundreds of
        standard deviations have drawn it off.
        """
        if not hidden:
            return False
        bench = masked(self.bench, hidden)
        forward = Forward(self.judged(bench), self.threads)
        found, size = fit(forward, one.hypothesis, one.u[None], one.nu[None]), data(forward)
        self.simulations += forward.chains
        if found.objective > size + scatter(size):
            return False
        self.bench, self.findings = bench, told(self.findings, hidden)
        return True

    def _searched(self) -> Investigation:
        one = self._nominal
        if one is None or one.bench is not self.bench:
            return investigate(self.make(self.bench), self.threads)
        return investigate(self.make(self.bench), self.threads, one.fit, self._alone.at_hand(one))
