"""Physical ranges of what a laboratory says, and which wrong unit a number outside them suggests.

The limits are wide: they refuse what no laboratory has (a bead of 5 µm said to be in mm, steel of 193e9 GPa),
so that a slip of a unit is caught and an unusual experiment is not. Forces and times are held against the
scales of a Hertz impact with the record's own numbers.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from sonicvacuum.materials import MATERIALS

# Solids from aerogel-like shells to osmium, with room for wires and glue.
DENSITY = (50.0, 30000.0)
LIKELY_DENSITY = (500.0, 20000.0)
# A handbook's number and one for the same material in a record differ by less.
TABLE_FACTOR = 100.0
# No recorder is finer, whatever it counts in; errors far below make ratios that are no numbers.
FINEST = 1e-15
# Largest reading of a gauge, whatever it counts in: a thousand times the least noise that a search tells from
# none, and a thousand times the largest error.
READING = (1e-9, 1e15)
# Largest force of a record over that of the same impact on one contact.
FORCE = (3e-3, 100.0)
# Over the contact time: a duration, the whole record, one sampling interval.
DURATION = (0.03, 300.0)
SHORTEST_RECORD = 0.2
LONGEST_INTERVAL = 2.0
# The unit of a number without one: a fraction, a ratio, a count.
PURE = "1"
# A striker lighter than this fraction of a bead suggests its mass was given in kg.
LIGHTEST_STRIKER = 3e-3


class LaboratoryError(ValueError):
    """What no laboratory has; `key` is its place in the file."""

    def __init__(self, key: str, problem: str):
        super().__init__(f"{key}: {problem}")
        self.key = key


@dataclass(frozen=True)
class Range:
    """What a number in `unit` may be, and the factors by which other units would make it larger or smaller.

    Attributes:
        unit: of the number.
        low, high: limits, both included.
        others: other unit → the number it would show for 1 `unit`.
    """

    unit: str
    low: float
    high: float
    others: Mapping[str, float]

    def check(self, key: str, value: float) -> None:
        """LaboratoryError for a value outside the range, or next to zero without being it."""
        inside = self.low <= value <= self.high
        if inside and 0.0 < abs(value) < FINEST:
            told = f"is {self._shown(value)}, nearer to 0 than {FINEST:g}; write 0 where it is meant"
            raise LaboratoryError(key, told)
        if inside:
            return
        raise LaboratoryError(
            key,
            f"is {self._shown(value)}, outside {self.low:g} to {self._shown(self.high)}"
            + suspicion(self.unit, value, self.low, self.high, self.others),
        )

    def _shown(self, value):
        return f"{value:g}" if self.unit == PURE else f"{value:g} {self.unit}"


def suspicion(unit: str, value: float, low: float, high: float, others: Mapping[str, float]) -> str:
    """`; the number looks like one in mm/s: convert it to m/s`, or a plain request to correct the number."""
    fitting = [name for name, factor in others.items() if low <= value / factor <= high]
    if not fitting:
        return "; correct the number"
    cure = f"divide it by {others[fitting[0]]:g}" if unit == PURE else f"convert it to {unit}"
    return f"; the number looks like one in {' or '.join(fitting)}: {cure}"


# More would overflow the engine's counters; what a computer can do lies far below (`physics.extent`).
BEADS = Range("beads", 0.0, 1e12, {})
LENGTH = {"m": 1e-3, "cm": 0.1, "um": 1e3}
DIAMETER = Range("mm", 0.02, 500.0, LENGTH)
COATING = Range("um", 1e-3, 2e4, {"m": 1e-6, "mm": 1e-3, "nm": 1e3})
MASS = Range("g", 1e-9, 1e6, {"kg": 1e-3, "mg": 1e3})
MODULUS = Range("GPa", 1e-5, 1500.0, {"MPa": 1e3, "Pa": 1e9})
SPEED = Range("m/s", 1e-5, 100.0, {"mm/s": 1e3, "cm/s": 1e2, "km/s": 1e-3})
STATIC_FORCE = Range("N", 0.0, 1e4, {"mN": 1e3})
RELATIVE = Range(PURE, 0.0, 2.0, {"%": 1e2})
TRIGGER = Range("us", 0.0, 1e4, {"ns": 1e3})
DROOP = Range("us", 1.0, 1e9, {"s": 1e-6, "ms": 1e-3})
LOWPASS = Range("us", 0.0, 1e4, {"ns": 1e3})
SOLID = Range("kg/m3", *DENSITY, {"g/cm3": 1e-3})
STRENGTH = Range("MPa", 1e-2, 2e5, {"Pa": 1e6, "GPa": 1e-3})
# A quartz clock is good to 1e-4, a badly set time base to a few per cent.
CLOCK = Range(PURE, 0.0, 0.2, {"%": 1e2, "ppm": 1e6})
TOLERANCE = Range(PURE, 0.0, 1.0, {"%": 1e2})
ODDS = Range(PURE, 0.0, 1e6, {})
_FORCES = {"mN": 1e3, "kN": 1e-3}
AMPLITUDE = Range("N", 1e-9, 1e9, _FORCES)
WAVE_SPEED = Range("m/s", 1.0, 6000.0, {"km/s": 1e-3, "mm/s": 1e3, "cm/s": 1e2})
RATIO = Range(PURE, 0.0, 100.0, {"%": 1e2})
RESTITUTION = Range(PURE, -1.0, 1.2, {"%": 1e2})
COUNT = Range(PURE, 0.0, 1000.0, {})
WIDTH = Range("diameters", 0.3, 1e3, {"m": 5e-3, "mm": 5.0})


def error_range(unit: str) -> Range:
    """What a standard error may be, whatever it is of and whatever an uncalibrated gauge counts in."""
    return Range(unit, FINEST, 1e12, {})


def force_range(impact_N: float) -> Range:
    """What a peak may be, given the force of the same impact on one contact."""
    return Range("N", FORCE[0] * impact_N, FORCE[1] * impact_N, _FORCES)


def check_mass(key: str, mass_g: float, diameter_mm: float) -> None:
    """LaboratoryError for a ball whose mass and diameter make a density that no solid has."""
    MASS.check(f"{key}.mass_g", mass_g)
    density = _density(mass_g, diameter_mm)
    if DENSITY[0] <= density <= DENSITY[1]:
        return
    guesses = [
        f"mass in {name}"
        for name, factor in MASS.others.items()
        if _likely(_density(mass_g / factor, diameter_mm))
    ]
    guesses += [
        f"diameter in {name}"
        for name, factor in LENGTH.items()
        if _likely(_density(mass_g, diameter_mm / factor))
    ]
    cure = f"; suspected: {' or '.join(guesses)}" if guesses else ""
    raise LaboratoryError(
        f"{key}.mass_g",
        f"is {mass_g:g} g, which at a diameter of {diameter_mm:g} mm is a density of {density:.3g} kg/m3, "
        f"outside {DENSITY[0]:g} to {DENSITY[1]:g}{cure}; give g and mm",
    )


def check_bead(key: str, bead) -> None:
    """LaboratoryError for a bead (a block in mm, g and um) of a size, density or coating that none has."""
    DIAMETER.check(f"{key}.diameter_mm", bead.diameter_mm)
    if bead.faces == "flat":
        # Nothing is known of what lies between its faces.
        MASS.check(f"{key}.mass_g", bead.mass_g)
    else:
        check_mass(key, bead.mass_g, bead.diameter_mm)
    if bead.coating_um is not None:
        COATING.check(f"{key}.coating_um", bead.coating_um)


def check_coating(key: str, bead) -> None:
    """LaboratoryError for a coating without core, a core without coating, or one that fills the bead."""
    if (bead.coating_um is None) != (bead.core is None):
        given, lacking = ("core", "coating_um") if bead.coating_um is None else ("coating_um", "core")
        raise LaboratoryError(
            key, f"{given} is given without {lacking}; give both, or neither for a solid bead"
        )
    if bead.coating_um is not None and bead.coating_um >= 500.0 * bead.diameter_mm:
        raise LaboratoryError(
            f"{key}.coating_um",
            f"is {bead.coating_um:g} um on a bead of {bead.diameter_mm:g} mm; it must be below half",
        )


def check_striker_mass(key: str, mass_g: float, bead_g: float) -> None:
    """LaboratoryError for a flat striker so light beside a bead that its mass must be in kg."""
    MASS.check(f"{key}.mass_g", mass_g)
    if mass_g < LIGHTEST_STRIKER * bead_g:
        raise LaboratoryError(
            f"{key}.mass_g",
            f"is {mass_g:g} g, {mass_g / bead_g:.2g} of a bead's mass; "
            "the number looks like one in kg: convert it to g",
        )


def check_material(key: str, name: str, given) -> None:
    """LaboratoryError for numbers that no solid has, or far from the table's for a material that it knows."""
    table = MATERIALS.get(name)
    for part, value, limits, known in (
        ("modulus_GPa", given.modulus_GPa, MODULUS, table and table.modulus / 1e9),
        ("density_kg_m3", given.density_kg_m3, SOLID, table and table.density),
        (
            "yield_MPa",
            given.yield_MPa,
            STRENGTH,
            table and table.yield_strength and table.yield_strength / 1e6,
        ),
    ):
        if value is not None:
            limits.check(f"{key}.{part}", value)
            _check_known(f"{key}.{part}", name, value, limits, known)


def _check_known(key, name, value, limits, table):
    if table is None or table / TABLE_FACTOR <= value <= table * TABLE_FACTOR:
        return
    raise LaboratoryError(
        key,
        f"is {value:g} {limits.unit}; the table has {table:g} {limits.unit} for {name}"
        + suspicion(limits.unit, value, table / 10.0, table * 10.0, limits.others),
    )


def likely_ball(mass: float, radius: float) -> bool:
    """Whether a common solid makes a ball of so many kg and m; any flat striker (infinite radius) can be."""
    return math.isinf(radius) or _likely(_density(1e3 * mass, 2e3 * radius))


def _density(mass_g, diameter_mm):
    return mass_g * 1e-3 / (math.pi / 6.0 * (diameter_mm * 1e-3) ** 3)


def _likely(density):
    return LIKELY_DENSITY[0] <= density <= LIKELY_DENSITY[1]
