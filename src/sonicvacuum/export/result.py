"""The whole export of one model: its table and its law for each simulator, as a structure and as text."""

import math

from msgspec import Struct

from sonicvacuum.export.base import MOTION, RESTITUTION, Simulator
from sonicvacuum.export.nearest import Match
from sonicvacuum.export.table import Coefficient, Limit, Measured

HAS = {MOTION: "the same law", RESTITUTION: "the same restitution", None: "the nearest law"}


class _Part(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Part of an export."""


class Reference(_Part, kw_only=True):
    """The impact at which nearest laws agree."""

    speed_m_s: float
    restitution: float
    contact_duration_us: float


class Parameter(_Part, kw_only=True):
    """One number of a simulator's input."""

    name: str
    value: float
    unit: str


class Agrees(_Part, kw_only=True):
    """Largest differences between speeds; `within_m_s` where the restitution agrees within `error`."""

    speeds_m_s: tuple[float, float]
    restitution: float
    contact_duration_rel: float
    within_m_s: tuple[float, float] | None = None
    error: float | None = None


class ForSimulator(_Part, kw_only=True):
    """What one simulator takes.

    Attributes:
        has: "the same law", "the same restitution", "the nearest law", or "no such law".
        effect: of the law written, with `fitted`, its parameters where it is not the model's own.
        reason: why there is no law.
    """

    simulator: str
    has: str
    title: str = ""
    equation: str = ""
    effect: str = ""
    fitted: dict[str, float] = {}
    parameters: list[Parameter] = []
    lines: list[str] = []
    notes: list[str] = []
    agreement: Agrees | None = None
    reason: str = ""
    reference: str
    read: str


class Export(_Part, kw_only=True):
    """One model of one ball, format 1; `moot`: effects that do not act on one ball, and why."""

    format: int = 1
    record: str
    effects: list[str]
    moot: dict[str, str]
    reference: Reference
    coefficients: list[Coefficient]
    limits: list[Limit]
    measured: list[Measured]
    simulators: list[ForSimulator]


def for_simulator(one: Simulator, found: Match | str, error: float) -> ForSimulator:
    """A match, or the reason why there is none, in the structure that is written."""
    told = {"simulator": one.title, "reference": one.reference, "read": one.read}
    if isinstance(found, str):
        return ForSimulator(has="no such law", reason=f"{found}; it lacks {one.lacks}", **told)
    a, near = found.agreement, found.same is None
    agrees = Agrees(
        speeds_m_s=(a.low, a.high),
        restitution=a.restitution,
        contact_duration_rel=a.duration_rel,
        within_m_s=(a.within_low, a.within_high) if near else None,
        error=error if near else None,
    )
    numbers = [Parameter(name=n.name, value=n.value, unit=n.unit) for n in found.written.numbers]
    return ForSimulator(
        has=HAS[found.same],
        title=found.law.title,
        equation=found.law.equation,
        effect=found.law.effect,
        fitted=found.parameters if near else {},
        parameters=numbers,
        lines=list(found.written.lines),
        notes=list(found.written.notes),
        agreement=agrees,
        **told,
    )


def text(export: Export) -> str:
    """The export as it is read."""
    law = " + ".join(e for e in export.effects if e not in export.moot) or "none: elastic Hertz contact"
    r = export.reference
    rows = [
        f"{export.record}: one ball on a wall, law: {law}",
        f"at {r.speed_m_s:.4g} m/s: restitution {r.restitution:.4f}, contact {r.contact_duration_us:.4g} us",
        *(f"{name} does not act on one ball: {why}" for name, why in export.moot.items()),
        "",
        *(_coefficient(c) for c in export.coefficients),
        *(f"  {x.effect} {x.parameter} < {x.limit:.4g}{_unit(x.unit)} (95 %)" for x in export.limits),
        *(_measured(m) for m in export.measured),
    ]
    for one in export.simulators:
        rows += ["", *_simulator(one)]
    return "\n".join(rows) + "\n"


def _coefficient(c):
    return f"  {c.effect} {c.parameter} = {_told(c.value, c.sigma)}{_unit(c.unit)}"


def _unit(unit):
    """A unit behind its number; none behind a pure one."""
    return "" if unit == "1" else f" {unit}"


def _told(value, sigma):
    """A value with its error to two digits, and no digits beyond that; five of one without."""
    if not sigma:
        return f"{value:.5g}"
    places = 1 - math.floor(math.log10(float(f"{sigma:.1e}")))
    if not 0 <= places < 7:
        return f"{value:.5g} +- {sigma:.2g}"
    return f"{value:.{places}f} +- {sigma:.{places}f}"


def _measured(m):
    model = "-" if m.model is None else f"{m.model:.4g}"
    number = f"{_told(m.value, m.sigma)}{_unit(m.unit)}, model {model}"
    return f"  {m.run}: {m.quantity} at {m.speed_m_s:.4g} m/s {number}"


def _simulator(one):
    """Rows of one simulator: everything but the input itself is a comment of it."""
    rows = [f"== {one.simulator}: {one.has} ({one.title})" if one.title else f"== {one.simulator}: {one.has}"]
    if one.reason:
        return [*rows, f"   {one.reason}"]
    a = one.agreement
    low, high = a.speeds_m_s
    agrees = (
        f"restitution within {a.restitution:.2g}, contact time within {100 * a.contact_duration_rel:.2g} %"
    )
    rows += [f"   {one.equation}", f"   {low:.3g} to {high:.3g} m/s: {agrees}"]
    if a.within_m_s:
        rows.append(
            f"   restitution within {a.error:g} from {a.within_m_s[0]:.3g} to {a.within_m_s[1]:.3g} m/s"
        )
    rows += [f"   {p.name} = {p.value:.9g}{_unit(p.unit)}" for p in one.parameters]
    rows += [f"   | {line}" for line in one.lines]
    return [*rows, *(f"   note: {n}" for n in one.notes), f"   reference: {one.reference}"]
