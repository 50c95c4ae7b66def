"""The ideal rule is one: places gain nothing, copies share, and shares are those of theory."""

import math

import numpy as np
import pytest
from scipy import stats

from sonicvacuum_blind import ideal
from sonicvacuum_blind.hide import Spec, laboratory
from sonicvacuum_blind.ideal import Hypothesis, shares
from sonicvacuum_blind.strength import FALSE_ALARM, Rival, ceiling

DATA = 40
DRAWS = 4000


def explanation(name, direction, data, mass=0.0):
    """A linear effect fitted to noise-free data: it misses what stands at right angles to its direction."""
    slopes = (direction * (direction @ data))[:, None]
    missed = direction * (direction @ data) - data
    return Hypothesis(name, mass, missed, slopes, (np.zeros(0), np.zeros((0, 1))))


def at_angle(cosine):
    one, two = np.eye(DATA)[:2]
    return one, cosine * one + math.sqrt(1.0 - cosine**2) * two


@pytest.mark.parametrize("copies", [2, 3, 5])
def test_copies_under_other_names_share(copies):
    one = np.eye(DATA)[0]
    same = [explanation(f"copy {k}", one, 20.0 * one) for k in range(copies)]
    found = shares(same, np.random.default_rng(1), DRAWS)
    # 4 standard errors of a share of the draws.
    assert list(found.values()) == pytest.approx([1.0 / copies] * copies, abs=4 * math.sqrt(0.25 / DRAWS))


def test_copies_share_where_strengths_act_linearly():
    one = np.eye(DATA)[0]
    found = ceiling([Rival(f"copy {k}", None, one) for k in range(4)], 12.0 * one, np.random.default_rng(1))
    assert found["copy 0"] == pytest.approx(0.25, abs=4 * math.sqrt(0.19 / 2000))  # 4 standard errors


def test_an_effect_gains_nothing_by_more_places():
    """Ten places, each with a tenth of the mass, all alike: as good as the one of the other effect."""
    one = np.eye(DATA)[0]
    many = [explanation("many", one, 20.0 * one, -math.log(10.0)) for _ in range(10)]
    found = shares([*many, explanation("one", one, 20.0 * one)], np.random.default_rng(2), DRAWS)
    assert found["one"] == pytest.approx(0.5, abs=4 * math.sqrt(0.25 / DRAWS))  # 4 standard errors


@pytest.mark.parametrize(("d_prime", "cosine"), [(10.0, 0.95), (20.0, 0.98), (100.0, 0.9995)])
def test_two_linear_effects_are_told_apart_as_often_as_theory_says(d_prime, cosine):
    """The likelier of two is that along which data are larger: Φ(d′ √((1 − cos)/2)), but for priors, whose
    ratio is the cosine.
    """
    one, other = at_angle(cosine)
    data = d_prime * one
    both = [explanation("one", one, data), explanation("other", other, data)]
    expected = stats.norm.cdf(d_prime * math.sqrt((1.0 - cosine) / 2.0))
    found = shares(both, np.random.default_rng(3), DRAWS)["one"]
    assert found == pytest.approx(expected, abs=0.03)  # ln of the cosine moves the bound by up to 0.05


def test_nothing_is_named_in_a_hundredth_of_what_is_empty_with_equal_effects():
    one, other = at_angle(0.5)
    empty = ceiling([Rival("a", None, one), Rival("b", None, other)], 0.0 * one, np.random.default_rng(4))
    assert empty["none"] == pytest.approx(1.0 - FALSE_ALARM, abs=1e-3)  # the level itself, on the same draws


def test_what_is_hidden_is_found_through_the_integrator_at_any_strength():
    """No signature of the truth is handed over, and the fit leaves nothing of it at d′ 100."""
    spec = Spec("x", "single", "ball", "white", ("hunt-crossley",), 100.0, 7, 0)
    own = laboratory(spec)
    line = ideal.line(spec)
    assert line.ideal > 0.99
    sizes = [float(cell.split("=")[1]) for cell in line.cells.split()]
    rest = own.case.hidden[0].seen[: len(own.case.frame.base)]
    assert math.hypot(*sizes) == pytest.approx(np.linalg.norm(rest), rel=1e-3)  # four digits are written


def test_empty_records_have_no_ideal_and_nothing_is_left_anywhere():
    line = ideal.line(Spec("x", "null", "one-speed", "white", (), 0.0, 7, 0))
    assert math.isnan(line.ideal)
    assert line.before == 0.0
    assert {cell.split("=")[1] for cell in line.cells.split()} == {"0"}
