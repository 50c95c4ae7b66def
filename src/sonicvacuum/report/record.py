"""The page of one record: where simulation and measurement disagree, what is missing, how sure that is.

Made from the folder that `sonicvacuum discover` wrote; the same section stands in the report of the pipeline.
"""

from pathlib import Path

from sonicvacuum.discover import draws, given, quantities
from sonicvacuum.discover.compare import check_source
from sonicvacuum.discover.judge.explanations import key
from sonicvacuum.discover.verdict import Model, Verdict
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.effects.whereabouts import materials_of
from sonicvacuum.files import read_json, reading, replacing
from sonicvacuum.report import bench, inline, misfit, next_run, origin, plots, rows, words
from sonicvacuum.report.phrases import plural
from sonicvacuum.report.sketch import sketch
from sonicvacuum.tables import read_csv

# Drawing → what it shows.
PICTURES = {
    "where": "Score of the residual of the nominal model by run, gauge and feature, in standard errors: "
    "violet where the data lie above the prediction, orange where they lie below.",
    "scalars": "Score of each measured quantity against the nominal (open) and the extended model (filled), "
    "in standard errors; band: two of them.",
    "candidates": "Probability of each single explanation.",
    "parameters": "Posterior of each parameter as sampled (steps; a smooth curve where it was followed as a "
    "profile), 90 % interval shaded, and the Gaussian of value and standard error (dashed; alone where no "
    "draws lie beside the verdict). On the right the range searched (grey), the value with its 90 % "
    "interval, and a cross where the effect is off, if the axis has that value.",
    "gap": "Misfit of the best model of each round, and of the adopted one where that is another; 1 is the "
    "noise.",
    "traces": "First and last run: measured, nominal and extended traces; below them running means of the "
    "residuals over their own standard error (band: two of them).",
    "law": "Free-form contact law: force between two beads besides the nominal one, with its standard error, "
    "where contacts have been. Positive rates: approaching.",
}
# What a page adds to the folder of discover.
PAGE = ("index.html", "parameters.csv", *(f"{name}.{kind}" for name in PICTURES for kind in ("svg", "png")))
# Those that stand on the page as drawn; the others' numbers do.
_SHOWN = ("parameters", "law", "traces")
_PAIRS = 6
# What the page needs of each table.
_COLUMNS = {
    "where": ("run", "sensor", "feature", "z_before", "q_before"),
    "candidates": ("effects", "delta_chi2", "log10_bayes", "probability", "parameters"),
    "gap": ("run", "data", "before", "after", "held_out_before", "held_out_after"),
    "limits": ("effect", "parameter", "limit_95", "estimate", "testable", "place"),
    "quantities": quantities.HEADER,
}


def write_page(folder, catalogue: Catalogue = CATALOGUE) -> Path:
    """Write `index.html` into a folder of discover; its path."""
    folder = Path(folder)
    found, traces = section(folder, catalogue), plots.plots(folder / "traces.csv")
    text = (
        inline.environment()
        .get_template("discovery.html.j2")
        .render(one=found, traces=traces, plot_style=plots.style(), plot_script=plots.script(traces))
    )
    path = folder / "index.html"
    with replacing(path) as stream:
        stream.write(text)
    return path


def section(folder, catalogue: Catalogue = CATALOGUE) -> dict:
    """All that the template of a record needs; the catalogue knows the effects of the verdict.

    Raises:
        InputError: where the folder does not hold what discover writes, or names an effect whose file is
            needed.
    """
    folder = Path(folder)
    verdict, model = read_json(folder / "verdict.json", Verdict), read_json(folder / "model.json", Model)
    for name in verdict.parameters:
        check_source(folder / "verdict.json", name, verdict.sources, catalogue)
    tables = {name: _rows(folder / f"{name}.csv") for name in ("where", "candidates", "gap", "limits")}
    inputs, records = given.read(folder) or (None, [])
    with reading(folder, "run sonicvacuum discover again"):
        told = _told(folder, verdict, model, tables, catalogue, records)
        return told | _origin(inputs, records, verdict, model)


def _origin(inputs, records, verdict, model):
    """What a verdict is on; little is known of one that was written before this was kept."""
    if not records:
        known = {"title": verdict.record, "ball": False, "gauges": True}
        return known | {"sketch": "", "origin": [], "strained": [], "notes": []}
    return {
        "title": _title(records),
        "ball": records[0].beads == 0,
        "gauges": bool(records[0].gauges),
        "sketch": sketch(records[0]),
        "origin": origin.rows(inputs, records),
        "strained": bench.strained(verdict, model, records[0]),
        "notes": [f"Run {n[4:]}" if n.startswith("run ") else n for n in inputs.notes],
    }


def _title(records):
    """What a page is on: titles of records that were searched together, of many the first and how many."""
    titles = list(dict.fromkeys(one.title for one in records))
    more = len(titles) - 1
    return "; ".join(titles) if more < 3 else f"{titles[0]} and {plural(more, 'further record')}"


def _told(folder, verdict, model, tables, catalogue, records):
    name, quantities_of = verdict.record, rows.quantities(_quantities(folder), records)
    gauges = [g.id for g in records[0].gauges] if records else []
    materials = materials_of(records[0].specimen) if records else ()
    drawn = draws.read(folder)
    candidates = [rows.candidate(r, gauges, catalogue, materials) for r in tables["candidates"]]
    data = sum(int(r["data"]) for r in tables["gap"] if r["run"] == "all")
    shrinking = (misfit.gap(verdict, len(model.speed_ratio), data), misfit.goodness(verdict))
    return {
        "name": name,
        "headline": words.headline(verdict, catalogue) + bench.moved_modulus(verdict, model),
        "slips": bench.slips(verdict, records),
        "corrected": bench.corrected(verdict),
        "where": misfit.where(verdict, tables["where"], quantities_of),
        "grid": rows.grid(tables["where"]),
        "quantities": quantities_of,
        "common": sorted({name for r in quantities_of for name in r["common"]}),
        "moved": any(r["nominal"] != r["extended"] for r in quantities_of),
        "effects": rows.effects(verdict, catalogue, drawn, gauges, materials),
        "drawn": words.drawn(drawn),
        "tests_nothing": verdict.sees_nothing,
        "odds": rows.odds(verdict, catalogue, tables["candidates"]),
        "nuisances": " ".join(
            filter(None, (bench.nuisances(model, verdict), bench.measured(verdict, records)))
        ),
        "present": rows.present(verdict, model, catalogue),
        "law": words.law(verdict, catalogue),
        "alternatives": words.alternatives(verdict, catalogue),
        "pairs": [r for r in candidates if "+" in r["effects"]][:_PAIRS],
        "tried": "Set tried" if any(r["effects"].count("+") > 1 for r in candidates) else "Pair tried",
        "unfitted": words.unfitted(verdict, {key(r["effects"].split("+")) for r in candidates}, catalogue)
        or ("" if any("+" in r["effects"] for r in candidates) else "No pair of effects was tried."),
        "singles": [r for r in candidates if "+" not in r["effects"]],
        "gap": " ".join(filter(None, shrinking)),
        "rounds": rows.rounds(tables["gap"], catalogue),
        "runs": [r for r in tables["gap"] if not r["run"].startswith("round ")],
        "held_out": verdict.gap.held_out is not None,
        "added": bool(words.effects_of(verdict)),
        "limits": [rows.limit(r, catalogue) for r in tables["limits"] if r["testable"] == "1"],
        "unexplained": "unknown" in verdict.named,
        "not_testable": [words.plain(n, catalogue) for n in verdict.not_testable if n not in verdict.named],
        "experiment": next_run.told(verdict, tables["where"], records, catalogue),
        "decided": words.decided(verdict),
        "simulations": verdict.simulations,
        "warnings": verdict.warnings or [],
        "pictures": _pictures(folder, name),
    }


def _quantities(folder):
    """Rows of the quantities measured without traces; none where there are only traces."""
    path = folder / quantities.FILE
    return _rows(path) if path.exists() else []


def _rows(path):
    """Rows of a table; InputError where it lacks a column."""
    return read_csv(path, "run sonicvacuum discover again", _COLUMNS[path.stem])


def _pictures(folder, name):
    """Drawing → SVG, caption and whether it is narrow; those that the folder holds."""
    found = {}
    for picture in _SHOWN:
        path, caption = folder / f"{picture}.svg", PICTURES[picture]
        if path.exists():
            svg = inline.svg(path, f"{name}-{picture}", caption)
            found[picture] = {"svg": svg, "caption": caption, "narrow": inline.is_narrow(path)}
    return found
