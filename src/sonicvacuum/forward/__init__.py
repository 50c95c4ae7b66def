"""The forward model, lane by lane: chains and gauges go in, their motion, readings and scalars come out.

`motion.see` simulates a setup and reads its gauges; `scalars` measures on the readings what a record reports
as single numbers. What is predicted of a record and what `discover` fits both come from here.
"""

from sonicvacuum.forward.motion import Seen, readings, see
from sonicvacuum.forward.scalars import (
    SOLITARY,
    all_measured,
    measured,
    of_amplitudes,
    passages,
    virtual,
)

__all__ = [
    "SOLITARY",
    "Seen",
    "all_measured",
    "measured",
    "of_amplitudes",
    "passages",
    "readings",
    "see",
    "virtual",
]
