"""The tables of a record's page, made from the verdict and the tables beside it: numbers with plain names."""

import math
import re
from collections.abc import Sequence

from sonicvacuum.discover import policy
from sonicvacuum.records import Record
from sonicvacuum.report.misfit import SIDES
from sonicvacuum.report.phrases import chance, share
from sonicvacuum.report.tables import decimals, digits, fixed, number, unit_of, with_error
from sonicvacuum.report.words import LEAST_TOLD, plain

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
    known = list(SIDES)
    features = sorted(
        dict.fromkeys(c["feature"] for c in cells),
        key=lambda name: known.index(name) if name in known else len(known),
    )
    places: dict[tuple[str, str], dict[str, dict]] = {}
    for c in cells:
        places.setdefault((c["run"], c["sensor"]), {})[c["feature"]] = _cell(c)
    lines = [
        {"run": run, "sensor": sensor, "cells": [found.get(f) for f in features]}
        for (run, sensor), found in places.items()
    ]
    return {"features": features, "lines": lines, "gaps": any(None in line["cells"] for line in lines)}


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
    """One row of `quantities`; `common` is what its value has in common with others → relative error. Models
    are told to as many decimals as the measured value.
    """
    places = _decimals(row["measured"], row["sigma"])
    return {
        "run": row["run"],
        "quantity": in_full(row["quantity"]),
        "measured": _measured(row, common),
        "common": sorted(common),
        **{name: _of_model(row[name], places) for name in ("nominal", "extended", "held_out")},
    }


def _of_model(text, places):
    """A model's number beside a measured one that has so many decimals; "" for none."""
    if not text or places is None or not math.isfinite(float(text)):
        return number(text, 4)
    return fixed(float(text), places)


def _measured(row, common):
    """`at most 3.0 ± 0.5 N`; `197 ± 2 m/s ± 4.1 %` with an error that others have as well."""
    own = f"{_BOUNDS[row['bound']]}{_as_stated(row['measured'], row['sigma'])}{unit_of(row['unit'])}"
    return f"{own} ± {number(100.0 * math.hypot(*common.values()), 2)} %" if common else own


def _as_stated(value, sigma):
    """A measured value with as many decimals as its stated error, two digits of which are shown at most."""
    error = number(sigma, 2)
    if float(error) != float(sigma) or "e" in error:
        return with_error(float(value), float(sigma))
    return f"{fixed(float(value), _decimals(value, sigma))} ± {error}"


def _decimals(value, sigma):
    """Decimals of a measured value; None where powers of ten say it better, or without an error."""
    error = number(sigma, 2)
    if float(error) == float(sigma) and "e" not in error:
        return len(error.partition(".")[2])
    return decimals(float(value), float(sigma)) if float(sigma) > 0.0 else None


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


def candidate(row: dict, gauges, catalogue, materials=()) -> dict:
    """A row of candidates.csv as it is shown: places by name, numbers in four digits, keys of a single effect
    without its id, no probability of nothing or of certainty.
    """
    told = placed(row["parameters"], gauges, catalogue, materials)
    if "+" not in row["effects"]:
        told = re.sub(rf"(^|; ){re.escape(row['effects'])} ", r"\1", told)
    told = re.sub(r"(?<= )-?\d[\d.]*(e[+-]?\d+)?(?=;|$)", lambda found: number(found[0]), told)
    sure = row["probability"]
    return row | {"parameters": told, "probability": chance(float(sure)) if sure else ""}


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
            "value": digits(r["after"]),  # as many digits as the sentence above it
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
    if key == "contact":
        said += " (between that bead and the next)"
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


def _interval(value, sigma, draws):
    """The 90 % interval of the draws, where there are any, or else of the Gaussian: as many digits as the
    value, one more where an end that leans far to one side would keep fewer than two.
    """
    room = policy.NINETY * sigma
    ends = (value - room, value + room)
    if draws is not None:
        ends = (draws.quantile(0.05), draws.quantile(0.95))
    elif not sigma > 0.0:
        return ""
    places = decimals(max(map(abs, ends)), sigma) if sigma > 0.0 else None
    if places is None:
        return " to ".join(_rounded(x, 4) for x in ends)
    least = min((abs(x) for x in ends if x), default=math.inf)
    places += least < 10.0 ** (1 - places)
    return " to ".join(fixed(x, places) for x in ends)


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
        return re.sub(r"(?<![\w.])-", "−", " to ".join(ends))
    return f"{'above' if value < none else 'below'} {_apart(row['limit_95'], off(p))}"
