"""What a user writes in `record.yaml` (format 1): the closed schema of measured data, units in the key names.

One class for each quantity that an observable may give, so that what it needs, what it allows and its unit
stand in one place and an editor can be told (`schema`).
"""

from typing import Annotated, Any, Literal, get_args

import msgspec
from msgspec import Meta, field

from sonicvacuum.laboratory.blocks import Block as _Block
from sonicvacuum.laboratory.blocks import ChainBlock, MaterialBlock, StrikerBlock
from sonicvacuum.laboratory.specimen import NonNegative, Positive

# Names of gauges and runs: they become column headings and file names.
Id = Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.+-]*$")]
FileName = Annotated[str, Meta(pattern=r"^[^/\\.][^/\\]*$")]
Fraction = Annotated[float, Meta(gt=0.0, lt=1.0)]


class SourceBlock(_Block, kw_only=True):
    """Where the data come from, in free text."""

    citation: str | None = None
    doi: str | None = None
    licence: str | None = None
    note: str | None = None


class RecordMaterialBlock(MaterialBlock, kw_only=True):
    """Overrides of the table of materials, and one standard error of the modulus relative to it."""

    modulus_rel_sigma: NonNegative = 0.0


class RecordChainBlock(ChainBlock, kw_only=True):
    """As in a case; `beads` 0 is one ball, the striker, on the wall."""

    beads: Annotated[int, Meta(ge=0)]


class RecordSensorBlock(_Block, kw_only=True):
    """A gauge: white noise of one sample in N, relative standard error of its gain."""

    id: Id
    kind: Literal["embedded", "wall"]
    bead: Annotated[int, Meta(ge=1)] | None = None
    sigma_N: NonNegative = 0.0
    gain_rel_sigma: NonNegative = 0.0


class RecordStrikerBlock(StrikerBlock, kw_only=True):
    """The striker of one run."""

    speed_m_s: Positive
    speed_rel_sigma: NonNegative = 0.0


class _Observable(_Block, tag_field="quantity", kw_only=True):
    """One measured scalar with its standard error."""

    value: float
    sigma: NonNegative


class SpeedBlock(_Observable, tag="speed", kw_only=True):
    """Distance over peak-to-peak time of the main pulse."""

    from_: Id = field(name="from")
    to: Id
    unit: Literal["m/s"]


class AmplitudeBlock(_Observable, tag="amplitude", kw_only=True):
    """Peak of the main pulse above rest."""

    sensor: Id
    unit: Literal["N"]


class DurationBlock(_Observable, tag="duration", kw_only=True):
    """Time for which the main pulse exceeds level × peak."""

    sensor: Id
    level: Fraction = 0.01
    unit: Literal["us"]


class WidthBlock(_Observable, tag="width", kw_only=True):
    """Duration × speed / bead diameter."""

    from_: Id = field(name="from")
    to: Id
    sensor: Id
    level: Fraction = 0.01
    unit: Literal["diameters"]


class PulseCountBlock(_Observable, tag="pulse_count", kw_only=True):
    """Separate peaks above threshold × first peak before the reflection returns."""

    sensor: Id
    threshold: Fraction = 0.15
    unit: Literal["1", 1]


class DecayBlock(_Observable, tag="decay", kw_only=True):
    """Amplitude at `to` over amplitude at `from`."""

    from_: Id = field(name="from")
    to: Id
    unit: Literal["1", 1]


class SpeedAtAmplitudeBlock(_Observable, tag="speed_at_amplitude", kw_only=True):
    """Speed of a solitary wave whose peak at the sensor is amplitude_N, whatever the striker."""

    amplitude_N: Positive
    sensor: Id
    unit: Literal["m/s"]


class RestitutionBlock(_Observable, tag="restitution", kw_only=True):
    """Rebound speed over impact speed of the striker."""

    unit: Literal["1", 1]


class ContactDurationBlock(_Observable, tag="contact_duration", kw_only=True):
    """Time of contact of the ball with the wall."""

    unit: Literal["us"]


ObservableBlock = (
    SpeedBlock
    | AmplitudeBlock
    | DurationBlock
    | WidthBlock
    | PulseCountBlock
    | DecayBlock
    | SpeedAtAmplitudeBlock
    | RestitutionBlock
    | ContactDurationBlock
)

# quantity → its class, and the unit in which a record gives it
OBSERVABLES = {kind.__struct_config__.tag: kind for kind in get_args(ObservableBlock)}
UNITS = {q: get_args(kind.__annotations__["unit"])[0] for q, kind in OBSERVABLES.items()}
# What one ball on a wall can tell.
BALL_QUANTITIES = ("restitution", "contact_duration")


class RunBlock(_Block, kw_only=True):
    """One impact: its striker, and signals or scalars or both."""

    id: Id
    striker: RecordStrikerBlock
    signals: FileName | None = None
    observables: list[ObservableBlock] = field(default_factory=list)


class RecordBlock(_Block, kw_only=True):
    """`record.yaml`."""

    format: Literal[1]
    title: str
    source: SourceBlock = SourceBlock()
    chain: RecordChainBlock
    materials: dict[str, RecordMaterialBlock] = field(default_factory=dict)
    sensors: list[RecordSensorBlock] = field(default_factory=list)
    trigger_sigma_us: NonNegative = 0.0
    runs: Annotated[list[RunBlock], Meta(min_length=1)]


def schema() -> dict[str, Any]:
    """JSON schema of `record.yaml`, for editors; made from the types that check it."""
    (whole,), parts = msgspec.json.schema_components([RecordBlock], ref_template="#/$defs/{name}")
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **whole, "$defs": parts}
