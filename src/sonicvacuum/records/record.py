"""One data set as the library sees it: the blocks of `record.yaml` with their traces, and the same in SI.

The blocks stay the truth, so that what is read is what is written; SI values are derived from them here.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import combinations, product
from typing import Any

import msgspec
import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.gauges import KINDS, Gauge
from sonicvacuum.laboratory.blocks import material_of, specimen_of, striker_of
from sonicvacuum.laboratory.specimen import Specimen, Striker
from sonicvacuum.materials import MODULUS_REL_SIGMA, modulus_rel_sigma
from sonicvacuum.observe.run import Geometry
from sonicvacuum.records.blocks import PRESENT, SCALED, UNITS, RecordBlock, RunBlock
from sonicvacuum.records.signals import Signals

# SI value of one unit of an observable; units not listed are SI.
_SI = {"us": 1e-6}
# Stand-in for an unknown time zero, as a share of the trace.
UNKNOWN_TRIGGER = 0.1
# A count without an error is still rounded to a whole number.
COUNT_SIGMA = 1.0 / math.sqrt(12.0)


@dataclass(frozen=True)
class Tolerances:
    """Relative standard errors of what all bodies, runs or gauges of a laboratory share.

    None where the record does not say: then what reads it has its own, stated default. 0: exact.
    """

    bead_mass_rel: float | None = None
    bead_diameter_rel: float | None = None
    coating_rel: float | None = None
    static_force_rel: float | None = None
    striker_mass_rel: float | None = None
    speed_common_rel: float | None = None
    gain_common_rel: float | None = None


@dataclass(frozen=True)
class Observable:
    """One measured scalar in SI units (m/s, N, s; ratios, counts and diameters as they are).

    Attributes:
        quantity: key of `observe.quantities.QUANTITIES`.
        value: what was measured; an amplitude in the unit of its gauge.
        sigma: its standard error.
        options: what the quantity needs or takes: from, to, sensor, level, threshold, amplitude (N).
        bound: `at_most` or `at_least`; None where the value is one.
        shared: source → relative standard error in common with others that name it.
    """

    quantity: str
    value: float
    sigma: float
    options: Mapping[str, str | float]
    bound: str | None = None
    shared: Mapping[str, float] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """`speed g9-g5`, `pulse_count wall at 0.08`, for tables and messages."""
        return label_of(self.quantity, self.options)

    @property
    def in_words(self) -> str:
        """The same without underscores: `pulse count wall at 0.08`."""
        return in_words(self.quantity, self.options)


def label_of(name: str, options: Mapping[str, object]) -> str:
    """The name of a quantity, with the gauges and the force or the level that it is read at."""
    where = "-".join(str(options[k]) for k in ("from", "to") if k in options)
    force = f"{options['amplitude']:g} N" if "amplitude" in options else ""
    level = next((f"at {options[k]:g}" for k in ("level", "threshold") if k in options), "")
    return " ".join(p for p in (name, where, str(options.get("sensor", "")), force, level) if p)


def in_words(quantity: str, options: Mapping[str, object]) -> str:
    """The same of a quantity's key, without underscores."""
    return label_of(quantity.replace("_", " "), options)


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
        digest: SHA-256 of the files read, one after the other (record.yaml, then the traces in the order of
            the runs), "" where it was not read from any.
        steps: gauge id → step of its recorder in the gauge's unit, of those whose steps outweigh the noise;
            what is done to traces hides it.
    """

    block: RecordBlock
    signals: Mapping[str, Signals] = field(default_factory=dict)
    name: str = ""
    digest: str = ""
    steps: Mapping[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        runs, gauges = len(self.block.runs), ", ".join(s.id for s in self.block.sensors)
        return (
            f"<Record {self.name}: {self.beads} beads, {runs} run{'s' * (runs > 1)}, {gauges or 'no gauges'}>"
        )

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
        """Standard error in s of the time zero of each run; infinite where it is not known at all."""
        given = self.block.trigger_sigma_us
        return math.inf if given == "unknown" else given / 1e6

    @property
    def trigger_width_s(self) -> float:
        """The same, but finite: an unknown time zero lies within a tenth of the longest traces or so."""
        if math.isfinite(self.trigger_sigma_s):
            return self.trigger_sigma_s
        spans = [s.interval_s * s.samples for s in self.signals.values()]
        return UNKNOWN_TRIGGER * max(spans, default=0.0)

    @property
    def clock_rel_sigma(self) -> float:
        """Relative standard error of the recorder's clock, one for all runs."""
        return self.block.clock_rel_sigma

    @property
    def tolerances(self) -> Tolerances:
        """Relative standard errors of what is shared."""
        return Tolerances(**msgspec.structs.asdict(self.block.tolerances))

    @property
    def model_floor_rel(self) -> float | None:
        """Smooth systematic misfit expected, as a share of the peak; None: to be inferred."""
        return self.block.model_floor_rel

    @property
    def priors(self) -> Mapping[str, float]:
        """Effect → odds against its usual prior; 0 excludes it. Those that are `present` have none."""
        return {name: odds for name, odds in self.block.priors.items() if odds != PRESENT}

    @property
    def present(self) -> tuple[str, ...]:
        """Effects that are known to act, and so are part of the nominal model."""
        return tuple(name for name, odds in self.block.priors.items() if odds == PRESENT)

    def modulus_rel_sigma(self, name: str) -> float | None:
        """Relative standard error of a material's modulus, 0: exact, None where the record gives none."""
        given = self.block.materials.get(name)
        return None if given is None else given.modulus_rel_sigma

    def taken_modulus_rel_sigma(self, name: str) -> float:
        """The same, or what it is taken for where the record gives none.

        Of the beads roundness and surface are in it too, so that no handbook narrows it.
        """
        stated = self.modulus_rel_sigma(name)
        if stated is not None:
            return stated
        beads = {bead.surface.name for bead in self.specimen.bodies.kinds}
        return MODULUS_REL_SIGMA if name in beads else modulus_rel_sigma(name)

    @cached_property
    def gauges(self) -> tuple[Gauge, ...]:
        """The gauges with their errors."""
        return tuple(_gauge(s) for s in self.block.sensors)

    @property
    def geometry(self) -> Geometry:
        """Where the gauges sit."""
        return Geometry(self.beads, self.specimen.diameters, self.gauges)

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


def _gauge(block) -> Gauge:
    """A sensor's block in SI units; what it does not say is 0."""
    suffix = KINDS[block.kind].suffix
    scaled = {key: getattr(block, f"{key}_{suffix}") or 0.0 for key in SCALED}
    gain = math.inf if block.gain_rel_sigma == "unknown" else block.gain_rel_sigma
    errors = {"gain_rel_sigma": gain, "delay_sigma_s": block.delay_sigma_us / 1e6}
    droop = math.inf if block.droop_us is None else block.droop_us / 1e6
    return Gauge(block.id, block.kind, block.bead, droop_s=droop, **errors, **scaled)


def observable(block) -> Observable:
    """An observable's block in SI units."""
    quantity = block.__struct_config__.tag
    scale = _SI.get(UNITS[quantity], 1.0)
    names = {"from_": "from", "to": "to", "sensor": "sensor", "level": "level", "threshold": "threshold"}
    options = {name: getattr(block, f) for f, name in names.items() if hasattr(block, f)}
    if hasattr(block, "amplitude_N"):
        options["amplitude"] = block.amplitude_N
    sigma = block.sigma or (COUNT_SIGMA if quantity == "pulse_count" else 0.0)
    return Observable(quantity, block.value * scale, sigma * scale, options, block.bound, dict(block.shared))


def check_records(given: Sequence[Any], place: str) -> None:
    """InputError for no record, for what is none (a folder's path above all), and for one and its copy."""
    if not given:
        raise InputError(f"{place}: is given no record; give at least one, as in {place}(read(folder))")
    for one in given:
        if not isinstance(one, Record):
            raise InputError(f"{place}: is given {_no_record(one, place)}")
    check_distinct(given, [one.name for one in given])


def _no_record(given, place):
    """What was given in place of a record, and the cure."""
    if isinstance(given, list | tuple) and any(isinstance(one, Record) for one in given):
        return f"a {type(given).__name__} of records; give the records themselves, as in {place}(*records)"
    return f"{given!r:.100} as a record; give what sv.read(folder) returns"


def check_distinct(records: Sequence[Record], names: Sequence[str]) -> None:
    """InputError where one of several records is another, be it under another name, or holds a run of it.

    Taken together their data would count twice, and every error come out too small.
    """
    for (one, name), (other, second) in combinations(zip(records, names, strict=True), 2):
        if one is other or (one.digest and one.digest == other.digest):
            raise InputError(
                f"{second}: holds the same data as {name}, which would count twice; give one of them"
            )
        for run, earlier in product(other.signals, one.signals):
            if _same(one.signals[earlier].readings, other.signals[run].readings):
                raise InputError(
                    f"{second}: run {run} holds the same samples as run {earlier} of {name}, which would "
                    "count twice; leave it out of one of them"
                )


def _same(one, other):
    """Whether two runs read the same in all gauges that both have, and anything at all."""
    common = [id for id in one if id in other]
    equal = all(np.array_equal(one[id], other[id]) for id in common)
    return equal and any(np.ptp(one[id]) > 0.0 for id in common)
