"""One record from reading to files: verdict.json, model.json and the tables."""

import math
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from msgspec import UNSET

from sonicvacuum import plugins, stages
from sonicvacuum.blas import one_thread
from sonicvacuum.discover import (
    draws,
    given,
    hidden,
    law,
    next_experiment,
    posterior,
    quantities,
    unnamed,
    upper,
    verdict,
)
from sonicvacuum.discover.draws import Draws
from sonicvacuum.discover.faults import competition
from sonicvacuum.discover.fit import goodness, heldout
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import degenerate, explanations, locate, strained, whereabouts
from sonicvacuum.discover.judge.law import surface
from sonicvacuum.discover.model import window
from sonicvacuum.discover.model.abreast import processors
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.nuisances import assumed, exact
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.search.free_law import FreeLaw
from sonicvacuum.discover.verdict import Verdict
from sonicvacuum.effects import Catalogue
from sonicvacuum.physics import validity
from sonicvacuum.records import Record, check_records
from sonicvacuum.records.extent import check_extent
from sonicvacuum.records.suspects import copies

# Unit of the readings of a gauge whose calibration nobody knows.
UNCALIBRATED = "as recorded"


@dataclass(frozen=True)
class Result:
    """What `discover` found in one record, with all that tables and figures need.

    Attributes:
        record: the record put right; of several taken together the first.
        given: the records as they were given.
        notes: what was done to their traces before anything else.
        found: the search.
        places: disagreements of the nominal model with the data.
        after: those of the extended model.
        limits: of all effects that were not named.
        verdict: what is written.
        law: the free-form law, where one was needed.
        posterior: weighted draws of each parameter of what is named.
    """

    record: Record
    given: tuple[Record, ...]
    notes: tuple[str, ...]
    found: Investigation
    places: list[locate.Place]
    after: list[locate.Place]
    limits: list[degenerate.Limit]
    verdict: Verdict
    law: FreeLaw | None = None
    posterior: tuple[Draws, ...] = ()

    @property
    def extended(self) -> tuple[Forward, Fit]:
        """The extended model: what is named, and the free-form law where one was needed."""
        return (self.law.forward, self.law.fit) if self.law else (self.found.forward, self.found.final)


@one_thread
def discover(
    *records: Record, threads: int | None = None, catalogue: Catalogue | None = None, limits: bool = True
) -> Result:
    """What the nominal model of measured data lacks.

    Args:
        *records: one record, or records of one chain and its gauges, which get one verdict.
        threads: processors to use, by threads of the compiled engine and, on Linux, copies of this process
            that follow hypotheses side by side; all of them by default. The result does not depend on it.
        catalogue: the effects that may be missing, as of `sv.catalogue("my_law.py")`; by default the
            project's and those of installed packages.
        limits: refuse a search that asks for more memory than the machine has.

    Returns:
        `verdict` (named effects, probabilities, parameters, gap before and after, limits, next run) and all
        that tables and pictures need.

    Raises:
        InputError: for no record or processor, or records that cannot be simulated, do not belong together,
            or (`limits`) ask too much.
    """
    check_records(records, "discover")
    catalogue = plugins.catalogue() if catalogue is None else catalogue
    clock = Clock()
    ready, notes = zip(*(window.fitted(one, catalogue) for one in records), strict=True)
    for one in ready if limits else ():
        check_extent(one)
    outcome = competition.discover(ready, catalogue, processors(threads, "discover"))
    found, forward = outcome.found, outcome.found.forward
    clock.mark("search")
    stages.begin("places and limits")
    places = locate.locate(forward, found.null)
    found, free = unnamed.with_law(found)
    found, scores = hidden.told(found, upper.screened(found))
    clock.mark("free-form law")
    model, final = (free.forward, free.fit) if free else (forward, found.final)
    after = locate.locate(model, final) if final is not found.null else places
    clock.mark("locate")
    fits = [goodness.goodness(forward, found.null), goodness.goodness(model, final)]
    limits, untestable, wider = upper.limits(found, fits[1], scores)
    alike = degenerate.confusable(
        found.named, found.candidates, found.combinations, found.alike, found.probabilities
    )
    before = heldout.held_out(found.null, found.sizes)
    left = (
        heldout.HeldOut(free.held_out, found.sizes) if free else heldout.held_out(final, found.sizes, before)
    )
    told = law.told(free, found) if free else UNSET
    clock.mark("limits")
    named, counted, e = verdict.named_effects(found), found.counted or found, forward.experiment
    rivals, drawn = posterior.of_named(found)
    clock.mark("posterior")
    stages.begin("next experiment")
    proposal = next_experiment.propose(found, alike, rivals)
    clock.mark("next experiment")
    result = Verdict(
        record=found.forward.experiment.name,
        named=found.named,
        probabilities=found.probabilities,
        confusable=alike,
        parameters=verdict.parameters(counted.final, rivals, drawn, e.materials) if named else {},
        gap=verdict.gaps(found.null, final, found.sizes, before, left),
        where=verdict.where(places),
        upper_limits=verdict.upper_limits(limits),
        not_testable=untestable,
        next_experiment=proposal,
        reasons=[
            *found.reasons,
            *(whereabouts.doubts(rivals, counted.final, e) if named else ()),
            *_taken_as_stated(found, records),
            *(law.reasons(told) if free else ()),
            *verdict.corrections(outcome.findings),
        ],
        alarms=found.alarms,
        timing_s=clock.seconds(),
        law=told,
        simulations=forward.chains
        + (free.forward.chains if free else 0)
        + outcome.simulations
        + (found.counted.forward.chains if found.counted else 0),
        faults=verdict.faults(outcome.findings),
        fit=verdict.goodness_of_fit(*fits, found.smooth or forward.experiment.model_floor_rel or 0.0, wider),
        sources=verdict.sources(catalogue),
        warnings=_doubts(found, records[0]) or UNSET,
        nuisances=verdict.nuisances(counted.forward, counted.final, rivals),
    )
    said = tuple(line for lines in notes for line in lines)
    return Result(outcome.record, records, said, found, places, after, limits, result, free, tuple(drawn))


def _taken_as_stated(found: Investigation, records: tuple[Record, ...]) -> list[str]:
    """What was taken as exact, or as known so well, where something is named: a tolerance might explain it
    instead. And what the nominal model would have of the record otherwise than stated, and files read twice.
    """
    e, said = found.forward.experiment, []
    if found.named and e.record is not None:
        said = [exact(e.record, e.shared), assumed(e.record, [b.chain for b in e.batches])]
    final = found.final if verdict.named_effects(found) else None
    known = final is not None or not found.named
    moved = strained.lines(found.forward, found.null, final) if known else []
    return [*filter(None, said), *moved, *(line for one in records for line in copies(one))]


def _doubts(found: Investigation, record: Record) -> list[str]:
    """What in the motion of the final model leaves the range of its physics, see `physics.validity`."""
    forward, final = found.forward, found.final
    surfaces = [bead.surface for bead in record.specimen.bodies.kinds]
    yields = {surface.name: surface.yield_Pa for surface in surfaces}
    doubts = []
    for batch in forward.experiment.batches:
        nominal = forward.nominal(batch, final.nu[None])
        setup = final.hypothesis.change(final.u[None])(nominal, np.zeros(len(batch.runs), dtype=int))
        history = forward.simulate(batch, setup).history
        try:
            doubts += validity.warnings(setup.chain, history, yields)
        except validity.MeaninglessError as error:
            doubts.append(str(error))
    return list(dict.fromkeys(doubts))


class Clock:
    """Seconds by step."""

    def __init__(self):
        self._start = self._last = time.perf_counter()
        self._steps: dict[str, float] = {}

    def mark(self, step: str) -> None:
        """End a step."""
        now = time.perf_counter()
        self._steps[step], self._last = round(now - self._last, 3), now

    def seconds(self) -> dict[str, float]:
        """Seconds of each step and in total."""
        return {"total": round(time.perf_counter() - self._start, 3), **self._steps}


@one_thread
def write(result: Result, folder: Path) -> None:
    """Write verdict, model and tables; the verdict last, so that a folder that holds one is complete."""
    header = ["run", "sensor", "feature", "z_before", "p_before", "q_before", "size", "z_after"]
    left = locate.again(result.places, result.after)
    verdict.write_table(
        folder / "where.csv",
        header,
        (
            (p.run, p.sensor, p.feature, p.z, p.p, p.q, p.size, after)
            for p, after in zip(result.places, left, strict=True)
        ),
    )
    if any(run.scalars for run in result.found.forward.experiment.runs):
        told = quantities.rows((result.found.forward, result.found.null), result.extended)
        verdict.write_table(folder / quantities.FILE, quantities.HEADER, told)
    verdict.write_table(folder / "candidates.csv", *candidates(result))
    verdict.write_table(folder / "gap.csv", *gap_rows(result))
    verdict.write_table(
        folder / "limits.csv",
        ["effect", "parameter", "limit_95", "estimate", "testable", "place"],
        ((x.effect, x.parameter, x.value, x.estimate, int(x.testable), x.place) for x in result.limits),
    )
    verdict.write_table(folder / "traces.csv", *trace_rows(result))
    draws.write(folder, result.posterior)
    if result.law:
        verdict.write_table(folder / "law.csv", *law.rows(surface(result.law)))
    notes = (*result.notes, *result.found.forward.experiment.notes)
    verdict.write_json(given.inputs(result.given, notes), folder / given.FILE)
    verdict.write_json(verdict.model(result.found, result.law), folder / "model.json")
    verdict.write_json(result.verdict, folder / "verdict.json")


def candidates(result: Result):
    """Header and rows: singles, then combinations.

    `cosine` is that between the residual of the nominal model and the effect's signature (singles).
    """
    header = ["effects", "delta_chi2", "log10_bayes", "probability", "parameters", "flags", "cosine"]
    found, nan = result.found, math.nan
    best, size = found.scores.best(), math.sqrt(max(float(found.null.normal.chi2.sum()), 1e-300))
    rows = []
    for c in found.candidates:
        p = result.verdict.probabilities.get(c.effect, nan)
        cosine = abs(float(found.scores.z[best[c.effect]])) / size if c.effect in best else nan
        rows.append((c.effect, *_evidence(c), p, _values(c.fit), " ".join(c.flags), cosine))
    for c in found.combinations:
        p = result.verdict.probabilities.get(explanations.key(c.effects), nan)
        rows.append(("+".join(c.effects), *_evidence(c), p, _values(c.fit), "", nan))
    return header, rows


def _evidence(one):
    return one.gain, one.log_bayes / math.log(10.0)


def _values(fit):
    values = fit.hypothesis.values(fit.u)
    return "; ".join(
        f"{e} {n} {v:.6g}" for e, given in values.items() for n, v in given.items() if v is not None
    )


def gap_rows(result: Result):
    """Header and rows: χ² per datum of each run before and after, fitted and held out, and by round."""
    found = result.found
    before = heldout.held_out(found.null, found.sizes)
    _, final = result.extended
    after = heldout.held_out(final, found.sizes, before)
    if result.law:
        after = heldout.HeldOut(result.law.held_out, found.sizes)
    rows = []
    for k, run in enumerate(found.forward.experiment.runs):
        size = found.sizes[k]
        each = (found.null.normal.chi2[k, 0], final.normal.chi2[k, 0], before.chi2[k], after.chi2[k])
        rows.append((run.id, size, *(heldout.per_datum(chi2, size) for chi2 in each), 1.0))
    total = found.sizes.sum()
    fitted = (heldout.per_datum(one.normal.chi2.sum(), total) for one in (found.null, final))
    rows.append(("all", total, *fitted, before.mean, after.mean, 1.0))
    for k, (name, chi2) in enumerate(rounds_of(found)):
        after = heldout.per_datum(chi2, total)
        rows.append((f"round {k}: {name}", total, math.nan, after, math.nan, math.nan, 1.0))
    header = ["run", "data", "before", "after", "held_out_before", "held_out_after", "floor"]
    return header, rows


def rounds_of(found: Investigation) -> list[tuple[str, float]]:
    """Best model of each round and its χ²; at last that of the adopted effects where they are another."""
    models = [("nominal", found.null)]
    models += [(c.effect, c.fit) for c in found.candidates[:1]]
    models += [("+".join(c.effects), c.fit) for c in found.combinations[:1]]
    adopted = set(found.final.hypothesis.ids)
    if adopted and all(set(name.split("+")) != adopted for name, _ in models):
        models.append(("+".join(found.final.hypothesis.ids), found.final))
    return [(name, float(one.normal.chi2.sum())) for name, one in models]


def trace_rows(result: Result):
    """Header and rows: measured trace and both models for each run and gauge (empty without signals).

    Columns are in N; where a gauge reads something else, or nobody calibrated it, they have no unit in
    their names and each row has its own.
    """
    from sonicvacuum.discover.search.unknown import raw

    found = result.found
    e = found.forward.experiment
    header = ["run", "sensor", "time_us", "measured_N", "nominal_N", "extended_N", "sigma_N"]
    units = {g.id: g.unit if g.calibrated else UNCALIBRATED for g in e.gauges}
    mixed = any(unit != "N" for unit in units.values())
    if mixed:
        header = [name.removesuffix("_N") for name in header] + ["unit"]

    def unit(gauge):
        return (units[gauge.id],) if mixed else ()

    if not any(r.has_signals for r in e.runs):
        return header, []
    before = raw(found.forward, found.null)
    after = raw(*result.extended) if result.extended[1] is not found.null else before
    rows = []
    for k, run in enumerate(e.runs):
        step = max(1, len(run.time) // 1000)
        for s, gauge in enumerate(e.gauges):
            counts = slice(None) if run.present is None else run.present[s]
            columns = (run.time * 1e6, run.readings[s], before[k][s], after[k][s])
            table = np.column_stack([c[counts][::step] for c in columns])
            sigma = float(e.sigma[s])
            # Python's own numbers, which are formatted in half the time that numpy's take.
            rows.extend((run.id, gauge.id, *row, sigma, *unit(gauge)) for row in table.tolist())
    return header, rows
