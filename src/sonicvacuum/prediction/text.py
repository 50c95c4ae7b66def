"""A prediction in words and as JSON; both say the same numbers."""

from dataclasses import asdict, replace
from typing import Any

from sonicvacuum.prediction.measure import SAMPLES_PER_PULSE, ChainPrediction

# Arrays stand in the Python object only.
_ARRAYS = ("time_us", "readings_N")
_COLUMNS = {
    "reading_N": "reading N",
    "contact_force_N": "contact N",
    "arrival_us": "peak at us",
    "onset_us": "begins us",
    "duration_us": "lasts us",
    "duration_half_us": "half height us",
}


def content(prediction: ChainPrediction) -> dict[str, Any]:
    """Numbers by name, units in the names; what is not known is None."""
    plain = asdict(replace(prediction, time_us=(), readings_N={}))
    return {"format": 1} | {key: value for key, value in plain.items() if key not in _ARRAYS}


def text(prediction: ChainPrediction) -> str:
    """The same for reading."""
    p = prediction
    lines = [
        f"{p.beads} beads of {p.bead_mass_g:.4g} g, struck by {p.striker_mass_g:.4g} g at "
        f"{p.striker_speed_m_s:.4g} m/s"
    ]
    if p.coating_um is not None:
        lines.append(f"the coating of {p.coating_um:.4g} um acts as a layer bonded to its core")
    if p.wave_speed_m_s is not None:
        lines.append(f"wave speed {p.wave_speed_m_s:.4g} m/s, {_place(p.speed_from)} to {_place(p.speed_to)}")
    lines += ["", *_table(p), ""]
    if p.window_us:
        lines.append(
            f"record from {p.window_us[0]:.0f} to {p.window_us[1]:.0f} us (impact at 0) for a rest and the "
            "first pulse at every gauge"
            + (f"; to {p.echo_until_us:.0f} us for the wall's echo as well" if p.echo_until_us else "")
        )
    if p.sampling_us:
        lines.append(
            f"sample at least every {p.sampling_us:.3g} us ({1e3 / p.sampling_us:.3g} kHz): "
            f"{SAMPLES_PER_PULSE} samples across the shortest pulse at half its height"
        )
    lines += [f"beware: {warning}" for warning in p.warnings]
    return "\n".join(lines)


def _table(prediction):
    rows = [("gauge", *_COLUMNS.values())]
    for g in prediction.gauges:
        numbers = (getattr(g, key) for key in _COLUMNS)
        rows.append((_place(g.gauge), *("–" if n is None else f"{n:.4g}" for n in numbers)))
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    yield from ("  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in rows)
    yield from (f"{_place(g.gauge)}: {g.note}" for g in prediction.gauges if g.note)


def _place(gauge):
    return f"bead {gauge}" if gauge.isdigit() else gauge
