"""A verdict says where its own simulation leaves the range of the physics."""

from types import SimpleNamespace

import numpy as np
import pytest
from made_records import block

from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.session import _doubts
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.reader import parse


@pytest.mark.parametrize(("strength", "doubtful"), [(59.0, False), (1.0, True)])
def test_contacts_that_would_yield_are_told(strength, doubtful):
    content = block((0.3, 0.9))
    content["materials"]["parylene-c"]["yield_MPa"] = strength
    parsed = parse(content)
    time = np.arange(0.0, 700.0, 1.0)
    traces = {r.id: Signals(time, {s.id: np.zeros(700) for s in parsed.sensors}) for r in parsed.runs}
    record = Record(parsed, traces, "made")
    forward = Forward(experiment(record))
    final = SimpleNamespace(nu=np.zeros(forward.layout.size), u=np.zeros(0), hypothesis=Hypothesis())
    told = _doubts(SimpleNamespace(forward=forward, final=final), record)
    assert [("times the yield strength" in t) for t in told] == ([True] if doubtful else [])
