"""Records with slips: what a laboratory gets wrong, made of sound records."""

from dataclasses import replace

import msgspec

from sonicvacuum.records import Signals


def altered(record, gauge, change, run=None):
    """A record in which the trace of a gauge, in one run or all, is changed."""

    def one(id, signals):
        if run not in (None, id):
            return signals
        readings = {k: change(v) if k == gauge else v for k, v in signals.readings.items()}
        return Signals(signals.time_us, readings)

    return replace(record, signals={k: one(k, s) for k, s in record.signals.items()})


def unstated(record):
    """The record of a laboratory that does not say how loud its gauges are."""
    sensors = [msgspec.structs.replace(s, sigma_N=None) for s in record.block.sensors]
    return replace(record, block=msgspec.structs.replace(record.block, sensors=sensors))
