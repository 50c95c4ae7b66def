"""Whether data suffice for a fit: with as many parameters as data any numbers are explained, so that such a
fit says nothing of what is missing, and nothing is named from it.
"""

from collections.abc import Iterable

from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward


def data(forward: Forward) -> int:
    """Number of data of all runs: samples that count, and scalars."""
    return sum(forward.experiment.size(run) for run in range(len(forward.experiment.runs)))


def parameters(fit: Fit) -> int:
    """Number of parameters of the effects of a fit, the places that they may have included.

    Nuisances are not counted: each has a stated error, which is a datum of its own.
    """
    return len(fit.u) + sum(bool(c.effect.places) for c in fit.hypothesis.components)


def suffice(forward: Forward, fit: Fit) -> bool:
    """Whether there are more data than parameters."""
    return data(forward) > parameters(fit)


def first(forward: Forward, found: Iterable[Candidate]) -> list[Candidate]:
    """Candidates for which the data suffice before all others; else in their order."""
    return sorted(found, key=lambda c: not suffice(forward, c.fit))


def told(forward: Forward, found: Iterable[Candidate]) -> list[str]:
    """One line with numbers and cure where the data do not suffice for some candidates; none otherwise."""
    short = [c for c in found if not suffice(forward, c.fit)]
    if not short:
        return []
    count, most = data(forward), max(parameters(c.fit) for c in short)
    names = ", ".join(f"{c.effect} ({parameters(c.fit)})" for c in short)
    return [
        f"too few data, {count} in all, for effects with as many parameters or more: {names}; they would "
        f"explain any numbers and are not named: measure {most + 1 - count} more (another speed or gauge)"
    ]
