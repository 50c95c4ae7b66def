"""One case, resolved: everything a simulation needs, in SI, with nothing left to look up.

The blocks (`CaseBlock` and its parts) are what a user writes in `config.yaml`, units in the key names;
`resolve` turns a block into a card. What a chain is, `sonicvacuum.laboratory` says, for records too.
"""

import math
from typing import Annotated, Any, Literal

import msgspec
from msgspec import UNSET, Meta, Struct, UnsetType, field
from msgspec.structs import replace

from sonicvacuum.gauges import KINDS, Gauge
from sonicvacuum.gauges.base import misplaced
from sonicvacuum.laboratory import blocks, checks, ranges
from sonicvacuum.laboratory.blocks import (
    BeadBlock,
    ChainBlock,
    MaterialBlock,
    material_of,
    specimen_of,
    striker_of,
)
from sonicvacuum.laboratory.bodies import Bodies
from sonicvacuum.laboratory.ranges import LaboratoryError
from sonicvacuum.laboratory.specimen import Bead, Material, NonNegative, Positive, Specimen, Striker

GaugeKind = Annotated[str, Meta(extra_json_schema={"enum": list(KINDS)})]
# What stands beside the gauges in the table of a card's traces.
COLUMNS = {checks.TIME: "times", "run": "numbers of runs", "speed_m_s": "striker's speeds"}
# Part of a file's name; without (?!\n), $ would let a new line stand at the end.
Name = Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*(?!\n)$", max_length=100)]


class _Block(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    pass


class AimBlock(_Block):
    """The striker's speed is adjusted until the sensor's peak is this."""

    sensor: Name
    amplitude_N: Positive


class StrikerBlock(blocks.StrikerBlock, kw_only=True):
    """Striker: a list of speeds makes a sweep, one run for each."""

    speed_m_s: Positive | Annotated[list[Positive], Meta(min_length=1)]
    aim: AimBlock | None = None


class SensorBlock(_Block):
    """A gauge and its electronics; the kinds are those of `gauges`."""

    id: Name
    kind: GaugeKind
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
    """One case of `config.yaml`; `model` is put in once `discover` has made it (`discover.extended`)."""

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


class CardStriker(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Striker; `radius_m` is absent for a flat one."""

    mass_kg: Positive
    surface: Material
    speeds_m_s: Annotated[tuple[Positive, ...], Meta(min_length=1)]
    radius_m: Positive | None = None
    aim: AimBlock | None = None


class CardSensor(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A gauge as a card's file holds it: `gauge` is the gauge itself.

    Attributes:
        id: its name.
        kind: key of `gauges.KINDS`.
        bead: its bead, from 1; None for a gauge in none.
        droop_s: RC time of its discharge in s; None where there is none.
        lowpass_s: time constant of its bandwidth in s; 0: unlimited.
    """

    id: Name
    kind: str
    bead: int | None = None
    droop_s: Positive | None = None
    lowpass_s: NonNegative = 0.0

    @property
    def droop_us(self) -> float | None:
        """RC time of the discharge in us; None where there is none."""
        return None if self.droop_s is None else 1e6 * self.droop_s

    @property
    def lowpass_us(self) -> float:
        """Time constant of the bandwidth in us; 0: unlimited."""
        return 1e6 * self.lowpass_s

    @property
    def gauge(self) -> Gauge:
        """The gauge with its electronics."""
        return Gauge(self.id, self.kind, self.bead, self.droop_s, self.lowpass_s)


class Card(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A resolved case: one chain, one striker, one or more impact speeds (one run each).

    `bead` is every bead, or the first of `pattern` where they repeat one; `bodies` has those that differ.
    """

    format: Literal[1] = 1
    case: Name
    variant: Name
    title: str
    beads: Annotated[int, Meta(ge=1)]
    bead: Bead
    pattern: tuple[Bead, ...] | UnsetType = UNSET
    bodies: dict[int, Bead] | UnsetType = UNSET
    wall: Material
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

    @property
    def specimen(self) -> Specimen:
        """The chain."""
        pattern = (self.bead,) if self.pattern is UNSET else self.pattern
        bodies = Bodies(pattern, {} if self.bodies is UNSET else self.bodies)
        return Specimen(self.beads, bodies, self.wall, self.gravity_m_s2, self.static_force_N)

    def strikers(self, speeds=None) -> list[Striker]:
        """The striker at each of its speeds in m/s, or at the given ones."""
        s = self.striker
        size = {} if s.radius_m is None else {"radius_m": s.radius_m}
        speeds = s.speeds_m_s if speeds is None else speeds
        return [Striker(s.surface, s.mass_kg, float(speed), **size) for speed in speeds]

    def stiffened(self, name: str, ratio: float) -> "Card":
        """The card with the modulus of one material times a ratio, wherever it has that material."""
        changes = {
            "bead": self.bead.stiffened(name, ratio),
            "striker": replace(self.striker, surface=self.striker.surface.stiffened(name, ratio)),
            "wall": self.wall.stiffened(name, ratio),
        }
        if self.pattern is not UNSET:
            changes["pattern"] = tuple(bead.stiffened(name, ratio) for bead in self.pattern)
        if self.bodies is not UNSET:
            changes["bodies"] = {k: bead.stiffened(name, ratio) for k, bead in self.bodies.items()}
        return replace(self, **changes)


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
        LaboratoryError: for a bead outside the chain, a sphere without diameter, an unknown material …
    """
    written = block.striker
    checks.check_chain(block.chain)
    checks.check_materials(block.materials)
    specimen = specimen_of(block.chain, block.materials)
    surface = material_of(written.material, block.materials, "striker.material")
    speeds = written.speed_m_s if isinstance(written.speed_m_s, list) else [written.speed_m_s]
    striker = striker_of(written, surface, specimen, "striker", speeds[0])
    bodies = specimen.bodies
    checks.check_striker("striker", written, checks.lightest_g(block.chain))
    checks.check_speeds("striker.speed_m_s", *speeds)
    card = Card(
        case=case,
        variant=variant,
        title=block.title,
        beads=specimen.beads,
        bead=bodies.pattern[0],
        pattern=bodies.pattern if block.chain.pattern else UNSET,
        bodies=dict(bodies.exceptions) or UNSET,
        wall=specimen.wall,
        striker=CardStriker(
            mass_kg=striker.mass_kg,
            surface=surface,
            speeds_m_s=tuple(speeds),
            radius_m=None if math.isinf(striker.radius_m) else striker.radius_m,
            aim=written.aim,
        ),
        gravity_m_s2=specimen.gravity_m_s2,
        static_force_N=specimen.static_force_N,
        sensors=tuple(map(_sensor, block.sensors)),
        duration_s=block.duration_us / 1e6,
        interval_s=block.sample_us / 1e6,
        effects=block.effects,
    )
    check_gauges(card)
    return card


def check_gauges(card: Card) -> None:
    """LaboratoryError for a gauge that is nowhere, a name or times that none can have, an aim at no gauge."""
    ids = [s.id for s in card.sensors]
    for place, sensor in enumerate(card.sensors):
        key = f"sensors[{place}]"
        checks.check_sensor(key, sensor, COLUMNS)
        if sensor.kind not in KINDS:
            known = ", ".join(KINDS)
            raise LaboratoryError(f"{key}.kind", f"is {sensor.kind!r}; the kinds of gauges are {known}")
        if problem := misplaced(sensor.kind, sensor.bead, card.beads):
            raise LaboratoryError(f"{key}.bead", problem)
        if sensor.id in ids[:place]:
            raise LaboratoryError(f"{key}.id", f"is {sensor.id!r}; another sensor has this id: rename one")
    aim = card.striker.aim
    if aim is not None and aim.sensor not in ids:
        raise LaboratoryError(
            "striker.aim.sensor", f"is {aim.sensor!r}; no sensor has this id: {', '.join(ids)}"
        )


def check(card: Card) -> None:
    """LaboratoryError for a card that `resolve` would not have made; the message names the place in the card.

    Lengths and masses are told in the units of the ranges, mm and g.
    """
    check_gauges(card)
    ranges.STATIC_FORCE.check("static_force_N", card.static_force_N)
    places = {"bead": card.bead}
    places |= {f"pattern[{k}]": b for k, b in enumerate(() if card.pattern is UNSET else card.pattern)}
    places |= {f"bodies.{k}": b for k, b in ({} if card.bodies is UNSET else card.bodies).items()}
    for key, bead in places.items():
        block = _as_block(bead)
        ranges.check_coating(key, block)
        ranges.check_bead(key, block)
    s = card.striker
    surfaces = {f"{key}.surface": bead.surface for key, bead in places.items()}
    for key, surface in (surfaces | {"wall": card.wall, "striker.surface": s.surface}).items():
        ranges.check_material(key, "", _as_material(surface))
    size = None if s.radius_m is None else 2e3 * s.radius_m
    shape = "flat" if size is None else "sphere"
    striker = StrikerBlock(
        shape=shape, material=s.surface.name, mass_g=1e3 * s.mass_kg, diameter_mm=size, speed_m_s=1.0
    )
    checks.check_striker("striker", striker, 1e3 * min(bead.mass_kg for bead in places.values()))
    checks.check_speeds("striker.speeds_m_s", *s.speeds_m_s)


def _as_block(bead):
    return BeadBlock(
        diameter_mm=1e3 * bead.diameter_m,
        mass_g=1e3 * bead.mass_kg,
        material=bead.surface.name,
        coating_um=None if bead.coating_m is None else 1e6 * bead.coating_m,
        core=None if bead.core is None else bead.core.name,
        faces="flat" if bead.flat else "sphere",
    )


def _as_material(surface):
    """Without its name: the model of a record may have moved a modulus away from the table's."""
    known = {"density_kg_m3": surface.density_kg_m3}
    known["yield_MPa"] = None if surface.yield_Pa is None else surface.yield_Pa / 1e6
    return MaterialBlock(modulus_GPa=surface.modulus_Pa / 1e9, **known)


def _sensor(block):
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
