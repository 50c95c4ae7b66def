"""Two laws of damping in place of one that stands for both.

Together a dashpot, whose force grows with the rate alone, and Hunt and Crossley's law, which grows as δ^{3/2}
besides, lose nearly as Kuwabara and Kono's does, as δ^{1/2}: it leaves hardly anything, and alone either of
the two leaves so much that no search begins with it. What each fitted law changes grows nearly as its
strength does, so that algebra tells how much of two of them the data ask for.
"""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from sonicvacuum.discover.fit.evidence import Candidate
from sonicvacuum.discover.fit.normal import from_slopes
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.search import restart, screen
from sonicvacuum.discover.search.directions import Direction
from sonicvacuum.discover.search.planes import Start
from sonicvacuum.discover.search.secants import scaled

# Of its strength alone each of two laws keeps a share within these.
SHARES = (0.03, 1.5)


def starts(forward: Forward, null: Fit, found: Sequence[Candidate]) -> list[Start]:
    """Pairs of fitted laws in place of the best single effect, the most promising first; none where that is
    no law of damping.

    Args:
        forward: the predictor.
        null: the nominal model, fitted.
        found: single effects, best first.
    """
    laws = [c for c in found if _mixes(c)]
    if len(laws) < 3 or laws[0] is not found[0]:
        return []
    seen = _screened(forward, laws)
    scores, products = seen.projected
    left = restart.promised(seen.fit)
    result = []
    for pair in combinations(range(1, len(laws)), 2):
        at = np.ix_(pair, pair)
        share = np.linalg.lstsq(products[at], scores[list(pair)], rcond=1e-9)[0]
        if not np.all((share > SHARES[0]) & (share < SHARES[1])):
            continue
        gain = null.objective - left + float(scores[list(pair)] @ share)
        result.append(_start([laws[k] for k in pair], share, laws[0].fit.nu, gain))
    return sorted(result, key=lambda s: -s.gain)


def _mixes(c: Candidate) -> bool:
    """Whether what an effect changes grows as its strength does, all along the chain."""
    (component,) = c.fit.hypothesis.components
    strength = component.free[0]
    along = component.effect.dissipative and not component.effect.places
    return along and strength.endless and np.isfinite(c.fit.objective)


def _screened(forward, laws) -> screen.Screen:
    """What the nominal model leaves at the nuisances of the first law, whose slopes beside that take up what
    they can, and as directions what each law changes of it.
    """
    first, nothing = laws[0].fit, (Hypothesis(), np.zeros((1, 0)))
    columns = forward.columns(first.hypothesis, first.u[None], first.nu[None], precise=True)
    plain = forward.sampled(*nothing, first.nu[None])
    acting = [forward.sampled(c.fit.hypothesis, c.fit.u[None], first.nu[None]) for c in laws]
    base = [
        np.concatenate([bare[:, None], own[:, 1 + len(first.u) :]], axis=1)
        for bare, own in zip(plain, columns, strict=True)
    ]
    changed = [np.vstack(some) - bare for some, bare in zip(zip(*acting, strict=True), plain, strict=True)]
    # What is not shown is no number.
    changes = [np.nan_to_num(some) for some in changed]
    normal = from_slopes(forward, 0, nothing[1], first.nu[None], base)
    strengths = [c.fit.hypothesis.coordinates[0].parameter.name for c in laws]
    directions = tuple(Direction(c.effect, name) for c, name in zip(laws, strengths, strict=True))
    return screen.from_columns(forward, Fit(nothing[0], normal, True), directions, base, changes)


def _start(pair, share, nu, gain):
    """Two laws with so much of their strengths."""
    hypothesis = Hypothesis(tuple(c.fit.hypothesis.components[0] for c in pair))
    u = np.concatenate(
        [scaled(c.fit.hypothesis.coordinates[0], c.fit.u, s) for c, s in zip(pair, share, strict=True)]
    )
    return Start(gain, hypothesis, u[None], nu[None], np.zeros((1, 2), dtype=int))
