"""Lower minima of chains whose beads need not weigh alike.

Beads that differ part and meet again behind the wave, at instants that depend on every one of them: where
data show that, χ² has many minima in their masses, hundreds apart. From each of some draws about the best
minimum so far a fit goes down, in rounds that are ever narrower, until a round gains little; the whole is
done anew with other draws while that may still lead lower.
"""

import numpy as np

from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.forward import Forward

# Draws of a round, and how wide they lie in standard errors: first about beads that weigh alike, then about
# the best.
ROUNDS = ((16, 0.7), (16, 0.4), (16, 0.25), (16, 0.25), (16, 0.15))
# Another round is made where one has gained so much in χ², and all of them again where minima found
# independently lie further apart: at most so often.
GAINED, AGAIN = 4.0, 4
# Draws that are followed to the end, and steps before these are chosen.
FOLLOWED, FIRST = 4, 6
SEED = 0x6EAD


def lower(forward: Forward, one: Fit) -> Fit:
    """The lowest minimum found for a hypothesis, `one` where none is lower or beads weigh alike."""
    places = [k for k in forward.layout.scattered if forward.nuisance_sigma[k]]
    best, ends = one, []
    for seed in np.random.SeedSequence(SEED).spawn(AGAIN) if places else ():
        found = _descended(forward, one, places, np.random.default_rng(seed))
        ends.append(found.objective)
        best = min((best, found), key=lambda f: f.objective)
        if len(ends) > 1 and sorted(ends)[1] - min(ends) < GAINED:
            break
    return best


def _descended(forward, one, places, generator):
    """The lowest minimum of rounds of draws, `one` where the first round finds none that is lower."""
    best, middle = one, one.nu.copy()
    middle[places] = 0.0
    for count, width in ROUNDS:
        rows = np.repeat(middle[None], count, axis=0)
        rows[:, places] += width * generator.standard_normal((count, len(places)))
        u = np.repeat(one.u[None], count, axis=0)
        found = fit(forward, one.hypothesis, u, rows, keep=FOLLOWED, halved=FIRST)
        gained = best.objective - found.objective
        best = found if gained > (GAINED if best is one else 0.0) else best
        if gained < GAINED:
            break
        middle = best.nu
    return best
