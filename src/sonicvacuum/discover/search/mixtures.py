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
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
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
    left, changes = _projected(forward, laws)
    products, scores = changes @ changes.T, changes @ left
    result = []
    for pair in combinations(range(1, len(laws)), 2):
        at = np.ix_(pair, pair)
        share = np.linalg.lstsq(products[at], scores[list(pair)], rcond=1e-9)[0]
        if not np.all((share > SHARES[0]) & (share < SHARES[1])):
            continue
        objective = float(left @ left - scores[list(pair)] @ share)
        result.append(_start([laws[k] for k in pair], share, laws[0].fit.nu, null.objective - objective))
    return sorted(result, key=lambda s: -s.gain)


def _mixes(c: Candidate) -> bool:
    """Whether what an effect changes grows as its strength does, all along the chain."""
    (component,) = c.fit.hypothesis.components
    strength = component.free[0]
    along = component.effect.dissipative and not component.effect.places
    return along and strength.endless and np.isfinite(c.fit.objective)


def _projected(forward, laws):
    """(data + nuisances,) what the nominal model leaves at the nuisances of the first law, and (laws, …) what
    each one changes of it, both without what nuisances take up.
    """
    first = laws[0].fit
    columns = forward.columns(first.hypothesis, first.u[None], first.nu[None], precise=True)
    plain = forward.sampled(Hypothesis(), np.zeros((1, 0)), first.nu[None])
    found = [forward.sampled(c.fit.hypothesis, c.fit.u[None], first.nu[None]) for c in laws]
    p, q = len(first.u), forward.layout.size
    slopes, left, changes = [], [], []
    for run, own in enumerate(columns):
        part = np.zeros((q, own.shape[2]))
        part[forward.local(run)] = own[0, 1 + p :]
        slopes.append(part)
        left.append(forward.data(run) - plain[run][0])
        changes.append(np.array([one[run][0] - plain[run][0] for one in found]))
    slopes, left, changes = np.hstack(slopes), np.concatenate(left), np.hstack(changes)
    # Counts of pulses jump, and what is not shown is no number.
    good = np.isfinite(left) & np.isfinite(changes).all(axis=0) & np.isfinite(slopes).all(axis=0)
    basis = np.linalg.qr(np.hstack([slopes[:, good], np.eye(q)]).T)[0]
    left = np.concatenate([left[good], -first.nu])
    changes = np.hstack([changes[:, good], np.zeros((len(laws), q))])
    return left - basis @ (basis.T @ left), changes - (changes @ basis) @ basis.T


def _start(pair, share, nu, gain):
    """Two laws with so much of their strengths."""
    hypothesis = Hypothesis(tuple(c.fit.hypothesis.components[0] for c in pair))
    u = np.concatenate(
        [scaled(c.fit.hypothesis.coordinates[0], c.fit.u, s) for c, s in zip(pair, share, strict=True)]
    )
    return Start(gain, hypothesis, u[None], nu[None], np.zeros((1, 2), dtype=int))
