"""A contact law of no particular form held against names beside something unknown.

Where something is left, names may be no more than what comes nearest to a law that the catalogue lacks. So
the free-form law is fitted beside all that is named, beside less of it, and alone; names that it makes
superfluous are dropped. What each leaves counts as a smooth discrepancy, so that their evidence compares.
"""

import math
from dataclasses import dataclass, replace

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit import discrepancy, smooth
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import decided, explanations, gross
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.search import pairs, restart
from sonicvacuum.discover.search.free_law import FreeLaw, free_law
from sonicvacuum.discover.search.singles import setup_of

# A name beside the law has to gain what it would elsewhere, and this share of what the law gains: a
# polynomial errs by some per cent, which a name may take up.
_EARNED, _ERRS = policy.LEAST_LOG10_BAYES * math.log(10.0), policy.SHARE


@dataclass(frozen=True)
class _Account:
    """Named effects as fitted without the law, the law beside them, the smooth discrepancy that both leave,
    and the log evidence of all against the nominal model.
    """

    base: Fit
    law: FreeLaw | None
    size: smooth.Size
    worth: float

    @property
    def left(self) -> float:
        """χ² of what is left."""
        return float((self.law.fit if self.law else self.base).normal.chi2.sum())

    @property
    def gain(self) -> float:
        """Half of what the law takes away in χ²."""
        return 0.5 * (float(self.base.normal.chi2.sum()) - self.left)


def with_law(found: Investigation) -> tuple[Investigation, FreeLaw | None]:
    """An investigation and the free-form law that belongs to it, None where none does; names that the law
    makes superfluous are gone.
    """
    return _Weighed(found).told() if explanations.UNKNOWN in found.named else (found, None)


class _Weighed:
    """An investigation that left something unknown."""

    def __init__(self, found: Investigation):
        self.found, self.setup = found, setup_of(found.forward)
        e = found.forward.experiment
        # Where its size is stated it counts as noise already.
        self.known = discrepancy.Shapes(e) if e.model_floor_rel is None else None

    def told(self) -> tuple[Investigation, FreeLaw | None]:
        """See `with_law`."""
        found = self.found
        law = free_law(found.forward, found.null)
        alone = self._account(found.null, law) if law else None
        if found.final is found.null:
            return (self._surely(alone) if alone else found), law
        plain = self._account(found.final)
        law = free_law(found.forward, found.final)
        best = whole = self._account(found.final, law) if law else plain
        most = self._most(plain.left)
        for one in (alone, *map(self._searched, self._less(found.final))):
            if one is None or one.law is None or one.left > most:
                continue
            # A law alone has all of a catalogue of laws in it: it is asked for more than a name is.
            earned = -max(_EARNED, _ERRS * one.gain) if best.law else policy.LAW_LOG_BAYES
            if one.worth > best.worth + earned:
                best = one
        if best is whole:
            return found, whole.law
        return self._renamed(best, best.worth - plain.worth), best.law

    def _most(self, left: float) -> float:
        """χ² that a law may leave that replaces names, which leave so much. Beside much more than the noise a
        polynomial is easily as good as a name: there it has to take away as much as a further group of it.
        """
        size = data(self.found.forward)
        if not gross.gross(self.found.forward, self.found.final, self.known):
            return left
        return size + (1.0 - policy.LAW_FURTHER) * (left - size)

    def _surely(self, alone: _Account) -> Investigation:
        """Nothing was named, as which of several effects it is was open: whether the law beats them all."""
        rivals = [one.fit for one in self.found.rivals if one.fit.hypothesis.components]
        fits = [restart.moved(self.found.forward, one) for one in rivals]
        surer = alone.worth - max((self._account(one).worth for one in fits), default=math.inf)
        return self._renamed(alone, surer) if surer > policy.LAW_LOG_BAYES else self.found

    def _less(self, fit: Fit) -> list[Fit]:
        """The same fit less each of its effects, where there are several."""
        count = len(fit.hypothesis.components)
        forward, null = self.found.forward, self.found.null
        return [restart.fewer(forward, null, fit, k) for k in range(count) if count > 1]

    def _searched(self, base: Fit) -> _Account | None:
        """Some effects with the law beside them, where it earns its place."""
        law = free_law(self.found.forward, base)
        return self._account(base, law) if law else None

    def _account(self, base: Fit, law: FreeLaw | None = None) -> _Account:
        """Evidence of some effects, and of the law beside them."""
        own = pairs.combination(self.found.null, base, self.setup).log_bayes
        forward, fit = (law.forward, law.fit) if law else (self.found.forward, base)
        size = self._size(forward, fit)
        return _Account(base, law, size, own + (law.log_bayes if law else 0.0) + size.log_odds)

    def _size(self, forward: Forward, fit: Fit) -> smooth.Size:
        return smooth.infer(forward, fit, self.known) if self.known else smooth.Size(0.0, 0.0)

    def _renamed(self, best: _Account, surer: float) -> Investigation:
        """The investigation with what is left of its names beside the law."""
        found, names = self.found, list(best.base.hypothesis.ids)
        gone = [name for name in found.named if name not in (*names, explanations.UNKNOWN)]
        than = f"than {' + '.join(gone)}" if gone else "than any effects that were tried"
        reason = (
            f"a contact law that the catalogue lacks explains more {than} beside something unknown "
            f"(log10 Bayes factor {surer / math.log(10.0):.3g})"
        )
        own = explanations.key([*names, explanations.UNKNOWN])
        share = 1.0 / (1.0 + math.exp(-min(surer, 700.0)))
        odds = {name: p * (1.0 - share) for name, p in found.probabilities.items()}
        odds[own] = odds.get(own, 0.0) + share
        # Limits on all else are not to be tighter for a law that was made for these data.
        seen = self._size(found.forward, best.base)
        return replace(
            found,
            named=[*names, explanations.UNKNOWN],
            final=best.base,
            probabilities=odds,
            reasons=[reason, *found.forward.experiment.notes],
            counted=decided.viewed(found.forward, found.null, best.base, self.known, seen)
            if seen.found
            else None,
            smooth=best.size.size if best.size.found else 0.0,
            rivals=[],
        )
