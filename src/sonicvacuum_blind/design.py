"""Record designs: which chain, which strikers, which gauges, with which errors; drawn, then fixed.

A design is what the laboratory writes down. Its runs are nominal plans; what really happens (errors of speed,
gain, trigger and modulus, noise, the hidden effect) is added in `hide`.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.laboratory.specimen import GRAVITY
from sonicvacuum.materials import MATERIALS
from sonicvacuum_blind.gauges import bounce, main_pulse, read, scalar
from sonicvacuum_blind.plan import Gauge, Plan, Solid

KINDS = ("traces", "varied", "one-speed", "scalars", "ball")
SAMPLES = 480
# name of the beads' material → (Young's modulus in Pa or None for the table's, coating in µm)
BEADS = {
    "parylene-c": (15e9, 50.0),
    "stainless-steel": (None, None),
    "ptfe": (None, None),
    "nylon": (None, None),
    "delrin": (None, None),
    "brass": (None, None),
    "aluminium": (None, None),
    "glass": (None, None),
}
CORE = "stainless-steel"  # under any coating
STRIKERS = ("alumina", "stainless-steel", "bearing-steel")


@dataclass(frozen=True)
class Scalar:
    """One observable of one run: its run's place, quantity, options, and standard error in SI units."""

    run: int
    quantity: str
    options: dict
    sigma: float = 0.0


@dataclass(frozen=True)
class Design:
    """A record before anything is hidden in it.

    Attributes:
        kind: one of `KINDS`.
        runs: nominal plans, one for each impact, alike but for the speed.
        coating: thickness in m, None for solid beads.
        interval: time between samples in s.
        samples: per trace; 0 for a record of scalars.
        sigma: (gauges,) white noise of one sample in N.
        scalars: observables.
        speed_sigma, gain_sigma, modulus_sigma: relative standard errors.
        trigger_sigma: s.
    """

    kind: str
    runs: tuple[Plan, ...]
    coating: float | None
    interval: float
    samples: int
    sigma: tuple[float, ...] = ()
    scalars: tuple[Scalar, ...] = ()
    speed_sigma: float = 0.01
    gain_sigma: float = 0.02
    modulus_sigma: float = 0.05
    trigger_sigma: float = 1e-6

    @property
    def reference(self) -> Plan:
        """The run of middle speed, in whose units strengths are given."""
        return self.runs[len(self.runs) // 2]

    @property
    def coated(self) -> bool:
        """Whether the record states a coating of its beads."""
        return self.coating is not None

    @property
    def traced(self) -> int:
        """Samples simulated for each trace, also where only scalars are recorded."""
        return self.samples or SAMPLES

    def times(self, shift: float = 0.0) -> np.ndarray:
        """(samples,) true times in s of recorded times 0, interval, … for a trigger shift."""
        return self.interval * np.arange(self.traced) - shift


def draw(kind: str, random: np.random.Generator) -> Design:
    """A design of one kind.

    Raises:
        ValueError: for an unknown kind.
    """
    if kind not in KINDS:
        raise ValueError(f"design kind {kind!r} is not one of {', '.join(KINDS)}")
    return _ball(random) if kind == "ball" else _chain(kind, random)


def _errors(random):
    return {
        "speed_sigma": _rounded(random.uniform(0.005, 0.02)),
        "gain_sigma": _rounded(random.uniform(0.01, 0.03)),
        "modulus_sigma": _rounded(random.uniform(0.02, 0.1)),
    }


def _rounded(value, digits=2):
    return float(f"{value:.{digits}g}")


def _bodies(random):
    """Beads' material with modulus, its coating, a wall and a striker."""
    name = str(random.choice(list(BEADS)))
    modulus, coating = BEADS[name]
    bead = Solid(name, modulus or MATERIALS[name].modulus, MATERIALS[name].poisson)
    diameter = _rounded(random.uniform(4e-3, 1e-2), 3)
    volume = math.pi / 6.0 * diameter**3
    if coating:
        core = math.pi / 6.0 * (diameter - 2e-6 * coating) ** 3
        mass = core * MATERIALS[CORE].density + (volume - core) * MATERIALS[name].density
    else:
        mass = volume * MATERIALS[name].density
    return bead, diameter, _rounded(mass, 4), coating and coating * 1e-6


def _table(name):
    return Solid(name, MATERIALS[name].modulus, MATERIALS[name].poisson)


def _chain(kind, random):
    varied = kind == "varied"
    bead, diameter, mass, coating = _bodies(random)
    beads = round(math.exp(random.uniform(*np.log([8, 40])))) if varied else int(random.integers(14, 25))
    striker = _table(str(random.choice([s for s in STRIKERS if s != bead.name])))
    flat = bool(random.random() < 0.5)
    wall = _table("stainless-steel" if bead.name != "stainless-steel" else "bearing-steel")
    vertical = bool(random.random() < 0.5)
    plan = Plan(
        beads=beads,
        bead=bead,
        striker=striker,
        wall=wall,
        bead_radius=diameter / 2.0,
        striker_radius=math.inf if flat else diameter / 2.0,
        bead_mass=mass,
        striker_mass=_rounded(mass * math.exp(random.uniform(*np.log([0.7, 1.6]))), 3),
        speed=_rounded(math.exp(random.uniform(*np.log([0.15, 0.6])))),
        gravity=GRAVITY if vertical else 0.0,
        core=None if coating is None else _table(CORE),
        gauges=_gauges(beads, random),
    )
    plan = _as_others_do(plan, random) if varied else plan
    runs = _speeds(plan, _count(kind, random))
    samples = int(random.integers(240, 961)) if varied else SAMPLES
    interval, pulse = _sampling(runs, samples)
    bare = Design(
        kind,
        runs,
        coating,
        interval,
        samples,
        trigger_sigma=max(1e-8, _rounded(pulse * random.uniform(0.003, 0.015), 1)),
        **_errors(random),
    )
    if kind == "scalars":
        return _scalars(bare, random)
    return replace(bare, sigma=_noise(bare, random))


def _count(kind, random):
    """Number of runs."""
    counts = {"traces": int(random.integers(3, 5)), "one-speed": 1, "scalars": int(random.integers(4, 7))}
    return counts[kind] if kind in counts else int(random.integers(2, 6))


def _speeds(plan, count):
    """Runs from under half to over twice the speed of a plan."""
    ratios = np.exp(np.linspace(-1.0, 1.0, count) * math.log(2.2)) if count > 1 else [1.0]
    return tuple(replace(plan, speed=_rounded(plan.speed * r, 3)) for r in ratios)


def _as_others_do(plan, random):
    """A laboratory with one or two gauges, and half the time a preload of up to a fifth of the impact."""
    first, second, wall = plan.gauges
    gauges = ((first, second), (first, wall), (first,), (wall,))[int(random.integers(4))]
    load = _rounded(random.uniform(0.02, 0.2) * plan.force_scale) if random.random() < 0.5 else 0.0
    return replace(plan, gauges=gauges, static_force=load)


def _gauges(beads, random):
    """Two gauges in beads, some beads apart and from the wall, and one at the wall."""
    first = int(random.integers(beads // 2 - 1, beads // 2 + 3))
    second = max(first + 1, min(first + int(random.integers(3, 6)), beads - 3))
    return (
        Gauge("g1", "embedded", first),
        Gauge("g2", "embedded", second),
        Gauge("wall", "wall"),
    )


def _sampling(runs, samples):
    """Interval in s that lets the slowest run's reflection reach the first gauge, and the pulse length."""
    slowest = min(runs, key=lambda p: p.speed)
    watched = replace(slowest, gauges=(slowest.gauges[0], Gauge("end", "wall")))
    times = np.arange(0.0, 40.0 * slowest.beads) * 0.1 * slowest.contact_time
    first, wall = (main_pulse(y, times).time for y in read(watched, times, 1e-5))
    return _rounded(1.15 * (2.0 * wall - first) / samples), 5.0 * slowest.contact_time


def _peaks(design):
    """(runs, gauges) main peaks in N of the nominal runs."""
    return np.array(
        [[main_pulse(y, design.times()).force for y in read(p, design.times())] for p in design.runs]
    )


def _noise(design, random):
    """Noise of each gauge: about 1 % of its peak in the middle of the speeds."""
    share = math.exp(random.uniform(*np.log([0.006, 0.015])))
    return tuple(_rounded(share * f) for f in np.median(_peaks(design), axis=0))


def _scalars(design, random):
    """Speeds, amplitudes, durations and decays instead of traces."""
    share = math.exp(random.uniform(*np.log([0.003, 0.01])))
    wanted = [
        ("speed", {"from": "g1", "to": "g2"}),
        ("speed", {"from": "g2", "to": "wall"}),
        ("amplitude", {"sensor": "g1"}),
        ("amplitude", {"sensor": "g2"}),
        ("amplitude", {"sensor": "wall"}),
        ("duration", {"sensor": "g1", "level": 0.5}),
        ("decay", {"from": "g1", "to": "g2"}),
    ]
    scalars = []
    for k, plan in enumerate(design.runs):
        readings = read(plan, design.times())
        for quantity, options in wanted:
            value = scalar(plan, readings, design.times(), quantity, options)
            scalars.append(Scalar(k, quantity, options, _rounded(share * value)))
    return replace(design, samples=0, sigma=(0.0,) * 3, scalars=tuple(scalars))


def _ball(random):
    """One ball on a wall, restitution and contact duration at several speeds."""
    bead, diameter, mass, _ = _bodies(random)
    wall = _table("stainless-steel" if bead.name != "stainless-steel" else "bearing-steel")
    plan = Plan(0, bead, bead, wall, diameter / 2.0, diameter / 2.0, mass, mass, 1.0)
    runs = tuple(replace(plan, speed=_rounded(v, 3)) for v in np.geomspace(0.1, 2.0, 7))
    share = math.exp(random.uniform(*np.log([0.003, 0.01])))
    scalars = []
    for k, one in enumerate(runs):
        for quantity, value in bounce(one).items():
            scalars.append(Scalar(k, quantity, {}, _rounded(share * value)))
    errors = _errors(random) | {"gain_sigma": 0.0}
    return Design("ball", runs, None, 1e-6, 0, scalars=tuple(scalars), trigger_sigma=0.0, **errors)
