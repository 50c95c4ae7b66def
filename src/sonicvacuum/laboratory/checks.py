"""What `config.yaml` and `record.yaml` are both held against: every number that the two have in common.

Each function takes blocks as users write them and raises `LaboratoryError`, which names the key, the value,
the range and the unit that was probably meant.
"""

from collections.abc import Mapping

from sonicvacuum.laboratory import ranges
from sonicvacuum.laboratory.blocks import ChainBlock, MaterialBlock, StrikerBlock, bead_blocks
from sonicvacuum.laboratory.ranges import LaboratoryError

# Heading of the times in every table of traces; no gauge can have this name.
TIME = "time_us"
_COLUMNS = {TIME: "times"}


def check_chain(chain: ChainBlock) -> None:
    """Number, preload, sizes, masses and coatings."""
    ranges.BEADS.check("chain.beads", chain.beads)
    ranges.STATIC_FORCE.check("chain.static_force_N", chain.static_force_N)
    for key, bead in bead_blocks(chain).kinds:
        ranges.check_bead(key, bead)


def check_materials(materials: Mapping[str, MaterialBlock]) -> None:
    """Modulus, density and yield strength of each material that is given."""
    for name, given in materials.items():
        ranges.check_material(f"materials.{name}", name, given)


def check_striker(key: str, striker: StrikerBlock, lightest_g: float) -> None:
    """Size, and a mass that goes with it, or for a flat striker with the chain's lightest bead."""
    if striker.diameter_mm is not None:
        ranges.DIAMETER.check(f"{key}.diameter_mm", striker.diameter_mm)
    if striker.shape == "sphere":
        ranges.check_mass(key, striker.mass_g, striker.diameter_mm)
    else:
        ranges.check_striker_mass(key, striker.mass_g, lightest_g)


def lightest_g(chain: ChainBlock) -> float:
    """Mass of the lightest bead of a chain in g."""
    return min(bead.mass_g for _, bead in bead_blocks(chain).kinds)


def check_speeds(key: str, *speeds: float) -> None:
    """LaboratoryError for a speed of a striker, in m/s, that none has."""
    for speed in speeds:
        ranges.SPEED.check(key, speed)


def check_sensor(key: str, sensor, columns: Mapping[str, str] = _COLUMNS) -> None:
    """Name and times of a gauge: a block with `id` and `droop_us`, and with `lowpass_us` where it has one.

    `columns` are those that stand beside the gauges in tables of traces: heading → what it holds.

    Raises:
        LaboratoryError: naming the key, for such a column as a name and for times that no gauge has.
    """
    if sensor.id in columns:
        told = f"is {sensor.id!r}, the column of the {columns[sensor.id]}; choose another"
        raise LaboratoryError(f"{key}.id", told)
    if sensor.droop_us is not None:
        ranges.DROOP.check(f"{key}.droop_us", sensor.droop_us)
    ranges.LOWPASS.check(f"{key}.lowpass_us", getattr(sensor, "lowpass_us", 0.0))
