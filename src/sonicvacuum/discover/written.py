"""What is written of a verdict: verdict.json, model.json, what it was made of, and the tables."""

import math
from pathlib import Path

import numpy as np

from sonicvacuum.blas import one_thread
from sonicvacuum.discover import draws, given, law, quantities, verdict
from sonicvacuum.discover.fit import heldout
from sonicvacuum.discover.judge import explanations, locate
from sonicvacuum.discover.judge.law import surface
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.session import Result

# Unit of the readings of a gauge whose calibration nobody knows.
UNCALIBRATED = "as recorded"


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
    verdict.write_json(result.model, folder / "model.json")
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
