"""Clocks that are off by a step, as samplings differ by, beside effects that move all times.

Beads that are so many times stiffer make every time shorter and every force higher by the same factor. Beside
them a clock put right by what pulses last has taken what is theirs.
"""

import math

from sonicvacuum.discover.faults import policy
from sonicvacuum.discover.faults.judged import Judged
from sonicvacuum.discover.faults.starts import FARTHEST
from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.effects import Catalogue

# Ratios of sampling intervals that are set in steps of 1, 2 and 5, or of which every second or fourth sample
# was kept, within a decade.
STEPS = (1.0, 1.25, 2.0, 2.5, 4.0, 5.0, 8.0)


def steps_near(value: float) -> list[float]:
    """Steps that a clock may be off by which was put right by a factor, as far as effects move times."""
    decade = math.floor(math.log10(value))
    every = [step * 10.0 ** (decade + k) for k in (-1, 0, 1) for step in STEPS]
    return [step for step in every if step != 1.0 and abs(math.log(step / value)) < policy.OTHER_CLOCK]


def alike(catalogue: Catalogue) -> set[str]:
    """Effects that move all times or all forces as a modulus or a speed does."""
    return {e.id for e in catalogue if {p.acts_like for p in e.parameters} & {"modulus", "speed"}}


def log_prior(slip: Judged | None) -> float:
    """Log of the prior of a clock that is off by one step, over that of one off by just the factor by which
    it was put right: one step of those of three decades, or any factor that a clock may be off by.
    """
    if slip is None or slip.slip.fault != "clock":
        return 0.0
    sigma = abs(slip.size) / math.sqrt(max(slip.gain, 1.0))
    return math.log(2.0 * FARTHEST / (3.0 * len(STEPS) * math.sqrt(2.0 * math.pi) * sigma))


def share(found: Investigation, catalogue: Catalogue) -> None:
    """Effects that are `alike` share what one of them has beside a clock off by any factor."""
    same, told = alike(catalogue), found.probabilities
    for name, own in list(told.items()):
        effects = explanations.effects(name)
        if len(moved := same & set(effects)) != 1:
            continue
        rest = [e for e in effects if e not in moved]
        for other in sorted(same):
            key = explanations.key([*rest, other])
            told[key] = told.get(key, 0.0) + own / len(same) - own * (key == name)
    found.reasons.append(
        f"{' and '.join(sorted(same))} act alike beside a clock that is off by any factor: they share their "
        "probability"
    )
