"""The first screen: is 15 GPa a property of the polymer? Five sentences, from the numbers of the ledger."""

import pandas as pd

from sonicvacuum.report.tables import number
from sonicvacuum_paper.ladder import members


def sentences(ledger: pd.DataFrame, metrics: pd.DataFrame, by_law: dict | None = None) -> list[str]:
    """Five sentences; none where a number is missing.

    Args:
        ledger: rows of the ledger, as text.
        metrics: `results/metrics.csv`, as text.
        by_law: what laws of loss say together, `rivals.of_laws`; None where none were compared.
    """
    rows = {r["claim"]: r for r in ledger.to_dict("records")}
    value = metrics.set_index(["case", "quantity"])["value"].to_dict()
    wanted = ("fig3a-speed", "low-speed", "fig3a-duration", "fig3a-width", "force-level", "speed-ratio-low")
    like = [value.get(("compare.layer", f"hertz_modulus_{c}"), "") for c in ("fig3a", "small_amplitude")]
    if not all(claim in rows and rows[claim]["layer_loss"] for claim in wanted) or not all(like):
        return []
    n = {claim: {c: number(rows[claim][c], 3) for c in ("layer", "layer_loss", "matched", "matched_loss")}
         for claim in wanted}  # fmt: skip
    fast, slow = (float(m) for m in like)
    speed, low, lasting, wide, force, ratio = (n[claim] for claim in wanted)
    speed_, low_, lasting_, wide_, force_, ratio_ = (rows[claim]["measured"] for claim in wanted)  # printed
    return [
        f"{_verdict(rows)} the 50 µm layer that is printed, with the handbook's 2.76 GPa and nothing fitted, "
        f"runs like a Hertz contact of {fast:.1f} GPa at 0.44 m/s and of {slow:.1f} GPa at 0.25 N.",
        f"It gives {speed['layer']} and {low['layer']} m/s ({speed_} and {low_} printed); Hertz with the "
        f"fitted 15 GPa gives {speed['matched']} and {low['matched']}.",
        f"Against the bare layer stand its speed ({_by(rows['fig3a-speed'], 'layer')}), {lasting['layer']} "
        f"µs ({lasting_} printed), {wide['layer']} diameters ({wide_}) and {force['layer']} N (about "
        f"{force_}).",
        f"One loss, calibrated on the {lasting_} µs alone, gives {speed['layer_loss']} and "
        f"{low['layer_loss']} m/s, ratio {ratio['layer_loss']} ({ratio_}), and {force['layer_loss']} N; with "
        f"it 15 GPa gives {speed['matched_loss']} and {low['matched_loss']} m/s, ratio "
        f"{ratio['matched_loss']}{_laws(by_law)}.",
        f"Not settled: the base level of the {lasting_} µs, thickness and modulus of the film at impact, "
        "printed without tolerance; films of other thickness on the same balls would decide.",
    ]


def _laws(found):
    """What changes with the law of the loss; nothing where no other was tried."""
    if not found:
        return ""
    layer, hertz = found["ratios"]
    with_ = f"with {found['speaks']} of {found['of']} laws of loss"
    return f"; so it is {with_} ({layer} on the layer, {hertz} on Hertz)"


def _verdict(rows):
    """Whether the ladder speaks for the layer: it holds both speeds with a loss, and Hertz does not."""
    held = [
        c in members(rows[claim]["agrees"]) for c in ("layer_loss",) for claim in ("fig3a-speed", "low-speed")
    ]
    against = "matched_loss" in members(rows["low-speed"]["excluded"])
    if all(held) and against:
        return "15 GPa is mostly the layer's geometry, not a property of the polymer:"
    return "Whether 15 GPa is a property of the polymer these models do not tell:"


def _by(row, column):
    excluded = members(row["excluded"])
    return f"{excluded[column]} σ" if excluded.get(column) else "within its bound"
