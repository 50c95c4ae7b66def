"""Beads that do not all weigh alike: each differs from what is stated within the tolerance of their masses.

A tolerance says how well a bead's mass is known, of all beads in common (a balance that is off) and of each
one beside the others. What single beads change adds up to few shapes of the traces: of the slopes to all
masses at the nominal model, without what all beads have in common and what other nuisances take up, the
directions that the data show are nuisances of their own (`Shared` of the kind "bead-scatter"), with the prior
of the masses, which is the same in whatever directions it is counted.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.model.experiment import Experiment
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.nuisances import SCATTER, Shared

# As many places in every data set, so that a record that is put right has the nuisances that it had; those of
# directions that the data do not show are empty.
DIRECTIONS = 24
# What directions without a place of their own may add to chi2 together, on average.
UNSEEN = 0.5


def scattered(data: Experiment) -> Experiment:
    """The data set whose beads may weigh each a little more or less; the same object where their masses are
    exact.
    """
    sigma = next((one.sigma for one in data.shared if one.kind == "bead-mass"), 0.0)
    if not sigma or data.beads < 2:
        return data
    each = tuple(Shared(SCATTER, sigma, weights=tuple(row)) for row in np.eye(data.beads))
    trial = replace(data, shared=(*data.shared, *each))
    directions = _directions(trial, len(each))[:DIRECTIONS]
    missing = np.zeros((DIRECTIONS - len(directions), data.beads))
    own = (tuple(map(float, row)) for row in np.concatenate([directions, missing]))
    return replace(data, shared=(*data.shared, *(Shared(SCATTER, sigma, weights=row) for row in own)))


def _directions(trial, beads):
    """(n, beads) orthonormal, first what the data show best beside all else that is not known, but for what
    they do not show; what all beads have in common is not among them.
    """
    from sonicvacuum.discover.model.forward import Forward

    forward = Forward(trial)
    none = np.zeros((1, forward.layout.size))
    found = forward.columns(Hypothesis(), np.zeros((1, 0)), none)
    whole = np.zeros((forward.layout.size, sum(part.shape[2] for part in found)))
    end = 0
    for run, part in enumerate(found):
        whole[forward.layout.local(run), end : end + part.shape[2]] = np.nan_to_num(part[0, 1:])
        end += part.shape[2]
    others, own = whole[:-beads], whole[-beads:]
    inverse = np.linalg.inv(np.eye(len(others)) + others @ others.T)
    across = others @ own.T
    left = own @ own.T - across.T @ inverse @ across
    contrasts = np.eye(beads) - 1.0 / beads
    values, vectors = np.linalg.eigh(contrasts @ left @ contrasts)
    order = np.argsort(values)[::-1][:-1]
    # An eigenvalue is what a direction adds to chi2 on average, if its mass scatters by the tolerance.
    rest = np.cumsum(values[order][::-1])[::-1]
    return vectors.T[order[rest > UNSEEN]]
