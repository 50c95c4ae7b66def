"""One case, resolved: everything a simulation needs, in SI, with nothing left to look up.

The blocks (`CaseBlock` and its parts) are what a user writes in `config.yaml`, units in the key names;
`resolve` turns a block into a card. Units are converted here and nowhere else.
"""

import math
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct, field

from sonicvacuum.materials import MATERIALS, Material

GRAVITY = 9.81

Positive = Annotated[float, Meta(gt=0.0)]
NonNegative = Annotated[float, Meta(ge=0.0)]
Name = Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$")]


class _Block(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    pass


class MaterialBlock(_Block):
    """Overrides of one material, key by key; one outside the table needs modulus and Poisson's ratio."""

    modulus_GPa: Positive | None = None
    poisson: Annotated[float, Meta(gt=-1.0, le=0.5)] | None = None
    density_kg_m3: Positive | None = None
    yield_MPa: Positive | None = None


class BeadBlock(_Block):
    """A bead: `material` is what touches; a coated bead names its core."""

    diameter_mm: Positive
    mass_g: Positive
    material: str
    coating_um: Positive | None = None
    core: str | None = None


class WallBlock(_Block):
    """Flat, fixed wall."""

    material: str


class ChainBlock(_Block):
    """Beads between striker and wall; bead 1 is struck, the last bead touches the wall."""

    beads: Annotated[int, Meta(ge=1)]
    orientation: Literal["vertical", "horizontal"]
    bead: BeadBlock
    wall: WallBlock
    static_force_N: NonNegative = 0.0


class AimBlock(_Block):
    """The striker's speed is adjusted until the sensor's peak is this."""

    sensor: Name
    amplitude_N: Positive


class StrikerBlock(_Block):
    """Striker: a list of speeds makes a sweep, one run for each."""

    shape: Literal["flat", "sphere"]
    material: str
    mass_g: Positive
    speed_m_s: Positive | Annotated[list[Positive], Meta(min_length=1)]
    diameter_mm: Positive | None = None
    aim: AimBlock | None = None


class SensorBlock(_Block):
    """A gauge: embedded (mean of the two contact forces of its bead) or at the wall (last contact)."""

    id: Name
    kind: Literal["embedded", "wall"]
    bead: Annotated[int, Meta(ge=1)] | None = None
    droop_us: Positive | None = None
    lowpass_us: NonNegative = 0.0


class ModelBlock(_Block):
    """What a case takes from the model that `discover` makes of a record.

    `specimen: other` for another chain of the same material, which takes the modulus and the contact laws but
    no property of that record's chain, gauges or striker; `losses: left-out` for the twin without what takes
    energy.
    """

    record: Name
    specimen: Literal["same", "other"] = "same"
    losses: Literal["kept", "left-out"] = "kept"


class CaseBlock(_Block):
    """One case of `config.yaml`; `model` is put in once `discover` has made it (`paper.named`)."""

    title: str
    chain: ChainBlock
    striker: StrikerBlock
    sensors: Annotated[list[SensorBlock], Meta(min_length=1)]
    duration_us: Positive
    sample_us: Positive = 0.5
    materials: dict[str, MaterialBlock] = {}
    effects: dict[str, dict[str, float | str]] = {}
    model: ModelBlock | None = None
    variants: dict[str, dict[str, Any]] = {}


class CardMaterial(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A material as used."""

    name: str
    modulus_Pa: Positive
    poisson: float
    density_kg_m3: Positive | None = None
    yield_Pa: Positive | None = None


class CardBead(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A bead: `surface` is the coating where there is one."""

    diameter_m: Positive
    mass_kg: Positive
    surface: CardMaterial
    coating_m: Positive | None = None
    core: CardMaterial | None = None


class CardStriker(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Striker; `radius_m` is absent for a flat one."""

    mass_kg: Positive
    surface: CardMaterial
    speeds_m_s: Annotated[tuple[Positive, ...], Meta(min_length=1)]
    radius_m: Positive | None = None
    aim: AimBlock | None = None


class CardSensor(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A gauge with the time constants of its electronics."""

    id: str
    kind: Literal["embedded", "wall"]
    bead: int | None = None
    droop_s: float | None = None
    lowpass_s: float = 0.0


class Card(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A resolved case: one chain, one striker, one or more impact speeds (one run each)."""

    format: Literal[1] = 1
    case: str
    variant: str
    title: str
    beads: Annotated[int, Meta(ge=1)]
    bead: CardBead
    wall: CardMaterial
    striker: CardStriker
    gravity_m_s2: NonNegative
    static_force_N: NonNegative
    sensors: tuple[CardSensor, ...]
    duration_s: Positive
    interval_s: Positive
    effects: dict[str, dict[str, float | str]] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """`case.variant`, the stem of all its files."""
        return f"{self.case}.{self.variant}"


class CardError(ValueError):
    """A case that cannot be simulated; `key` is the place in the case's block."""

    def __init__(self, key: str, problem: str):
        super().__init__(f"{key}: {problem}")
        self.key = key


def material(name: str, overrides: dict[str, MaterialBlock], key: str) -> CardMaterial:
    """A material of the table with a case's overrides.

    Raises:
        CardError: for a name that is not in the table and not fully given among the overrides.
    """
    known = MATERIALS.get(name, Material(math.nan, math.nan, None, None, ""))
    given = overrides.get(name, MaterialBlock())
    modulus = known.modulus if given.modulus_GPa is None else given.modulus_GPa * 1e9
    poisson = known.poisson if given.poisson is None else given.poisson
    if math.isnan(modulus) or math.isnan(poisson):
        raise CardError(
            key,
            f"material {name!r} is not in the table ({', '.join(sorted(MATERIALS))}); "
            "use one of these or give its modulus_GPa and poisson under materials",
        )
    density = known.density if given.density_kg_m3 is None else given.density_kg_m3
    strength = known.yield_strength if given.yield_MPa is None else given.yield_MPa * 1e6
    return CardMaterial(
        name=name, modulus_Pa=modulus, poisson=poisson, density_kg_m3=density, yield_Pa=strength
    )


def variant_names(case: dict[str, Any]) -> list[str]:
    """Names of the variants of a case as written; a case without variants has one, `nominal`."""
    return list(case.get("variants") or {}) or ["nominal"]


def merged(case: dict[str, Any], variant: str) -> dict[str, Any]:
    """The case as written with the overrides of one variant merged in, key by key."""
    plain = {k: v for k, v in case.items() if k != "variants"}
    return _merge(plain, (case.get("variants") or {}).get(variant) or {})


def resolve(case: str, variant: str, block: CaseBlock) -> Card:
    """The card of one case, its variant's overrides merged already (`merged`).

    Raises:
        CardError: for a bead outside the chain, a sphere without diameter, an unknown material and the like.
    """
    chain, striker = block.chain, block.striker
    if striker.shape == "sphere" and striker.diameter_mm is None:
        raise CardError("striker.diameter_mm", "missing; a sphere needs its diameter")
    if (chain.bead.coating_um is None) != (chain.bead.core is None):
        raise CardError(
            "chain.bead", "coating_um and core go together: give both, or neither for a solid bead"
        )
    if chain.bead.coating_um is not None and chain.bead.coating_um / 500.0 >= chain.bead.diameter_mm:
        raise CardError(
            "chain.bead.coating_um", f"is {chain.bead.coating_um}; the coating must be thinner than the bead"
        )
    if striker.aim is not None and striker.aim.sensor not in [s.id for s in block.sensors]:
        raise CardError("striker.aim.sensor", f"is {striker.aim.sensor!r}; no sensor has this id")

    ids = [s.id for s in block.sensors]
    for place, name in enumerate(ids):
        if name in ids[:place]:
            raise CardError(f"sensors[{place}].id", f"is {name!r}; another sensor has this id: rename one")

    def look(name, key):
        return material(name, block.materials, key)

    speeds = striker.speed_m_s if isinstance(striker.speed_m_s, list) else [striker.speed_m_s]
    return Card(
        case=case,
        variant=variant,
        title=block.title,
        beads=chain.beads,
        bead=CardBead(
            diameter_m=chain.bead.diameter_mm / 1e3,
            mass_kg=chain.bead.mass_g / 1e3,
            surface=look(chain.bead.material, "chain.bead.material"),
            coating_m=None if chain.bead.coating_um is None else chain.bead.coating_um / 1e6,
            core=None if chain.bead.core is None else look(chain.bead.core, "chain.bead.core"),
        ),
        wall=look(chain.wall.material, "chain.wall.material"),
        striker=CardStriker(
            mass_kg=striker.mass_g / 1e3,
            surface=look(striker.material, "striker.material"),
            speeds_m_s=tuple(speeds),
            radius_m=striker.diameter_mm / 2e3 if striker.shape == "sphere" else None,
            aim=striker.aim,
        ),
        gravity_m_s2=GRAVITY if chain.orientation == "vertical" else 0.0,
        static_force_N=chain.static_force_N,
        sensors=tuple(_sensor(s, k, chain.beads) for k, s in enumerate(block.sensors)),
        duration_s=block.duration_us / 1e6,
        interval_s=block.sample_us / 1e6,
        effects=block.effects,
    )


def _sensor(block, place, beads):
    key = f"sensors[{place}]"
    if block.kind == "embedded" and block.bead is None:
        raise CardError(f"{key}.bead", "missing; an embedded sensor needs the number of its bead")
    if block.kind == "wall" and block.bead is not None:
        raise CardError(f"{key}.bead", f"is {block.bead}; the wall sensor sits in no bead: remove the key")
    if block.bead is not None and block.bead > beads:
        raise CardError(f"{key}.bead", f"is {block.bead}; the chain has {beads} beads")
    droop = None if block.droop_us is None else block.droop_us / 1e6
    return CardSensor(
        id=block.id, kind=block.kind, bead=block.bead, droop_s=droop, lowpass_s=block.lowpass_us / 1e6
    )


def _merge(base, changes):
    result = dict(base)
    for key, value in changes.items():
        inside = isinstance(value, dict) and isinstance(result.get(key), dict)
        result[key] = _merge(result[key], value) if inside else value
    return result


def dump(card: Card) -> bytes:
    """The card as JSON, keys in the order of the fields."""
    return msgspec.json.format(msgspec.json.encode(card), indent=1) + b"\n"


def load(text: bytes) -> Card:
    """The card of a JSON text; msgspec.ValidationError names the field at fault."""
    return msgspec.json.decode(text, type=Card)
