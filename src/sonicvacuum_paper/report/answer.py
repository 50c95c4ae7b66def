"""The first screen: is 15 GPa a property of the polymer? Five sentences, from the numbers of the ledger."""

import pandas as pd

from sonicvacuum.report.phrases import joined
from sonicvacuum.report.tables import number
from sonicvacuum_paper.ladder import members

COUNTS = {1: "one", 2: "two", 3: "three", 4: "four", 5: "five"}


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
    speed_, low_, lasting_, wide_, _, ratio_ = (rows[claim]["measured"] for claim in wanted)  # printed
    return [
        f"{_verdict(rows)} The printed 50 µm layer with the handbook's 2.76 GPa, nothing fitted, is as fast "
        f"as a Hertz chain of {fast:.1f} GPa at 0.44 m/s, and of {slow:.1f} GPa at 0.25 N.",
        f"It gives {speed['layer']} and {low['layer']} m/s ({speed_} and {low_} printed); Hertz with the "
        f"fitted 15 GPa gives {speed['matched']} and {low['matched']}.",
        _against(
            [
                (rows["fig3a-speed"], "fast", "slow", ""),
                (rows["fig3a-duration"], "long", "short", f"{lasting['layer']} µs, printed {lasting_}"),
                (rows["fig3a-width"], "wide", "narrow", f"{wide['layer']} diameters, printed {wide_}"),
            ],
            rows["force-level"],
        ),
        f"One loss, calibrated on the {lasting_} µs alone, brings the layer to {speed['layer_loss']} and "
        f"{low['layer_loss']} m/s (ratio {ratio['layer_loss']}, printed {ratio_}) and {force['layer_loss']} "
        f"N. The same on Hertz at 15 GPa gives {speed['matched_loss']} and {low['matched_loss']} m/s (ratio "
        f"{ratio['matched_loss']}).{_laws(by_law)}",
        f"Still open are the level at which the {lasting_} µs were read, and thickness of the film and its "
        "modulus at impact, which are printed without tolerance. Films of another thickness on the same "
        "balls would decide.",
    ]


def _against(asked, force):
    """What of the printed numbers the layer without losses contradicts, and how.

    `asked`: row, what the pulse is above and below the printed value, and both values in words, "" for the
    difference in standard errors. `force`: row of the force, which rests on a reading of Fig. 7.
    """
    found = []
    for row, above, below, told in asked:
        if "layer" in members(row["excluded"]):
            side = above if float(row["layer"]) > float(row["measured"]) else below
            found.append(f"too {side} ({told or _by(row, 'layer')})")
    if not found:
        return "The layer without losses contradicts none of the printed speed, duration and width."
    count = f"{COUNTS[len(found)]} printed number{'s' if len(found) > 1 else ''}"
    return f"The layer without losses contradicts {count}: its pulse is {joined(found)}{_strong(force)}."


def _strong(row):
    """What the force says besides, if the level of Fig. 7 is that of all tests; nothing where it fits."""
    if "layer" not in members(row["excluded"]):
        return ""
    told = f"{number(row['layer'], 3)} N against about {row['measured']}"
    return f"; too strong as well ({told}), if Fig. 7 tells the largest force of all tests"


def _laws(found):
    """What changes with the law of the loss; nothing where no other was tried."""
    if not found:
        return ""
    layer, hertz = found["ratios"]
    all_ = found["speaks"] == found["of"]
    laws = f"All {COUNTS.get(found['of'], found['of'])}" if all_ else f"{found['speaks']} of {found['of']}"
    told = f" {laws} laws of loss agree on both speeds: ratio {layer} on the layer, {hertz} on Hertz"
    if found["whole"] == found["of"]:
        return f"{told}."
    return f"{told}; the pulse of Fig. 6(b) stays whole on the layer with {found['whole']} of them."


def _verdict(rows):
    """Whether the ladder speaks for the layer: it holds both speeds with a loss, and Hertz does not."""
    held = [
        c in members(rows[claim]["agrees"]) for c in ("layer_loss",) for claim in ("fig3a-speed", "low-speed")
    ]
    against = "matched_loss" in members(rows["low-speed"]["excluded"])
    if all(held) and against:
        return (
            "If the film is bonded, linear and 50 µm thick, the 15 GPa come mostly from its geometry and not "
            "from the polymer."
        )
    return "Whether 15 GPa is a property of the polymer these models do not tell."


def _by(row, column):
    excluded = members(row["excluded"])
    return f"{excluded[column]} σ" if excluded.get(column) else "within its bound"
