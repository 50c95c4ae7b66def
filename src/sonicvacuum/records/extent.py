"""How much a record asks for, a search in it or a look at it, estimated beforehand, see `physics.extent`."""

from dataclasses import replace

from sonicvacuum.files import InputError
from sonicvacuum.physics.extent import LIFT, Extent, TooLargeError, estimate
from sonicvacuum.physics.scales import COUNTING, passage_of, sampling_of
from sonicvacuum.records.assemble import assemble, duration_of, interval_of
from sonicvacuum.records.record import Record

# Simulations of every run that a verdict takes, some 2 000 for one effect and more for several; how many of
# them stand in the memory at once.
SIMULATIONS, AT_ONCE = 5000, 100


def check_extent(record: Record) -> None:
    """InputError for a record whose search asks for more than a computer gives."""
    try:
        Extent(record.beads, 1.0, 1.0, 1.0).check()  # before anything is made for each bead
        for batch in assemble(record):
            runs = [record.runs[place] for place in batch.runs]
            spans = duration_of(record, runs, batch.chain), interval_of(runs, batch.chain)
            one = estimate(batch.chain, 2 * len(record.gauges) + 1, *spans)
            replace(one, work=SIMULATIONS * one.work, memory=AT_ONCE * one.memory).check()
    except TooLargeError as error:
        raise InputError(f"{record.name}: {error}") from None


def check_expected(record: Record) -> None:
    """InputError for a record whose nominal model, followed until its pulse has come back from the wall, asks
    for more than a computer gives.
    """
    try:
        Extent(record.beads, 1.0, 1.0, 1.0).check()
        for batch in assemble(record) if record.beads else ():
            spans = passage_of(batch.chain, COUNTING), sampling_of(batch.chain)
            estimate(batch.chain, 2 * len(record.gauges) + 1, *spans).check(
                f"fewer beads or gauges, or {LIFT}"
            )
    except TooLargeError as error:
        raise InputError(f"{record.name}: {error}") from None
