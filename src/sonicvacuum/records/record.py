"""One data set as the library sees it: the blocks of `record.yaml` with their traces, and the same in SI.

The blocks stay the truth, so that what is read is what is written; SI values are derived from them here.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from sonicvacuum.laboratory.blocks import material_of, specimen_of, striker_of
from sonicvacuum.laboratory.specimen import Specimen, Striker
from sonicvacuum.observe.run import Geometry
from sonicvacuum.observe.sensor import Sensor
from sonicvacuum.records.blocks import UNITS, RecordBlock, RunBlock
from sonicvacuum.records.signals import Signals

# SI value of one unit of an observable; units not listed are SI.
_SI = {"us": 1e-6}
# A count without an error is still rounded to a whole number.
COUNT_SIGMA = 1.0 / math.sqrt(12.0)


@dataclass(frozen=True)
class Gauge:
    """A gauge of the record.

    Attributes:
        id, kind, bead: as in `observe.Sensor`.
        sigma: white noise of one sample in N.
        gain_rel_sigma: relative standard error of its gain, one gain for all runs.
    """

    id: str
    kind: str
    bead: int | None
    sigma: float
    gain_rel_sigma: float

    @property
    def sensor(self) -> Sensor:
        """The gauge with ideal electronics and unit gain."""
        return Sensor(id=self.id, kind=self.kind, bead=self.bead)


@dataclass(frozen=True)
class Observable:
    """One measured scalar in SI units (m/s, N, s; ratios, counts and diameters as they are).

    Attributes:
        quantity: key of `observe.quantities.QUANTITIES`.
        value, sigma: with its standard error.
        options: what the quantity needs or takes: from, to, sensor, level, threshold, amplitude (N).
    """

    quantity: str
    value: float
    sigma: float
    options: Mapping[str, str | float]

    @property
    def label(self) -> str:
        """`speed g9-g5`, for tables and messages."""
        o = self.options
        where = "-".join(str(o[k]) for k in ("from", "to") if k in o)
        force = f"{o['amplitude']:g} N" if "amplitude" in o else ""
        return " ".join(p for p in (self.quantity, where, str(o.get("sensor", "")), force) if p)


@dataclass(frozen=True, eq=False)
class Run:
    """One impact.

    Attributes:
        id: its name.
        striker: what hit the chain.
        signals: traces, or None.
        observables: scalars.
    """

    id: str
    striker: Striker
    signals: Signals | None
    observables: tuple[Observable, ...]


@dataclass(frozen=True, eq=False)
class Record:
    """One data set.

    Attributes:
        block: `record.yaml`.
        signals: run id → traces, for the runs that have any.
        name: of its folder, "" where it was not read from one.
    """

    block: RecordBlock
    signals: Mapping[str, Signals] = field(default_factory=dict)
    name: str = ""

    @property
    def title(self) -> str:
        """One line."""
        return self.block.title

    @property
    def beads(self) -> int:
        """Number of beads; 0 is one ball on the wall."""
        return self.block.chain.beads

    @cached_property
    def specimen(self) -> Specimen:
        """The chain; LaboratoryError naming the key where its block does not describe one."""
        return specimen_of(self.block.chain, self.block.materials)

    @property
    def trigger_sigma_s(self) -> float:
        """Standard error in s of the time zero of each run."""
        return self.block.trigger_sigma_us / 1e6

    def modulus_rel_sigma(self, name: str) -> float:
        """Relative standard error of a material's modulus, 0 where the record gives none."""
        given = self.block.materials.get(name)
        return 0.0 if given is None else given.modulus_rel_sigma

    @cached_property
    def gauges(self) -> tuple[Gauge, ...]:
        """The gauges with their errors."""
        return tuple(Gauge(s.id, s.kind, s.bead, s.sigma_N, s.gain_rel_sigma) for s in self.block.sensors)

    @property
    def sensors(self) -> tuple[Sensor, ...]:
        """The gauges with ideal electronics."""
        return tuple(g.sensor for g in self.gauges)

    @property
    def geometry(self) -> Geometry:
        """Where the gauges sit."""
        return Geometry(self.beads, self.specimen.diameters, self.sensors)

    @cached_property
    def runs(self) -> tuple[Run, ...]:
        """The impacts, in the order of the file."""
        return tuple(
            Run(r.id, self._striker(r, k), self.signals.get(r.id), tuple(map(observable, r.observables)))
            for k, r in enumerate(self.block.runs)
        )

    def _striker(self, run: RunBlock, place: int) -> Striker:
        s, key = run.striker, f"runs[{place}].striker"
        # One ball on a wall: what touches is what the chain's bead says.
        surface = self.specimen.first.surface
        if self.beads:
            surface = material_of(s.material, self.block.materials, f"{key}.material")
        return striker_of(s, surface, self.specimen, key, s.speed_m_s, s.speed_rel_sigma)


def observable(block) -> Observable:
    """An observable's block in SI units."""
    quantity = block.__struct_config__.tag
    scale = _SI.get(UNITS[quantity], 1.0)
    names = {"from_": "from", "to": "to", "sensor": "sensor", "level": "level", "threshold": "threshold"}
    options = {name: getattr(block, f) for f, name in names.items() if hasattr(block, f)}
    if hasattr(block, "amplitude_N"):
        options["amplitude"] = block.amplitude_N
    sigma = block.sigma or (COUNT_SIGMA if quantity == "pulse_count" else 0.0)
    return Observable(quantity, block.value * scale, sigma * scale, options)
