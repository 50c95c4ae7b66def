"""Records whose priors exclude every effect: what is left is none or unknown, and slips are told. All ended
in an error.
"""

from dataclasses import replace

import msgspec
import pytest

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes
from sonicvacuum.effects import CATALOGUE


def excluded(record):
    """The record of a laboratory that has no effect of the catalogue."""
    priors = dict.fromkeys(CATALOGUE.ids, 0)
    return replace(record, block=msgspec.structs.replace(record.block, priors=priors))


@pytest.mark.parametrize(("which", "named"), [("empty", []), ("hidden", ["unknown"])])
def test_a_misfit_is_unknown_and_noise_is_none(request, which, named):
    v = session.discover(excluded(request.getfixturevalue(which)), threads=1).verdict
    assert v.named == named
    assert set(v.probabilities) == {"none", "unknown"}
    assert v.probabilities["none"] == pytest.approx(float(not named), abs=0.1)
    assert v.faults == []


def test_slips_are_told_all_the_same(hidden):
    swapped = excluded(changes.gauges_swapped(hidden, "g4", "g7"))
    v = session.discover(swapped, threads=1).verdict
    assert ("gauges-swapped", ("g4", "g7")) in [
        (f.fault, tuple(f.sensor)) for f in v.faults if f.probability > 0.9
    ]
    assert v.named == ["unknown"]
