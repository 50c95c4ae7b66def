"""From the numbers that one has at the bench to a case: units, masses from densities, a striker by default.

Quantities are numbers in SI units or texts with their unit (`20mm`, `33 g`, `50um`).
"""

import math
from collections.abc import Iterable
from numbers import Integral
from typing import Any

from sonicvacuum.builders import ball_mass
from sonicvacuum.card import Card, CaseBlock, resolve
from sonicvacuum.files import InputError, convert
from sonicvacuum.laboratory.next_run import gauge_beads
from sonicvacuum.laboratory.ranges import DIAMETER, LaboratoryError
from sonicvacuum.materials import MATERIALS
from sonicvacuum.physics.extent import Extent, TooLargeError
from sonicvacuum.schema_errors import likely
from sonicvacuum.scope.units import quantity
from sonicvacuum.simulation import extent

# What is asked for → base unit (or `g`, which here is the gram) → factor to SI; an example to write.
_UNITS = {
    "diameter": ({"m": 1.0}, "20mm"),
    "coating": ({"m": 1.0}, "50um"),
    "mass": ({"kg": 1.0, "g": 1e-3}, "33g"),
    "striker_mass": ({"kg": 1.0, "g": 1e-3}, "33g"),
    "striker_diameter": ({"m": 1.0}, "20mm"),
    "speed": ({"m/s": 1.0}, "0.5m/s"),
    "preload": ({"N": 1.0}, "2N"),
    "aim": ({"N": 1.0}, "5N"),
}
# Texts without a unit are in the only unit that is usual.
_BARE = ("speed", "preload", "aim")
# Key of a case → what the user calls it.
_NAMES = {
    "chain.bead.diameter_mm": "diameter",
    "chain.bead.mass_g": "mass",
    "chain.bead.coating_um": "coating",
    "chain.bead": "coating",
    "chain.static_force_N": "preload",
    "striker.mass_g": "striker_mass",
    "striker.diameter_mm": "striker_diameter",
    "striker.speed_m_s": "speed",
}
# The case is cut to length once the speed of its striker is known.
_ANY_DURATION_US = 1.0


def in_si(name: str, value: str | float | None) -> float | None:
    """A quantity in SI units; InputError for a text that is no positive number with a unit of its kind."""
    if value is None:
        return None
    if not isinstance(value, str):
        try:
            number = float(value)
        except (TypeError, ValueError, OverflowError):
            number = math.nan
        return _positive(name, number, value)
    units, example = _UNITS[name]
    number, unit = quantity(value) or (math.nan, None)
    bare = unit is None and name in _BARE
    if math.isnan(number) or not (bare or (unit is not None and unit.base in units)):
        raise InputError(f"{name}: is {value!r}; write a number with its unit, as in {example}")
    return _positive(name, number if bare else number * unit.factor * units[unit.base], value)


def _positive(name, number, given):
    if not (math.isfinite(number) and number > 0.0):
        raise InputError(f"{name}: is {given!r:.100}; it must be a positive number, as in {_UNITS[name][1]}")
    return number


def card_of(
    *,
    beads: int,
    diameter: str | float,
    material: str,
    speed: str | float | None,
    mass: str | float | None,
    coating: str | float | None,
    core: str | None,
    wall: str | None,
    orientation: str,
    preload: str | float | None,
    striker: str,
    striker_mass: str | float | None,
    striker_diameter: str | float | None,
    striker_material: str | None,
    gauges: Any,
    aim: str | float | None,
) -> Card:
    """The case of `predict`, of no particular length; its arguments stand there.

    Raises:
        InputError: naming the argument, its value and the cure.
    """
    check_beads(beads)
    for name, needed in (("diameter", diameter), ("material", material)):
        if needed is None:
            raise InputError(f"{name}: missing; give that of a bead")
    for name, given in (("material", material), ("core", core), ("wall", wall)):
        _known(name, given)
    ball = _bead(in_si("diameter", diameter), material, in_si("mass", mass), in_si("coating", coating), core)
    sensors = _sensors(gauges, beads)
    hit = _striker(striker, in_si("striker_mass", striker_mass), striker_diameter, striker_material, ball)
    hit |= _start(speed, aim, sensors)
    chain = {"beads": int(beads), "orientation": orientation, "bead": ball}
    chain |= {
        "wall": {"material": wall or core or material},
        "static_force_N": in_si("preload", preload) or 0.0,
    }
    content = {"title": "what to expect", "chain": chain, "striker": hit, "sensors": sensors}
    block = convert(content | {"duration_us": _ANY_DURATION_US}, CaseBlock, "predict")
    try:
        return resolve("predict", "asked", block)
    except LaboratoryError as error:
        name = _NAMES.get(error.key, error.key)
        raise InputError(f"{name}{str(error).removeprefix(error.key)}") from None


def _known(name, material):
    """InputError for a material that the table does not have."""
    if material is None:
        return
    if not isinstance(material, str):
        raise InputError(f"{name}: is {material!r:.100}; write the name of a material, as in 'brass'")
    if material in MATERIALS:
        return
    hint = likely(material, list(MATERIALS)) or f"known are {', '.join(sorted(MATERIALS))}"
    raise InputError(f"{name}: {material!r} is not in the table of materials; {hint}")


def _bead(diameter, material, mass, coating, core):
    """Keys of a bead."""
    if (coating is None) != (core is None):
        given, lacking = ("core", "coating") if coating is None else ("coating", "core")
        raise InputError(f"{lacking}: missing beside {given}; give both, or neither for solid beads")
    if coating is not None and coating >= diameter / 2.0:
        raise InputError(f"coating: is {coating:g} m on a bead of {diameter:g} m; it must be below half")
    mass = _mass("diameter", diameter, material, coating, core) if mass is None else mass
    bead = {"diameter_mm": diameter * 1e3, "mass_g": mass * 1e3, "material": material}
    return bead if coating is None else bead | {"coating_um": coating * 1e6, "core": core}


def _mass(name, diameter, *solid):
    """Mass in kg of a ball; InputError for a diameter in m of which none can be computed with."""
    try:
        DIAMETER.check(name, 1e3 * diameter)
    except LaboratoryError as error:
        raise InputError(str(error)) from None
    return ball_mass(diameter, *solid)


def _striker(shape, mass, diameter, material, bead):
    """Keys of the striker: by default a ball like the beads, else what lacks follows from the density."""
    diameter = in_si("striker_diameter", diameter)
    if shape not in ("sphere", "flat"):
        raise InputError(f"striker: is {shape!r}; write sphere or flat")
    if shape == "sphere" and mass is None and diameter is None and material is None:
        return {"shape": shape, **{key: bead[key] for key in ("material", "mass_g", "diameter_mm")}}
    material = material or bead.get("core") or bead["material"]
    _known("striker_material", material)
    if shape == "flat":
        if mass is None:
            raise InputError("striker_mass: missing; the mass of a flat striker follows from nothing else")
        return {"shape": shape, "material": material, "mass_g": mass * 1e3}
    if diameter is None:
        heavy = ball_mass(1.0, material)
        diameter = bead["diameter_mm"] / 1e3 if mass is None else (mass / heavy) ** (1.0 / 3.0)
    mass = _mass("striker_diameter", diameter, material) if mass is None else mass
    return {"shape": shape, "material": material, "mass_g": mass * 1e3, "diameter_mm": diameter * 1e3}


def check_beads(beads: int) -> None:
    """InputError for what is no number of beads."""
    if not isinstance(beads, Integral) or isinstance(beads, bool):
        raise InputError(f"beads: is {beads!r:.100}; write a whole number, as in 10")
    if beads < 1:
        raise InputError(f"beads: is {beads}; a chain has at least 1")


def _sensors(gauges, beads):
    """Keys of the gauges: numbers of beads and `wall`; by default early, late and at the wall."""
    if gauges is None:
        gauges = [*gauge_beads(beads), "wall"]
    places = gauges.split(",") if isinstance(gauges, str) else gauges
    places = list(places) if isinstance(places, Iterable) else [places]
    if not places:
        raise InputError("gauges: none is given; as in 3,7,wall, or leave them out")
    return [_sensor(place, beads) for place in dict.fromkeys(str(place).strip() for place in places)]


def _sensor(place, beads):
    if place == "wall":
        return {"id": place, "kind": "wall"}
    if not (place.isascii() and place.isdigit() and 1 <= int(place) <= beads):
        raise InputError(
            f"gauges: {place!r:.100} is no bead from 1 to {beads}; as in 3,7,wall (bead 1 is struck)"
        )
    return {"id": str(int(place)), "kind": "embedded", "bead": int(place)}


def _start(speed, aim, sensors):
    """Keys of the striker's speed; with an aim, `[GAUGE=]FORCE`, it is where the search begins."""
    if aim is None:
        if speed is None:
            raise InputError("speed: missing; give the striker's speed, or the force to aim at")
        return {"speed_m_s": in_si("speed", speed)}
    gauge, equals, force = aim.rpartition("=") if isinstance(aim, str) else ("", "", aim)
    ids = [s["id"] for s in sensors]
    gauge = gauge.strip() if equals else ids[0]
    if gauge not in ids:
        raise InputError(f"aim: {gauge!r} is none of the gauges {', '.join(ids)}; as in {ids[-1]}=5N")
    target = {"sensor": gauge, "amplitude_N": in_si("aim", force)}
    return {"speed_m_s": in_si("speed", speed) or 1.0, "aim": target}


def check_size(card: Card, cure: str) -> None:
    """InputError, with the cure, for a chain that asks for more than a computer gives."""
    try:
        Extent(card.beads, 1.0, 1.0, 1.0).check(cure)  # before anything is made for each bead
        extent(card).check(cure)
    except TooLargeError as error:
        raise InputError(f"beads: the chain {error}") from None
