"""Durations of pulses whose second hump grows into a pulse of its own, and slopes of what is not found."""

import numpy as np
import pytest

from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model import differences, scalars
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.memory import Memory
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search.singles import setup_of
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse

LEVEL, ERROR = 0.3, 0.001
DURATION = 0  # the first number of the run
# A heavy striker sends a second hump after the first, higher than the level. From this exponent on, the dip
# between, above the level too, is deep enough to part two pulses.
PARTED = 1.5612


def table(duration=1.0, amplitude=1.0):
    """A record of one shot with two numbers of one gauge, in us and N, of `ERROR`."""
    bead = {"diameter_mm": 2.91, "mass_g": 0.03226, "material": "glass"}
    striker = {"shape": "sphere", "material": "delrin", "diameter_mm": 3.78, "mass_g": 0.04}
    numbers = [
        {"quantity": "duration", "level": LEVEL, "value": duration, "unit": "us"},
        {"quantity": "amplitude", "value": amplitude, "unit": "N"},
    ]
    observables = [{**one, "sensor": "p1", "sigma": ERROR * one["value"]} for one in numbers]
    content = {
        "format": 1,
        "title": "Glass beads",
        "chain": {
            "orientation": "horizontal",
            "beads": 15,
            "bead": bead,
            "wall": {"material": "stainless-steel"},
        },
        "sensors": [{"id": "p1", "kind": "embedded", "bead": 6, "gain_rel_sigma": 0.001}],
        "runs": [
            {
                "id": "shot",
                "striker": {**striker, "speed_m_s": 0.0474, "speed_rel_sigma": 0.0},
                "observables": observables,
            }
        ],
    }
    return Record(parse(content), {}, "table")


def of_exponent(forward):
    """Another exponent in all contacts, and its coordinate."""
    effect = CATALOGUE.effect("contact-exponent")
    hypothesis = Hypothesis((Component(effect, variants(effect, setup_of(forward))[0]),))
    return hypothesis, hypothesis.coordinates[0]


def predicted(forward, exponents):
    """(L, 2) numbers of the run for some exponents, in standard errors."""
    hypothesis, coordinate = of_exponent(forward)
    u = np.array([[coordinate.inverse(n)] for n in exponents])
    return forward.sampled(hypothesis, u, np.zeros((len(u), forward.layout.size)))[0]


def test_a_duration_goes_on_where_a_shoulder_becomes_a_pulse():
    """It was 0 from there on: the truth lay behind a cliff."""
    forward = Forward(experiment(table()))
    lasting = predicted(forward, [PARTED - 0.002, PARTED - 0.001, PARTED + 0.001, PARTED + 0.02])[:, DURATION]
    assert lasting[0] == pytest.approx(42.76 / ERROR, rel=2e-3)
    first, at = np.diff(lasting[:3]) / [0.001, 0.002]
    assert at == pytest.approx(first, rel=0.1)
    assert lasting[3] == pytest.approx(lasting[1] + 0.021 * first, rel=1e-3)


@pytest.mark.parametrize("precise", [False, True])
def test_no_slope_leads_to_where_a_number_is_not_found(monkeypatch, precise):
    """A difference over that cliff had a slope of thousands, and the fit beside it an error of nothing."""
    forward = Forward(experiment(table()))
    hypothesis, coordinate = of_exponent(forward)

    def slopes(exponent):
        u = np.array([[coordinate.inverse(exponent)]])
        return forward.columns(hypothesis, u, np.zeros((1, forward.layout.size)), precise=precise)[0][0, 1]

    known, found = slopes(PARTED), scalars.predict

    def lacking(*rest):
        (values,) = found(*rest)
        longer = values[:, DURATION] > values[0, DURATION]
        return [np.where(longer[:, None] & [True, False], 0.0, values)]

    monkeypatch.setattr(scalars, "predict", lacking)
    forward.memory = Memory()
    lost = slopes(PARTED)
    assert known[DURATION] > 0.0 and lost[DURATION] == 0.0
    assert lost[1] == known[1]


def test_a_fit_passes_where_a_shoulder_becomes_a_pulse():
    truth = PARTED + 0.005
    duration, amplitude = (ERROR * predicted(Forward(experiment(table())), [truth])[0]).tolist()
    forward = Forward(experiment(table(duration, amplitude)))
    hypothesis, coordinate = of_exponent(forward)
    u = np.array([[coordinate.inverse(PARTED - 0.04)]])
    found = fit(forward, hypothesis, u, np.zeros((1, forward.layout.size)))
    assert found.objective < 0.01
    assert abs(coordinate.value(found.u[0]) - truth) < 0.5 * found.sigma[0] * coordinate.slope(found.u[0])


def test_slopes_are_of_first_order_where_only_two_steps_lead_over_a_cliff():
    """Of a sample and two numbers, of which one is nowhere found, and the other not two steps away."""
    value = np.array([[[1.0, 3.0, 0.0], [1.1, 3.2, 4.0], [1.3, 0.0, 4.0]]])
    found = differences.slopes(value, np.array([[0.0, 0.1, 0.2]]), 1, 2)
    assert found[0, 0] == pytest.approx([0.5, 2.0, 0.0])
