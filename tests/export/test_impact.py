"""Closed forms of one ball's impact: limits, inverses, and the engine where a law has no other check."""

import math

import numpy as np
import pytest
from made_balls import SPEEDS, bounced
from scipy.integrate import solve_ivp
from scipy.special import beta, lambertw

from sonicvacuum.physics import impact


def oscillator(ratio):
    """Restitution of a spring and a dashpot that do not pull, at every speed (Schwager & Pöschel 2007)."""
    return math.exp(-ratio * impact.oscillator_duration(ratio))


def hunt_crossley(y):
    """Restitution of f(δ)(1 + d v) for y = d v, whatever f: m v dv = −f (1 + d v) dδ separates, so that d v −
    ln(1 + d v) is the same before and after (Hunt & Crossley 1975); its root is a Lambert function.
    """
    return (1.0 + np.real(lambertw(-(1.0 + y) * np.exp(-1.0 - y)))) / y


@pytest.mark.parametrize("ratio", [0.05, 0.4, 0.9, 0.999999999, 1.0, 1.5, 4.0])
def test_the_oscillator_lasts_until_its_force_is_zero(ratio):
    def motion(_, state):
        return state[1], -state[0] - 2.0 * ratio * state[1]

    def force(time, state):
        return state[0] + 2.0 * ratio * state[1] if time > 0.0 else 1.0

    force.terminal = True
    found = solve_ivp(motion, (0.0, 50.0), (0.0, 1.0), events=force, rtol=1e-11, atol=1e-13)
    # Accuracy of the integration above.
    assert impact.oscillator_duration(ratio) == pytest.approx(found.t[-1], rel=1e-7)
    assert oscillator(ratio) == pytest.approx(-found.y[1, -1], rel=1e-7)


def test_a_restitution_names_no_damping_from_the_critical_one_on():
    with pytest.raises(ValueError, match="critical"):
        impact.uncut_restitution(1.0)


def test_hunt_crossley_durations_have_their_limits():
    assert impact.hunt_crossley_duration(0.0, 1.0) == pytest.approx(math.pi, rel=1e-8)  # harmonic half period
    # Johnson, Contact Mechanics (1985), Sec. 11.4: 2.9432 (5/4)^{2/5} for the Hertz contact.
    assert impact.hunt_crossley_duration(0.0, 1.5) == pytest.approx(2.94327 * 1.25**0.4, rel=1e-5)


def test_the_viscoelastic_forms_agree_where_both_hold():
    x = np.array([1e-4, 1e-3, 1e-2])
    # The next order of the series is x^{5/2} with the coefficient 0.27 (Schwager & Pöschel 2008), then x³.
    bound = 0.4 * x**2.5 + 2e-5 * x
    # Ramirez, Pöschel, Brilliantov & Schwager, Phys. Rev. E 60, 4465 (1999), Eqs. 22 and 24: C1 = 1.15344.
    first = 2.0 * 1.25**0.6 * beta(0.6, 1.5) / 2.5
    series = 1.0 - first * x + 0.6 * (first * x) ** 2
    assert np.all(np.abs(series - impact.viscoelastic_restitution(x)) < bound)
    assert first == pytest.approx(1.15344, abs=1e-5)


def test_the_viscoelastic_form_is_the_engine_s_at_any_damping():
    for time_us in (0.5, 5.0, 20.0):
        chain, rebound, _ = bounced("kuwabara-kono", time_us=time_us)
        stiffness, mass = (float(a(1)[0, 0]) for a in (chain.stiffnesses, chain.masses))
        x = impact.viscoelastic_number(time_us * 1e-6, stiffness, mass, SPEEDS)
        # The approximant's own error: by a solver to 1e-11 the engine is within 1e-7, the approximant 6e-4
        # away where the ball keeps a tenth of its speed, 1e-4 where it keeps half.
        np.testing.assert_allclose(impact.viscoelastic_restitution(x), rebound, rtol=0.0, atol=8e-4)


def test_closed_forms_are_the_engine_s():
    _, rebound, _ = bounced("tsuji", alpha=0.4)
    np.testing.assert_allclose(rebound, oscillator(impact.tsuji_ratio(0.4)), rtol=1e-5)  # the engine's step
    _, rebound, _ = bounced("hunt-crossley", damping_s_per_m=0.3)
    np.testing.assert_allclose(rebound, hunt_crossley(0.45 * SPEEDS), rtol=1e-6)
