"""The tables of a record's page, made from the verdict and the tables beside it: numbers with plain names."""

import math
import re
from collections.abc import Sequence

from sonicvacuum.discover import policy
from sonicvacuum.records import Record
from sonicvacuum.report.misfit import SIDES
from sonicvacuum.report.tables import number, unit_of
from sonicvacuum.report.words import LEAST_TOLD, plain, share

# Scores from this on are written into their cell; those beyond the second have the full colour.
TOLD, FULL = 3.0, 10.0
# Explanations that are shown: the first ones, and all above `LEAST_TOLD`.
FEWEST, MOST = 3, 8


def grid(cells: list[dict]) -> dict | None:
    """Scores of the nominal model: a line for each run and gauge, a column for each feature; None without.

    Each cell has its number as shown, its shade from 0 to 1, the side, and the sentence under the cursor.
    """
    cells = [c for c in cells if c["sensor"]]
    if not cells:
        return None
    features = list(dict.fromkeys(c["feature"] for c in cells))
    places: dict[tuple[str, str], dict[str, dict]] = {}
    for c in cells:
        places.setdefault((c["run"], c["sensor"]), {})[c["feature"]] = _cell(c)
    lines = [
        {"run": run, "sensor": sensor, "cells": [found.get(f) for f in features]}
        for (run, sensor), found in places.items()
    ]
    return {"features": features, "lines": lines}


def _cell(c):
    z = float(c["z_before"])
    sides = SIDES.get(c["feature"], (f"a larger {c['feature']}", f"a smaller {c['feature']}"))
    said = f"run {c['run']}, gauge {c['sensor']}: {sides[z <= 0.0]} by {abs(z):.3g} standard errors"
    return {
        "shown": f"{z:+.0f}".replace("-", "−") if abs(z) >= TOLD else "",
        "shade": f"{min(abs(z) / FULL, 1.0):.2f}",
        "side": "above" if z > 0.0 else "below",
        "said": said,
    }


_BOUNDS = {"": "", "at_most": "at most ", "at_least": "at least "}


def quantities(table: list[dict], records: Sequence[Record] = ()) -> list[dict]:
    """What was measured without traces: what both models give, and what the fit would say without it.

    A measured value has its own error and, behind its unit, the one that it has in common with others, in
    parts of it; `common` names where that comes from. Only the `records` know of it.
    """
    shared = {
        (run.id, one.in_words): one.shared
        for record in records
        for run in record.runs
        for one in run.observables
    }
    return [_quantity(r, shared.get((r["run"], r["quantity"]), {})) for r in table]


def _quantity(row, common):
    """One row of `quantities`; `common` is what its value has in common with others → relative error."""
    return {
        "run": row["run"],
        "quantity": in_full(row["quantity"]),
        "measured": _measured(row, common),
        "common": sorted(common),
        **{name: number(row[name], 4) for name in ("nominal", "extended", "held_out")},
    }


def _measured(row, common):
    """`at most 3.0 ± 0.5 N`; `197 ± 2 m/s ± 4.1 %` with an error that others have as well."""
    own = f"{_BOUNDS[row['bound']]}{_as_stated(row['measured'], row['sigma'])}{unit_of(row['unit'])}"
    return f"{own} ± {number(100.0 * math.hypot(*common.values()), 2)} %" if common else own


def _as_stated(value, sigma):
    """A measured value with as many decimals as its stated error, two digits of which are shown at most."""
    error = number(sigma, 2)
    if float(error) != float(sigma) or "e" in error:
        return with_error(float(value), float(sigma))
    return f"{float(value):.{len(error.partition('.')[2])}f} ± {error}"


def in_full(label: str) -> str:
    """`duration g9 at 0.02` with what the level is a part of; `speed at amplitude g9 0.25 N` and
    `width g9-g5 g9` in words.
    """
    peak = "first peak" if label.startswith("pulse count") else "peak"
    label = re.sub(r"^speed at amplitude (\S+) ", r"speed where \1 reads ", label)
    label = re.sub(r"^width (\S+) (\S+)", r"width at \2, by the speed \1", label)
    label = re.sub(r"\b(speed|decay) ([^\s-]+)-([^\s-]+)", r"\1 \2–\3", label)
    return re.sub(r" at ([0-9.e-]+)$", rf", above \1 of the {peak}", label)


def odds(verdict, catalogue, singles=()) -> list[dict]:
    """The most probable explanations, with plain names, ids, shares and the numbers that they need.

    `singles` are rows of candidates.csv.
    """
    fitted = {r["effects"].replace("+", " + "): r["parameters"] for r in singles}
    best = sorted(verdict.probabilities.items(), key=lambda item: -item[1])[:MOST]
    return [
        {
            "name": plain(k, catalogue),
            "id": k,
            "share": share(p),
            "percent": f"{100.0 * p:.1f}",
            "with": in_words(fitted.get(k, ""), catalogue),
        }
        for place, (k, p) in enumerate(best)
        if place < FEWEST or p >= LEAST_TOLD
    ]


def in_words(parameters, catalogue):
    """`dynamic-modulus modulus_ratio 3.87` of candidates.csv in words: `modulus over … = 3.9`."""
    told = []
    for part in filter(None, (p.strip() for p in parameters.split(";"))):
        effect, name, value = part.rsplit(" ", 2)
        if effect in catalogue and name in {p.name for p in catalogue.effect(effect).parameters}:
            p = catalogue.effect(effect).parameter(name)
            told.append(f"{p.help} = {_apart(value, off(p), 2)}{unit_of(p.unit)}")
    return "; ".join(told)  # help texts hold commas


def placed(parameters: str, gauges, catalogue, materials=()) -> str:
    """Parameters of candidates.csv, with a gauge or material, which it counts from 0, by its name."""
    known, told = {"sensor": gauges, "material": materials}, []
    for part in parameters.split("; "):
        effect, _, rest = part.partition(" ")
        key, _, where = rest.partition(" ")
        if known.get(key) and effect in catalogue and catalogue.effect(effect).sits == key:
            part = f"{effect} {'gauge' if key == 'sensor' else key} {known[key][int(where)]}"
        told.append(part)
    return "; ".join(told)


def present(verdict, model, catalogue) -> str:
    """Effects of the nominal model, which the record says act, with what is found of them; "" without any."""
    there = [name for name in model.effects if name in catalogue.ids and name not in verdict.named]
    found = []
    for name in there:
        values = "; ".join(f"{name} {key} {value}" for key, value in model.effects[name].items())
        found.append(f"{catalogue.effect(name).title.lower()} ({in_words(values, catalogue)})")
    return ", ".join(found)


def rounds(table: list[dict], catalogue) -> list[dict]:
    """Misfit of the best model of each round, with a bar that is full at the first and empty at the noise."""
    steps = [r for r in table if r["run"].startswith("round ")]
    values = [float(r["after"]) for r in steps]
    most = math.log(max([*values, 1.001]))
    return [
        {
            "name": _round(r["run"].split(": ", 1)[1], catalogue),
            "value": number(r["after"]),  # as many digits as the sentence above it
            "percent": f"{100.0 * min(max(math.log(max(v, 1.0)) / most, 0.0), 1.0):.1f}",
        }
        for r, v in zip(steps, values, strict=True)
    ]


def _round(name, catalogue):
    return "nominal model" if name == "nominal" else f"with {plain(name, catalogue)}"


def effects(verdict, catalogue, draws, gauges=(), materials=()) -> list[dict]:
    """What was named: title, equation, source, and its parameters with errors.

    Args:
        verdict: what was found.
        catalogue: knows the effects of the verdict.
        draws: as in `draws.read`.
        gauges: names of the record's gauges in its order; () where they are not known.
        materials: names of the beads' materials likewise.
    """
    found = []
    for name, given in verdict.parameters.items():
        one = catalogue.effect(name)
        parameters = [
            _place(key, value, draws.get((name, key)), {"sensor": gauges, "material": materials}.get(key))
            if key == one.sits
            else _parameter(one.parameter(key), value, draws.get((name, key)))
            for key, value in given.items()
        ]
        found.append(
            {
                "id": name,
                "title": one.title,
                "equation": one.equation,
                "reference": one.reference,
                "signature": one.signature,
                "parameters": parameters,
            }
        )
    return found


def _place(key, found, draws, names):
    """Row of the place of an effect, and how likely it and others are; a gauge or material, which verdicts
    count from 0, by its name.
    """

    def name(place):
        return names[int(place)] if names else f"{place:g}"

    told = [f"{name(place)}\N{NO-BREAK SPACE}({share(p)})" for place, p in _likely(found.value, draws)]
    where = "gauge" if key == "sensor" and names else key
    said = key if key == "material" else f"sits at {where}"
    row = {"name": said, "value": name(found.value), "searched": "", "off": ""}
    return row | {"interval": ", ".join(told), "odds": True}


def _likely(told, draws):
    """(place, probability) of the told place and the likeliest others, as many as together have 90 %."""
    odds = {} if draws is None else dict(zip(draws.value.tolist(), draws.weight.tolist(), strict=True))
    found, total = [], 0.0
    for place in sorted(odds, key=lambda place: (place != told, -odds[place])):
        if total < 0.9:
            found.append((place, odds[place]))
            total += odds[place]
    return found


def _parameter(p, found, draws):
    """Row of a parameter: what, value with its error, 90 % interval, range searched, value without effect."""
    unit, interval = unit_of(p.unit), _interval(found.value, found.sigma, draws)
    return {
        "name": p.help,
        "odds": False,
        "value": with_error(found.value, found.sigma) + unit,
        "interval": interval and interval + unit,
        "searched": f"{number(p.low)} to {number(p.high)}{unit}",
        "off": off(p),
    }


def with_error(value, sigma):
    """Value ± standard error with two digits of the error."""
    if not sigma > 0.0:
        return f"{value:.4g} (error not determined)"
    places = _places(value, sigma)
    if places is None:
        return f"{number(value)} ± {number(sigma, 2)}"
    return f"{_to(value, places)} ± {_to(sigma, places)}"


def _places(value, sigma):
    """Decimals down to the second digit of an error; None where powers of ten say it better."""
    # Rounding may carry: 0.0996 is 0.10.
    places = 1 - math.floor(math.log10(float(f"{sigma:.1e}")))
    return None if places >= 7 or abs(value) >= 1e6 else places


def _to(value, places):
    return f"{round(value, places):.{max(0, places)}f}"


def _interval(value, sigma, draws):
    """The 90 % interval of the draws, where there are any, or else of the Gaussian: one digit more than the
    value, since it may lean far to one side.
    """
    room = policy.NINETY * sigma
    ends = (value - room, value + room)
    if draws is not None:
        ends = (draws.quantile(0.05), draws.quantile(0.95))
    elif not sigma > 0.0:
        return ""
    places = _places(max(map(abs, ends)), sigma) if sigma > 0.0 else None
    return " to ".join(_rounded(x, 4) if places is None else _to(x, places + 1) for x in ends)


def off(parameter) -> str:
    """Value at which a parameter leaves the nominal model as it is, in words."""
    if parameter.off is None:
        return "shapes only"
    if callable(parameter.off):
        return "as recorded"
    return "∞" if math.isinf(parameter.off) else f"{parameter.off:g}"


def _rounded(value, digits) -> str:
    """A number with so many significant digits, also where they end before the decimal point."""
    return number(f"{float(value):.{digits - 1}e}", digits)


def _apart(value, other: str, digits=3) -> str:
    """A number to so many digits, or to as many as tell it from another one."""
    told = (_rounded(value, more) for more in range(digits, 7))
    return next((text for text in told if text != other), _rounded(value, 7))


def limit(row: dict, catalogue) -> dict:
    """One effect that was not named: how far from having none these data still let it be."""
    if row["effect"] not in catalogue:
        name, said = row["effect"], f"{row['parameter']}: {number(row['limit_95'], 3)}"
        return {"effect": name, "title": name, "parameter": row["parameter"], "limit": said, "off": ""}
    one = catalogue.effect(row["effect"])
    p = one.parameter(row["parameter"])
    return {
        "effect": one.id,
        "title": one.title,
        "parameter": p.help,
        "limit": f"{_bounded(p, row)}{unit_of(p.unit)}",
        "off": off(p),
    }


def _bounded(p, row):
    """`below 0.2`; `above` where the effect fades as its parameter grows, or can only lower it; both ends of
    what may depart either way from having none.
    """
    value = float(row["limit_95"])
    # What the record says is not in the table, but the estimate lies between that and the limit.
    none = float(row["estimate"]) if callable(p.off) else p.off
    other = 2.0 * none - value
    if not callable(p.off) and p.low < none < p.high and p.low <= other <= p.high:
        ends = (_apart(str(end), off(p)) for end in sorted((value, other)))
        return " to ".join(ends).replace("-", "−")
    return f"{'above' if value < none else 'below'} {_apart(row['limit_95'], off(p))}"
