"""Verdicts on records with slips against what was done to them: a row for each record, and shares of them."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from sonicvacuum_blind.score import LIKELY, UNKNOWN, SummaryLine, cases, confidently, load, whole
from sonicvacuum_blind.shares import counted_of, quantile
from sonicvacuum_blind.slips import SLIPS
from sonicvacuum_blind.stated import of_named

# A slip that the record's own errors explain up to this d′ cannot be told from them.
PLAIN = 10.0
CURE = "give truths of sonicvacuum blind slips, and verdicts of discover on their records"


@dataclass(frozen=True)
class SlipRow:
    """One record. Truths: 1 or 0.

    Attributes:
        id, setup, slip, effect: what was made; `effect` is hidden besides, "" for none.
        place: run and gauges of the slip, "" where it concerns all.
        d_prime: of a slip that changes what truly happened; NaN for the others, which are plain.
        named: verdict, joined by `+`.
        confidence: probability of what is named.
        faults: each with its place and probability.
        slip_named: with its place, at least as likely as not; or an effect that is the slip in other words.
        slip_listed: the same at any probability.
        wrong_slip: another slip is held likelier than not, and not the one that was made.
        confident_wrong: an effect was named that is not there, with probability 0.9 or more and no word of
            unknown.
        effect_named: the hidden effect is among what is named.
        seconds: of the verdict.
    """

    id: str
    setup: int
    slip: str
    effect: str
    place: str
    d_prime: float
    named: str
    confidence: float
    faults: str
    slip_named: int
    slip_listed: int
    wrong_slip: int
    confident_wrong: int
    effect_named: int
    seconds: float

    @property
    def plain(self) -> bool:
        """Whether the data can show the slip."""
        return self.slip != "sound" and not self.d_prime < PLAIN


def score(truth_folder, verdict_folder, partly: bool = False) -> list[SlipRow]:
    """Rows of all cases below a folder of truths, by slip, set-up and effect.

    Args:
        truth_folder: of truths.
        verdict_folder: of verdicts.
        partly: leave out cases that have no verdict yet.

    Raises:
        InputError: where a case has no verdict, or its truth is not one of slips.
    """
    rows, order = [], list(SLIPS)
    for truth, verdict in cases(truth_folder, verdict_folder, partly):
        with whole(f"{verdict} (truth: {truth})", CURE):
            rows.append(row(load(truth), load(verdict)))
    return sorted(rows, key=lambda r: (order.index(r.slip), r.setup, r.effect))


def row(truth: dict, verdict: dict) -> SlipRow:
    """One case.

    Raises:
        KeyError, TypeError, ValueError: where truth or verdict is not whole.
    """
    if truth["slip"] not in SLIPS:
        raise ValueError(f"slip {truth['slip']!r} is not one of {', '.join(SLIPS)}")
    slip, named, effects = SLIPS[truth["slip"]], verdict["named"], truth["effects"]
    own = [f for f in verdict["faults"] if f["fault"] in slip.faults and _at(f, truth)]
    called = any(name in slip.effects for name in named)
    likely = [f for f in verdict["faults"] if f["probability"] >= LIKELY]
    wrong = [n for n in named if n not in (UNKNOWN, *effects, *slip.effects)]
    is_named = called or any(f in own for f in likely)
    return SlipRow(
        id=truth["id"],
        setup=int(truth["setup"]),
        slip=slip.id,
        effect="+".join(effects),
        place=" ".join(filter(None, [truth["run"], *(truth["sensor"] or [])])),
        d_prime=math.nan if truth["d_prime"] is None else float(truth["d_prime"]),
        named="+".join(named),
        confidence=of_named(verdict),
        faults="; ".join(map(_format_fault, verdict["faults"])),
        slip_named=int(is_named),
        slip_listed=int(called or bool(own)),
        wrong_slip=int(bool(likely) and not is_named),
        confident_wrong=int(UNKNOWN not in named and confidently(verdict["probabilities"], wrong)),
        effect_named=int(bool(effects) and set(effects) <= set(named)),
        seconds=float(verdict["timing_s"]["total"]),
    )


def _at(fault, truth):
    """Whether a fault is where the slip was made; slips of all gauges or runs may be found in some."""
    sensors = fault["sensor"] if isinstance(fault["sensor"], list) else [fault["sensor"]]
    run = truth["run"] is None or fault["run"] == truth["run"]
    return run and (truth["sensor"] is None or set(sensors) == set(truth["sensor"]))


def _format_fault(fault):
    sensors = fault["sensor"] if isinstance(fault["sensor"], list) else [fault["sensor"]]
    where = " ".join(filter(None, [fault["run"], *sensors]))
    return f"{fault['fault']}{where and f' ({where})'} {fault['probability']:.3f}"


def summary(rows: Iterable[SlipRow]) -> list[SummaryLine]:
    """Shares with their 95 % intervals: over all slips, of each kind, of sound records; seconds."""
    rows = list(rows)
    slipped, sound = [r for r in rows if r.slip != "sound"], [r for r in rows if r.slip == "sound"]
    plain = [r for r in slipped if r.plain]
    hidden = [r for r in plain if r.effect and SLIPS[r.slip].correctable]
    return [
        counted_of("slip named", "that the data can show", plain, "slip_named", ">= 0.8"),
        counted_of("slip named", "all", slipped, "slip_named"),
        counted_of("another slip named", "all", slipped, "wrong_slip"),
        counted_of("confident wrong effect", "all", slipped, "confident_wrong", "<= 0.01"),
        counted_of("true effect named", "slip that can be put right", hidden, "effect_named", ">= 0.8"),
        counted_of("true effect named", "no slip", [r for r in sound if r.effect], "effect_named"),
        counted_of("slip named", "no slip", sound, "wrong_slip"),
        counted_of("confident wrong effect", "no slip", sound, "confident_wrong"),
        *(counted_of("slip named", s, [r for r in plain if r.slip == s], "slip_named") for s in SLIPS),
        _seconds(rows, "median", 0.5),
        _seconds(rows, "90th percentile", 0.9),
    ]


def _seconds(rows, group, level):
    return SummaryLine("seconds per record", group, *quantile([r.seconds for r in rows], level))
