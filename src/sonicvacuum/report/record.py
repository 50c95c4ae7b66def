"""The page of one record: where simulation and measurement disagree, what is missing, how sure that is.

Made from the folder that `sonicvacuum discover` wrote; the same section stands in the report of the pipeline.
"""

import csv
import math
from pathlib import Path

import msgspec

from sonicvacuum.discover.compare import check_source
from sonicvacuum.discover.verdict import Model, Verdict
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.files import InputError, read_text, reading, replacing
from sonicvacuum.report import inline, words
from sonicvacuum.report.tables import number

# Drawing → what it shows.
PICTURES = {
    "where": "Score of the residual of the nominal model by run, gauge and feature, in standard errors: "
    "violet where the data lie above the prediction, orange where they lie below.",
    "scalars": "Score of each measured quantity against the nominal (open) and the extended model (filled), "
    "in standard errors; band: two of them.",
    "candidates": "Probability of each single explanation.",
    "parameters": "Posterior of each parameter: Gaussian of value and standard error, 90 % interval shaded; "
    "on the right the range searched (grey), the value with its 90 % interval, and a cross where the effect "
    "is off, if the axis has that value.",
    "gap": "Misfit of the best model of each round, adopted or not; 1 is the noise.",
    "traces": "First and last run: measured, nominal and extended traces; below them running means of the "
    "residuals over their own standard error (band: two of them).",
}
# What a page adds to the folder of discover.
PAGE = ("index.html", "parameters.csv", *(f"{name}.{kind}" for name in PICTURES for kind in ("svg", "png")))
_PAIRS = 6
# What the page needs of each table.
_COLUMNS = {
    "where": ("run", "sensor", "feature", "z_before", "q_before"),
    "candidates": ("effects", "delta_chi2", "log10_bayes", "probability", "parameters"),
    "gap": ("run", "data", "before", "after", "held_out_before", "held_out_after"),
    "limits": ("effect", "parameter", "limit_95", "testable", "place"),
}


def write_page(folder, catalogue: Catalogue = CATALOGUE) -> Path:
    """Write `index.html` into a folder of discover; its path."""
    found = section(folder, catalogue)
    text = inline.environment().get_template("discovery.html.j2").render(one=found)
    path = Path(folder) / "index.html"
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
    verdict, model = _json(folder / "verdict.json", Verdict), _json(folder / "model.json", Model)
    for name in verdict.parameters:
        check_source(folder / "verdict.json", name, verdict.sources, catalogue)
    tables = {name: _rows(folder / f"{name}.csv") for name in ("where", "candidates", "gap", "limits")}
    with reading(folder, "run sonicvacuum discover again"):
        return _told(folder, verdict, model, tables, catalogue)


def _told(folder, verdict, model, tables, catalogue):
    name = verdict.record
    return {
        "name": name,
        "headline": words.headline(verdict, catalogue) + words.moved_modulus(verdict, model),
        "slips": words.slips(verdict),
        "corrected": words.corrected(verdict),
        "where": words.where(verdict, tables["where"]),
        "parameters": _parameters(verdict, catalogue),
        "nuisances": words.nuisances(model),
        "alternatives": words.alternatives(verdict),
        "pairs": [r for r in tables["candidates"] if "+" in r["effects"]][:_PAIRS],
        "singles": [r for r in tables["candidates"] if "+" not in r["effects"]],
        "gap": " ".join(filter(None, (words.gap(verdict), words.goodness(verdict)))),
        "runs": [r for r in tables["gap"] if not r["run"].startswith("round ")],
        "added": bool(words.effects_of(verdict)),
        "limits": [_limit(r, catalogue) for r in tables["limits"] if r["testable"] == "1"],
        "not_testable": [n for n in verdict.not_testable if n not in verdict.named],
        "experiment": words.experiment(verdict.next_experiment, tables["where"]),
        "decided": words.decided(verdict),
        "simulations": verdict.simulations,
        "warnings": verdict.warnings or [],
        "pictures": _pictures(folder, name),
    }


def _json(path, kind):
    try:
        return msgspec.json.decode(read_text(path), type=kind)
    except (msgspec.DecodeError, msgspec.ValidationError) as error:
        raise InputError(f"{path}: not what sonicvacuum discover writes ({error}); run it again") from None


def _rows(path):
    """Rows of a table; InputError where it lacks a column."""
    with reading(path, "run sonicvacuum discover again"):
        table = csv.DictReader(read_text(path).splitlines(), strict=True)
        rows = list(table)
        missing = [c for c in _COLUMNS[path.stem] if c not in (table.fieldnames or ())]
        if missing:
            raise ValueError(f"no column {missing[0]}")
        for line, row in enumerate(rows, 2):
            if None in row or None in row.values():
                raise ValueError(f"line {line} has another number of cells than the header")
    return rows


def _pictures(folder, name):
    """Drawing → SVG, caption and whether it is narrow; those that the folder holds."""
    found = {}
    for picture, caption in PICTURES.items():
        path = folder / f"{picture}.svg"
        if path.exists():
            svg = inline.svg(path, f"{name}-{picture}", caption)
            found[picture] = {"svg": svg, "caption": caption, "narrow": inline.is_narrow(path)}
    return found


def _parameters(verdict, catalogue):
    """Rows of the table: what, value with its error, 90 % interval, range searched, off value."""
    rows = []
    for name, given in verdict.parameters.items():
        one = catalogue.effect(name)
        for key, found in given.items():
            if key == one.places:
                at = {"parameter": f"sits at {key}", "value": f"{found.value:g}"}
                rows.append({"effect": name, **at, "interval": "", "searched": "", "off": ""})
                continue
            p = one.parameter(key)
            rows.append(
                {
                    "effect": name,
                    "parameter": f"{p.help}, {key}",
                    "value": _with_error(found.value, found.sigma),
                    "interval": _interval(found.value, found.sigma),
                    "searched": f"{p.low:g} to {p.high:g}",
                    "off": _off(p),
                }
            )
    return rows


def _with_error(value, sigma):
    """Value ± standard error with two digits of the error."""
    if not sigma > 0.0:
        return f"{value:.4g} (error not determined)"
    digits = max(0, 1 - math.floor(math.log10(sigma)))
    return f"{value:.{digits}f} ± {sigma:.{digits}f}" if digits < 7 else f"{value:.4g} ± {sigma:.2g}"


def _interval(value, sigma):
    return f"{value - 1.645 * sigma:.4g} to {value + 1.645 * sigma:.4g}" if sigma > 0.0 else ""


def _off(parameter):
    if parameter.off is None:
        return "shapes only"
    if callable(parameter.off):
        return "as recorded"
    return "∞" if math.isinf(parameter.off) else f"{parameter.off:g}"


def _limit(row, catalogue):
    known = row["effect"] in catalogue
    p = catalogue.effect(row["effect"]).parameter(row["parameter"]) if known else None
    return {
        "effect": row["effect"],
        "parameter": row["parameter"],
        "off": _off(p) if p else "",
        "limit": number(row["limit_95"], 3),
        "weakest": row["place"],
    }
