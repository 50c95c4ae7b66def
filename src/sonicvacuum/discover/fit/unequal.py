"""Lower minima of chains whose beads differ, in mass within their tolerance or by design.

Beads that differ part and meet again behind the wave, at instants that depend on every one of them: where
data show that, χ² has many minima in their masses and moduli, hundreds apart. From each of some draws about
the best minimum so far a fit goes down, in rounds that are ever narrower, until a round gains little; the
whole is done anew with other draws while that may still lead lower.
"""

import math

import numpy as np

from sonicvacuum.discover.fit.refit import Fit, fit
from sonicvacuum.discover.model.forward import Forward

# Draws of a round, and how wide they lie in standard errors: first about beads that weigh alike, then about
# the best.
ROUNDS = ((16, 0.7), (16, 0.4), (16, 0.25), (16, 0.25), (16, 0.15))
# Of these, the first of those about a minimum that leaves no more than noise.
CLOSE = 2
# Another round is made where one has gained so much in χ², and all of them again where minima found
# independently lie further apart: at most so often.
GAINED, AGAIN = 4.0, 4
# Draws that are followed to the end, and steps before these are chosen.
FOLLOWED, FIRST = 4, 6
SEED = 0x6EAD


def lower(forward: Forward, one: Fit, noise: float = math.inf) -> Fit:
    """The lowest minimum found for a hypothesis, `one` where none is lower or beads are alike.

    Args:
        forward: the predictor.
        one: a fit.
        noise: χ² that noise may leave; a fit that leaves more may have ended short in chains of several kinds
            of beads, and is followed until one leaves no more.
    """
    layout = forward.layout
    mixed = one.objective > noise and len(forward.experiment.batches[0].chain.bodies.kinds) > 1
    places = [k for k in (layout.of_chain if mixed else layout.scattered) if forward.nuisance_sigma[k]]
    best, ends = one, []
    for seed in np.random.SeedSequence(SEED).spawn(AGAIN) if places else ():
        generator = np.random.default_rng(seed)
        middle = one.nu.copy()
        middle[places] = 0.0
        found = _descended(forward, one, middle, places, generator)
        if mixed and found.objective <= noise:
            # Of many minima this is the one that explains the data; others need not be asked for.
            return _descended(forward, found, found.nu, places, generator, ROUNDS[CLOSE:])
        ends.append(found.objective)
        best = min((best, found), key=lambda f: f.objective)
        if len(ends) > 1 and sorted(ends)[1] - min(ends) < GAINED:
            break
    return best


def _descended(forward, one, middle, places, generator, rounds=ROUNDS):
    """The lowest minimum of rounds of draws about (q,) a middle, `one` where the first round finds none that
    is lower.
    """
    best = one
    for count, width in rounds:
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
