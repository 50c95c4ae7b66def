"""The table of a record of one ball: law, coefficient with its error, limits on the others, and how the model
fits."""

import numpy as np
from msgspec import Struct

from sonicvacuum.discover.verdict import Verdict
from sonicvacuum.effects import Catalogue
from sonicvacuum.export.bounce import Subject
from sonicvacuum.records import Record
from sonicvacuum.records.predict import Conditions, predict


class _Part(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Part of an export."""


class Coefficient(_Part, kw_only=True):
    """One parameter of the model; `sigma` is None where no verdict gives it."""

    effect: str
    parameter: str
    value: float
    sigma: float | None
    unit: str


class Limit(_Part, kw_only=True):
    """What the data allow of an effect that is not in the model, with 95 % confidence."""

    effect: str
    parameter: str
    limit: float
    unit: str


class Measured(_Part, kw_only=True):
    """One number of the record and the model's."""

    run: str
    speed_m_s: float
    quantity: str
    value: float
    sigma: float
    model: float | None
    unit: str


def coefficients(subject: Subject, verdict: Verdict | None, catalogue: Catalogue) -> list[Coefficient]:
    """The model's parameters that act on one ball."""
    rows = []
    for name, given in subject.effects.items():
        if name in subject.moot:
            continue
        one = catalogue.effect(name)
        told = verdict.parameters.get(name, {}) if verdict else {}
        for key, value in given.items():
            if key != one.sits:
                sigma = told[key].sigma if key in told else None
                unit = one.parameter(key).unit
                rows.append(
                    Coefficient(effect=name, parameter=key, value=float(value), sigma=sigma, unit=unit)
                )
    return rows


def limits(verdict: Verdict | None, catalogue: Catalogue) -> list[Limit]:
    """The verdict's upper limits; none without a verdict."""
    rows = []
    for name, given in (verdict.upper_limits if verdict else {}).items():
        if name in catalogue:
            one = catalogue.effect(name)
            rows += [
                Limit(effect=name, parameter=key, limit=value, unit=one.parameter(key).unit)
                for key, value in given.items()
                if key != one.sits
            ]
    return rows


def measured(record: Record, conditions: Conditions) -> list[Measured]:
    """Every restitution and contact time of a record, and what the model makes of it."""
    rows = []
    for run, predicted in zip(record.runs, predict(record, conditions), strict=True):
        for one, shown in zip(run.observables, predicted.observables, strict=True):
            scale, unit = (1e6, "us") if one.quantity == "contact_duration" else (1.0, "1")
            model = float(shown.value) * scale if np.isfinite(shown.value) else None
            number = {"value": one.value * scale, "sigma": one.sigma * scale, "model": model, "unit": unit}
            rows.append(
                Measured(run=run.id, speed_m_s=run.striker.speed_m_s, quantity=one.quantity, **number)
            )
    return rows
