"""Ranges of parameters go with the impact: the same in its units for grains and balls; as written, beads."""

from dataclasses import replace

import pytest
from effect_cases import nominal

from sonicvacuum.effects import CATALOGUE, effect
from sonicvacuum.effects.sized import ratios_of, sized

# Parameter → how it grows with the size of all bodies, at the same materials and speeds: forces with its
# square, times and depths in proportion.
POWERS = {
    ("velocity-power", "gamma"): 2.0,
    ("linear-dashpot", "damping_kg_s"): 2.0,
    ("static-preload", "force_N"): 2.0,
    ("kuwabara-kono", "time_us"): 1.0,
    ("contact-gap", "gap_um"): 1.0,
    ("viscous-drag", "rate_per_s"): -1.0,
    ("hunt-crossley", "damping_s_per_m"): 0.0,
}


def chain(size):
    """The paper's chain with all bodies so many times as large; gravity, which is no size, left out."""
    own = nominal().chain
    bodies = own.bodies.replaced(lambda b: replace(b, radius=b.radius * size, mass=b.mass * size**3))
    return replace(own, bodies=bodies, striker_mass=own.striker_mass * size**3, gravity=0.0 * own.gravity)


def test_the_catalogue_stands_where_it_was_written_for():
    assert all(sized(e, ratios_of(nominal().chain)) is e for e in CATALOGUE)


@pytest.mark.parametrize("size", [1e-3, 1e3])
@pytest.mark.parametrize("name", POWERS)
def test_ranges_go_with_the_impact(name, size):
    id, parameter = name
    # Relative to a chain that is far off as well: the catalogue's own middle is no chain's exactly.
    one, other = (sized(effect(id), ratios_of(chain(s))).parameter(parameter) for s in (size, 3.0 * size))
    power = POWERS[name]
    for key in ("low", "high", "scale"):
        assert getattr(other, key) / getattr(one, key) == pytest.approx(3.0**power, rel=1e-6)
    if not power:
        assert one == other == effect(id).parameter(parameter)


@pytest.mark.parametrize("name", ["sensor-droop", "sensor-lowpass"])
def test_electronics_have_times_of_their_own(name):
    assert sized(effect(name), ratios_of(chain(1e-3))) is effect(name)
