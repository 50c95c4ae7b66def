"""What a search for several effects found, and beside how much that is smooth."""

from dataclasses import dataclass, field

from sonicvacuum.discover.fit import smooth
from sonicvacuum.discover.fit.evidence import Combination
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward


@dataclass(frozen=True)
class Grown:
    """Where adding and taking away came to an end.

    Attributes:
        forward: the predictor with the smooth discrepancy in its noise.
        null: the nominal model there.
        best: effects and fit there; no effects where none is left.
        size: the discrepancy.
        tried: other combinations there, the best one and none included.
    """

    forward: Forward
    null: Fit
    best: Combination
    size: smooth.Size
    tried: dict[frozenset, Combination] = field(default_factory=dict)
