"""Hide an effect in a record: draw the record's design, what is hidden, every error and the noise; write both
sides.

The record goes to one folder, the truth to another; nothing in the record says what is hidden in it.
"""

import itertools
import json
import math
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import numpy as np

from sonicvacuum import records
from sonicvacuum.blas import one_thread
from sonicvacuum.files import replacing
from sonicvacuum_blind import TRUTH, catalogue, design, foreign
from sonicvacuum_blind.design import Design
from sonicvacuum_blind.integrate import NoSolution
from sonicvacuum_blind.prediction import Errors, predict
from sonicvacuum_blind.record import as_record
from sonicvacuum_blind.signature import Frame
from sonicvacuum_blind.strength import Rival, leftover, nearest, rivals, scale

KINDS = ("null", "single", "pair", "set", "foreign", "beside")
# How many effects each hides.
NUMBERS = {"null": (0,), "single": (1,), "pair": (2,), "set": (3, 4), "foreign": (1,), "beside": (2,)}
NOISES = ("white", "ar1", "quantised")
# Error of the integrator for the data themselves: 1e-7 of a peak.
TOLERANCE = 1e-9
# A design in which the effect cannot reach this share of the wanted d′ is drawn anew, so often at most.
ENOUGH, TRIES = 0.9, 12
# Designs drawn in search of one in which the effects can act at all.
DRAWS = 200
CORRELATIONS = (0.2, 0.5, 0.8)
# Streams of random numbers by name, in the order in which they are spawned; new ones go to the end.
STREAMS = ("case", "errors", "noise", "rule", "further run", "choice")


@dataclass(frozen=True)
class Spec:
    """What is asked of one case.

    Attributes:
        id: name of the record's folder.
        kind: one of `KINDS`.
        design: one of `design.KINDS`.
        noise: one of `NOISES`.
        effects: ids of the catalogue (kind single: one, pair: two, set: three or four) or of `foreign` (one),
            or one of each (beside); none for null.
        d_prime: wanted d′ of each effect; for foreign ones, of what no single effect of the catalogue
            explains.
        seed: of the study, and the case's own place in it.
        place: of the case in the study.
    """

    id: str
    kind: str
    design: str
    noise: str
    effects: tuple[str, ...]
    d_prime: float
    seed: int
    place: int

    def __post_init__(self):
        for name, value, allowed in (
            ("kind", self.kind, KINDS),
            ("design", self.design, design.KINDS),
            ("noise", self.noise, NOISES),
        ):
            if value not in allowed:
                raise ValueError(f"case {self.id}: {name} is {value!r}; use one of {', '.join(allowed)}")
        wanted = NUMBERS[self.kind]
        if len(self.effects) not in wanted:
            number = " or ".join(map(str, wanted))
            raise ValueError(f"case {self.id}: kind {self.kind} hides {number} effects, got {self.effects}")
        for name in self.effects:
            known = foreign.BY_ID if name in self.outside else catalogue.BY_ID
            if name not in known:
                raise ValueError(f"case {self.id}: effect {name!r} is not one of {', '.join(known)}")
        if not 0.0 <= self.d_prime < math.inf:
            raise ValueError(f"case {self.id}: d_prime is {self.d_prime}; use a finite number from 0 on")
        for name, value in (("seed", self.seed), ("place", self.place)):
            if value < 0:
                raise ValueError(f"case {self.id}: {name} is {value}; use a whole number from 0 on")

    @property
    def outside(self) -> tuple[str, ...]:
        """The hidden effects that are none of the catalogue's."""
        return {"foreign": self.effects, "beside": self.effects[1:]}.get(self.kind, ())


@dataclass(frozen=True)
class Hidden:
    """One hidden effect as drawn and scaled."""

    id: str
    parameters: dict
    place: str | int | None
    place_kind: str | None
    change: object
    seen: np.ndarray
    d_prime: float


@dataclass(frozen=True)
class Case:
    """A record's design with what is hidden in it, and what the catalogue's effects do there (empty where
    nobody asked yet).
    """

    frame: Frame
    hidden: tuple[Hidden, ...]
    directions: tuple[Rival, ...]

    @property
    def change(self):
        """All hidden effects, one after the other."""

        def all_of(plan):
            for one in self.hidden:
                plan = one.change(plan)
            return plan

        return all_of


@dataclass(frozen=True)
class Laboratory:
    """Who measures a case: what is hidden there, and what is off with this record's strikers and gauges.

    Attributes:
        case: design and hidden effects.
        correlation: of the noise of neighbouring samples, where it is correlated.
        errors: of the record.
    """

    case: Case
    correlation: float
    errors: Errors

    @property
    def design(self) -> Design:
        """What the laboratory knows of its record."""
        return self.case.frame.design


def stream(spec: Spec, name: str) -> np.random.Generator:
    """One of the case's independent streams of random numbers, from its start."""
    seeds = np.random.SeedSequence(spec.seed, spawn_key=(spec.place,)).spawn(len(STREAMS))
    return np.random.default_rng(seeds[STREAMS.index(name)])


def laboratory(spec: Spec) -> Laboratory:
    """The laboratory of a case, the same whenever it is asked for.

    Raises:
        ValueError: where no drawn design lets the effects act.
    """
    case, correlation = _case(spec, stream(spec, "case"))
    return Laboratory(case, correlation, drawn_errors(case.frame.design, stream(spec, "errors")))


def hide(spec: Spec) -> tuple[records.Record, dict]:
    """A record with something hidden in it, and the truth.

    The same spec gives the same record, bit for bit: every draw comes from
    `SeedSequence(seed, spawn_key=(place,))`.

    Raises:
        ValueError: where no drawn design lets the effects act.
    """
    own, noise_random = laboratory(spec), stream(spec, "noise")
    made = own.design
    clean = predict(made, own.case.change, own.errors, TOLERANCE)
    traces, noise = noisy(made, clean.traces, spec.noise, own.correlation, noise_random)
    sigmas = np.array([s.sigma for s in made.scalars], dtype=float)
    scalars = clean.scalars + sigmas * noise_random.standard_normal(len(sigmas))
    # The folder's name says nothing of what is inside; neither does the title.
    record = as_record(made, traces, scalars, title=f"Data set {spec.id}")
    return record, _truth(spec, own.case, own.errors, noise)


@one_thread
def write(spec: Spec, records_folder, truth_folder) -> None:
    """Hide, and keep what was made; see `keep`."""
    keep(spec.id, *hide(spec), records_folder, truth_folder)


def keep(name: str, record: records.Record, truth: dict, records_folder, truth_folder) -> None:
    """Write `truth_folder/<name>/truth.json`, and after it `records_folder/<name>/`.

    In this order: a record that stands without its truth was not made here.
    """
    with replacing(Path(truth_folder) / name / TRUTH) as stream:
        json.dump(truth, stream, indent=1, sort_keys=True)
        stream.write("\n")
    records.write(record, Path(records_folder) / name)


def _case(spec, random):
    """A design in which all effects reach the wanted d′; the best of the designs tried otherwise."""
    best, reached = None, -1.0
    correlation = float(random.choice(CORRELATIONS)) if spec.noise == "ar1" else 0.0
    drawn = (design.draw(spec.design, random) for _ in range(DRAWS))
    able = (d for d in drawn if all(_entry(spec, name).acts(d.reference, d.coated) for name in spec.effects))
    for made in itertools.islice(able, TRIES):
        try:
            case, least = _with_effects(spec, made, correlation, random)
        except NoSolution:
            # So much of the effect cannot be had here: an error that is stated as uncertain takes its place.
            continue
        if not _measurable(spec, case):
            continue
        if least > reached:
            best, reached = case, least
        if least >= ENOUGH * spec.d_prime:
            break
    if best is None:
        raise ValueError(
            f"case {spec.id}: {', '.join(spec.effects)} cannot act in designs {spec.design}; give another"
        )
    return best, correlation


def _measurable(spec, case):
    """Whether the laboratory would write its numbers down: not a speed of pulses found in the wrong order."""
    made = case.frame.design
    if not made.scalars:
        return True
    errors = drawn_errors(made, stream(spec, "errors"))
    return bool(np.all(predict(made, case.change, errors, TOLERANCE).scalars > 0.0))


def _with_effects(spec, made, correlation, random):
    """A design with the wanted effects in it, and the least d′ that one of them reaches."""
    frame = Frame.of(made, correlation)
    directions = tuple(rivals(frame)) if spec.outside else ()
    # The strength of an effect outside the catalogue is what no single effect of the catalogue explains.
    measures = [partial(leftover, directions) if e in spec.outside else np.linalg.norm for e in spec.effects]
    hidden = tuple(
        _hidden(frame, _entry(spec, e), spec.d_prime, measure, random)
        for e, measure in zip(spec.effects, measures, strict=True)
    )
    reached = (measure(h.seen) for h, measure in zip(hidden, measures, strict=True))
    return Case(frame, hidden, directions), min(reached, default=np.inf)


def _entry(spec, name):
    return (foreign.BY_ID if name in spec.outside else catalogue.BY_ID)[name]


def _hidden(frame, entry, target, measure, random):
    reference = frame.design.reference
    sign = int(random.choice(entry.signs))
    shape = entry.draw(random, reference)
    places = _visible(frame, entry)
    place = places[int(random.integers(len(places)))]
    found = scale(frame, entry, target, sign, shape, place, measure)
    parameters = entry.values(sign * found.strength, reference, shape)
    return Hidden(
        entry.id,
        {k: float(v) for k, v in parameters.items()},
        place,
        entry.places,
        catalogue.hidden(entry, sign * found.strength, shape, place, reference),
        found.seen,
        float(np.linalg.norm(found.seen)),
    )


def _visible(frame, entry):
    """Places that some gauge can see before the record ends: not next to the striker only."""
    places = entry.where(frame.design.reference)
    if entry.places in ("bead", "contact"):
        return tuple(p for p in places if 3 <= p <= frame.design.reference.beads - 1)
    return places


def drawn_errors(made: Design, random: np.random.Generator) -> Errors:
    """Errors of one standard deviation each, cut at 2.5."""
    size = len(Errors.of(made).vector)
    return Errors.of(made, np.clip(random.standard_normal(size), -2.5, 2.5))


def noisy(made: Design, traces: np.ndarray, kind: str, correlation: float, random) -> tuple[np.ndarray, dict]:
    """Traces (runs, gauges, samples) in N with noise of the stated sigma, and what the noise was."""
    if not made.samples:
        return traces, {"kind": "none"}
    sigma = np.array(made.sigma)[:, None]
    fresh = random.standard_normal(traces.shape)
    if kind == "ar1":
        for k in range(1, traces.shape[-1]):
            fresh[..., k] = correlation * fresh[..., k - 1] + np.sqrt(1.0 - correlation**2) * fresh[..., k]
        return traces + sigma * fresh, {"kind": kind, "correlation": correlation}
    if kind == "quantised":
        steps = 2.0
        lsb = steps * sigma
        white = sigma * np.sqrt(1.0 - steps**2 / 12.0)
        return lsb * np.round((traces + white * fresh) / lsb), {"kind": kind, "lsb_sigma": steps}
    return traces + sigma * fresh, {"kind": kind}


def _truth(spec, case, errors, noise):
    frame, made = case.frame, case.frame.design
    # In the linear approximation, effects of a pair add up.
    seen = sum((h.seen for h in case.hidden), np.zeros(len(frame.base) + frame.slopes.shape[1]))
    directions = list(case.directions)
    if spec.kind in ("single", "pair"):
        # As large as what is hidden: strong rivals are not weak ones made larger.
        directions = rivals(frame, spec.d_prime)
        # Shapes and strengths of the catalogue's directions lie on a grid; what is hidden need not.
        directions += [Rival(h.id, h.place, h.seen / h.d_prime) for h in case.hidden]
    near = nearest(directions, seen, case.hidden[0].id) if directions else ("none", 0.0)
    return {
        "format": 1,
        **asdict(spec),
        "hidden": [
            {
                "id": h.id,
                "parameters": h.parameters,
                **({h.place_kind: h.place} if h.place_kind else {}),
                "d_prime": h.d_prime,
                "d_prime_flat": frame.flat(h.seen),
            }
            for h in case.hidden
        ],
        "d_prime_all": float(np.linalg.norm(seen)),
        "leftover_d_prime": leftover(directions, seen) if directions else 0.0,
        "nearest": {"id": near[0], "leaves_d_prime": near[1]},
        "runs": len(made.runs),
        "gauges": len(made.reference.gauges),
        "noise_drawn": noise,
        "errors_sigma": {
            "speeds": errors.speeds.tolist(),
            "modulus": errors.modulus,
            "gains": errors.gains.tolist(),
            "triggers": errors.triggers.tolist(),
        },
    }
