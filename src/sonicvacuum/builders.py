"""The blocks of a case from Python: `sv.bead`, `sv.chain`, `sv.striker`, `sv.gauge`, joined by `sv.case`.

Each returns what the block of the same name in `config.yaml` is read into, with the same keys in the same
units. What a ball's size and material decide (its mass) or what is usual (a wall of the beads' material) may
be left out. A wrong value is named where it is written; what only the whole shows, `sv.case` says.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, TypeVar

from msgspec import Struct, to_builtins
from msgspec.structs import asdict, replace

from sonicvacuum.card import Card, CaseBlock, SensorBlock, StrikerBlock, resolve
from sonicvacuum.files import InputError, check_values, convert
from sonicvacuum.gauges import KINDS
from sonicvacuum.gauges.base import misplaced
from sonicvacuum.laboratory.blocks import BeadBlock, ChainBlock
from sonicvacuum.laboratory.ranges import DIAMETER, LaboratoryError, check_coating
from sonicvacuum.materials import MATERIALS
from sonicvacuum.physics.theory import bead_mass

# In g, stands for a mass that is computed once all else has been checked.
_ANY_MASS = 1.0
_Made = TypeVar("_Made", bound=Struct)


def ball_mass(
    diameter_m: float, material: str, coating_m: float | None = None, core: str | None = None
) -> float:
    """Mass in kg of a ball of table materials; with a coating by Eq. (2) of Daraio & Nesterenko (2006).

    Raises:
        KeyError: for a material that the table does not have.
    """
    coating = coating_m or 0.0
    inner = MATERIALS[core or material].density
    return float(bead_mass(diameter_m / 2.0 - coating, coating, inner, MATERIALS[material].density))


def bead(
    *,
    diameter_mm: float,
    material: str,
    mass_g: float | None = None,
    coating_um: float | None = None,
    core: str | None = None,
    faces: Literal["sphere", "flat"] = "sphere",
) -> BeadBlock:
    """A bead.

    Args:
        diameter_mm: outer diameter.
        material: what touches, a name of the table of materials or of the case's own `materials`.
        mass_g: from diameter and density where it is not given.
        coating_um: thickness of a coating.
        core: material below it.
        faces: `flat` for a body with ground faces, which balls touch; its mass has to be given.

    Returns:
        The block `bead` of a chain, masses in g and lengths in mm and µm as their names say.

    Raises:
        InputError: naming key, value and cure.

    Examples:
        >>> import sonicvacuum as sv
        >>> round(sv.bead(diameter_mm=20.0, material="bearing-steel").mass_g, 2)
        32.71
    """
    given = {"diameter_mm": diameter_mm, "material": material, "coating_um": coating_um, "core": core}
    return _ball(BeadBlock, "bead", mass_g, given | {"faces": faces})


def chain(
    *,
    bead: BeadBlock | None = None,
    pattern: Iterable[BeadBlock] | None = None,
    beads: int | None = None,
    bodies: Mapping[int, BeadBlock | Mapping[str, Any]] | None = None,
    wall: str | None = None,
    orientation: Literal["horizontal", "vertical"] = "horizontal",
    static_force_N: float = 0.0,
) -> ChainBlock:
    """Beads in a row between striker and wall.

    Args:
        bead: every bead; or
        pattern: beads that repeat from bead 1, the one that is struck, to the wall.
        beads: their number; as many as the pattern has where it is not given.
        bodies: number of a bead → the bead that stands there instead, or the keys in which it differs.
        wall: its material; that of bead 1 (of its core) where it is not given.
        orientation: `vertical` with the wall below, where weight compresses the chain, or `horizontal`.
        static_force_N: force on bead 1 at rest.

    Returns:
        The block `chain` of a case.

    Raises:
        InputError: naming key, value and cure.

    Examples:
        >>> import sonicvacuum as sv
        >>> balls = [sv.bead(diameter_mm=10 * 0.9**k, material="glass") for k in range(6)]
        >>> tapered = sv.chain(pattern=balls)
        >>> tapered.beads, tapered.wall.material
        (6, 'glass')
    """
    if pattern is not None:
        if not isinstance(pattern, Iterable):
            raise InputError(f"chain: pattern: is a {type(pattern).__name__}; give several of sv.bead")
        pattern = list(pattern)
    if not isinstance(bodies or {}, Mapping):
        raise InputError(f"chain: bodies: is a {type(bodies).__name__}; give number of a bead: what is there")
    first = bead or (pattern[0] if pattern else None)
    if not isinstance(first, BeadBlock):
        raise InputError(
            "chain: bead: missing, or none of sv.bead; give bead, or a pattern of them to repeat"
        )
    if beads is None and not pattern:
        raise InputError("chain: beads: missing; give the number of beads")
    changed = {k: asdict(b) if isinstance(b, BeadBlock) else b for k, b in (bodies or {}).items()}
    keys = {
        "beads": len(pattern or ()) if beads is None else beads,
        "orientation": orientation,
        "bead": bead,
        "pattern": pattern,
        "bodies": changed,
        "wall": {"material": wall or first.core or first.material},
        "static_force_N": static_force_N,
    }
    return _block(ChainBlock, "chain", keys)


def striker(
    ball: BeadBlock | None = None,
    *,
    speed_m_s: float | Sequence[float],
    shape: Literal["sphere", "flat"] = "sphere",
    material: str | None = None,
    mass_g: float | None = None,
    diameter_mm: float | None = None,
    aim: Mapping[str, Any] | None = None,
) -> StrikerBlock:
    """What hits bead 1: a ball like a bead, or as the other keys say.

    Args:
        ball: a bead whose material, mass and diameter the striker has where they are not given.
        speed_m_s: at impact; several make one run each.
        shape: `flat` for a body with a flat face.
        material: of what touches bead 1.
        mass_g: of a ball, from diameter and density where it is not given.
        diameter_mm: of a ball.
        aim: `sensor` and `amplitude_N`: the speed is changed until this gauge has this peak.

    Returns:
        The block `striker` of a case.

    Raises:
        InputError: naming key, value and cure.

    Examples:
        >>> import sonicvacuum as sv
        >>> sv.striker(sv.bead(diameter_mm=5.0, material="glass"), speed_m_s=[0.1, 0.2]).speed_m_s
        [0.1, 0.2]
    """
    if ball is not None:
        if not isinstance(ball, BeadBlock):
            raise InputError(f"striker: ball: is {ball!r:.100}; give what sv.bead returns, or material=…")
        material = material or ball.material
        mass_g = ball.mass_g if mass_g is None else mass_g
        diameter_mm = ball.diameter_mm if diameter_mm is None and shape == "sphere" else diameter_mm
    given = {"shape": shape, "material": material, "diameter_mm": diameter_mm}
    return _ball(StrikerBlock, "striker", mass_g, given | {"speed_m_s": speed_m_s, "aim": aim})


def gauge(
    kind: str = "embedded",
    bead: int | None = None,
    *,
    id: str | None = None,
    droop_us: float | None = None,
    lowpass_us: float = 0.0,
) -> SensorBlock:
    """A gauge with its electronics.

    Args:
        kind: `embedded` (force inside a bead), `wall` (force on the wall), `velocity` (laser vibrometer on a
            bead, m/s) or `acceleration` (m/s²); module `gauges` has them all.
        bead: the one that it reads; none for the wall.
        id: its name in results; kind and bead, as in `velocity-15`, where it is not given.
        droop_us: time constant with which a constant signal decays; none where it stays.
        lowpass_us: time constant of the bandwidth.

    Returns:
        One of the `sensors` of a case.

    Raises:
        InputError: naming key, value and cure.

    Examples:
        >>> import sonicvacuum as sv
        >>> sv.gauge("velocity", bead=15).id
        'velocity-15'
    """
    keys = {"kind": kind, "bead": bead, "id": id or (kind if bead is None else f"{kind}-{bead}")}
    made = _block(SensorBlock, "gauge", keys | {"droop_us": droop_us, "lowpass_us": lowpass_us})
    if made.kind not in KINDS:
        raise InputError(f"gauge: kind: is {kind!r}; the kinds of gauges are {', '.join(KINDS)}")
    # How many beads there are the case will say.
    if problem := misplaced(made.kind, made.bead, made.bead or 1):
        raise InputError(f"gauge: bead: {problem}")
    return made


def case(
    chain: ChainBlock | Mapping[str, Any],
    striker: StrikerBlock | Mapping[str, Any],
    sensors: Sequence[SensorBlock | Mapping[str, Any]],
    *,
    duration_us: float,
    sample_us: float = 0.5,
    materials: Mapping[str, Mapping[str, Any]] | None = None,
    effects: Mapping[str, Mapping[str, Any]] | None = None,
    title: str = "case",
) -> Card:
    """A case of one's own, resolved into SI: what the blocks of `config.yaml` hold, built or as mappings.

    Args:
        chain: from `sv.chain`, or a mapping with its keys.
        striker: likewise from `sv.striker`.
        sensors: from `sv.gauge`, or mappings with its keys.
        duration_us: simulated from the moment of impact.
        sample_us: time between samples.
        materials: name → `modulus_GPa`, `poisson`, `density_kg_m3`, `yield_MPa` that override the table.
        effects: id → parameters of what an ideal chain lacks; `sonicvacuum effects` lists them.
        title: one line.

    Returns:
        `Card`, in SI, what `sv.simulate` takes.

    Raises:
        InputError: for an unknown key, a value out of range, a gauge outside the chain and the like.

    Examples:
        >>> import sonicvacuum as sv
        >>> ball = sv.bead(diameter_mm=5.0, material="bearing-steel")
        >>> wall = sv.gauge("wall")
        >>> chain, striker = sv.chain(bead=ball, beads=8), sv.striker(ball, speed_m_s=0.5)
        >>> card = sv.case(chain, striker, [wall], duration_us=200)
        >>> card.beads, round(card.bead.mass_kg * 1e3, 3)
        (8, 0.511)
    """
    parts = {"chain": chain, "striker": striker, "sensors": sensors, "duration_us": duration_us}
    more = {"sample_us": sample_us, "materials": materials, "effects": effects, "title": title}
    block = _block(CaseBlock, "case", parts | more)
    try:
        return resolve("case", "own", block)
    except LaboratoryError as error:
        raise InputError(f"case: {error}") from None


def _block(kind: type[_Made], place: str, keys: dict[str, Any]) -> _Made:
    """The block of these keys, those that are None left out; blocks among them are checked once more."""

    def plain(value: Any) -> Any:
        if hasattr(value, "tolist"):  # numbers and arrays of numpy
            return value.tolist()
        raise InputError(f"{place}: holds a {type(value).__name__}; give numbers, texts, lists and mappings")

    given = {key: value for key, value in keys.items() if value is not None}
    content = to_builtins(given, enc_hook=plain)
    # Parameters of effects may be infinite, which the effects themselves look at.
    check_values({key: value for key, value in content.items() if key != "effects"}, place)
    return convert(content, kind, place)


def _ball(kind: type[_Made], place: str, mass_g: float | None, keys: dict[str, Any]) -> _Made:
    """The block of these keys with its mass; where none is given, the one of a ball of that size."""
    made = _block(kind, place, keys | {"mass_g": _ANY_MASS if mass_g is None else mass_g})
    try:
        return made if mass_g is not None else replace(made, mass_g=_mass_g(made, place))
    except LaboratoryError as error:
        raise InputError(str(error)) from None


def _mass_g(made: Any, place: str) -> float:
    """Mass in g of the ball of a block; InputError for what is no ball, or has no density in the table."""
    if made.diameter_mm is None or "flat" in (getattr(made, "faces", None), getattr(made, "shape", None)):
        raise InputError(f"{place}: mass_g: missing; only that of a ball follows from diameter and material")
    DIAMETER.check(f"{place}.diameter_mm", made.diameter_mm)
    core, coating_um = getattr(made, "core", None), getattr(made, "coating_um", None) or 0.0
    if coating_um:
        check_coating(place, made)
    for name in filter(None, (made.material, core)):
        if name not in MATERIALS:
            told = f"mass_g: missing; the table of materials has no density of {name!r}"
            raise InputError(f"{place}: {told}: give mass_g, or one of {', '.join(MATERIALS)}")
    return 1e3 * ball_mass(made.diameter_mm / 1e3, made.material, coating_um / 1e6, core)
