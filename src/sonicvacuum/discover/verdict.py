"""What is written: the verdict and the extended model (closed schemas), and the tables behind the pictures.

`verdict.json` and `model.json` are JSON with the keys of `Verdict` and `Model`; numbers that do not exist
are null.
"""

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

import msgspec
import numpy as np
from msgspec import UNSET, Struct, UnsetType, field

from sonicvacuum.discover.draws import PROFILE, SAMPLED, VALLEY, Draws
from sonicvacuum.discover.faults.found import Finding
from sonicvacuum.discover.faults.table import told
from sonicvacuum.discover.fit.goodness import Goodness
from sonicvacuum.discover.fit.heldout import HeldOut, per_datum
from sonicvacuum.discover.fit.places import ALONG
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import rivals
from sonicvacuum.discover.judge.degenerate import Limit
from sonicvacuum.discover.judge.explanations import key
from sonicvacuum.discover.judge.locate import Place
from sonicvacuum.discover.judge.rivals import Rival
from sonicvacuum.discover.law import Law
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.nuisances import SCATTER
from sonicvacuum.discover.parts import (
    CellFit,
    Fault,
    Gap,
    Gaps,
    GoodnessOfFit,
    Known,
    Next,
    Part,
    Source,
    Sources,
    Value,
    Where,
)
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.search.free_law import FreeLaw
from sonicvacuum.effects import Catalogue
from sonicvacuum.files import replacing
from sonicvacuum.tables import write_csv

# How the line begins that says which slips were put right.
PUT_RIGHT = "all else is of the record put right"
# The posterior's own width is told from so many times the standard error of its Gaussian on, where draws are
# worth so many equal ones: they scatter.
BENT, MANY = 1.5, 50


class Verdict(Part, kw_only=True):
    """The verdict on one record, format 1.

    Attributes:
        record: name of the record.
        named: ids of the effects, `unknown` last where a misfit is left that nothing of the catalogue
            explains.
        probabilities: over explanations: none, unknown, an id, or several joined by ` + ` in alphabetical
            order, `unknown` last where a misfit is left beside them.
        confusable: sets of effects between which this data do not decide, the named one first.
        parameters: effect → parameter → value.
        gap: before and after.
        where: the largest significant disagreements of the nominal model, largest first, 40 at most;
            where.csv has all comparisons.
        upper_limits: effect → parameter → 95 % limit; effects that cannot be tested here are left out.
        not_testable: effects whose limit lies beyond the bounds of the search.
        next_experiment: null where nothing is left to separate.
        reasons: what decided.
        alarms: p-value of what each step leaves.
        timing_s: seconds by step.
        simulations: chains simulated.
        warnings: what in the final model leaves the range of its physics; left out where nothing does.
        sources: id → source of the effects of the user's own that were searched; absent without any.
        fit: goodness of fit; None in verdicts written before it was tested.
        nuisances: what the record leaves open besides speeds, time zeros, the beads' modulus and stated gains
            → what is found of it in the extended model; absent without any.
        faults: slips of the laboratory, most probable first; where one is put right, all else is of the
            record put right, and `reasons` says so.
        law: the free-form contact law, which `model.json` holds as well; absent where none was needed.
    """

    format: int = 1
    record: str
    named: list[str]
    probabilities: dict[str, float]
    confusable: list[list[str]]
    parameters: dict[str, dict[str, Value]]
    gap: Gaps
    where: list[Where]
    upper_limits: dict[str, dict[str, float]]
    not_testable: list[str]
    next_experiment: Next | None
    reasons: list[str]
    alarms: dict[str, float]
    timing_s: dict[str, float]
    simulations: int
    sources: Sources = UNSET
    warnings: list[str] | UnsetType = UNSET
    fit: GoodnessOfFit | None = None
    nuisances: dict[str, Known] | UnsetType = UNSET
    faults: list[Fault] = field(default_factory=list)
    law: Law | UnsetType = UNSET

    @property
    def probability(self) -> float | None:
        """Probability of what is named; None in verdicts on sets written before those had one."""
        return self.probabilities.get(key(self.named))

    @property
    def sees_nothing(self) -> bool:
        """Whether no effect of the catalogue would show in these data."""
        return not (self.named or self.upper_limits) and bool(self.not_testable)


class Model(Part, kw_only=True):
    """The extended model: effects with their parameters (places included) and the record's nuisances as
    fitted.

    Attributes:
        effects: effect → parameter → value, in order; materials by their names.
        speed_ratio: run → striker speed over the recorded one.
        trigger_us: run → trigger shift.
        gain: gauge → gain over the stated one.
        modulus_ratio: bead material's modulus over the recorded one, as far as its stated error goes.
        sources: id → source of those effects that are the user's own; absent without any.
    """

    format: int = 1
    record: str
    effects: dict[str, dict[str, float | str]]
    speed_ratio: dict[str, float]
    trigger_us: dict[str, float]
    gain: dict[str, float]
    modulus_ratio: float
    sources: Sources = UNSET


def faults(findings: Iterable[Finding]) -> list[Fault]:
    """Slips as they are written."""
    return [
        Fault(
            fault=told(f.fault),
            run=f.run,
            sensor=list(f.sensor) if isinstance(f.sensor, tuple) else f.sensor,
            probability=float(f.probability),
            value=None if f.value is None else float(f.value),
            quantity=f.quantity or UNSET,
        )
        for f in sorted(findings, key=lambda f: -f.probability)
    ]


def corrections(findings: Iterable[Finding]) -> list[str]:
    """What is said of a record that was put right, one line; nothing of one that was not."""
    right = dict.fromkeys(told(f.fault) for f in findings if f.corrected)
    return [f"{PUT_RIGHT}: {', '.join(right)}"] if right else []


def sources(catalogue: Catalogue, ids=None) -> Sources:
    """Sources of the effects of the user's own, of all of them or of those with some ids."""
    own = {e.id: e.source for e in catalogue if e.source and (ids is None or e.id in ids)}
    return {id: Source(name=s.name, sha256=s.sha256) for id, s in own.items()} or UNSET


def parameters(
    fit: Fit, found: Sequence[Rival] = (), drawn: Sequence[Draws] = (), materials: Sequence[str] = ()
) -> dict[str, dict[str, Value]]:
    """Values and standard errors of the free parameters, with what rivals that have them make of them; of
    beads and contacts the distance of where else the effect may sit, root mean square; 0 of gauges and
    `materials`, the beads' in their order.

    Where the posterior is much wider than the Gaussian of the fit, as along a valley that bends, by many
    draws or by what is told in their place, its width is the error.
    """
    many = (d for d in drawn if d.how in (VALLEY, PROFILE) or (d.how == SAMPLED and d.effective > MANY))
    wide = {(d.effect, d.parameter): d.error for d in many}
    off = [share @ np.square(shift) for share, shift in rivals.shifts(fit, found)]
    result, first, sigma = {}, 0, np.sqrt(np.square(fit.sigma) + off)
    for component in fit.hypothesis.components:
        values = {}
        for k, c in enumerate(component.free):
            u, name = fit.u[first + k], c.parameter.name
            error, width = c.slope(u) * sigma[first + k], wide.get((component.effect.id, name), 0.0)
            told = error if width <= BENT * error else width
            values[name] = Value(value=float(c.value(u)), sigma=_finite(told))
        if component.effect.places:
            values[component.effect.places] = _place(component, drawn, materials)
        first += len(component.free)
        result[component.effect.id] = values
    return result


def _place(component, drawn, materials):
    """The place of an effect, and how far off it may be; of a material its name."""
    one, along = component.effect, component.effect.places in ALONG
    wide = [d for d in drawn if (d.effect, d.parameter) == (one.id, one.places)] if along else []
    off = [float(d.weight @ np.square(d.value - component.place)) for d in wide]
    named = materials and one.places == "material"
    name = materials[component.place] if named else UNSET
    return Value(value=float(component.place), sigma=math.sqrt(sum(off)), name=name)


def nuisances(forward: Forward, fit: Fit, found: Sequence[Rival] = ()) -> dict[str, Known] | UnsetType:
    """What a fit says of uncalibrated gains and of what else the runs share, with what rivals make of it."""
    layout, e = forward.layout, forward.experiment
    value = fit.nu * forward.nuisance_sigma
    square = np.diag(fit.covariance)[len(fit.u) :] + rivals.nuisances(fit, found)
    error = np.sqrt(square) * forward.nuisance_sigma
    known = {}
    for gauge, at in zip(e.gauges, layout.gains, strict=True):
        if not gauge.calibrated:
            ratio = float(gauge.gain * np.exp(value[at]))
            known[f"gain {gauge.id}"] = Known(value=ratio, sigma=float(error[at]), prior=None)
    for at, one in enumerate(layout.others, start=layout.modulus + 1):
        if one.kind == SCATTER:
            continue  # of many beads at once, which nobody could weigh
        scale = 1e6 if one.kind == "delay" else 1.0
        here = value[at] * scale if one.kind in ("delay", "clock", "shared") else np.exp(value[at])
        name = f"{one.kind} {one.of}".strip()
        known[name] = Known(value=float(here), sigma=float(error[at]) * scale, prior=one.sigma * scale)
    return known or UNSET


def gap(before: float, after: float) -> Gap:
    """A gap over the noise floor, 1."""
    closed = 1.0 - (after - 1.0) / (before - 1.0) if abs(before - 1.0) > 1e-12 else None
    return Gap(before=before, after=after, floor=1.0, closed=closed)


def gaps(null: Fit, final: Fit, sizes: np.ndarray, before: HeldOut, after: HeldOut) -> Gaps:
    """Fitted and held-out gaps."""
    total = sizes.sum()
    fitted = gap(*(per_datum(one.normal.chi2.sum(), total) for one in (null, final)))
    return Gaps(fitted=fitted, held_out=gap(before.mean, after.mean) if len(sizes) > 1 else None)


def model(found: Investigation, law: FreeLaw | None = None) -> Model:
    """The extended model of an investigation; the nominal one where nothing, or nothing known, was named.

    A free-form law is one more effect of it.
    """
    forward, fit = found.forward, found.final if named_effects(found) else found.null
    fit = law.fit if law else fit
    e, layout = forward.experiment, forward.layout
    effects = present(forward, fit) | fit.hypothesis.values(fit.u)
    effects |= {law.component.effect.id: law.parameters} if law else {}
    sits = [c for c in fit.hypothesis.components if c.effect.places == "material"]
    named = {c.effect.id: {c.effect.places: e.materials[c.place]} for c in sits}
    shift = fit.nu[: layout.size] * forward.nuisance_sigma
    return Model(
        record=e.name,
        effects={k: {n: float(v) for n, v in p.items()} | named.get(k, {}) for k, p in effects.items()},
        speed_ratio={r.id: float(np.exp(shift[layout.speed(k)])) for k, r in enumerate(e.runs)},
        trigger_us={r.id: float((r.shift + shift[layout.trigger(k)]) * 1e6) for k, r in enumerate(e.runs)},
        gain={g.id: float(g.gain * np.exp(shift[at])) for g, at in zip(e.gauges, layout.gains, strict=True)},
        modulus_ratio=float(np.exp(shift[layout.modulus])),
        sources=sources(e.catalogue, fit.hypothesis.ids),
    )


def present(forward: Forward, fit: Fit) -> dict[str, dict[str, float]]:
    """Effects that the record says act, with their values as fitted: a coating that is open in its thickness
    is the only one that has such.
    """
    e, layout = forward.experiment, forward.layout
    ratio = math.exp(sum(fit.nu[at] * forward.nuisance_sigma[at] for at in layout.other("coating")))
    return {name: {key: x * ratio for key, x in given.items()} for name, given in e.present.items()}


def named_effects(found: Investigation) -> list[str]:
    """What was named, without `unknown`."""
    return [n for n in found.named if n != "unknown"]


def goodness_of_fit(nominal: Goodness, extended: Goodness, smooth_rel: float, wider: float) -> GoodnessOfFit:
    """Goodness of fit of both models, by run and gauge."""
    before, after = (
        [CellFit(run=c.run, sensor=c.sensor, chi2=c.chi2, p=c.p, whiteness=c.whiteness) for c in one.cells]
        for one in (nominal, extended)
    )
    return GoodnessOfFit(nominal=before, extended=after, p=extended.tests, smooth_rel=smooth_rel, wider=wider)


def where(places: list[Place], most: int = 40) -> list[Where]:
    """The significant cells, largest first; of more than `most` those that are the largest of their run and
    gauge, and of the rest the largest.
    """
    cells = sorted((p for p in places if p.found), key=lambda p: -abs(p.z))
    first = {(c.run, c.sensor or c.feature): c for c in reversed(cells)}.values()
    chosen = sorted(cells, key=lambda c: not any(c is one for one in first))[:most]
    cells = sorted(chosen, key=lambda c: -abs(c.z))
    return [Where(run=c.run, sensor=c.sensor, feature=c.feature, z=c.z, p=c.p) for c in cells]


def upper_limits(limits: list[Limit]) -> dict[str, dict[str, float]]:
    """Effect → parameter → limit, of those that can be tested."""
    result: dict[str, dict[str, float]] = {}
    for one in limits:
        if one.testable:
            result.setdefault(one.effect, {})[one.parameter] = one.value
    return result


def write_json(content: Struct, path: Path) -> None:
    """JSON with keys in the order of the schema."""
    with replacing(path, "wb") as stream:
        stream.write(msgspec.json.format(msgspec.json.encode(content), indent=1) + b"\n")


def write_table(path: Path, header: list[str], rows) -> None:
    """CSV of a header and rows; numbers to seven digits, empty where there is none."""
    write_csv(path, header, ([_cell(v) for v in row] for row in rows))


def _cell(value):
    if isinstance(value, (float, np.floating)):
        return "" if math.isnan(value) else f"{value:.7g}"
    return "" if value is None else value


def _finite(value):
    return float(value) if np.isfinite(value) else 0.0
