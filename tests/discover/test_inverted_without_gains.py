"""A gauge upside down where no gauge is calibrated."""

from dataclasses import replace

from made_records import with_keys

from sonicvacuum.discover.faults.examine import examine
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.records import Signals


def test_it_is_told_and_put_right(empty):
    """It was `unknown` with 1.00 after a minute: beside a gain of nearly nothing no pulse was expected."""
    record = with_keys(empty, sensors={"gain_rel_sigma": "unknown"})
    turned = {
        k: Signals(s.time_us, {**s.readings, "g7": -s.readings["g7"]}) for k, s in record.signals.items()
    }
    bench, found = examine(
        replace(record, signals=turned), predicted(experiment(replace(record, signals=turned)))
    )
    assert [(f.fault, f.run, f.sensor) for f in found] == [("gauge-inverted", None, "g7")]
    for run, signals in bench.record.signals.items():
        assert (signals.readings["g7"] == record.signals[run].readings["g7"]).all()
