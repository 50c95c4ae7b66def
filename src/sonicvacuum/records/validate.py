"""What a record's keys must satisfy beyond their types: names that exist, ranges, what goes with what."""

from collections.abc import Iterable

from sonicvacuum.gauges import KINDS
from sonicvacuum.gauges.base import misplaced
from sonicvacuum.laboratory import checks, ranges
from sonicvacuum.laboratory.blocks import material_of, specimen_of, striker_of
from sonicvacuum.laboratory.ranges import LaboratoryError
from sonicvacuum.observe.contacts import BALL_QUANTITIES
from sonicvacuum.physics.scales import impact_scales
from sonicvacuum.records.assemble import assemble
from sonicvacuum.records.blocks import (
    PRESENT,
    SCALED,
    SUFFIXES,
    AmplitudeBlock,
    DecayBlock,
    RecordBlock,
    SpeedAtAmplitudeBlock,
)
from sonicvacuum.records.record import Record

_RANGE_OF = {
    "speed": ranges.WAVE_SPEED,
    "speed_at_amplitude": ranges.WAVE_SPEED,
    "width": ranges.WIDTH,
    "pulse_count": ranges.COUNT,
    "decay": ranges.RATIO,
    "echo_ratio": ranges.RATIO,
    "restitution": ranges.RESTITUTION,
}


def validate(block: RecordBlock) -> None:
    """Check a converted block.

    Raises:
        LaboratoryError: it names the key, its value and the cure.
    """
    specimen = _check_chain(block)
    _check_materials(block)
    _check_sensors(block)
    _check_shared(block)
    _check_apparatus(block)
    _check_unique("runs", [r.id for r in block.runs])
    for k, run in enumerate(block.runs):
        _check_run(block, specimen, run, f"runs[{k}]")
    _check_scalars(Record(block))


def _check_chain(block):
    checks.check_chain(block.chain)
    return specimen_of(block.chain, block.materials)


def _check_materials(block):
    for k, run in enumerate(block.runs):
        material_of(run.striker.material, block.materials, f"runs[{k}].striker.material")
    checks.check_materials(block.materials)
    for name, given in block.materials.items():
        ranges.RELATIVE.check(f"materials.{name}.modulus_rel_sigma", given.modulus_rel_sigma or 0.0)


def _check_sensors(block):
    beads = block.chain.beads
    if beads == 0 and block.sensors:
        raise LaboratoryError("sensors", "one ball on a wall (beads: 0) has no gauges; write sensors: []")
    _check_unique("sensors", [s.id for s in block.sensors])
    for k, s in enumerate(block.sensors):
        key = f"sensors[{k}]"
        checks.check_sensor(key, s)
        if s.kind not in KINDS:
            raise LaboratoryError(f"{key}.kind", f"is {s.kind!r}; write {' or '.join(KINDS)}")
        if problem := misplaced(s.kind, s.bead, beads):
            raise LaboratoryError(f"{key}.bead", problem)
        if s.gain_rel_sigma != "unknown":
            ranges.RELATIVE.check(f"{key}.gain_rel_sigma", s.gain_rel_sigma)
        ranges.TRIGGER.check(f"{key}.delay_sigma_us", s.delay_sigma_us)
        _check_units(s, key)


def _check_units(sensor, key):
    """Noise, baseline and drift are given in the unit of the sensor's kind."""
    own = KINDS[sensor.kind].suffix
    for suffix in SUFFIXES:
        for name in SCALED:
            if suffix != own and getattr(sensor, f"{name}_{suffix}") is not None:
                raise LaboratoryError(
                    f"{key}.{name}_{suffix}",
                    f"a sensor of kind {sensor.kind} reads {KINDS[sensor.kind].unit}: give {name}_{own}",
                )
    for name in SCALED:
        if size := getattr(sensor, f"{name}_{own}"):
            ranges.error_range(KINDS[sensor.kind].unit).check(f"{key}.{name}_{own}", size)


def _check_shared(block):
    """What concerns the laboratory as a whole."""
    if block.trigger_sigma_us != "unknown":
        ranges.TRIGGER.check("trigger_sigma_us", block.trigger_sigma_us)
    ranges.CLOCK.check("clock_rel_sigma", block.clock_rel_sigma)
    for name in block.tolerances.__struct_fields__:
        if (value := getattr(block.tolerances, name)) is not None:
            ranges.TOLERANCE.check(f"tolerances.{name}", value)
    if block.model_floor_rel is not None:
        ranges.TOLERANCE.check("model_floor_rel", block.model_floor_rel)
    for name, odds in block.priors.items():
        if odds != PRESENT:
            ranges.ODDS.check(f"priors.{name}", odds)


def _check_apparatus(block):
    """What the laboratory says it could do is something that this chain can have done to it."""
    given = block.apparatus
    if given is None:
        return
    checks.check_speeds("apparatus.speed_m_s", *(given.speed_m_s or ()))
    if given.speed_m_s and given.speed_m_s[0] > given.speed_m_s[1]:
        slow, fast = given.speed_m_s
        raise LaboratoryError("apparatus.speed_m_s", f"is [{slow:g}, {fast:g}]; give the slowest first")
    for mass in given.striker_mass_g:
        ranges.MASS.check("apparatus.striker_mass_g", mass)
    for force in given.static_force_N:
        ranges.STATIC_FORCE.check("apparatus.static_force_N", force)
    for bead in given.gauge_beads:
        if bead > block.chain.beads:
            raise LaboratoryError(
                "apparatus.gauge_beads", f"{bead}: no such bead; the chain has {block.chain.beads} beads"
            )


def _check_unique(key, ids: Iterable[str]):
    ids = list(ids)
    for k, name in enumerate(ids):
        if name in ids[:k]:
            raise LaboratoryError(
                f"{key}[{k}].id", f"is {name!r}, as {key}[{ids.index(name)}].id is; names must differ"
            )


def _check_run(block, specimen, run, key):
    if run.signals is None and not run.observables:
        raise LaboratoryError(
            key, f"run {run.id!r} has neither signals nor observables; give one or remove the run"
        )
    _check_striker(specimen, block.chain, run.striker, f"{key}.striker")
    if run.signals is not None:
        _check_traced(block, run, key)
    for j, observable in enumerate(run.observables):
        _check_observable(block, observable, f"{key}.observables[{j}]")


def _check_striker(specimen, chain, striker, key):
    striker_of(striker, specimen.first.surface, specimen, key, striker.speed_m_s)
    if specimen.beads == 0 and striker.shape != "sphere":
        raise LaboratoryError(
            f"{key}.shape", f"is {striker.shape!r}; with beads: 0 the striker is the ball: sphere"
        )
    checks.check_striker(key, striker, checks.lightest_g(chain))
    checks.check_speeds(f"{key}.speed_m_s", striker.speed_m_s)
    ranges.RELATIVE.check(f"{key}.speed_rel_sigma", striker.speed_rel_sigma)


def _check_traced(block, run, key):
    if not block.sensors:
        raise LaboratoryError(f"{key}.signals", "is given, but the record has no sensors; describe them")
    if run.signals.lower() == "record.yaml":
        raise LaboratoryError(f"{key}.signals", "is record.yaml itself; name the CSV file with the traces")
    for k, s in enumerate(block.sensors):
        noise = KINDS[s.kind].noise_key
        if getattr(s, noise) == 0.0:
            raise LaboratoryError(
                f"sensors[{k}].{noise}",
                f"is 0, while run {run.id!r} has signals; give the standard deviation of one sample's noise "
                "(of a quantised signal at least its step over √12), or leave the key out: it is then "
                "estimated from the samples before the pulse",
            )


def _check_observable(block, observable, key):
    quantity = observable.__struct_config__.tag
    if block.chain.beads == 0 and quantity not in BALL_QUANTITIES:
        raise LaboratoryError(
            f"{key}.quantity",
            f"is {quantity!r}; one ball on a wall (beads: 0) gives {' or '.join(BALL_QUANTITIES)}",
        )
    if quantity == "contact_duration" and block.chain.beads > 0:
        raise LaboratoryError(f"{key}.quantity", "is 'contact_duration'; it is defined for beads: 0 only")
    ids = [s.id for s in block.sensors]
    for name in ("from_", "to", "sensor"):
        sensor = getattr(observable, name, None)
        if sensor is not None and sensor not in ids:
            raise LaboratoryError(
                f"{key}.{name.strip('_')}", f"is {sensor!r}; the sensors are {', '.join(ids) or 'none'}"
            )
    _check_pair(block, observable, key)
    _check_unit_of(block, observable, key)
    for source, size in observable.shared.items():
        ranges.TOLERANCE.check(f"{key}.shared.{source}", size)
    if observable.shared and quantity == "pulse_count":
        raise LaboratoryError(f"{key}.shared", "a count has no relative error; leave the key out")
    if observable.sigma == 0.0 and quantity != "pulse_count":
        raise LaboratoryError(f"{key}.sigma", "is 0; give the standard error of the value")
    if observable.sigma:
        ranges.error_range(observable.unit).check(f"{key}.sigma", observable.sigma)
    if isinstance(observable, SpeedAtAmplitudeBlock):
        ranges.AMPLITUDE.check(f"{key}.amplitude_N", observable.amplitude_N)


def _check_pair(block, observable, key):
    if not hasattr(observable, "to"):
        return
    place = {s.id: s.bead or block.chain.beads + 1 for s in block.sensors}
    units = {s.id: KINDS[s.kind].unit for s in block.sensors}
    if isinstance(observable, DecayBlock) and units[observable.from_] != units[observable.to]:
        raise LaboratoryError(
            f"{key}.to",
            f"is {observable.to!r}, which reads {units[observable.to]}, while {observable.from_!r} reads "
            f"{units[observable.from_]}; name two sensors of one unit",
        )
    if place[observable.from_] == place[observable.to]:
        raise LaboratoryError(
            f"{key}.to", f"is {observable.to!r}, at the same place as {observable.from_!r}; name two places"
        )


def _check_unit_of(block, observable, key):
    """Amplitudes are given in the unit of their gauge; amplitude_N asks for a force gauge."""
    if not isinstance(observable, AmplitudeBlock | SpeedAtAmplitudeBlock):
        return
    unit = next(KINDS[s.kind].unit for s in block.sensors if s.id == observable.sensor)
    if isinstance(observable, SpeedAtAmplitudeBlock):
        if unit != "N":
            raise LaboratoryError(f"{key}.sensor", f"is {observable.sensor!r}, which reads {unit}, not N")
    elif observable.unit != unit:
        raise LaboratoryError(
            f"{key}.unit", f"is {observable.unit!r}; sensor {observable.sensor!r} reads {unit}"
        )


def _check_scalars(record):
    """Values of observables: fixed ranges, and for forces and times the scales of the run's impact."""
    for batch in assemble(record):
        for lane, k in enumerate(batch.runs):
            force, contact = impact_scales(batch.chain.take([lane]))
            for j, entry in enumerate(record.block.runs[k].observables):
                _range(entry, force, contact).check(f"runs[{k}].observables[{j}].value", entry.value)


def _range(entry, force, contact):
    quantity = entry.__struct_config__.tag
    if quantity == "amplitude" and entry.unit != "N":
        return ranges.Range(entry.unit, 0.0, 1e9, {})
    if quantity == "amplitude":
        return ranges.force_range(force)
    if quantity in ("duration", "contact_duration", "echo_delay"):
        low, high = (f * contact * 1e6 for f in ranges.DURATION)
        return ranges.Range("us", low, high, {"s": 1e-6, "ms": 1e-3, "ns": 1e3})
    return _RANGE_OF[quantity]
