"""Studies: which cases are made, each with its own seed, and their list as CSV.

A study is a fixed list: case k of a study of one seed is the same whatever else is made, on any machine.
"""

import re
from collections.abc import Iterable
from dataclasses import asdict, fields
from functools import cache

import numpy as np

from sonicvacuum.files import InputError
from sonicvacuum.tables import read_numbered, write_csv
from sonicvacuum_blind import catalogue, foreign
from sonicvacuum_blind.hide import Spec

# The seed of the full study was drawn after its method was fixed: git tag and commit. Seeds of the studies
# before, and the commit that keeps the tables of the last of them.
TAG, METHOD = "study-11", "47e12f4"
BEFORE = (
    20_062, 88_822_325, 21_976_860, 16_372_354, 4_176_103, 95_641_188, 77_886_124, 58_825_997, 95_771_918,
)  # fmt: skip
KEPT_BEFORE = "7f214b2"
# The list once more, "again", of which commit 92f947a searched a part: drawn after that commit.
# Empty records alone, "nulls": drawn after commit a00f2f7, which searched them (docs/study.md); effects
# beside something from outside the catalogue, "beside": after d211601, which knew such records from
# "beside-training" and searched them.
SEEDS = {
    "small": 20061,
    "full": 33_744_973,
    "nulls": 97_583_300,
    "again": 84_131_661,
    "training": 20063,
    "laws": 60_524_133,
    "beside": 65_059_155,
    "beside-training": 71_460_911,
}
TRAINING = 300
# Places in the list of the small study that are left out, so that `make` takes minutes; the others keep the
# numbers and the records that they had among 36.
LEFT_OUT = {"small": {5, 6, 7, 9, 19, 20, 29, 30, 31, 34, 35}}
# Single effects in traces of several speeds: d′ → records of each effect.
STRENGTHS = {3.0: 4, 5.0: 5, 7.5: 5, 10.0: 5, 20.0: 5, 50.0: 3, 150.0: 2, 500.0: 2}
# What the best of the catalogue leaves of effects from outside, in d′.
OUTSIDE = (8.0, 12.0, 20.0, 60.0)
# Other designs than that and one ball: any set-up, one speed, no traces.
ELSEWHERE = ("varied", "one-speed", "scalars")
# Records with nothing hidden: design, noise, how many.
NULLS = (
    ("traces", "white", 180),
    ("traces", "ar1", 300),
    ("traces", "quantised", 40),
    ("varied", "white", 40),
    ("one-speed", "white", 40),
    ("scalars", "white", 40),
    ("ball", "white", 20),
)
# Of empty records alone as many that one false name in 250, of all together, would be seen to be less than
# the one in a hundred that is allowed; the full study has them besides.
ALONE = (
    ("traces", "white", 340),
    ("varied", "white", 80),
    ("one-speed", "white", 80),
    ("scalars", "white", 80),
    ("ball", "white", 20),
    ("traces", "ar1", 440),
    ("varied", "ar1", 80),
    ("one-speed", "ar1", 80),
    ("traces", "quantised", 240),
    ("varied", "quantised", 80),
    ("one-speed", "quantised", 80),
)
# What the full study has of strong effects besides, so that a share near one is seen to be at least 0.97 of
# an ideal rule's: a hundred records that are all right tell that, twenty do not. The same of each effect.
STRONG = {50.0: 5, 150.0: 4, 500.0: 3}
STRONG_ELSEWHERE = 4
STRONG_PAIRS = 90
# Several effects: design, d′ of each, how many effects, how many records.
TOGETHER = (
    ("traces", 10.0, 2, 60),
    ("traces", 20.0, 2, 60),
    ("traces", 50.0, 2, 20),
    ("varied", 20.0, 2, 20),
    ("one-speed", 20.0, 2, 20),
    ("scalars", 20.0, 2, 20),
    ("ball", 20.0, 2, 10),
    ("traces", 20.0, 3, 16),
    ("varied", 20.0, 3, 8),
    ("one-speed", 20.0, 3, 8),
    ("scalars", 20.0, 3, 8),
)
# Effects that act on one ball; gauges and beads do not exist there.
BALL = (
    "dynamic-modulus",
    "contact-exponent",
    "plastic-contact",
    "linear-dashpot",
    "kuwabara-kono",
    "tsuji",
    "hunt-crossley",
    "velocity-power",
    "relaxing-contact",
    "striker-error",
)
# What acts on it besides; in what the full study adds to the main list, so that its cases stay those of
# other seeds.
ON_BALL_BESIDES = "wall-compliance"


def cases(study: str) -> list[Spec]:
    """The cases of a study, a key of `SEEDS`.

    The training study takes cases evenly out of a list like the main part of the full one, with seeds of its
    own: what is calibrated on it has seen nothing of the full study.

    Raises:
        ValueError: for another name.
    """
    if study not in SEEDS:
        raise ValueError(f"study {study!r} is not one of {', '.join(SEEDS)}")
    rows, _, order = _listed(study)
    left_out = LEFT_OUT.get(study, set())
    return [
        Spec(f"{study}-{k:04d}", *rows[i], seed=SEEDS[study], place=k)
        for k, i in enumerate(order)
        if i not in left_out
    ]


@cache
def added(seed: int) -> frozenset[int]:
    """Places of the cases that the study of a seed has besides its main list, in no fixed share of it: they
    count where a group of like cases is told of, and not where all are added up.
    """
    studies = [study for study, own in SEEDS.items() if own == seed]
    if not studies:
        return frozenset()
    _, main, order = _listed(studies[0])
    return frozenset(k for k, i in enumerate(order) if i >= main)


def _listed(study):
    """Rows of a study's list, how many of the first are its main part, and the order in which they stand."""
    random = np.random.default_rng(np.random.SeedSequence(SEEDS[study]))
    lists = {"small": _small, "laws": _laws, "nulls": lambda: _empty(ALONE)}
    lists |= dict.fromkeys(("beside", "beside-training"), lambda: _beside(random))
    rows = list(lists.get(study, lambda: _full(random))())
    if study == "training":
        rows = [rows[(2 * k + 1) * len(rows) // (2 * TRAINING)] for k in range(TRAINING)]
    main = len(rows)
    if study == "full":
        rows += _besides(random)
    # Folder names must not follow the order of kinds.
    return rows, main, random.permutation(len(rows)).tolist()


def _small():
    """36 cases: 18 singles over all designs, 8 nulls, 6 foreign ones, 4 pairs; see `LEFT_OUT`."""
    singles = ("kuwabara-kono", "viscous-drag", "coating-thickness", "contact-gap", "sensor-droop", "gravity")
    singles += ("dynamic-modulus", "plastic-contact", "wall-compliance", "sensor-offset", "mass-defect")
    for k, name in enumerate(singles):
        yield "single", "traces", "white", (name,), (10.0, 20.0)[k % 2]
    for name in ("contact-exponent", "hunt-crossley", "guide-friction"):
        yield "single", "traces", "quantised", (name,), 15.0
    yield "single", "one-speed", "white", ("sensor-lowpass",), 10.0
    yield "single", "one-speed", "white", ("relaxing-contact",), 20.0
    yield "single", "scalars", "white", ("striker-error",), 10.0
    yield "single", "ball", "white", ("hunt-crossley",), 20.0
    for noise in ("white", "white", "white", "ar1", "quantised"):
        yield "null", "traces", noise, (), 0.0
    for kind in ("one-speed", "scalars", "ball"):
        yield "null", kind, "white", (), 0.0
    names = ("graded-modulus", "dimer", "sensor-saturation", "two-defects", "resonant-wall", "quadratic-drag")
    for name in names:
        yield "foreign", "traces", "white", (name,), 12.0
    for pair in (
        ("kuwabara-kono", "sensor-gain"),
        ("dynamic-modulus", "viscous-drag"),
        ("wall-compliance", "sensor-droop"),
        ("mass-defect", "tsuji"),
    ):
        yield "pair", "traces", "white", pair, 20.0


def _laws():
    """Contact laws from outside the catalogue, each at three strengths."""
    for name in foreign.LAWS:
        for strength in (30.0, 100.0, 300.0):
            for _ in range(2):
                yield "foreign", "traces", "white", (name,), strength


def _beside(random):
    """An effect of the catalogue and one from outside, as strong as each other."""
    for name in foreign.STUDIED:
        for strength in OUTSIDE:
            for effect in random.choice(catalogue.STUDIED, 3, replace=False):
                yield "beside", "traces", "white", (str(effect), name), strength


def _empty(counts):
    """Records in which nothing is hidden."""
    for kind, noise, count in counts:
        for _ in range(count):
            yield "null", kind, noise, (), 0.0


def _full(random):
    """Strengths, noise kinds and designs in fixed shares; pairs and sets drawn."""
    ids = catalogue.STUDIED
    noises = ("white", "white", "white", "ar1", "quantised")
    for name in ids:
        for strength, count in STRENGTHS.items():
            for k in range(count):
                yield "single", "traces", noises[k % 5], (name,), strength
        for kind in ELSEWHERE:
            for strength in (10.0, 10.0, 10.0, 40.0):
                yield "single", kind, "white", (name,), strength
    for name in BALL:
        for strength in (10.0, 10.0, 10.0, 40.0):
            yield "single", "ball", "white", (name,), strength
    yield from _empty(NULLS)
    for name in foreign.STUDIED:
        for strength in OUTSIDE:
            for _ in range(3):
                yield "foreign", "traces", "white", (name,), strength
    for kind, strength, size, count in TOGETHER:
        among = BALL if kind == "ball" else ids
        for _ in range(count):
            chosen = random.choice(len(among), size, replace=False)
            yield "pair" if size == 2 else "set", kind, "white", tuple(among[i] for i in chosen), strength


def _besides(random):
    """Cases of which the main list has too few to tell whether a goal is met."""
    ids = catalogue.STUDIED
    yield from _empty(ALONE)
    for name in ids:
        for strength, count in STRONG.items():
            for _ in range(count):
                yield "single", "traces", "white", (name,), strength
        for kind in ELSEWHERE:
            for _ in range(STRONG_ELSEWHERE):
                yield "single", kind, "white", (name,), 40.0
    for name in (*BALL, ON_BALL_BESIDES):
        # As often as the others in the main list, and all of them as often as elsewhere.
        strengths = (10.0, 10.0, 10.0, 40.0) if name == ON_BALL_BESIDES else ()
        for strength in (*strengths, *[40.0] * STRONG_ELSEWHERE):
            yield "single", "ball", "white", (name,), strength
    for _ in range(STRONG_PAIRS):
        chosen = random.choice(len(ids), 2, replace=False)
        yield "pair", "traces", "white", tuple(ids[i] for i in chosen), 50.0


def write_cases(specs: Iterable[Spec], path) -> None:
    """The list of cases as CSV; effects joined by `+`."""
    cells = ((asdict(spec) | {"effects": "+".join(spec.effects)}).values() for spec in specs)
    write_csv(path, [f.name for f in fields(Spec)], cells)


def read_cases(path) -> list[Spec]:
    """The cases of a CSV file.

    Raises:
        InputError: naming file and line of what is wrong.
    """
    names = [f.name for f in fields(Spec)]
    rows = read_numbered(path, f"write {','.join(names)} and one line for each case", names)
    seen: dict[str, int] = {}
    for line, row in rows:
        _check_id(row["id"], seen.setdefault(row["id"].lower(), line), path, line)
    return [_spec(row, path, line) for line, row in rows]


def _check_id(name, first, path, line):
    """Ids become folders: none outside of those that are written, and no two of them one."""
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_.+-]{,99}", name):
        raise InputError(
            f"{path}, line {line}: id is {name!r}; a folder is called so: use letters, digits and _ . + -"
        )
    if first != line:
        raise InputError(f"{path}, line {line}: id {name} stands in line {first} already; rename one")


def _spec(row, path, line):
    try:
        numbers = {"d_prime": float(row["d_prime"]), "seed": int(row["seed"]), "place": int(row["place"])}
        effects = tuple(row["effects"].split("+")) if row["effects"] else ()
        return Spec(**{**row, **numbers, "effects": effects})
    except (ValueError, TypeError) as error:
        raise InputError(f"{path}, line {line}: {error}") from None


def batch(specs: list[Spec], place: int, of: int) -> list[Spec]:
    """Every `of`-th case from `place` (counted from 0) on: batches of like cost."""
    if not 0 <= place < of:
        raise ValueError(f"batch {place} of {of} does not exist")
    return specs[place::of]


def chosen(study: str | None, path, place: int, of: int) -> list[Spec]:
    """A batch of a study, or of a list of cases; InputError unless one of the two is given."""
    if (study is None) == (path is None):
        raise InputError("give --study or --cases, one of them")
    return batch(cases(study) if study else read_cases(path), place, of)
