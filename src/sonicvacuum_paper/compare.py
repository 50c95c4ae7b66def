"""Metrics of the pseudo-case `compare`: two simulated cases held against each other, column by column.

Definitions in `workflow/resources/claims.md`, "Two cases". The numerical error of a comparison follows from
those of its metrics: how far it moves when each of them moves by its own.
"""

import math
from collections.abc import Callable

from sonicvacuum_paper.columns import Metrics, lossless_twin
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.rows import Row, absent

BETWEEN = "g9-g5"
# So much less deep is a valley that counts as less split.
SPLIT_MARGIN = 0.02
# Striker over bead, of fig3a, ratio-2, fig5a and ratio-5.
MASS_RATIOS = (PRINTED.light_striker / PRINTED.bead_mass, 2.0, PRINTED.heavy_striker / PRINTED.bead_mass, 5.0)


def column_rows(metrics: Metrics, column: str) -> list[Row]:
    """All comparisons in one column of the ledger."""
    case = f"compare.{column}"
    rows = [
        _derived(case, name, sensor, [metrics.find(c, column, q, s) for c, q, s in needs], needs, function)
        for name, sensor, needs, function in COMPARISONS
    ]
    return [*rows, _losses_delay_splitting(metrics, column), _decay_with_losses(metrics, column)]


def modulus_row(metrics: Metrics, moduli: dict[str, float]) -> Row:
    """Modulus in GPa at which fig3a runs at the printed speed; one value for all columns.

    Args:
        metrics: of all cases.
        moduli: full card name → modulus in Pa of the fig3a runs to interpolate between.
    """
    name = "modulus_for_fig3a_speed"
    found = _speeds(metrics, moduli)
    if found is None:
        return absent("compare", name, "", "GPa", "fewer than two runs of fig3a have a speed")

    def modulus(*speeds):
        return interpolated(PRINTED.speed_coated, speeds, sorted(moduli.values())) / 1e9

    return _propagated("compare", name, "", "GPa", found, modulus)


def equivalent_row(metrics: Metrics, column: str, case: str, moduli: dict[str, float]) -> Row:
    """Modulus in GPa that a Hertz contact needs to run as fast as a case does in a column of the ledger.

    Args:
        metrics: of all cases.
        column: of the ledger.
        case: fig3a or small-amplitude.
        moduli: full card name → modulus in Pa of the Hertz runs of that case.
    """
    key = f"compare.{column}", f"hertz_modulus_{case.replace('-', '_')}", ""
    found, own = _speeds(metrics, moduli), metrics.find(case, column, "speed", BETWEEN)
    if found is None or own is None or not own.known:
        return absent(*key, "GPa", f"fewer than two runs of {case} have a speed, or this column has none")

    def modulus(speed, *speeds):
        return interpolated(speed, speeds, sorted(moduli.values())) / 1e9

    return _propagated(*key, "GPa", [own, *found], modulus)


def _speeds(metrics, moduli):
    """Speeds of the runs in the order of their moduli; None where fewer than two have one."""
    found = [metrics.at(n, "speed", BETWEEN) for n in sorted(moduli, key=moduli.get)]
    return None if len(found) < 2 or any(r is None or not r.known for r in found) else found


def needs_of(row: Row) -> tuple[tuple[str, str, str], ...]:
    """The (case, quantity, sensor) that a comparison is made of; empty for any other metric."""
    if not row.case.startswith("compare."):
        return ()
    return next((needs for name, at, needs, _ in COMPARISONS if (name, at) == (row.quantity, row.sensor)), ())


def interpolated(speed, speeds, moduli) -> float:
    """Modulus at a speed: ln E linear in ln speed through the two runs nearest in ln speed to it."""
    target = math.log(speed)
    points = sorted(
        (abs(math.log(v) - target), math.log(v), math.log(e)) for v, e in zip(speeds, moduli, strict=True)
    )
    (_, v1, e1), (_, v2, e2) = points[:2]
    return math.exp(e1 + (target - v1) * (e2 - e1) / (v2 - v1))


def _flag(function: Callable[..., bool]) -> Callable[..., float]:
    return lambda *values: float(function(*values))


# name, sensor, the (case, quantity, sensor) it needs, and what is made of their values.
COMPARISONS = (
    (
        "speed_ratio_fig3b_fig3a",
        "",
        (("fig3b", "speed", BETWEEN), ("fig3a", "speed", BETWEEN)),
        lambda steel, coated: steel / coated,
    ),
    (
        "speed_ratio_fig5b_fig5a",
        "",
        (("fig5b", "speed", BETWEEN), ("fig5a", "speed", BETWEEN)),
        lambda steel, coated: steel / coated,
    ),
    (
        "amplitude_ratio_fig3b_fig3a",
        "g9",
        (("fig3b", "amplitude", "g9"), ("fig3a", "amplitude", "g9")),
        lambda steel, coated: steel / coated,
    ),
    (
        "speed_ratio_fig3a_low",
        "",
        (("fig3a", "speed", BETWEEN), ("small-amplitude", "speed", BETWEEN)),
        lambda high, low: high / low,
    ),
    (
        "pressure_change_small_beads",
        "",
        (("fig6a", "mean_pressure_over_yield", BETWEEN), ("fig3a", "mean_pressure_over_yield", BETWEEN)),
        lambda small, large: abs(small / large - 1.0),
    ),
    (
        "wave_count_over_mass_ratio",
        "wall",
        tuple((case, "pulse_count_05", "wall") for case in ("fig3a", "ratio-2", "fig5a", "ratio-5")),
        lambda *counts: max(abs(n / r - 1.0) for n, r in zip(counts, MASS_RATIOS, strict=True)),
    ),
    (
        "coated_amplitude_lower",
        "g9",
        (("fig3a", "amplitude", "g9"), ("fig3b", "amplitude", "g9")),
        _flag(lambda coated, steel: coated < 0.99 * steel),
    ),
    (
        "coated_arrival_later",
        "wall",
        (("fig3a", "arrival", "wall"), ("fig3b", "arrival", "wall")),
        _flag(lambda coated, steel: coated > 1.01 * steel),
    ),
    (
        "extra_pulses_coated_stronger",
        "g9",
        (("fig3a", "extra_pulse_fraction", "g9"), ("fig3b", "extra_pulse_fraction", "g9")),
        _flag(lambda coated, steel: coated > steel + 0.005),
    ),
    (
        "decay_coated_faster",
        BETWEEN,
        (("fig3a", "decay", BETWEEN), ("fig3b", "decay", BETWEEN)),
        _flag(lambda coated, steel: coated < steel - 0.01),
    ),
    *(
        (
            "coated_less_split",
            sensor,
            (("fig5a", "valley_depth", sensor), ("fig5b", "valley_depth", sensor)),
            _flag(lambda coated, steel: coated < steel - SPLIT_MARGIN),
        )
        for sensor in ("g9", "wall")
    ),
    (
        "train_needs_heavy_striker",
        "wall",
        (("fig5a", "pulse_count_05", "wall"), ("fig3a", "pulse_count_05", "wall")),
        _flag(lambda heavy, light: heavy > light),
    ),
    (
        "duration_ratio_fig6b_fig6a",
        "wall",
        (("fig6b", "duration_half", "wall"), ("fig6a", "duration_half", "wall")),
        lambda heavy, light: heavy / light,
    ),
    (
        "train_only_large_beads",
        "wall",
        (("fig5a", "pulse_count", "wall"), ("fig6b", "pulse_count", "wall")),
        _flag(lambda large, small: large >= 2 and small == 1),
    ),
    (
        "strain_rate_higher_small_beads",
        "",
        (("fig6a", "strain_rate", BETWEEN), ("fig3a", "strain_rate", BETWEEN)),
        _flag(lambda small, large: small > 1.1 * large),
    ),
)


def _losses_delay_splitting(metrics, column):
    """1 if the train of fig5a is split less with its losses than without."""
    key = f"compare.{column}", "losses_delay_splitting", "g9"
    lossy = metrics.find("fig5a", column, "valley_depth", "g9")
    free = lossy and lossless_twin(metrics, "fig5a", column, "valley_depth", "g9")
    if not free or not _has_losses(metrics, lossy.case):
        return absent(*key, "1", "no loss effect has been named")
    needs = ((lossy.case, "valley_depth", "g9"), (free.case, "valley_depth", "g9"))
    return _derived(*key, [lossy, free], needs, _flag(lambda one, other: one < other - SPLIT_MARGIN))


def _decay_with_losses(metrics, column):
    """Decay of fig3a where a loss has been named; a model without loss passes by construction."""
    key = f"compare.{column}", "decay_with_losses", BETWEEN
    decay = metrics.find("fig3a", column, "decay", BETWEEN)
    if not decay or not _has_losses(metrics, decay.case):
        return absent(*key, "1", "no loss effect has been named")
    return _derived(*key, [decay], ((decay.case, "decay", BETWEEN),), lambda value: value)


def _has_losses(metrics, name):
    """Whether a card has effects that take energy."""
    count = metrics.at(name, "loss_effects")
    return count is not None and count.value > 0.0


def _derived(case, name, sensor, found, needs, function):
    for row, (of, quantity, place) in zip(found, needs, strict=True):
        if row is None:
            return absent(case, name, sensor, "1", f"{of}/{quantity}/{place} has not been found: no such run")
        if not row.known:
            return absent(case, name, sensor, "1", f"{row.case}/{quantity}/{place}: {row.reason}")
    return _propagated(case, name, sensor, "1", found, function)


def _propagated(case, name, sensor, unit, found, function):
    """The function of the rows' values; its error sums its changes as each moves by its own error."""
    values = [r.value for r in found]
    here, error = function(*values), 0.0
    for k, row in enumerate(found):
        step = row.numerical_error if math.isfinite(row.numerical_error) else 0.0
        moved = [function(*values[:k], values[k] + s, *values[k + 1 :]) for s in (step, -step)]
        error += max(abs(m - here) for m in moved)
    return Row(case, name, sensor, here, unit, error)
