"""The leading explanations of a gross misfit at their best, where walls or speeds are hardly known.

These make up for each other and for what is missing, so that an explanation has many minima, and misses the
one that another finds. The best ones are fitted from all over what is hardly known, and followed along the
valleys in which fits creep. From where these end all others are, with their own effects at any strength:
where the speeds of the shots make up for a loss that is not there, a loss has no slope that leads to it.
"""

from collections.abc import Sequence
from functools import partial
from itertools import product

import numpy as np

from sonicvacuum.discover.fit import evidence, valley, wide
from sonicvacuum.discover.fit.evidence import Combination
from sonicvacuum.discover.fit.refit import Fit, finished, fit
from sonicvacuum.discover.model import abreast
from sonicvacuum.discover.model.forward import Forward

# Explanations, by what they leave, that are brought to their best. Of nine records of real chains the best
# one stood eleventh before that.
ASKED = 12
# Of these so many, the best, are fitted from all over what is hardly known, and lead the others; so many
# times unless little changes, and those only that do not leave so many times as much as the best.
LEADERS, TIMES, STAYS, WORTH = 3, 3, 0.98, 2.0
# Starts beside the leaders that are followed; not to their minimum, where that is no lower than so many times
# what the best leaves.
FOLLOWED, NEAR = 4, 1.5
# Of all values of a parameter beside the strength every so many is tried.
THINNED = 3


def at_their_best(
    forward: Forward, null: Fit, found: Sequence[Combination], leaders: int = LEADERS
) -> list[Combination]:
    """Explanations, those that leave least at their best; all as they are where nothing is hardly known.

    Args:
        forward: the predictor.
        null: the nominal model, fitted.
        found: explanations.
        leaders: how many of them are fitted from all over what is hardly known.
    """
    if not wide.wide(forward):
        return list(found)
    ranked = sorted(found, key=lambda c: c.fit.objective)
    fits = [c.fit for c in ranked[:ASKED]]
    settled: set[int] = set()
    for _ in range(TIMES):
        least = min(one.objective for one in fits)
        order = sorted(range(len(fits)), key=lambda k: fits[k].objective)
        asked = [k for k in order if k not in settled and fits[k].objective < WORTH * least][:leaders]
        if not asked:
            break
        all_over = partial(_all_over, more=np.array([one.nu for one in fits]))
        better = abreast.each(forward, all_over, [fits[k] for k in asked])
        for k, one in zip(asked, better, strict=True):
            settled |= {k} if one.objective > STAYS * fits[k].objective else set()
            fits[k] = one
        near = NEAR * min(one.objective for one in fits)
        fits = abreast.each(forward, partial(_beside, leaders=[fits[k] for k in asked], near=near), fits)
    near = NEAR * min(one.objective for one in fits)
    # Of the others nothing is told that the last steps, and errors along a valley, would change.
    last = abreast.each(forward, _finished, [(one, one.objective < near) for one in fits])
    own = [_explained(null, c, one) for c, one in zip(ranked[:ASKED], last, strict=True)]
    return own + ranked[ASKED:]


def _all_over(forward, one: Fit, more: np.ndarray) -> Fit:
    """The better of a fit and of one from all over what is hardly known, as low as its valley leads."""
    return valley.along(forward, wide.again(forward, one, more, finish=False))


def _finished(forward, one: tuple[Fit, bool]) -> Fit:
    """A fit at its lowest, with its last steps, where it is near the best one."""
    return finished(forward, valley.along(forward, one[0])) if one[1] else one[0]


def _explained(null: Fit, c: Combination, one: Fit) -> Combination:
    """An explanation as it is fitted now."""
    if one is c.fit:
        return c
    gain = null.objective - one.objective
    worth = c.log_bayes - evidence.log_bayes(c.fit, c.gain) + evidence.log_bayes(one, gain)
    return Combination(c.effects, one, gain, worth)


def _beside(forward, one: Fit, leaders: Sequence[Fit], near: float) -> Fit:
    """The better of a fit and of one from where the leaders stand, which is followed to the end where it
    comes near the best one.
    """
    rows = [row for leader in leaders if leader is not one for row in _starts(one, leader)]
    if not rows:
        return one
    u, nu = one.hypothesis.inside(np.array([u for u, _ in rows])), np.array([nu for _, nu in rows])
    nu = wide.aligned(forward, one.hypothesis, u, nu)
    other = fit(forward, one.hypothesis, u, nu, keep=FOLLOWED, finish=False, reach=min(near, one.objective))
    return min((one, other), key=lambda f: f.objective)


def _starts(one: Fit, leader: Fit) -> list[tuple[np.ndarray, np.ndarray]]:
    """Coordinates (p,) and nuisances (q,) of an explanation where a leader stands: effects that both have as
    the leader has them, one of the others at a time at any strength and of any shape, all others as they are.
    """
    theirs = {
        c.effect.id: leader.u[at]
        for c, at in zip(leader.hypothesis.components, leader.hypothesis.columns, strict=True)
    }
    u, own = one.u.copy(), []
    for c, at in zip(one.hypothesis.components, one.hypothesis.columns, strict=True):
        if len(theirs.get(c.effect.id, ())) == len(c.free):
            u[at] = theirs[c.effect.id]
        else:
            own.append((c, at))
    rows = [(u, leader.nu)]
    for c, at in own:
        # A contact that relaxes has no slope to how soon it does where its strength is far off.
        others = [np.append(u[at.start + k], f.starts()[::THINNED]) for k, f in enumerate(c.free) if k]
        for values in product(c.free[0].starts(), *others):
            row = u.copy()
            row[at] = values
            rows.append((row, leader.nu))
    return rows
