"""The solitary wave in sonic vacuum: the long-wave soliton of Eq. (3), and the exact wave of the chain.

Long-wave: ξ = ξ_m cos⁴(√10/(5a) (x − V t)) over one hump, zero outside (Daraio and Nesterenko, Phys. Rev. E
73, 026612 (2006), solution of Eq. (3); Nesterenko, "Dynamics of Heterogeneous Materials", 2001, ch. 1).

Exact: contacts with F = k δⁿ pass one profile on with the delay a/V.  With φ = t V/a, and with compression d
and force f = dⁿ in units of their peaks, Newton's law of the beads is the advance-delay equation
d″(φ) = s⁻² [f(φ+1) − 2 f(φ) + f(φ−1)] or, integrated twice, d = s⁻² Λ*f with the tent Λ(φ) = max(1 − |φ|, 0)
(English and Pego, Proc. Am. Math. Soc. 133, 1763 (2005)).  The constant s fixes the speed,
V = s a √(k/M) δ_m^{(n−1)/2} = s a √(k/M) (F_m/k)^{(n−1)/(2n)}.  The wave exists (MacKay, Phys. Lett. A 251,
191 (1999)); its tails fall off doubly exponentially (Chatterjee, Phys. Rev. E 59, 5912 (1999); English and
Pego).

All in SI units; ``stiffness`` is k [N/mⁿ], which is `theory.hertz_stiffness` when n = 3/2.
"""

from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np

from .theory import Num, Real, require, require_not_negative, require_positive


def soliton_strain(position: Num, time: Num, peak_strain: Num, speed: Num, diameter: Num) -> Real:
    """Strain ξ of the long-wave soliton at ``position`` [m] and ``time`` [s]; its crest is at x = V t.

    ``speed`` V [m/s] is that of Eq. (5) at ``peak_strain``.  Arguments broadcast.
    """
    require_not_negative(peak_strain=peak_strain, speed=speed)
    require_positive(diameter=diameter)
    angle = np.sqrt(10) / 5 * (np.asarray(position) - np.multiply(speed, time)) / np.asarray(diameter)
    return np.asarray(peak_strain) * np.where(np.abs(angle) < np.pi / 2, np.cos(angle), 0.0) ** 4


def soliton_force(position: Num, time: Num, peak_force: Num, speed: Num, diameter: Num) -> Real:
    """Contact force F_m cos⁶(√10/(5a) (x − V t)) [N] of the long-wave soliton, by Eq. (4); V of Eq. (6)."""
    require_not_negative(peak_force=peak_force)
    return np.asarray(peak_force) * soliton_strain(position, time, 1.0, speed, diameter) ** 1.5


def soliton_width(diameter: Num, level: Num = 0.0) -> Real:
    """Width [m] of the long-wave soliton's force at ``level`` of its peak; 5πa/√10 ≈ 4.97 a at level 0.

    Divided by V it is the duration of the force pulse [s].  ValueError for a level outside [0, 1).
    """
    require_positive(diameter=diameter)
    require((np.asarray(level) >= 0) & (np.asarray(level) < 1), "level", level, "at least 0 and below 1")
    return np.sqrt(10) * np.asarray(diameter) * np.arccos(np.asarray(level, dtype=float) ** (1 / 6))


@dataclass(frozen=True, eq=False)
class SolitaryWave:
    """The exact solitary wave of a chain with F = k δⁿ and no static compression, in units of its own size.

    Phase φ is time in units of a/V, zero at the contact's peak, so a range of φ is also one of diameters.
    Made by `SolitaryWave.compute`; accurate to about 1e-13 of the peak.
    """

    exponent: float
    """n of the contact law."""
    speed_constant: float
    """s of V = s a √(k/M) (F_m/k)^{(n−1)/(2n)}; 0.9055 for Hertz contacts (long-wave: 2/√5 = 0.8944)."""
    phase: np.ndarray = field(repr=False)
    """Tabulated phases, shape (N,), evenly spaced."""
    profile: np.ndarray = field(repr=False)
    """Compression d = δ/δ_m of a contact at these phases, shape (N,)."""

    @classmethod
    def compute(cls, exponent: float = 1.5) -> "SolitaryWave":
        """The wave for the contact law F ∝ δⁿ, 1.01 ≤ n ≤ 3, computed once per process and n (milliseconds).

        ValueError outside that range: as n → 1 the wave widens without bound (183 diameters at 1.01) and the
        long-wave formulas become exact.
        """
        require(1.01 <= exponent <= 3, "exponent", exponent, "at least 1.01 and at most 3")
        return _solve(float(exponent))

    @cached_property
    def _compression(self):
        from scipy.interpolate import make_interp_spline

        return make_interp_spline(self.phase, self.profile, k=7)

    @cached_property
    def _impulse(self):
        from scipy.interpolate import make_interp_spline

        return make_interp_spline(self.phase, self.profile**self.exponent, k=7).antiderivative()

    def compression(self, phase: Num) -> Real:
        """d(φ) = δ/δ_m of a contact; any shape."""
        inside = np.abs(phase) < self.phase[-1]
        return np.where(inside, np.maximum(self._compression(np.where(inside, phase, 0.0)), 0.0), 0.0)[()]

    def force(self, phase: Num) -> Real:
        """f(φ) = F/F_m of a contact; any shape."""
        return self.compression(phase) ** self.exponent

    def gauge(self, phase: Num) -> Real:
        """Reading, in units of F_m, of a gauge inside a bead: the mean force of its two contacts; any shape.

        They are one unit of phase apart: (f(φ − ½) + f(φ + ½))/2, with φ = 0 in the middle.
        """
        phase = np.asarray(phase, dtype=float)
        return (self.force(phase - 0.5) + self.force(phase + 0.5)) / 2

    def bead_velocity(self, phase: Num) -> Real:
        """Velocity of a bead in units of F_m a/(M V): ∫f over one unit of phase; φ = 0 is its largest."""
        phase = np.asarray(phase, dtype=float)
        end = self.phase[-1]
        after, before = (self._impulse(np.clip(phase + half, -end, end)) for half in (0.5, -0.5))
        return after - before

    @cached_property
    def gauge_ratio(self) -> float:
        """Peak of an embedded gauge over the contact-force peak; 0.7073 for Hertz contacts."""
        return float(self.gauge(self._gauge_peak_phase))

    @cached_property
    def _gauge_peak_phase(self) -> float:
        """Zero while the pulse is broad; a narrow one (large n) shows a peak for each of the two contacts."""
        from scipy.optimize import minimize_scalar

        best = minimize_scalar(
            lambda x: -self.gauge(x), bounds=(0, 1), method="bounded", options={"xatol": 1e-9}
        )
        return float(best.x) if self.gauge(best.x) > self.gauge(0.0) * (1 + 1e-12) else 0.0

    def width(self, level: float = 0.5) -> float:
        """Width in diameters of the contact-force pulse at ``level`` of its peak, 0 < level < 1."""
        return self._width(self.force, level, 0.0)

    def gauge_width(self, level: float = 0.5) -> float:
        """Width in diameters of an embedded gauge's pulse at ``level`` of its own peak, 0 < level < 1."""
        return self._width(self.gauge, level, self._gauge_peak_phase)

    def _width(self, pulse, level: float, start: float) -> float:
        from scipy.optimize import brentq

        require(0 < level < 1, "level", level, "above 0 and below 1")
        height = level * pulse(start)
        return 2 * brentq(lambda x: pulse(x) - height, start, self.phase[-1], xtol=1e-14)

    def speed(self, peak_force: Num, stiffness: Num, diameter: Num, mass: Num) -> Real:
        """Speed V [m/s] of the wave with contact-force peak F_m [N]: what Eq. (6) approximates."""
        require_not_negative(peak_force=peak_force)
        require_positive(stiffness=stiffness, diameter=diameter, mass=mass)
        stretch = (np.asarray(peak_force) / np.asarray(stiffness)) ** self._power
        return self.speed_constant * np.asarray(diameter) * np.sqrt(np.divide(stiffness, mass)) * stretch

    @property
    def _power(self) -> float:
        """Exponent of F_m in V; 1/6 for Hertz contacts."""
        return (self.exponent - 1) / (2 * self.exponent)

    @property
    def density_prefactor(self) -> float:
        """C of V = C [2E/(a ρ^{3/2} (1 − ν²))]^{1/3} F_m^{1/6}, ρ = M/(πa³/6), for n = 3/2; 0.6887.

        Long-wave theory, Eq. (6), has 0.6802.  ValueError for another exponent, which has no such form.
        """
        require(self.exponent == 1.5, "exponent", self.exponent, "3/2 for a speed written with E, ν and ρ")
        return self.speed_constant * np.sqrt(6 / np.pi) / np.cbrt(6)

    def peak_force(self, speed: Num, stiffness: Num, diameter: Num, mass: Num) -> Real:
        """Contact-force peak F_m [N] of the wave of that speed [m/s]; inverse of `speed`."""
        require_not_negative(speed=speed)
        at_one_newton = self.speed(1.0, stiffness, diameter, mass)
        return (np.asarray(speed) / at_one_newton) ** (1 / self._power)

    def stiffness(self, speed: Num, peak_force: Num, diameter: Num, mass: Num) -> Real:
        """Stiffness k [N/mⁿ] at which the wave of peak F_m [N] has that speed [m/s]: V ∝ k^{1/(2n)}."""
        require_positive(speed=speed, peak_force=peak_force)
        at_one = self.speed(peak_force, 1.0, diameter, mass)
        return (np.asarray(speed) / at_one) ** (2 * self.exponent)

    def contact_pulse(
        self, time: Num, peak_force: float, stiffness: float, diameter: float, mass: float
    ) -> Real:
        """Force [N] of a contact at ``time`` [s] after its peak; any shape of time, one wave."""
        rate = self.speed(peak_force, stiffness, diameter, mass) / diameter
        return peak_force * self.force(rate * np.asarray(time))

    def gauge_pulse(
        self, time: Num, peak_force: float, stiffness: float, diameter: float, mass: float
    ) -> Real:
        """Reading [N] of an embedded gauge, ``time`` [s] after its pulse's middle; F_m is the contact's."""
        rate = self.speed(peak_force, stiffness, diameter, mass) / diameter
        return peak_force * self.gauge(rate * np.asarray(time))

    def duration(self, peak_force: Num, stiffness: Num, diameter: Num, mass: Num, level: float = 0.5) -> Real:
        """Duration [s] of the contact-force pulse at ``level`` of its peak; F_m above zero."""
        require_positive(peak_force=peak_force)
        return self.width(level) * np.asarray(diameter) / self.speed(peak_force, stiffness, diameter, mass)

    def peak_bead_velocity(self, peak_force: Num, stiffness: Num, diameter: Num, mass: Num) -> Real:
        """Largest bead velocity [m/s]; F_m [N] above zero."""
        unit = self._impulse_unit(peak_force, stiffness, diameter, mass) / np.asarray(mass)
        return self.bead_velocity(0.0) * unit

    def momentum(self, peak_force: Num, stiffness: Num, diameter: Num, mass: Num) -> Real:
        """Momentum of all beads in the wave [N s], the impulse ∫F dt of any contact; F_m [N] above zero."""
        total = self._impulse(self.phase[-1]) - self._impulse(self.phase[0])
        return total * self._impulse_unit(peak_force, stiffness, diameter, mass)

    def _impulse_unit(self, peak_force: Num, stiffness: Num, diameter: Num, mass: Num) -> Real:
        require_positive(peak_force=peak_force)
        passage = np.asarray(diameter) / self.speed(peak_force, stiffness, diameter, mass)
        return np.asarray(peak_force) * passage

    def energy(self, peak_force: Num, stiffness: Num) -> Real:
        """Energy of the wave [J], (n+3)/(2(n+1)) F_m δ_m ∫d^{n+1} dφ.

        The integral gives the mean potential energy over one passage a/V; by the virial theorem, exact here
        because Σ p u repeats itself one bead on, the mean kinetic energy is (n+1)/2 of it.
        """
        require_not_negative(peak_force=peak_force)
        require_positive(stiffness=stiffness)
        n = self.exponent
        # The trapezoid sum of a smooth function that vanishes at both ends is accurate to rounding.
        integral = np.sum(self.profile ** (n + 1)) * (self.phase[1] - self.phase[0])
        peak_approach = (np.asarray(peak_force) / np.asarray(stiffness)) ** (1 / n)
        return (n + 3) / (2 * (n + 1)) * integral * np.asarray(peak_force) * peak_approach


@lru_cache(maxsize=32)
def _solve(exponent: float) -> SolitaryWave:
    """Iterate d ← Λ*dⁿ / (Λ*dⁿ)(0), a renormalised fixed point, from the long-wave soliton until it rests.

    In Fourier space the tent is sinc² and the convolution exact; the window is wider than the wave, whose
    tails vanish doubly exponentially, so that its images do not meet.
    """
    n = exponent
    phase, profile, tent = _starting_point(n)
    middle = phase.size // 2
    for _ in range(10_000):
        new = np.fft.irfft(tent * np.fft.rfft(profile**n), phase.size)
        new[1:] = (new[1:] + new[:0:-1]) / 2
        new = np.maximum(new, 0.0)
        strength = new[middle]
        change = np.max(np.abs(new / strength - profile))
        profile = new / strength
        if change < 1e-14:
            break
    else:
        raise RuntimeError(f"the solitary wave for n = {n} did not converge; last change {change:.1e}")
    for table in (phase, profile):
        table.setflags(write=False)
    return SolitaryWave(n, float(np.sqrt(strength)), phase, profile)


def _starting_point(n: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Phases, long-wave profile cos^{2/(n−1)} and transform of the tent, on a window that holds the wave."""
    foot = np.pi / (n - 1) * np.sqrt(n * (n + 1) / 6)
    per_diameter = 32 if n >= 1.1 else 8
    half = per_diameter * int(np.ceil(foot / 2 + 6))
    phase = np.arange(-half, half) / per_diameter
    angle = np.pi * phase / foot
    profile = np.where(np.abs(angle) < np.pi / 2, np.cos(angle), 0.0) ** (2 / (n - 1))
    return phase, profile, np.sinc(np.fft.rfftfreq(phase.size, 1 / per_diameter)) ** 2
