"""What a search comes to: what is named, why, and the models with what is left counted as noise."""

from dataclasses import dataclass, field

from sonicvacuum.discover.fit import discrepancy, smooth
from sonicvacuum.discover.fit.evidence import Candidate, Combination
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.search import restart


@dataclass(frozen=True)
class View:
    """The models with a smooth discrepancy counted as noise, so that errors and limits allow for it."""

    forward: Forward
    null: Fit
    final: Fit


@dataclass(frozen=True)
class Decision:
    """What is named, and why; attributes as those of `Investigation`.

    Attributes:
        left: p-value of what the best explanation without anything unknown leaves.
        beside: explanation → log weight with a smooth discrepancy counted as noise.
        singles: single effects, best first, where pairs led some of them to lower minima.
        rivals: probable explanations as they are fitted beside what is left.
        smooth_only: whether what is unknown beside what is named is smooth, and has no shape beside that.
    """

    named: list[str]
    final: Fit
    alarms: dict[str, float]
    reasons: list[str]
    left: float
    combinations: list[Combination] = field(default_factory=list)
    smooth: float = 0.0
    counted: View | None = None
    beside: dict[str, float] | None = None
    singles: list[Candidate] | None = None
    rivals: list[Rival] | None = None
    smooth_only: bool = False


def viewed(
    forward: Forward, null: Fit, final: Fit, known: discrepancy.Shapes | None, one: smooth.Size
) -> View:
    """The nominal model and a final one with a smooth discrepancy of one size counted as noise."""
    noisy = smooth.with_size(forward.experiment, one.size, known, one.excess, one.kernel)
    counted = forward.of(noisy)
    moved = restart.moved(counted, null)
    return View(counted, moved, moved if final is null else restart.moved(counted, final))
