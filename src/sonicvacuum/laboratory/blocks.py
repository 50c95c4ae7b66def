"""What a user writes of a chain in `config.yaml`, `record.yaml` and cases: units stand in the key names.

`specimen_of` and `striker_of` turn the blocks into SI; units of a chain are converted here and nowhere else.
"""

import math
from typing import Annotated, Literal

import msgspec
from msgspec import UNSET, Meta, Struct, UnsetType

from sonicvacuum.laboratory import ranges
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.laboratory.ranges import LaboratoryError
from sonicvacuum.laboratory.specimen import (
    GRAVITY,
    Bead,
    Material,
    NonNegative,
    Positive,
    Specimen,
    Striker,
)
from sonicvacuum.materials import MATERIALS
from sonicvacuum.materials import Material as Tabulated

Faces = Literal["sphere", "flat"]


class Block(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """A mapping of YAML with a closed set of keys; those at their defaults are not written."""


class MaterialBlock(Block, kw_only=True):
    """Overrides of one material, key by key; one outside the table needs modulus and Poisson's ratio."""

    modulus_GPa: Positive | None = None
    poisson: Annotated[float, Meta(gt=-1.0, le=0.5)] | None = None
    density_kg_m3: Positive | None = None
    yield_MPa: Positive | None = None


class BeadBlock(Block, kw_only=True):
    """A bead: `material` is what touches; a coated bead names its core."""

    diameter_mm: Positive
    mass_g: Positive
    material: str
    coating_um: Positive | None = None
    core: str | None = None
    faces: Faces = "sphere"


class ChangeBlock(Block, kw_only=True):
    """What differs at one bead; `null` takes a coating and its core away."""

    diameter_mm: Positive | UnsetType = UNSET
    mass_g: Positive | UnsetType = UNSET
    material: str | UnsetType = UNSET
    coating_um: Positive | UnsetType | None = UNSET
    core: str | UnsetType | None = UNSET
    faces: Faces | UnsetType = UNSET


class WallBlock(Block, kw_only=True):
    """Flat, fixed wall."""

    material: str


class ChainBlock(Block, kw_only=True):
    """Beads between striker and wall; bead 1 is struck, the last bead touches the wall.

    All beads are like `bead`, or repeat `pattern`; `bodies` changes single ones.
    """

    beads: Annotated[int, Meta(ge=1)]
    orientation: Literal["vertical", "horizontal"]
    bead: BeadBlock | None = None
    pattern: Annotated[list[BeadBlock], Meta(min_length=1)] | None = None
    bodies: dict[Annotated[int, Meta(ge=1)], ChangeBlock] = {}
    wall: WallBlock
    static_force_N: NonNegative = 0.0


class StrikerBlock(Block, kw_only=True):
    """What hits bead 1; a sphere gives its diameter."""

    shape: Literal["flat", "sphere"]
    material: str
    mass_g: Positive
    diameter_mm: Positive | None = None


def material_of(name: str, overrides: dict[str, MaterialBlock], key: str) -> Material:
    """A material of the table with overrides.

    Raises:
        LaboratoryError: for a name that is not in the table and not fully given among the overrides.
    """
    known = MATERIALS.get(name, Tabulated(math.nan, math.nan, None, None, ""))
    given = overrides.get(name, MaterialBlock())
    modulus = known.modulus if given.modulus_GPa is None else given.modulus_GPa * 1e9
    poisson = known.poisson if given.poisson is None else given.poisson
    if math.isnan(modulus) or math.isnan(poisson):
        raise LaboratoryError(
            key,
            f"material {name!r} is not in the table ({', '.join(sorted(MATERIALS))}); "
            "use one of these or give its modulus_GPa and poisson under materials",
        )
    density = known.density if given.density_kg_m3 is None else given.density_kg_m3
    strength = known.yield_strength if given.yield_MPa is None else given.yield_MPa * 1e6
    return Material(name=name, modulus_Pa=modulus, poisson=poisson, density_kg_m3=density, yield_Pa=strength)


def specimen_of(chain: ChainBlock, overrides: dict[str, MaterialBlock]) -> Specimen:
    """A chain in SI units.

    Raises:
        LaboratoryError: for beads that are not described, or twice; a material that nobody knows; a bead
            without meaning; flat faces that touch.
    """
    bodies = bead_blocks(chain).replaced(lambda place: _bead(*place, overrides))
    wall = material_of(chain.wall.material, overrides, "chain.wall.material")
    _check_faces(chain.beads, bodies)
    gravity = GRAVITY if chain.orientation == "vertical" else 0.0
    return Specimen(chain.beads, bodies, wall, gravity, chain.static_force_N)


def bead_blocks(chain: ChainBlock) -> Bodies:
    """(key, `BeadBlock`) of each bead.

    Raises:
        LaboratoryError: for beads that are not described, or twice, or do not exist.
    """
    if (chain.bead is None) == (chain.pattern is None):
        problem = "missing; describe the beads" if chain.bead is None else "is given beside chain.pattern"
        raise LaboratoryError(
            "chain.bead", f"{problem}: give bead where all are alike, or pattern to be repeated"
        )
    if chain.pattern is None:
        places = (("chain.bead", chain.bead),)
    else:
        places = tuple((f"chain.pattern[{k}]", block) for k, block in enumerate(chain.pattern))
    pattern = Bodies(places)
    for bead in chain.bodies:
        if bead > chain.beads:
            raise LaboratoryError(f"chain.bodies.{bead}", f"no such bead; the chain has {chain.beads} beads")
    changed = {
        bead: (f"chain.bodies.{bead}", _changed(pattern[bead][1], change))
        for bead, change in chain.bodies.items()
    }
    return Bodies(places, changed)


def _changed(block, change):
    values = {name: getattr(change, name) for name in change.__struct_fields__}
    given = {name: value for name, value in values.items() if value is not UNSET}
    return msgspec.structs.replace(block, **given)


def _bead(key, block, overrides):
    ranges.check_coating(key, block)
    return Bead(
        diameter_m=block.diameter_mm / 1e3,
        mass_kg=block.mass_g / 1e3,
        surface=material_of(block.material, overrides, f"{key}.material"),
        coating_m=None if block.coating_um is None else block.coating_um / 1e6,
        core=None if block.core is None else material_of(block.core, overrides, f"{key}.core"),
        faces="flat" if block.faces == "flat" else UNSET,
    )


def _check_faces(beads, bodies):
    """Two flats have no Hertz contact."""
    if beads == 0 and (len(bodies.kinds) > 1 or bodies[1].flat):
        raise LaboratoryError("chain.bead", "with beads: 0 there is one ball: give bead, faces: sphere")
    kinds = bodies.kinds
    if beads > 1 and any(kinds[one].flat and kinds[other].flat for one, other in bodies.neighbours(beads)):
        raise LaboratoryError("chain", "flat faces touch flat faces; put a sphere between them")
    if beads and bodies[beads].flat:
        raise LaboratoryError("chain", "the last bead has flat faces, and so has the wall; put a sphere last")


def striker_of(
    block: StrikerBlock, surface: Material, specimen: Specimen, key: str, speed: float, sigma: float = 0.0
) -> Striker:
    """A striker in SI units; LaboratoryError for a sphere without size, or flat on flat faces."""
    if block.shape == "sphere" and block.diameter_mm is None:
        raise LaboratoryError(f"{key}.diameter_mm", "missing; a sphere needs its diameter")
    if block.shape == "flat" and specimen.beads and specimen.first.flat:
        raise LaboratoryError(f"{key}.shape", "is 'flat', and so are bead 1's faces; strike with a sphere")
    radius = block.diameter_mm / 2e3 if block.shape == "sphere" else math.inf
    return Striker(surface, block.mass_g / 1e3, speed, sigma, radius)
