"""Published facts of chains of unlike bodies, and normal impacts of single spheres."""

import math

import numpy as np
import pytest
from engine_cases import peak
from plain_chain import Plain, ball, hertz
from scipy.signal import find_peaks
from scipy.special import gamma

from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.run import simulate
from sonicvacuum.physics.solitary import SolitaryWave

STEEL = Elastic("steel", 193e9, 0.3)
DIAMETER, MASS, SPEED = 5e-3, 0.5e-3, 0.5


def chain(beads, *masses, exceptions=None):
    """Equal spheres but for their masses, struck by one of `MASS`; masses may differ from lane to lane."""
    pattern = tuple(Body(STEEL, mass, DIAMETER / 2) for mass in masses)
    others = {bead: Body(STEEL, mass, DIAMETER / 2) for bead, mass in (exceptions or {}).items()}
    return Chain(beads, Bodies(pattern, others), STEEL, STEEL, DIAMETER / 2, MASS, SPEED)


def test_dimers_of_two_mass_ratios_carry_solitary_waves():
    # Jayaprakash, Starosvetsky & Vakakis, PRE 83, 036606 (2011): a chain of alternating masses 1 and ε has a
    # wave that leaves nothing behind at ε = 0.3428 and 0.1548, among others, and none close by.
    ratios = np.array([0.33, 0.3428, 0.355, 0.165, 0.1548])
    force = simulate(chain(101, MASS, MASS * ratios), [60], 5.5e-4, 2e-7).force[:, 0]
    tails = []
    for trace in force.T:
        top = trace.argmax()
        after = top + np.flatnonzero(trace[top:] < 1e-3 * trace[top])[0]
        tails.append(trace[after : after + 300].max() / trace[top])
    assert max(tails[1], tails[4]) < 2e-3  # what the start of the wave at the striker leaves
    assert min(tails[0], tails[2], tails[3]) > 5e-3


def test_very_light_beads_are_springs():
    # ε → 0 of the same paper: two contacts in series, of constant K/2^{3/2}, between the heavy beads.
    for ratio in (1e-3, 1e-4):
        dimer = chain(161, MASS * ratio, MASS)
        found = simulate(dimer, (100, 102), 1.2e-3, 2e-7)
        (force, first), (_, second) = (peak(found.time, found.of(c)[:, 0]) for c in (100, 102))
        speed = 2.0 * DIAMETER / (second - first)
        exact = SolitaryWave.compute().speed(force, dimer.stiffness[0] / 2**1.5, 2.0 * DIAMETER, MASS)
        assert speed == pytest.approx(exact, rel=ratio)  # the light bead's inertia


# Mass of every second bead over that of the others.
RATIOS = (1.0, 0.8, 0.65, 0.5, 0.3428, 0.02)


@pytest.fixture(scope="module")
def dimers():
    """Chain and motion of dimers of `RATIOS`, one a lane."""
    made = chain(121, MASS, MASS * np.array(RATIOS))
    return made, simulate(made, range(79, 83), 9.5e-4, 2e-7)


def speed_of(found, lane):
    """Largest force of contact 80, N, and the wave's speed over the cell behind it, m/s."""
    (force, first), (_, second) = (peak(found.time, found.of(c)[:, lane]) for c in (80, 82))
    return force, 2.0 * DIAMETER / (second - first)


def test_a_dimer_carries_its_wave_as_fast_as_a_chain_of_its_mean_mass(dimers):
    # Long waves see the mean mass only (Porter, Daraio, Herbold, Szelengowicz & Kevrekidis, PRE 77, 015601
    # (2008), and the acoustic branch of a chain of two masses): at masses 1 and 0.3428, whose wave leaves
    # nothing behind, and at 2:1, whose wave leaves a little at each cell. The speed is that of its force.
    made, found = dimers
    wave = SolitaryWave.compute()
    for lane, ratio in enumerate(RATIOS):
        if ratio in (1.0, 0.5, 0.3428):
            force, speed = speed_of(found, lane)
            mean = wave.speed(force, made.stiffness[0], DIAMETER, MASS * (1.0 + ratio) / 2.0)
            # The theory's own error: the wave is a few beads long. Masses unmixed it is 1e-6.
            assert speed == pytest.approx(mean, rel=1e-2 if ratio < 1.0 else 1e-5)


def width(time, force):
    """Full width at half maximum of a pulse."""
    top, level = force.argmax(), 0.5 * force.max()
    first = top - np.flatnonzero(force[:top][::-1] < level)[0] - 1
    last = top + np.flatnonzero(force[top:] < level)[0]
    rise = np.interp(level, force[first : first + 2], time[first : first + 2])
    return np.interp(-level, -force[last - 1 : last + 1], time[last - 1 : last + 1]) - rise


def test_a_dimer_carries_a_wider_wave(dimers):
    """Width of the contact force in beads, mean of a cell's two contacts, over that of equal beads.

    Let f = g ± h be the forces of a cell's two kinds of contacts, a bead's diameter a apart, and
    θ = (m1 − m2)/(m1 + m2). Expanded about each contact, Newton's law gives h = aθ/2 g′ + …, and for the
    compression ψ(g), of the mean mass m, with h put in:

        m ∂²/∂t² [ψ + (aθ)²/8 (ψ″ g′² − 2 (ψ)″)] = a² ∂²/∂x² [g + a²/12 g″].

    Mean mass and mean spacing carry the wave as in a chain of equal beads; the dispersion is 1 + 3θ² =
    4 (m1² − m1 m2 + m2²)/(m1 + m2)² times theirs, the length its square root: 1 for equal beads, 2 for very
    light ones, between which the heavy ones are a diameter farther apart. Long-wave
    theory of dimers: Porter et al., PRE 77, 015601 (2008), and Physica D 238, 666 (2009).
    """
    _, found = dimers
    widths = []
    for lane in range(len(RATIOS)):
        each = [width(found.time, found.of(c)[:, lane]) for c in (79, 80)]
        widths.append(np.mean(each) * speed_of(found, lane)[1] / DIAMETER)
    broader = dict(zip(RATIOS, np.array(widths) / widths[0], strict=True))
    theory = {r: 2.0 * math.sqrt(1.0 - r + r**2) / (1.0 + r) for r in RATIOS}
    for ratio in (0.8, 0.65):
        # Terms left out are of order θ⁴ and of the wave's few beads: 0.9 % and 2.9 % are seen.
        assert broader[ratio] == pytest.approx(theory[ratio], rel=0.035)
    assert 1.0 < broader[0.8] < broader[0.65]
    # Two contacts in series: twice as wide, but for the light beads' inertia, of the order of their mass.
    assert broader[0.02] == pytest.approx(2.0, rel=0.02)
    # Between, light beads swing to and fro within the pulse, which then has humps and is no long wave: at the
    # mass ratio that leaves nothing behind both contacts are as wide as of very light beads.
    assert broader[0.3428] > 1.4 * theory[0.3428]


@pytest.fixture(scope="module")
def impurities():
    """Forces of chains of 80 beads whose bead 40 has 0.1, 1, 3 and 10 times the others' mass."""
    return simulate(
        chain(80, MASS, exceptions={40: MASS * np.array([0.1, 1.0, 3.0, 10.0])}), range(81), 6e-4, 2e-7
    )


def pulses(trace, least=5e-3):
    return trace[find_peaks(trace, height=least * trace.max())[0]]


def test_a_light_impurity_rattles(impurities):
    # Hascoët & Herrmann, Eur. Phys. J. B 14, 183 (2000): a light impurity oscillates, more and more weakly,
    # between its neighbours when the wave has passed; nearly all of the wave goes on.
    before, after = (impurities.of(c)[:, 0] for c in (39, 40))
    assert len(pulses(before)) >= 4
    assert len(pulses(after)) >= 4
    incident, passed = impurities.of(20)[:, 0].max(), impurities.of(60)[:, 0].max()
    assert 0.9 < passed / incident < 1.0


def test_a_heavy_impurity_is_shifted_and_breaks_the_wave(impurities):
    # The same paper: the transmitted wave is fragmented into pulses of decreasing amplitude; a pulse returns.
    incident = impurities.of(20)[:, 2]
    sent = pulses(impurities.of(60)[:, 2])
    assert len(sent) >= 2
    assert np.all(np.diff(sent) < 0.0)
    assert len(pulses(incident)) == 2
    heavier = impurities.of(20)[:, 3]
    assert pulses(heavier)[1] > pulses(incident)[1]
    # No impurity, no echo.
    assert len(pulses(impurities.of(20)[:, 1])) == 1


def first_peak(time, force):
    """The incident pulse; the reflected one may be larger."""
    top = find_peaks(force, height=0.1 * force.max())[0][0]
    return peak(time, force[: top + 5])


@pytest.mark.parametrize(("taper", "binary"), [(0.97, 0.002), (0.95, 0.005), (0.9, 0.03)])
def test_a_pulse_in_a_tapered_chain(taper, binary):
    # Radii in geometric sequence. Binary collisions make each bead faster than the last by 2/(1 + q³)
    # (Harbola, Rosas, Esposito & Lindenberg, PRE 80, 031303 (2009); hard spheres: Doney & Sen, PRE 72,
    # 041304 (2005)), so that momentum q³ v falls from bead to bead.
    beads = 40
    sizes = taper ** np.arange(1, beads + 1)
    bodies = tuple(Body(STEEL, MASS * s**3, DIAMETER / 2 * s) for s in sizes)
    tapered = Chain(beads, Bodies(bodies), STEEL, STEEL, DIAMETER / 2, MASS, SPEED)
    found = simulate(tapered, range(20, 32), 3e-4, 2e-8)
    force, moment = np.array([first_peak(found.time, found.of(c)[:, 0]) for c in range(20, 32)]).T
    # Self-similar: F scales as K^{2/5} m^{3/5} v^{6/5}, that is as q² g^{6/5}; times as q g^{−1/5}.
    faster = (np.exp(np.polyfit(np.arange(12), np.log(force), 1)[0]) / taper**2) ** (5 / 6)
    slower = np.exp(np.polyfit(np.arange(11), np.log(np.diff(moment)), 1)[0])
    assert slower == pytest.approx(taper * faster**-0.2, rel=5e-5)  # of the samples' spacing
    assert faster == pytest.approx(2.0 / (1.0 + taper**3), rel=binary)  # not quite binary collisions
    assert taper**3 * faster < 1.0


GLASS, LIMESTONE = ("glass", 48e9, 0.20), ("limestone", 20e9, 0.25)
ALUMINIUM, MAGNESIUM = ("aluminium alloy", 70e9, 0.30), ("magnesium alloy", 40e9, 0.35)
# Chung & Ooi, Granular Matter 13, 643 (2011), tests 1 (two spheres, each at 10 m/s) and 2 (a sphere on a
# rigid plane): radius in m, density in kg/m³, relative speed in m/s.
IMPACTS = {
    "two glass spheres": (GLASS, 0.010, 2800.0, 20.0, True),
    "two limestone spheres": (LIMESTONE, 0.010, 2500.0, 20.0, True),
    "aluminium on a plane": (ALUMINIUM, 0.100, 2699.0, 0.2, False),
    "magnesium on a plane": (MAGNESIUM, 0.100, 1800.0, 0.2, False),
}


@pytest.mark.parametrize("name", IMPACTS)
def test_normal_impacts_of_chung_and_ooi(name):
    material, radius, density, speed, two = IMPACTS[name]
    one = ball(2.0 * radius, material, density)
    rigid = ("rigid", 1e30, 0.3)
    other = one if two else Plain(math.inf, math.inf, rigid)
    mass, k = (one.mass / 2.0 if two else one.mass), hertz(one, other)
    # Johnson, Contact Mechanics (1985), Sec. 11.4: deepest approach, largest force and duration.
    depth = (1.25 * mass * speed**2 / k) ** 0.4
    largest = k * depth**1.5
    lasting = 2.0 * depth / speed * math.sqrt(math.pi) * gamma(1.4) / gamma(0.9)
    body = Body(Elastic(*material), one.mass, radius)
    made = Chain(1 if two else 0, body, body.surface, Elastic(*rigid), radius, one.mass, speed)
    if two:
        made = made.with_defect("gap", 1, 1.0)  # the second sphere flies freely
    found = simulate(made, [0], 1.2 * lasting, lasting / 500.0, refine=4.0)
    force = found.of(0)[:, 0]
    assert peak(found.time, force)[0] == pytest.approx(largest, rel=1e-6)  # of the quartic through the top
    assert np.trapezoid(force, found.time) == pytest.approx(2.0 * mass * speed, rel=1e-5)  # of the trapezoids
    contact = found.time[np.flatnonzero(force > 0.0)[-1]]
    assert contact == pytest.approx(lasting, abs=lasting / 500.0)  # one sample
    assert found.striker_speed[0] == pytest.approx(0.0 if two else -speed, abs=1e-6 * speed)
