"""The study of slips: which are made in which records, and their making.

Five set-ups, drawn like those of the other studies, each without and with one hidden effect, each with every
slip and without any. A slip's d′ is what the record's own errors of speed, modulus, gain and trigger leave of
it, as for effects (`signature`); slips that no such error resembles have none, and are plain. A list of its
own has the same beside smooth systematic errors (`systematics`), as real records do.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from sonicvacuum import records
from sonicvacuum.blas import one_thread
from sonicvacuum_blind.extra_cases import LENGTHS, SIZES
from sonicvacuum_blind.hide import TOLERANCE, Laboratory, Spec, keep, laboratory, noisy, stream
from sonicvacuum_blind.plan import Plan
from sonicvacuum_blind.prediction import predict
from sonicvacuum_blind.record import as_record
from sonicvacuum_blind.slips import ALONE, CLOCK, SLIPS, TOO_MUCH, Bench, Place, Slip, applies
from sonicvacuum_blind.systematics import Smooth

SEED = 20064
# Kind of design and hidden effect of each set-up; the effects are of several classes.
SETUPS = (
    ("traces", "kuwabara-kono"),
    ("traces", "sensor-droop"),
    ("traces", "viscous-drag"),
    ("varied", "wall-compliance"),
    ("traces", "contact-exponent"),
)
# As strong as losses in real chains are; what is weaker is the other studies' subject.
D_PRIME = 30.0
# Beside systematic errors: a seed of its own, drawn after commit 5c5e349; effects that stand out of them.
SMOOTH_SEED, SMOOTH_D_PRIME = 55_302_817, 100.0
# Of one run alone: drawn after commit c3204fd, which searched them.
ALONE_SEEDS = (14_380_337, 18_719_645, 99_378_064)


@dataclass(frozen=True)
class SlipCase:
    """One record: a set-up, an effect or none, a slip or none ("sound").

    Attributes:
        id: name of the record's folder; it says nothing of what is inside.
        slip: key of `slips.SLIPS`.
        setup: place in `SETUPS`.
        effect: hidden, "" for none.
        size: of the systematic error, as a share of the peak; 0 for none.
        alone: seed of the list of slips of one run alone; 0 for another list.
    """

    id: str
    slip: str
    setup: int
    effect: str
    size: float = 0.0
    alone: int = 0

    @property
    def seed(self) -> int:
        """Of the list that it is from."""
        return self.alone or (SMOOTH_SEED if self.size else SEED)

    @property
    def spec(self) -> Spec:
        """The case of the hidden effect that the slip is made in."""
        kind, names = ("single", (self.effect,)) if self.effect else ("null", ())
        strong = SMOOTH_D_PRIME if self.size else D_PRIME
        design, strength = SETUPS[self.setup][0], strong if self.effect else 0.0
        return Spec(self.id, kind, design, "white", names, strength, self.seed, self.setup)


def cases(smooth: bool = False) -> list[SlipCase]:
    """All cases, or those `smooth`, beside systematic errors of one size after the other; the order tells
    nothing.
    """
    usual = [s for s in SLIPS if s not in ALONE]
    rows = [(s, k, e) for k, (_, name) in enumerate(SETUPS) for e in ("", name) for s in usual]
    seed, sizes = (SMOOTH_SEED, SIZES) if smooth else (SEED, (0.0,))
    order = np.random.default_rng(np.random.SeedSequence(seed)).permutation(len(rows))
    return [SlipCase(f"slips-{n:04d}", *rows[i], sizes[n % len(sizes)]) for n, i in enumerate(order.tolist())]


def alone() -> list[SlipCase]:
    """Cases of one run that is triggered or struck otherwise than the others, each list of its own seed."""
    rows = [(s, k, e) for k, (_, name) in enumerate(SETUPS) for e in ("", name) for s in ALONE]
    every = [(*row, 0.0, seed) for seed in ALONE_SEEDS for row in rows]
    order = np.random.default_rng(np.random.SeedSequence(ALONE_SEEDS[0])).permutation(len(every))
    return [SlipCase(f"slips-{n:04d}", *every[i]) for n, i in enumerate(order.tolist())]


@lru_cache(maxsize=len(SETUPS) * 2)
def _of_spec(spec: Spec) -> Laboratory:
    return laboratory(spec)


def _laboratory(case: SlipCase) -> Laboratory:
    """The set-up, the same for all slips that are made in it."""
    return _of_spec(replace(case, id="").spec)


def possible(case: SlipCase) -> bool:
    """Whether the set-up has the gauges and runs that the slip needs."""
    design = _laboratory(case).design
    return applies(SLIPS[case.slip], design.reference, len(design.runs))


def make(case: SlipCase) -> tuple[records.Record, dict]:
    """The record with its slip, and the truth; the same case gives the same record, bit for bit."""
    own, slip = _laboratory(case), SLIPS[case.slip]
    design = own.design

    def truly(plan):
        # The slip first: an effect at the last contact is at that of the chain as it truly is.
        return own.case.change(slip.plan(plan) if slip.plan else plan)

    clean = predict(design, truly, own.errors, TOLERANCE)
    # The noise is the set-up's own, whatever the slip: records of one set-up differ in the slip alone.
    traces, _ = noisy(
        design, clean.traces + _off(case, clean, design), "white", 0.0, stream(case.spec, "noise")
    )
    sound = as_record(design, traces, clean.scalars, title=f"Data set {case.id}")
    pulse = 5e6 * design.reference.contact_time
    made, place = slip.written(Bench(sound, pulse, _random(case)))
    truth = {
        "format": 1,
        "id": case.id,
        "slip": slip.id,
        "setup": case.setup,
        "size": case.size,
        "run": place.run,
        "sensor": place.sensor,
        "effects": [case.effect] if case.effect else [],
        "d_prime": _d_prime(own, slip, place),
        "d_prime_effect": max((h.d_prime for h in own.case.hidden), default=0.0),
    }
    return replace(made, name=case.id), truth


def _off(case, clean, design):
    """The systematic error of traces, of each record its own."""
    if not case.size:
        return 0.0
    key = (int(case.id.removeprefix("slips-")), 9)
    random = np.random.default_rng(np.random.SeedSequence(case.seed, spawn_key=key))
    length = math.exp(random.uniform(*np.log(LENGTHS)))
    return Smooth(clean.traces, np.array([run.speed for run in design.runs]), case.size, length).drawn(random)


def _random(case):
    """Choices of one slip: of its kind and set-up, so that it is the same with an effect and without."""
    key = (case.setup, list(SLIPS).index(case.slip), 1)
    return np.random.default_rng(np.random.SeedSequence(case.seed, spawn_key=key))


def _d_prime(own: Laboratory, slip: Slip, place: Place) -> float | None:
    """d′ of a slip: refitted where something truly was otherwise, linear where it acts like an error of the
    record.
    """
    frame = own.case.frame
    truly = _as_slow if slip.id == "clock" else slip.plan
    if truly:
        return frame.fit(truly).size
    if slip.id not in _LIKE_ERRORS:
        return None
    return float(np.linalg.norm(frame.seen(_LIKE_ERRORS[slip.id](frame, place))))


def _as_slow(plan: Plan) -> Plan:
    """The chain that does in its own time what a recorder whose times are too long shows: forces are the same
    with times λ if masses are λ², speeds 1/λ.
    """
    heavy = {"bead_mass": plan.bead_mass * CLOCK**2, "striker_mass": plan.striker_mass * CLOCK**2}
    return replace(plan, speed=plan.speed / CLOCK, gravity=plan.gravity / CLOCK**2, **heavy)


def _like_speed(frame, place):
    run = int(place.run.removeprefix("r")) - 1
    return frame.slopes[:, run] * np.log(TOO_MUCH) / frame.design.speed_sigma


_LIKE_ERRORS = {
    "run-off": _like_speed,
    # The noise grows with the reading.
    "gain-common": lambda frame, _place: (1.0 - 1.0 / TOO_MUCH) * frame.base,
}


@one_thread
def write(case: SlipCase, records_folder, truth_folder) -> None:
    """Make a record, and keep it and its truth; see `hide.keep`."""
    keep(case.id, *make(case), records_folder, truth_folder)
