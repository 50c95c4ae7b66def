"""What the report shows of the rivals: the map, the deciding experiment, and whether relaxation would do.

All numbers come from the tables of `sonicvacuum paper rivals`; the sentences around them stand in
`uncertainty.html.j2`.
"""

import math

import pandas as pd

from sonicvacuum.discover.fit import evidence
from sonicvacuum.effects import CATALOGUE, IDS
from sonicvacuum.files import reading
from sonicvacuum.report.phrases import chance
from sonicvacuum.report.rows import in_full, in_words
from sonicvacuum.report.tables import number, unit_of
from sonicvacuum_paper.ladder import title
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.uncertainty import formats
from sonicvacuum_paper.uncertainty.layer_viscosity import WITH_LAYER
from sonicvacuum_paper.verdict import BOUND

WITHIN = 0.95
# Errors of the ledger: of the printed duration in us, and of 130 m/s.
DURATION, LOW = 14.0, 7.35
# Pulses that the paper saw leave the chain of Fig. 6(b).
WHOLE = 1
# Columns of the fits to the record.
SHOWN = (formats.MODULUS, formats.LAYER, formats.LOSS)
WORDS = {formats.LAYER: "the layer", formats.MODULUS: "another modulus of the polymer"}
# Prior of one effect, as discover has it.
PRIOR = (1.0 - evidence.PRIOR_NONE - evidence.PRIOR_UNKNOWN) / len(IDS)
CELLS = ("speed_m_s", "half_duration_us", "decay")


def context(contours, experiments, relaxation, losses, explained) -> dict:
    """What the template asks for, from the paths of the five tables; empty where they have not been made."""
    if not (contours and experiments and relaxation and losses and explained):
        return {"allowed": None}
    series = _read(experiments, formats.EXPERIMENTS)
    if series.empty:  # a configuration without a ledger
        return {"allowed": None}
    apart = series.groupby("series", sort=False)[["speeds_sigma", "all_sigma"]].first()
    return {
        "allowed": allowed(_read(contours, formats.MAP)),
        "series": _series(series),
        "apart": [(name, number(r.speeds_sigma, 2), number(r.all_sigma, 2)) for name, r in apart.iterrows()],
        "decisive": apart.speeds_sigma.idxmax(),
        "explained": of_sets(fits := _read(explained, formats.EXPLAINED, dtype=str, keep_default_na=False)),
        "weighed": weighed(fits),
        **of_laws(_read(losses, formats.LOSSES)),
        "relaxing": relaxing(_read(relaxation, formats.RELAXATION)),
    }


def _read(path, columns, **how):
    with reading(path, "run sonicvacuum paper rivals again"):
        return pd.read_csv(path, **how)[columns]


def allowed(table: pd.DataFrame) -> dict:
    """Moduli in GPa that the printed numbers allow of the printed film, and of one as thick as Hertz asks.

    `handbook` and `matched`: whether 2.76 GPa on the first and 15 GPa on the second are among them.
    """
    plane = table[(table.x == "modulus_GPa") & (table.y == "thickness_um")]
    found = {}
    for name, thickness, modulus in (
        ("handbook", PRINTED.coating, PRINTED.modulus_handbook),
        ("matched", plane.y_value.max() * 1e-6, PRINTED.modulus_matched),
    ):
        nearest = plane.y_value.loc[(plane.y_value - 1e6 * thickness).abs().idxmin()]
        inside = plane[(plane.y_value == nearest) & (plane.content < WITHIN)].x_value
        found[f"{name}_range"] = _span(inside, 2) if len(inside) else "none"
        found[name] = bool(len(inside)) and inside.min() <= modulus / 1e9 <= inside.max()
    return found


def _series(table):
    """One row for each point: what both models show there."""
    rows = []
    for (series, unit, at), both in table.groupby(["series", "unit", "at"], sort=False):
        of_model = both.set_index("model")
        cells = [number(of_model.loc[model, cell], 3) for cell in CELLS for model in formats.MODELS]
        rows.append({"series": f"{series},{unit_of(unit)}", "at": number(at, 3), "cells": cells})
    return rows


def of_sets(table: pd.DataFrame) -> dict:
    """Fits of single effects and pairs to the paper's record: heads of the columns, a row for each number.

    `table` is text. Each cell is what the fit gives and, after a bar, what it gives fitted to all others.
    Shown are modulus and layer, each without and with the ladder's loss.
    """
    sets = [name for name in dict.fromkeys(table.effects) if set(name.split("+")) <= set(SHOWN)]
    first = {name: table[table.effects == name].iloc[0] for name in sets}
    heads = [" with ".join(CATALOGUE.effect(n).title.lower() for n in name.split("+")) for name in sets]
    rows = []
    for (run, quantity), part in table.groupby(["run", "quantity"], sort=False):
        of_set = part.set_index("effects")
        printed = {"": "", "at_most": "at most ", "at_least": "at least "}[part.bound.iloc[0]]
        printed += f"{number(part.measured.iloc[0], 4)} ± {number(part.sigma.iloc[0], 2)}"
        cells = [[number(of_set.loc[n, c], 3) or "–" for c in ("extended", "held_out")] for n in sets]
        rows.append({"run": run, "quantity": in_full(quantity), "printed": printed, "cells": cells})
    return {
        "heads": heads,
        "rows": rows,
        "numbers": [in_words(first[n].parameters, CATALOGUE) for n in sets],
        "misfits": [number(first[n].misfit, 3) for n in sets],
        "worth": [number(first[n].log10_bayes, 3) for n in sets],
    }


def weighed(table: pd.DataFrame) -> dict:
    """How probable modulus and layer are, without and with a loss (any of those tried), by their evidence.

    Every effect has the catalogue's prior, that of the layer also ten times it and a tenth; last, the layer
    is known to be there, as the record says. `table` is text. Nothing else of the catalogue is in it.

    Returns:
        Kind of explanation → the best of it in words, its misfit, and its probability under each prior.
    """
    of_set = table.groupby("effects", sort=False).first()
    worth = {name: float(value) for name, value in of_set.log10_bayes.items()}
    kinds: dict[str, list[str]] = {}
    for name in worth:
        kinds.setdefault(_kind(name.split("+")), []).append(name)
    rows = {}
    for kind, own in kinds.items():
        best = of_set.loc[max(own, key=worth.get)]
        rows[kind] = [in_words(best.parameters, CATALOGUE), number(best.misfit, 3)]
    for odds in (1.0, 10.0, 0.1, None):
        weights = _weights(worth, odds)
        for kind, own in kinds.items():
            share = sum(weights[name] for name in own) / sum(weights.values())
            # Without the layer there is nothing where it is known to be there.
            rows[kind].append(chance(share) if share else "–")
    return rows


def _weights(worth: dict[str, float], odds: float | None) -> dict[str, float]:
    """Set of effects → prior times evidence, the largest 1; `odds` are the layer's, None: it is there."""
    logs = {}
    for name, value in worth.items():
        effects = name.split("+")
        layer = formats.LAYER in effects
        if odds is None and layer:
            logs[name] = value + (len(effects) - 1) * math.log10(PRIOR)
        elif odds is not None:
            logs[name] = value + len(effects) * math.log10(PRIOR) + layer * math.log10(odds)
    top = max(logs.values())
    return {name: 10.0 ** (logs[name] - top) if name in logs else 0.0 for name in worth}


def _kind(effects) -> str:
    """What a set of effects is: the contact, and whether it loses."""
    contact = [WORDS[name] for name in (formats.LAYER, formats.MODULUS) if name in effects]
    return " and ".join(contact) + " with a loss" * (not set(effects) <= set(WORDS))


def of_laws(table: pd.DataFrame) -> dict:
    """Rows of the laws of loss (`laws`), and with how many of them the conclusion holds (`by_law`).

    A law speaks for the layer where the layer with it meets both printed speeds and Hertz with it does not.
    """
    fast = (table.speed_m_s - PRINTED.speed_coated).abs() <= PRINTED.speed_error * PRINTED.speed_coated
    slow = (table.low_speed_m_s - PRINTED.speed_low).abs() <= BOUND * LOW
    meets = (fast & slow).groupby(table.law, sort=False)
    layer, hertz = meets.nth(0), meets.nth(1)
    speaks = layer.to_numpy() & ~hertz.to_numpy()
    of_layer = table[table.contact == "layer"]
    of_hertz = table[table.contact == "matched"]
    ratios = [_span(part.speed_m_s / part.low_speed_m_s, 3) for part in (of_layer, of_hertz)]
    rows = [
        [title(r.contact), WITH_LAYER.effect(r.law).title, _calibrated(r), *_cells(r)]
        for r in table.itertuples()
    ]
    words = {
        "speaks": int(speaks.sum()),
        "of": len(speaks),
        "ratios": ratios,
        "forces": _span(of_layer.gauge_N, 2),
        "whole": int((of_layer.pulses_fig6b == WHOLE).sum()),
        "durations": _span(of_layer.duration_us, 3),
    }
    return {"laws": rows, "by_law": words}


def _calibrated(row):
    """The number of a law with its unit."""
    (unit,) = {p.unit for p in WITH_LAYER.effect(row.law).parameters if p.name == row.parameter}
    return f"{number(row.value, 2)}{unit_of(unit)}"


def _cells(row):
    """Numbers of a law, in the order of the report's table."""
    ratio = row.speed_m_s / row.low_speed_m_s
    shown = (row.speed_m_s, row.low_speed_m_s, ratio, row.duration_us, row.gauge_N, row.decay, row.split_g9)
    return [*(number(v, 3) for v in shown), number(row.pulses_fig6b, 1)]


def relaxing(table: pd.DataFrame) -> dict:
    """What solids that relax from a static modulus to 15 GPa show, and how many show what is printed."""
    broad, single = (table[table.solid == name] for name in (formats.BROAD, formats.SINGLE))
    fast = (table.speed_m_s - PRINTED.speed_coated).abs() <= PRINTED.speed_error * PRINTED.speed_coated
    slow = (table.low_speed_m_s - PRINTED.speed_low).abs() <= BOUND * LOW
    lasts = (table.duration_us - 1e6 * PRINTED.duration_coated).abs() <= 2.0 * DURATION
    hidden = single.loc[single.time_us.idxmax()]
    return {
        "tangent": _span(broad.loss_tangent, 2),
        "duration": _span(broad.duration_us, 3),
        "decay": _span(broad.decay, 2),
        "hidden_tangent": number(hidden.loss_tangent, 1),
        "hidden_ms": number(hidden.time_us / 1e3, 2),
        "low": _span(single.low_speed_m_s[fast], 3),
        "fits": int((fast & slow & lasts).sum()),
        "sound": [f"{_longitudinal(m):.0f}" for m in (PRINTED.modulus_handbook, PRINTED.modulus_matched)],
    }


def _span(values, digits):
    ends = dict.fromkeys((number(values.min(), digits), number(values.max(), digits)))
    return " to ".join(ends)


def _longitudinal(modulus):
    """Speed in m/s of a longitudinal wave in the coating, √(E (1 − ν)/((1 + ν)(1 − 2ν))/ρ)."""
    nu = PRINTED.poisson
    return (modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / PRINTED.coating_density) ** 0.5
