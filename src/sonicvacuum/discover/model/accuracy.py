"""How accurate the simulations of a search are: the stepper and finite differences, as far as noise asks for.

Both follow the norm of the whitened data, in standard errors: a weak record is simulated with longer steps
than a precise one, so that the error stays the same small part of the noise. Where a record's own chain errs
by more than the rule expects, its steps are cut.
"""

from copy import copy

import numpy as np

from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.scales import passage_of

# Largest steps of speed and modulus for finite differences, relative; smaller where the data are precise, so
# that all data together change by about this many standard errors, and collinear columns come out collinear.
LARGEST_STEP, STEP_AIM = 3e-3, 10.0
# What traces show bends within such a step where contacts part and meet for many reflections: in four
# crossings the error of a preload came out as an eighth of what it is. Slopes that errors follow from are
# taken over so many times shorter steps there. Fits go by the longer ones, which lead past minima that lie
# near.
FINER = 10.0
# Error of a simulation at full accuracy as a share of the data's norm, and what is allowed of it, in standard
# errors over all data together; it grows as the fourth power of the step. Below LONGEST coated chains with
# any law, and contacts that forget ten times the elastic force in 0.3 us, err by some 1e-4 of a gauge's peak;
# at twice that a step is as long as one of a memory can be.
ERROR, ERROR_AIM, LONGEST = 1e-6, 0.05, 3.0
# Contacts that open and close for many reflections multiply what a step errs by: the prediction of a long
# record is held against one of half the step, until they agree within TOLERATED standard errors over all data
# together or the step is the full one's SHORTEST part. Effects whose steppers err otherwise are named for a
# difference of ten in χ² and more.
TOLERATED, SHORTEST = 0.5, 4.0
# Where a model that is hardly known leaves so many times the noise's χ², errors of some standard errors over
# all data are small beside the hundreds that it leaves: its steps are not cut.
HIDES = 25.0
# Only where traces last this share of the time in which the slowest wave would cross the chain five times:
# ordinary records end before.
LASTING = 0.3
# The same of running integrals, which only lead to where fits start.
LEADING_AIM = 1.0


def difference(norm: float) -> float:
    """Relative step of speeds and moduli for finite differences."""
    return float(np.clip(STEP_AIM / max(norm, 1e-9), 1e-5, LARGEST_STEP))


def bent(experiment) -> bool:
    """Whether data may bend within the usual steps: traces that last for reflections. Numbers that are read
    off traces would jump over shorter ones; where beads are of several kinds no step is short enough.
    """
    one_kind = all(len(batch.chain.bodies.kinds) == 1 for batch in experiment.batches)
    return one_kind and not any(run.scalars for run in experiment.runs) and reflected(experiment)


def reflected(experiment) -> bool:
    """Whether some traces last for reflections, see `lasting`."""
    return any(lasting(batch.chain, _recorded(experiment, batch)) for batch in experiment.batches)


def refinement(norm: float, leading: bool = False) -> float:
    """By what the stepper's full accuracy is refined: below 1, as far as noise leaves it unseen; less still
    where predictions are only `leading` to where others begin.
    """
    aim = LEADING_AIM if leading else ERROR_AIM
    return float(np.clip((ERROR * norm / aim) ** 0.25, 1.0 / LONGEST, 1.0))


def cut(forward) -> float:
    """By how much the steps of a `Forward` are cut beyond what its norm asks for: halved until the error of
    its nominal chains is tolerated; not at all where its data are `approximate`.
    """
    experiment, least = forward.experiment, refinement(forward.norm)
    if experiment.approximate or not reflected(experiment):
        return 1.0
    refine, seen = least, _nominal(forward, least)
    while refine < SHORTEST:
        finer = _nominal(forward, 2.0 * refine)
        if _apart(seen, finer) <= TOLERATED:
            break
        refine, seen = 2.0 * refine, finer
    return refine / least


def lasting(chain: Chain, time_s: float) -> bool:
    """Whether waves run to and fro several times in so many seconds after the impact."""
    return bool(chain.beads) and time_s > LASTING * passage_of(chain)


def _recorded(experiment, batch) -> float:
    """Last instant in s of the traces of a batch, 0 without any."""
    runs = [experiment.runs[k] for k in batch.runs]
    return max((float(run.time[-1]) for run in runs if run.has_signals), default=0.0)


def _nominal(forward, refine):
    """(data,) whitened prediction of the nominal chains."""
    other = copy(forward)
    other._refine = refine
    seen = other.sampled(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))
    forward.simulations = other.simulations
    return np.concatenate([value[0] for value in seen])


def _apart(one, other):
    """Distance of two predictions in standard errors; what is not shown does not count."""
    return np.sqrt(np.nansum((one - other) ** 2))
