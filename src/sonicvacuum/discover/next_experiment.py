"""The next run: which change of the experiment most likely leaves one explanation alone.

Each explanation that is left predicts a new run; every other may follow that prediction with its own
parameters and with all nuisances as far as the data at hand allow. The χ² that remains is what the run is
expected to decide between the two (Box & Hill, Technometrics 9, 57, 1967; Buzzi-Ferraris & Forzatti, Chem.
Eng. Sci. 38, 225, 1983), with the scatter that noise gives it. Proposed is the run after which, whichever is
true by its present probability, all others are most likely behind it; but for those that no run puts there,
such as a general law where one of its limits is true. Where what is missing is clear, but not where it
sits, explanations are its places.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from msgspec import UNSET

from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.imagined import changes, changes_of_two, together
from sonicvacuum.discover.judge import explanations, rivals, whereabouts
from sonicvacuum.discover.judge.degenerate import ALIKE
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.verdict import Next
from sonicvacuum.special import functions

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
    """One that is left: its name, natural log of its weight, its fit to the old runs, and where its effects
    sit, where that is asked.
    """

    name: str
    weight: float
    fit: Fit
    places: dict[str, int | str] = field(default_factory=dict)


def propose(found: Investigation, alike: list[list[str]], placed: Sequence[Rival] = ()) -> Next | None:
    """The run that most likely leaves one explanation alone; None without signals or rivals that are left.

    Two quantities of the last run are changed only where none alone would decide.

    Args:
        found: the search.
        alike: sets of effects that the data cannot tell from what is named.
        placed: what is named stands there once for each place where its effects may sit.
    """
    if not any(r.has_signals for r in found.forward.experiment.runs):
        return None
    sits = [] if alike else _at_places(found, placed)
    forward = (found.counted or found).forward if sits else found.forward
    left = sits or _left(found, alike)
    if len(left) < 2:
        return None
    known = [precision(forward, one.fit) for one in left]
    weights = np.array([one.weight for one in left])
    tried, apart = _tried(forward, left, known, changes(forward.experiment))
    if not tried:
        return None
    behind = put_behind(weights, apart)
    if (alike or sits) and (surely(weights, behind) < SURE).all():
        two, further = _tried(forward, left, known, changes_of_two(forward.experiment))
        tried, apart = tried + two, np.concatenate([apart, further])
        behind = put_behind(weights, apart)
    value = resolved(weights, behind)
    able = np.flatnonzero(behind.max(axis=0)[0, 1:] > _HOPELESS) + 1
    others = able if len(able) else np.arange(1, len(left))
    # Where any run will do, or none: the one that decides most.
    order = np.lexsort((apart[:, 0, others].min(axis=1), np.round(value, 3)))
    best = next(k for k in order[::-1] if len(tried[k]) == 1)
    if value[order[-1]] > value[best] + WORTH_TWO:
        best = order[-1]
    rival = int(others[np.argmin(apart[best, 0, others])])
    between = (left[0], left[rival])
    return Next(
        change=tried[best],
        separates=[one.name for one in between],
        delta_chi2=float(apart[best, 0, rival]),
        places=[one.places for one in between] if sits else UNSET,
    )


def _tried(forward, left, known, imagined):
    """Changes, and (c, n, n) how far each run takes explanations apart."""
    kept = _kept(left)
    offers = [one for one in imagined if not kept & one[0].keys()]

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
    behind = functions().ndtr(ahead / (2.0 * np.sqrt(np.maximum(apart, 1e-12))))
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


def _kept(left: list[Explanation]) -> set[str]:
    """What no run may change: records that hang differently say nothing of an effect of the orientation when
    taken together, and whatever loads a chain closes its gaps.
    """
    effects = [c.effect for one in left for c in one.fit.hypothesis.components]
    turned = {"chain.orientation"} if any(e.depends_on_orientation for e in effects) else set()
    loaded = {"chain.orientation", "chain.static_force_N"} if any(e.unloaded for e in effects) else set()
    return turned | loaded


def _at_places(found: Investigation, placed) -> list[Explanation]:
    """What is named at each place where it may sit, the told one first; [] where that is clear."""
    one = found.counted or found
    own = whereabouts.where_open(placed, one.final)
    return [
        Explanation(
            "+".join(r.fit.hypothesis.ids),
            float(np.log(r.probability)),
            r.fit,
            whereabouts.named(r.fit, one.forward.experiment),
        )
        for r in [*own[:1], *sorted(own[1:], key=lambda r: -r.probability)][: 1 + _ALIKE]
    ]


def _left(found: Investigation, alike) -> list[Explanation]:
    """The best explanation and those that the data cannot tell from it, or else the nearest that are left."""
    ranked = _ranked(found, alike)
    if explanations.UNKNOWN in found.named:
        return ranked  # all of them are ruled out, and yet one may be the nearest to what is there
    same = {name for names in alike for name in names}

    def possible(one):
        known = found.probabilities.get(explanations.key(one.name.split("+")), 0.0)
        return one.name in same or known > rivals.LEAST

    return [one for k, one in enumerate(ranked) if k == 0 or possible(one)]


def _ranked(found, alike):
    """The same, whether ruled out or not."""
    if len(found.named) > 1 and explanations.UNKNOWN not in found.named:
        own = set(found.named)
        ranked = [Explanation("+".join(c.effects), c.log_bayes, c.fit) for c in found.combinations]
        ranked = sorted(ranked, key=lambda r: set(r.name.split("+")) != own)
        near = sum(2.0 * (ranked[0].weight - r.weight) < ALIKE for r in ranked[1:]) if ranked else 0
        return ranked[: 1 + min(max(_RIVALS, near), _ALIKE)]
    ranked = [Explanation(c.effect, c.log_bayes, c.fit) for c in found.candidates if c.gain > 0.0]
    if len(found.named) == 1 and found.named[0] != explanations.UNKNOWN:
        ranked = sorted(ranked, key=lambda r: r.name != found.named[0])
        members = set(alike[0]) if alike else set()
        near = [r for r in ranked if r.name in members]
        return near[: 1 + _ALIKE] if len(near) > 1 else ranked[: 1 + _RIVALS]
    nothing = Explanation(explanations.NONE, 0.0, found.null)
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
