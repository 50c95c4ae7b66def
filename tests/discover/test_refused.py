"""A slip that keeps the right effect from predicting runs that it has not seen: nothing was named then, and
no slip told, although nuisances were strained by twenty of their errors.
"""

import math

import pytest
from made_records import made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes


def test_a_run_off_is_told_beside_a_gauge_of_another_gain():
    gain = [("sensor-gain", {"gain_ratio": 1.5, "sensor": 0.0})]
    record, _ = made(gain, seed=3, speeds=(0.3, 0.5, 0.8, 1.2))
    v = session.discover(changes.strikers(record, "speed_m_s", math.log(1.15), ("v2",))).verdict
    assert v.named == ["sensor-gain"]
    (told,) = (f for f in v.faults if f.probability > 0.9)
    assert (told.fault, told.run) == ("run-off", "v2")
    # The stated speed and that of all gauges are known to 1 and 2 %.
    assert told.value == pytest.approx(1.0 / 1.15, rel=0.05)
