"""Another number of beads in place of time zeros that are all off.

What a bead more delays at the wall, late triggers would delay as well, and an effect that is not known yet
besides: beside the nominal model time zeros explain more, as each run has its own. Beside the effects that
were found they may explain no more than a bead does, which has no size at all.
"""

from dataclasses import replace

import numpy as np

from sonicvacuum.discover.faults import zeros
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.judged import of_the_chain
from sonicvacuum.discover.faults.slips import Slip, chain_slips
from sonicvacuum.discover.faults.weights import unexplained
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.rounds import Investigation, investigate
from sonicvacuum.records import Record, Signals

# Times are shifted alike where they differ by no more than this share of an interval: roundings.
ROUNDED = 1e-3


def instead_of_zeros(search, found: Investigation) -> Investigation:
    """The effects beside another number of beads and time zeros as stated, where these explain a record as
    well as time zeros that are all off do, but for what those must gain.

    Args:
        search: of slips and effects; what it has put right and tells of follows what is returned.
        found: effects beside time zeros that were put right.
    """
    told = [f for f in search.findings if f.corrected and f.fault == "time-zero"]
    if len(told) != 1 or told[0].run is not None or not _movable(found):
        return found
    record = _with_zeros_of(search.bench.record, search.given)
    counts = [slip for slip in chain_slips(record) if of_the_chain(slip)] if record else []
    tried = [(slip, *_trial(search, found, slip, record)) for slip in counts]
    if not tried:
        return found
    slip, bench, left = min(tried, key=lambda one: one[2])
    if left - found.final.objective > zeros.cost(search.bench.record) + 2.0 * slip.log_prior:
        return found
    after = investigate(search.make(bench), search.threads)
    search.simulations += found.forward.chains
    if unexplained(after) and not unexplained(found):
        return found
    others = [f for f in search.findings if f is not told[0]]
    own = [replace(f, corrected=True) for f in slip.findings(0.0, told[0].probability)]
    search.bench, search.findings = bench, others + own
    return after


def _movable(found):
    """Whether effects were found, none of which sits at a bead or contact: that would be another one."""
    parts = found.final.hypothesis.components
    return bool(parts) and not any(c.effect.places in ("bead", "contact") for c in parts)


def _with_zeros_of(record: Record, given: Record) -> Record | None:
    """A record with the times that another one states; None where its own are no shift of these."""
    signals = {}
    for run, own in record.signals.items():
        stated = given.signals[run].time_us
        if own.samples != len(stated) or np.ptp(own.time_us - stated) > ROUNDED * 1e6 * own.interval_s:
            return None
        signals[run] = Signals(stated, own.readings)
    known = zeros.stated_again(record, given)
    return None if known is None else replace(known, signals=signals)


def _trial(search, found, slip: Slip, record: Record) -> tuple[Bench, float]:
    """The record with another number of beads, and what the effects found leave of it."""
    bench, one = replace(search.bench, record=slip.change(record, 0.0)), found.final
    forward = Forward(search.judged(bench), search.threads)
    trial = fit(forward, one.hypothesis, one.u[None], np.zeros((1, forward.layout.size)))
    search.simulations += forward.chains
    return bench, trial.objective
