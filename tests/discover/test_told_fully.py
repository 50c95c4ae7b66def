"""What a record may say besides values: shared errors, bounds, discharge of gauges, a coating."""

import math

import numpy as np
import pytest
from made_records import block

from sonicvacuum.discover import quantities
from sonicvacuum.discover.fit.evidence import occam_shape
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis
from sonicvacuum.discover.model.parameters import coordinate
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search.singles import setup_of
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse

SPEED = {"quantity": "speed", "from": "g4", "to": "g7", "unit": "m/s"}
FORCE = {"quantity": "amplitude", "sensor": "g4", "unit": "N"}
SHARED = {"places": 0.04}


def record(*observables, sensors=(), **changes) -> Record:
    """One impact on ten beads with these observables and no traces; `sensors` keys go to every gauge."""
    content = block([0.3]) | changes
    del content["runs"][0]["signals"]
    content["sensors"] = [{**s, **dict(sensors)} for s in content["sensors"]]
    content["runs"][0]["observables"] = list(observables)
    return Record(parse(content), {}, "told")


def shown(one: Record) -> np.ndarray:
    """Values in SI that the nominal model shows of its observables."""
    forward = Forward(experiment(one))
    values = forward.sampled(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))[0][0]
    return values * [s.sigma for s in forward.experiment.runs[0].scalars]


@pytest.fixture(scope="module")
def nominal():
    """Speed and force of the nominal model."""
    speed, force = SPEED | {"value": 200.0, "sigma": 2.0}, FORCE | {"value": 3.0, "sigma": 0.3}
    return shown(record(speed, force))


def chi2(*observables):
    """Least sum of squares of the nominal model, penalties of the nuisances included."""
    forward = Forward(experiment(record(*observables, materials={"parylene-c": {"modulus_rel_sigma": 0.0}})))
    return fit(forward, Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size))).objective


def test_an_error_that_two_speeds_share_counts_once(nominal):
    # Both 8 % off, 1 % of their own and 4 % shared: y' C^-1 y with C = own² + shared² everywhere. The
    # striker's 1 % moves both speeds too (a fifth of it).
    speed, off = float(nominal[0]), 0.08
    one = SPEED | {"value": speed * math.exp(off), "sigma": 0.01 * speed, "shared": SHARED}
    common = 0.04**2 + (0.2 * 0.01) ** 2
    pair = chi2(one, one)
    # Values are linear, the shared error a factor: half of 8 % is the next order.
    assert pair == pytest.approx(2 * off**2 / (0.01**2 + 2 * common), rel=0.1)
    alone = SPEED | {"value": speed * math.exp(off), "sigma": math.hypot(0.01, 0.04) * speed}
    assert chi2(alone, alone) > 1.7 * pair


def test_what_is_left_out_is_predicted_by_the_others(nominal):
    # Two speeds of one shared error s, each 3 % off, own error o: the other one alone says off s²/(s² + o²).
    speed, force, off = *map(float, nominal), 0.03
    one = SPEED | {"value": speed * (1.0 + off), "sigma": 0.01 * speed, "shared": SHARED}
    held = FORCE | {"value": 1.5 * force, "sigma": 0.1 * force, "bound": "at_most"}
    exact = {"parylene-c": {"modulus_rel_sigma": 0.0}}
    forward = Forward(experiment(record(one, one, held, materials=exact)))
    found = fit(forward, Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))
    first, _, bound = (
        dict(zip(quantities.HEADER, row, strict=True))
        for row in quantities.rows((forward, found), (forward, found))
    )
    share = 0.04**2 / (0.04**2 + 0.01**2)
    assert first["held_out"] == pytest.approx(speed * (1.0 + share * off), rel=2e-3)  # exp, and the striker
    assert (first["quantity"], first["unit"]) == ("speed g4-g7", "m/s")
    assert bound["extended"] == pytest.approx(force, rel=0.02) == bound["held_out"]
    assert (bound["bound"], bound["measured"]) == ("at_most", pytest.approx(1.5 * force))


def test_a_bound_asks_for_no_more(nominal):
    force = float(nominal[1])
    held = FORCE | {"value": 1.5 * force, "sigma": 0.1 * force, "bound": "at_most"}
    assert chi2(held) == pytest.approx(0.0, abs=1e-9)
    assert chi2(held | {"bound": "at_least"}) > 10.0
    missed = FORCE | {"value": 0.7 * force, "sigma": 0.1 * force}
    assert chi2(missed | {"bound": "at_most"}) == pytest.approx(chi2(missed), rel=1e-6)


def test_columns_of_shared_errors_and_bounds_are_slopes(nominal):
    speed, force = map(float, nominal)
    given = [
        SPEED | {"value": speed, "sigma": 0.01 * speed, "shared": SHARED},
        FORCE | {"value": 0.5 * force, "sigma": 0.1 * force, "bound": "at_most"},
        FORCE | {"value": 2.0 * force, "sigma": 0.1 * force, "bound": "at_most"},
    ]
    forward = Forward(experiment(record(*given)))
    at = 0.3 * np.ones((1, forward.layout.size))
    found = forward.columns(Hypothesis(), np.zeros((1, 0)), at, precise=True)[0][0, 1:]
    step = 1e-3
    around = np.concatenate([at + step * np.eye(at.size), at - step * np.eye(at.size)])
    value = forward.sampled(Hypothesis(), np.zeros((len(around), 0)), around)[0]
    slopes = (value[: at.size] - value[at.size :]) / (2.0 * step)
    np.testing.assert_allclose(found, slopes[forward.layout.local(0)], atol=2e-3)
    assert not found[:, 2].any() and found[:, 1].any()


def test_a_stated_discharge_is_in_the_nominal_model(nominal):
    force = FORCE | {"value": 3.0, "sigma": 0.3}
    assert 0.9 < shown(record(force, sensors={"droop_us": 1000.0}))[0] / nominal[1] < 0.99


def test_a_stated_thickness_is_searched_within_its_error():
    bead = {"diameter_mm": 4.86, "mass_g": 0.44, "material": "parylene-c", "coating_um": 50}
    chain = block([0.3])["chain"] | {"bead": bead | {"core": "stainless-steel"}}
    speed = SPEED | {"value": 200.0, "sigma": 2.0}
    free = Forward(experiment(record(speed, chain=chain)))
    known = Forward(experiment(record(speed, chain=chain, tolerances={"coating_rel": 0.1})))
    parameters = [f.experiment.catalogue.effect("coating-thickness").parameters[0] for f in (free, known)]
    assert [p.known for p in parameters] == [None, (pytest.approx(50.0), 0.1)]
    c = coordinate(parameters[1], setup_of(known))
    ends = sorted(float(c.value(u)) for u in (c.low, c.high))
    assert ends == pytest.approx([50.0 * math.exp(-0.2), 50.0 * math.exp(0.2)])
    assert all(ends[0] < c.value(u) < ends[1] for u in c.starts())
    hypothesis = Hypothesis((Component(known.experiment.catalogue.effect("coating-thickness"), (c,)),))
    one = fit(known, hypothesis, np.zeros((1, 1)), np.zeros((1, known.layout.size)))
    # Nothing is paid for a thickness that the data know no better than the record does.
    assert occam_shape(one, 0) <= 0.0 and abs(one.u[0]) <= 0.2 + 1e-9
