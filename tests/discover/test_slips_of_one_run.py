"""A run that was triggered at another moment than the others, or struck far from its stated speed."""

import numpy as np
import pytest

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.report import bench


@pytest.mark.parametrize(
    ("change", "slip", "value"),
    [
        # Twelve standard errors of the trigger; the pulse is 25 us wide.
        (lambda r: changes.time_zero(r, {"v1": 12.0}, 0.0), "time-zero", -12.0),
        (lambda r: changes.time_zero(r, {"v1": -90.0}, 0.0), "time-zero", 90.0),
        # Beyond what slopes at the stated speed lead to.
        (lambda r: changes.strikers(r, "speed_m_s", -np.log(2.0), ("v1",)), "run-off", 2.0),
        (lambda r: changes.strikers(r, "speed_m_s", np.log(10.0), ("v1",)), "run-off", 0.1),
        (lambda r: changes.strikers(r, "speed_m_s", -np.log(10.0), ("v0",)), "run-off", 10.0),
    ],
)
def test_it_is_told_with_its_size_and_nothing_is_missing(empty, change, slip, value):
    found = session.discover(change(empty), catalogue=CATALOGUE, limits=False).verdict
    assert found.named == []
    (one,) = found.faults
    assert (one.fault, one.run) == (slip, "v1" if value != 10.0 else "v0")
    assert one.probability > 0.95
    # The trigger's own error is 1 us, that of a speed 1 %.
    assert one.value == pytest.approx(value, rel=0.03, abs=2.0 if slip == "time-zero" else 0.0)
    if slip == "time-zero":
        (said,) = bench.slips(found)
        way = "before" if value < 0.0 else "after"
        assert f"us {way} the impact in run v1" in said
