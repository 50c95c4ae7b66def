"""The next run: which change of the experiment most likely leaves one explanation alone.

Each explanation that is left predicts a new run; every other may follow that prediction with its own
parameters and with all nuisances as far as the data at hand allow. The χ² that remains is what the run is
expected to decide between the two (Box & Hill, Technometrics 9, 57, 1967; Buzzi-Ferraris & Forzatti, Chem.
Eng. Sci. 38, 225, 1983), with the scatter that noise gives it. Proposed is the run after which, whichever is
true by its present probability, all others are most likely behind it; but for those that no run puts there,
such as a general law where one of its limits is true.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.imagined import changes, changes_of_two, together
from sonicvacuum.discover.judge.degenerate import ALIKE
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.verdict import Next

# Explanations beside the best that are held apart: the nearest where nothing is left alike, and of those that
# are left alike so many.
_RIVALS, _ALIKE = 2, 6
# Less likely than this to be put behind by any run: left out of account.
_HOPELESS = 0.1
# Two quantities are changed where no run with one changed is as sure as this to leave one explanation alone,
# and if that is surer by so much.
SURE, WORTH_TWO = 0.9, 0.05
# Runs that are simulated side by side.
_BESIDE = 10


@dataclass(frozen=True)
class Explanation:
    """One that is left: its name, natural log of its weight, and its fit to the old runs."""

    name: str
    weight: float
    fit: Fit


def propose(found: Investigation, alike: list[list[str]]) -> Next | None:
    """The run that most likely leaves one explanation alone; None without signals or rivals.

    Two quantities of the last run are changed only where none alone would decide.
    """
    forward = found.forward
    if not any(r.has_signals for r in forward.experiment.runs):
        return None
    left = _left(found, alike)
    if len(left) < 2:
        return None
    known = [precision(forward, one.fit) for one in left]
    weights = np.array([one.weight for one in left])
    tried, apart = _tried(forward, left, known, changes(forward.experiment))
    if not tried:
        return None
    behind = put_behind(weights, apart)
    if alike and (surely(weights, behind) < SURE).all():
        others = _tried(forward, left, known, changes_of_two(forward.experiment))
        tried, apart = tried + others[0], np.concatenate([apart, others[1]])
        behind = put_behind(weights, apart)
    value = resolved(weights, behind)
    able = np.flatnonzero(behind.max(axis=0)[0, 1:] > _HOPELESS) + 1
    rivals = able if len(able) else np.arange(1, len(left))
    # Where any run will do, or none: the one that decides most.
    order = np.lexsort((apart[:, 0, rivals].min(axis=1), np.round(value, 3)))
    best = next(k for k in order[::-1] if len(tried[k]) == 1)
    if value[order[-1]] > value[best] + WORTH_TWO:
        best = order[-1]
    rival = int(rivals[np.argmin(apart[best, 0, rivals])])
    separates = [left[0].name, left[rival].name]
    return Next(change=tried[best], separates=separates, delta_chi2=float(apart[best, 0, rival]))


def _tried(forward, left, known, imagined):
    """Changes, and (c, n, n) how far each run takes explanations apart."""
    # Records that hang differently say nothing of such an effect when taken together.
    turned = any(_depends_on_orientation(one.fit) for one in left)
    offers = [one for one in imagined if not (turned and "chain.orientation" in one[0])]

    def asked(branch, some):
        new = Forward(together([experiment for _, experiment in some]), branch.threads)
        apart = separations(branch, new, [one.fit for one in left], known)
        branch.simulations += new.simulations
        return apart

    shares = [offers[k : k + _BESIDE] for k in range(0, len(offers), _BESIDE)]
    found = abreast.each(forward, asked, shares, calls=len(left))
    apart = np.concatenate(found) if found else np.zeros((0, len(left), len(left)))
    return [change for change, _ in offers], apart


def put_behind(weights: np.ndarray, apart: np.ndarray) -> np.ndarray:
    """(c, n, n) probabilities that after each of c runs the explanation of the column is behind that of the
    row, if that is true, by more than `ALIKE`; 1 for itself.

    The χ² that a run takes from a wrong explanation, `apart` on the average, scatters by 2√apart.

    Args:
        weights: (n,) natural logs of what the explanations are worth now.
        apart: (c, n, n) χ² by which each run is expected to tell the explanation of the row, if true, from
            that of the column.
    """
    ahead = 2.0 * (weights[:, None] - weights) + apart - ALIKE
    behind = scipy.special.ndtr(ahead / (2.0 * np.sqrt(np.maximum(apart, 1e-12))))
    behind[:, range(len(weights)), range(len(weights))] = 1.0
    return behind


def resolved(weights: np.ndarray, behind: np.ndarray) -> np.ndarray:
    """(c,) probabilities that each run leaves the true explanation alone, but for those that no run can put
    behind it; arguments as `put_behind` has them.
    """
    able = behind.max(axis=0) > _HOPELESS
    return surely(weights, np.where(able, behind, 1.0))


def surely(weights: np.ndarray, behind: np.ndarray) -> np.ndarray:
    """(c,) the same with none left out."""
    return behind.min(axis=2) @ np.exp(weights - np.logaddexp.reduce(weights))


def _depends_on_orientation(fit):
    """Whether an effect of a fit is off at the recorded orientation."""
    return any(c.effect.depends_on_orientation for c in fit.hypothesis.components)


def _left(found: Investigation, alike) -> list[Explanation]:
    """The best explanation and those that the data cannot tell from it, or else the nearest."""
    if len(found.named) > 1 and "unknown" not in found.named:
        own = set(found.named)
        ranked = [Explanation("+".join(c.effects), c.log_bayes, c.fit) for c in found.combinations]
        ranked = sorted(ranked, key=lambda r: set(r.name.split("+")) != own)
        near = sum(2.0 * (ranked[0].weight - r.weight) < ALIKE for r in ranked[1:]) if ranked else 0
        return ranked[: 1 + min(max(_RIVALS, near), _ALIKE)]
    ranked = [Explanation(c.effect, c.log_bayes, c.fit) for c in found.candidates if c.gain > 0.0]
    if len(found.named) == 1 and found.named[0] != "unknown":
        ranked = sorted(ranked, key=lambda r: r.name != found.named[0])
        members = set(alike[0]) if alike else set()
        near = [r for r in ranked if r.name in members]
        return near[: 1 + _ALIKE] if len(near) > 1 else ranked[: 1 + _RIVALS]
    nothing = Explanation("none", 0.0, found.null)
    return [nothing, *ranked[:_RIVALS]] if not found.named else ranked[: 1 + _RIVALS]


def separations(old: Forward, new: Forward, fits: list[Fit], known: list[np.ndarray]) -> np.ndarray:
    """(c, n, n) χ² by which each of c new runs is expected to tell what made it (row) from a rival (column).

    The rival's parameters and the shared nuisances (gains, modulus) move within what the old data leave
    them; speed and trigger of the new run are free within their errors.

    Args:
        old, new: the old runs and the new ones.
        fits: n fits to the old runs.
        known: their `precision`.
    """
    columns = [new.columns(f.hypothesis, f.u[None], _shared(old, new, f)[None]) for f in fits]
    apart = np.zeros((len(columns[0]), len(fits), len(fits)))
    for run, told in enumerate(apart):
        predicted = np.stack([c[run][0, 0] for c in columns])
        for k, (own, prior) in enumerate(zip(columns, known, strict=True)):
            miss, slopes = predicted - predicted[k], own[run][0, 1:]
            projection = slopes @ miss.T
            explained = np.linalg.lstsq(slopes @ slopes.T + prior, projection, rcond=1e-12)[0]
            told[:, k] = (miss * miss).sum(axis=1) - (projection * explained).sum(axis=0)
    return np.maximum(apart, 0.0)


def _shared(old, new, fit):
    """(q,) nuisances of the new runs: what is shared as fitted, speeds and triggers at zero."""
    nu = np.zeros(new.layout.size)
    nu[new.layout.shared] = fit.nu[old.layout.shared]
    return nu


def precision(old: Forward, fit) -> np.ndarray:
    """(n, n) precision of the columns of a new run: parameters and shared nuisances from the old data, 1 for
    its own.
    """
    _, hessian = fit.normal.total()
    free = fit.normal.free
    kept = np.array([*range(free), *(free + old.layout.shared)])
    covariance = np.linalg.pinv(hessian[0], rcond=1e-12, hermitian=True)[np.ix_(kept, kept)]
    known = np.linalg.pinv(covariance, rcond=1e-12, hermitian=True)
    count = len(kept) + 2
    result = np.eye(count)
    # Columns run: parameters, modulus, speed, trigger, gains, others; speed and trigger are its own.
    shared = np.array([*range(free + 1), *range(free + 3, count)])
    result[np.ix_(shared, shared)] = known
    return result
