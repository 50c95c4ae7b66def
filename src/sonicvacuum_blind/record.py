"""A design with its data as a measured-data record (format 1), as a laboratory would write it down."""

import math

import msgspec
import numpy as np

from sonicvacuum.records import Record, Signals
from sonicvacuum.records.blocks import UNITS, RecordBlock
from sonicvacuum_blind.design import Design

_PER_SI = {"us": 1e6}


def as_record(design: Design, traces: np.ndarray, scalars: np.ndarray, title: str) -> Record:
    """The record.

    Args:
        design: what the laboratory knows.
        traces: (runs, gauges, samples) N.
        scalars: (scalars,) SI units.
        title: of the record; it must say nothing of what is hidden.
    """
    runs = [_run(design, k, scalars) for k in range(len(design.runs))]
    content = {
        "format": 1,
        "title": title,
        "source": {"note": "simulated data for a blind test"},
        "chain": _chain(design),
        "materials": _materials(design),
        "sensors": _sensors(design),
        "trigger_sigma_us": design.trigger_sigma * 1e6,
        "runs": runs,
    }
    block = msgspec.convert(content, RecordBlock)
    return Record(block, _signals(design, traces))


def _chain(design):
    plan = design.reference
    bead = {
        "diameter_mm": _clean(2e3 * plan.bead_radius),
        "mass_g": _clean(1e3 * plan.bead_mass),
        "material": plan.bead.name,
    }
    if design.coating is not None and plan.beads:
        bead |= {"coating_um": _clean(1e6 * design.coating), "core": plan.core.name}
    return {
        "beads": plan.beads,
        "orientation": "vertical" if plan.gravity else "horizontal",
        "bead": bead,
        "wall": {"material": plan.wall.name},
        "static_force_N": plan.static_force,
    }


def _materials(design):
    """Every constant in use, so that nothing rests on the table."""
    plan = design.reference
    block = {
        s.name: {"modulus_GPa": _clean(s.modulus / 1e9), "poisson": s.poisson}
        for s in (plan.bead, plan.striker, plan.wall, plan.core)
        if s is not None
    }
    block[plan.bead.name]["modulus_rel_sigma"] = design.modulus_sigma
    return block


def _sensors(design):
    return [
        {
            "id": g.id,
            "kind": g.kind,
            **({"bead": g.bead} if g.kind == "embedded" else {}),
            "sigma_N": sigma,
            "gain_rel_sigma": design.gain_sigma,
        }
        for g, sigma in zip(design.reference.gauges, design.sigma, strict=True)
    ]


def _run(design, place, scalars):
    plan = design.runs[place]
    flat = math.isinf(plan.striker_radius)
    striker = {
        "shape": "flat" if flat else "sphere",
        "material": plan.striker.name,
        "mass_g": _clean(1e3 * plan.striker_mass),
        "speed_m_s": plan.speed,
        "speed_rel_sigma": design.speed_sigma,
        **({} if flat else {"diameter_mm": _clean(2e3 * plan.striker_radius)}),
    }
    run = {"id": f"r{place + 1}", "striker": striker}
    if design.samples:
        run["signals"] = f"r{place + 1}.csv"
    own = [(s, v) for s, v in zip(design.scalars, scalars, strict=True) if s.run == place]
    return run | ({"observables": [_observable(s, v) for s, v in own]} if own else {})


def _observable(scalar, value):
    unit = UNITS[scalar.quantity]
    scale = _PER_SI.get(unit, 1.0)
    return {
        "quantity": scalar.quantity,
        **scalar.options,
        "value": float(value * scale),
        "sigma": _clean(scalar.sigma * scale),
        "unit": unit,
    }


def _signals(design, traces):
    if not design.samples:
        return {}
    time_us = np.round(design.times() * 1e6, 9)
    ids = [g.id for g in design.reference.gauges]
    return {f"r{k + 1}": Signals(time_us, dict(zip(ids, run, strict=True))) for k, run in enumerate(traces)}


def _clean(value):
    """Without the digits that a conversion of units leaves behind."""
    return float(f"{value:.12g}")
