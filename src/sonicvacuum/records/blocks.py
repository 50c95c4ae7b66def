"""What a user writes in `record.yaml` (format 1): the closed schema of measured data, units in the key names.

One class for each quantity that an observable may give, so that what it needs, what it allows and its unit
stand in one place and an editor can be told (`schema`).
"""

import datetime
from typing import Annotated, Any, Literal, get_args

import msgspec
from msgspec import Meta, field

from sonicvacuum.card import GaugeKind
from sonicvacuum.gauges import KINDS
from sonicvacuum.laboratory.blocks import Block as _Block
from sonicvacuum.laboratory.blocks import ChainBlock, MaterialBlock, StrikerBlock
from sonicvacuum.laboratory.specimen import NonNegative, Positive

# Names of gauges and runs: they become column headings and file names.
# Without (?!\n), $ would let a new line stand at the end.
Id = Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.+-]*(?!\n)$")]
FileName = Annotated[str, Meta(pattern=r"^[^/\\.][^/\\]*$")]
# An error that is not known at all: the gain of an uncalibrated gauge, the time zero of a free-running clock.
Unknown = Literal["unknown"]
# In place of odds: an effect that is known to act.
PRESENT = "present"
Present = Literal["present"]
Fraction = Annotated[float, Meta(gt=0.0, lt=1.0)]


class SourceBlock(_Block, kw_only=True):
    """Where the data come from, in free text, and the day on which they were taken (2026-05-01)."""

    citation: str | None = None
    date: datetime.date | None = None
    doi: str | None = None
    licence: str | None = None
    note: str | None = None


class RecordMaterialBlock(MaterialBlock, kw_only=True):
    """Overrides of the table of materials, and one standard error of the modulus relative to it; 0: exact."""

    modulus_rel_sigma: NonNegative | None = None


class RecordChainBlock(ChainBlock, kw_only=True):
    """As in a case; `beads` 0 is one ball, the striker, on the wall."""

    beads: Annotated[int, Meta(ge=0)]


class _SensorBlock(_Block, kw_only=True):
    id: Id
    kind: GaugeKind
    bead: Annotated[int, Meta(ge=1)] | None = None
    gain_rel_sigma: NonNegative | Unknown = 0.0
    delay_sigma_us: NonNegative = 0.0
    droop_us: Positive | None = None


# Keys whose unit is that of the gauge's kind: white noise of one sample (left out: estimated from the quiet
# stretch), standard errors of a constant offset and of a slow drift.
SCALED = ("sigma", "baseline_sigma", "drift_sigma")
SUFFIXES = tuple(dict.fromkeys(kind.suffix for kind in KINDS.values()))
RecordSensorBlock = msgspec.defstruct(
    "RecordSensorBlock",
    [(f"{key}_{suffix}", NonNegative | None, None) for suffix in SUFFIXES for key in SCALED],
    bases=(_SensorBlock,),
    module=__name__,
    namespace={"__doc__": "A gauge: kind, place, RC time of its discharge if known, noise, errors."},
    frozen=True,
    kw_only=True,
    forbid_unknown_fields=True,
    omit_defaults=True,
)


class TolerancesBlock(_Block, kw_only=True):
    """One standard error each, relative, of what all bodies, all runs or all gauges share; 0: exact.

    `bead_mass_rel` is that of each bead beside the others as well, which need not weigh alike.
    With `coating_rel` the thickness that `coating_um` states is that of the layer, if it acts as one; without
    it the layer's thickness is searched for.
    """

    bead_mass_rel: NonNegative | None = None
    bead_diameter_rel: NonNegative | None = None
    coating_rel: NonNegative | None = None
    static_force_rel: NonNegative | None = None
    striker_mass_rel: NonNegative | None = None
    speed_common_rel: NonNegative | None = None
    gain_common_rel: NonNegative | None = None


class ApparatusBlock(_Block, kw_only=True):
    """What the laboratory could do in a further run; what is left out here cannot be changed there.

    `speed_m_s` are the slowest and the fastest striker; the others list what is to be had: masses of strikers
    of the same kind, preloads, beads that may hold a gauge, orientations.
    """

    speed_m_s: tuple[Positive, Positive] | None = None
    striker_mass_g: list[Positive] = field(default_factory=list)
    static_force_N: list[NonNegative] = field(default_factory=list)
    gauge_beads: list[Annotated[int, Meta(ge=1)]] = field(default_factory=list)
    orientation: list[Literal["vertical", "horizontal"]] = field(default_factory=list)


class RecordStrikerBlock(StrikerBlock, kw_only=True):
    """The striker of one run."""

    speed_m_s: Positive
    speed_rel_sigma: NonNegative = 0.0


class _Observable(_Block, tag_field="quantity", kw_only=True):
    """One measured scalar with its standard error.

    Attributes:
        bound: `at_most` or `at_least`, where the value is a bound: the data then ask for no more than that.
        shared: source of error → relative standard error that the value has in common with every other one
            that names this source (a distance that several speeds were worked out with); not in `sigma`.
    """

    value: float
    sigma: NonNegative
    bound: Literal["at_most", "at_least"] | None = None
    shared: dict[Id, NonNegative] = field(default_factory=dict)


class SpeedBlock(_Observable, tag="speed", kw_only=True):
    """Distance over peak-to-peak time of the main pulse."""

    from_: Id = field(name="from")
    to: Id
    unit: Literal["m/s"]


class AmplitudeBlock(_Observable, tag="amplitude", kw_only=True):
    """Peak of the main pulse above rest, in the unit of the gauge."""

    sensor: Id
    unit: Literal[tuple(dict.fromkeys(kind.unit for kind in KINDS.values()))]


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


class EchoDelayBlock(_Observable, tag="echo_delay", kw_only=True):
    """Time from the incident pulse's peak to that of the pulse reflected by the wall."""

    sensor: Id
    unit: Literal["us"]


class EchoRatioBlock(_Observable, tag="echo_ratio", kw_only=True):
    """Amplitude of the pulse reflected by the wall over that of the incident one."""

    sensor: Id
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
    | EchoDelayBlock
    | EchoRatioBlock
    | SpeedAtAmplitudeBlock
    | RestitutionBlock
    | ContactDurationBlock
)

# quantity → its class, and the unit in which a record gives it
OBSERVABLES = {kind.__struct_config__.tag: kind for kind in get_args(ObservableBlock)}
UNITS = {q: get_args(kind.__annotations__["unit"])[0] for q, kind in OBSERVABLES.items()}
# An amplitude is given in the unit of its gauge.
AMPLITUDES = tuple(dict.fromkeys(kind.unit for kind in KINDS.values()))


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
    trigger_sigma_us: NonNegative | Unknown = 0.0
    clock_rel_sigma: NonNegative = 0.0
    tolerances: TolerancesBlock = TolerancesBlock()
    model_floor_rel: NonNegative | None = None
    priors: dict[str, NonNegative | Present] = field(default_factory=dict)
    apparatus: ApparatusBlock | None = None
    runs: Annotated[list[RunBlock], Meta(min_length=1)]


def schema() -> dict[str, Any]:
    """JSON schema of `record.yaml`, for editors; made from the types that check it."""
    (whole,), parts = msgspec.json.schema_components([RecordBlock], ref_template="#/$defs/{name}")
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **whole, "$defs": parts}
