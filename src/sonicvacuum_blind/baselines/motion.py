"""The full motion behind a record: its chain as it really was, integrated apart from the engine.

What the record says and what the truth adds make a `blind` plan for each run; the blind integrator then gives
displacement and velocity of every body at the record's times.
"""

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sonicvacuum.records import Record, Run
from sonicvacuum_blind import catalogue, foreign
from sonicvacuum_blind.integrate import integrate
from sonicvacuum_blind.plan import Gauge, Plan, Solid, problem


@dataclass(frozen=True)
class Motion:
    """One run without noise.

    Attributes:
        time: (samples,) s since the impact.
        compression: (samples, contacts) m, static part included, negative in an open contact.
        rate: (samples, contacts) m/s.
        velocity: (samples, bodies) m/s, the striker first.
        plan: the nominal plan of the run, as the record has it.
    """

    time: np.ndarray
    compression: np.ndarray
    rate: np.ndarray
    velocity: np.ndarray
    plan: Plan


def read_truth(path: Path) -> dict:
    """A truth.json."""
    return json.loads(Path(path).read_text(encoding="utf-8"))


def nominal(record: Record, run: Run) -> Plan:
    """The plan of a run as the record states it."""
    specimen, one = record.specimen, record.specimen.first
    bead, striker, wall = (
        Solid(m.name, m.modulus_Pa, m.poisson) for m in (one.surface, run.striker.surface, specimen.wall)
    )
    core = one.core and Solid(one.core.name, one.core.modulus_Pa, one.core.poisson)
    gauges = tuple(Gauge(g.id, g.kind, g.bead) for g in record.gauges)
    return Plan(
        beads=record.beads,
        bead=bead,
        striker=striker,
        wall=wall,
        bead_radius=0.5 * one.diameter_m,
        striker_radius=run.striker.radius_m,
        bead_mass=one.mass_kg,
        striker_mass=run.striker.mass_kg,
        speed=run.striker.speed_m_s,
        gravity=specimen.gravity_m_s2,
        static_force=specimen.static_force_N,
        core=core,
        gauges=gauges,
    )


def true_plan(record: Record, run: Run, truth: dict) -> Plan:
    """The plan of a run as it was: errors of speed and modulus as drawn, then all that is hidden."""
    plan, errors = nominal(record, run), truth["errors_sigma"]
    place = [r.id for r in record.runs].index(run.id)
    speed = 1.0 + run.striker.speed_rel_sigma * errors["speeds"][place]
    stiffness = 1.0 + (record.modulus_rel_sigma(plan.bead.name) or 0.0) * errors["modulus"]
    plan = replace(plan, speed=plan.speed * speed, modulus_ratio=stiffness)
    known = catalogue.BY_ID | foreign.BY_ID
    for one in truth["hidden"]:
        entry = known[one["id"]]
        plan = entry.put(plan, one.get(entry.places) if entry.places else None, **one["parameters"])
    return plan


def motion(record: Record, run: Run, truth: dict, tolerance: float = 1e-8) -> Motion:
    """The motion of a run at the times of its samples, which count from the impact here."""
    plan = true_plan(record, run, truth)
    setting = problem(plan)
    time = np.asarray(run.signals.time_us) * 1e-6
    found = integrate(setting, time - time[0], [], states=True, tolerance=tolerance)
    bodies = plan.beads + 1
    u, v = (np.pad(x[:, :bodies], ((0, 0), (0, 1))) for x in (found.displacement, found.velocity))
    compression = setting.rest[:bodies] - np.diff(u, axis=1)
    return Motion(time - time[0], compression, -np.diff(v, axis=1), v[:, :-1], nominal(record, run))


def noise_level(record: Record) -> float:
    """Noise of a gauge's sample over its largest reading, the median of gauges and runs."""
    shares = [
        g.sigma / float(np.max(np.abs(run.signals.readings[g.id])))
        for run in record.runs
        if run.signals is not None
        for g in record.gauges
        if g.id in run.signals.readings
    ]
    return float(np.median(shares)) if shares else math.nan
