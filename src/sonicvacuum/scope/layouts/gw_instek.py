"""GW Instek GDS scopes: keys, `Waveform Data`, then counts of the converter or volts.

Twenty-five counts are one division of the vertical scale (GDS-1000B manual, "acquisition", raw data of a
point 001C = 28 at 0.5 V/div: 28/25 × 0.5 V = 0.56 V).
"""

import numpy as np

from sonicvacuum.scope.layouts.base import Layout, Reading

COUNTS_PER_DIVISION = 25.0


def _readings(values: np.ndarray, keys, place: int) -> Reading:
    """Volts from whole counts; numbers with a fraction are volts already."""
    division = keys.number("scale", "V", place)
    finite = values[np.isfinite(values)]
    if not len(finite) or np.any(finite != np.round(finite)):
        return values, ""
    if not division:
        return values, "No vertical scale is read: whole numbers may be counts of the converter."
    said = f"Counts taken as {COUNTS_PER_DIVISION:g} to a division of {division:g} V."
    return values / COUNTS_PER_DIVISION * division, said


LAYOUT = Layout("gw-instek", r"^\W*Format,\s*\d\.\d\w|^\W*Memory Length,\s*\d", readings=_readings)
