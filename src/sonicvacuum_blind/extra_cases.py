"""A study of what real records hold beside one effect: smooth systematic errors, and three or four effects.

Nulls and singles have smooth systematic errors of 0.3 to 3 % of the peak; sets have none, each of their
effects d′ 20. The list is shuffled: any first part of it is a fair sample.
"""

import math
from dataclasses import dataclass

import numpy as np

from sonicvacuum import records
from sonicvacuum.blas import one_thread
from sonicvacuum_blind.catalogue import STUDIED
from sonicvacuum_blind.hide import TOLERANCE, Laboratory, Spec, keep, laboratory, noisy, stream
from sonicvacuum_blind.prediction import predict
from sonicvacuum_blind.record import as_record
from sonicvacuum_blind.strength import Rival, rivals
from sonicvacuum_blind.systematics import Smooth

SEED = 549_454_550
SIZES = (0.003, 0.01, 0.03)
STRENGTHS = (20.0, 50.0, 150.0, 500.0)
NULLS, SETS, OF_EACH = 11, 20, 20.0
# Correlation time in widths of the pulse, equally likely in the logarithm.
LENGTHS = (0.4, 1.2)


@dataclass(frozen=True)
class ExtraCase:
    """One record: what is hidden in it, and the systematic error's size as a share of the peak (0: none)."""

    spec: Spec
    size: float

    @property
    def id(self) -> str:
        """Name of the record's folder; it says nothing of what is inside."""
        return self.spec.id


def cases(seed: int = SEED) -> list[ExtraCase]:
    """All cases of a seed; the order tells nothing."""
    random = np.random.default_rng(np.random.SeedSequence(seed))
    rows = [("null", (), 0.0, size) for size in SIZES for _ in range(NULLS)]
    for k, name in enumerate(STUDIED):
        rows += [("single", (name,), STRENGTHS[(k + j) % 4], size) for j, size in enumerate(SIZES)]
    for count in (3, 4):
        for _ in range(SETS):
            chosen = sorted(random.choice(len(STUDIED), count, replace=False).tolist())
            rows.append(("set", tuple(STUDIED[i] for i in chosen), OF_EACH, 0.0))
    order = random.permutation(len(rows)).tolist()
    return [_case(seed, place, *rows[i]) for place, i in enumerate(order)]


def _case(seed, place, kind, effects, strength, size):
    return ExtraCase(
        Spec(f"extras-{place:04d}", kind, "traces", "white", effects, strength, seed, place), size
    )


def make(case: ExtraCase) -> tuple[records.Record, dict]:
    """The record and its truth; the same case gives the same record, bit for bit.

    Raises:
        ValueError: where no drawn design lets the effects act.
    """
    own, random = laboratory(case.spec), stream(case.spec, "further run")
    design = own.design
    clean = predict(design, own.case.change, own.errors, TOLERANCE)
    length = math.exp(random.uniform(*np.log(LENGTHS)))
    smooth = Smooth(clean.traces, np.array([run.speed for run in design.runs]), case.size, length)
    off = smooth.drawn(random) if case.size else np.zeros(clean.traces.shape)
    traces, _ = noisy(design, clean.traces + off, "white", 0.0, stream(case.spec, "noise"))
    record = as_record(design, traces, clean.scalars, title=f"Data set {case.id}")
    return record, _truth(case, own, smooth, off)


def _truth(case, own: Laboratory, smooth: Smooth, off):
    frame, hidden = own.case.frame, own.case.hidden
    sigma = np.array(own.design.sigma)
    rest = frame.seen((off / sigma[None, :, None]).ravel())
    slopes, whole = frame.slopes, sum((h.seen for h in hidden), np.zeros(sum(frame.slopes.shape)))
    return {
        "format": 1,
        "id": case.id,
        "kind": case.spec.kind,
        "effects": list(case.spec.effects),
        "size": case.size,
        "length_widths": smooth.length,
        "d_prime": case.spec.d_prime,
        "d_prime_hidden": [h.d_prime for h in hidden],
        "parameters": [h.parameters for h in hidden],
        "d_prime_systematic": float(np.linalg.norm(rest)),
        "d_prime_beside": smooth.seen(whole[: len(frame.base)], slopes, sigma) if case.size else None,
        "d_prime_exchanged": _exchanged(own) if len(hidden) > 1 else None,
        "chi2_systematic": float(np.square(rest[: len(frame.base)]).mean()),
        "data": len(frame.base),
    }


def _exchanged(own: Laboratory) -> float:
    """The least d′ that is left of a set if one of its effects is taken away or exchanged for any other one.

    To first order, as rivals of the other studies are: below some three, no rule can tell the set.
    """
    hidden, frame = own.case.hidden, own.case.frame
    whole = sum(h.seen for h in hidden)
    others = [r for r in rivals(frame, OF_EACH) if r.id not in {h.id for h in hidden}]
    least = math.inf
    for h in hidden:
        kept = np.column_stack([one.seen for one in hidden if one is not h])
        basis = np.linalg.qr(kept)[0]
        rest = whole - basis @ (basis.T @ whole)
        least = min([least, float(np.linalg.norm(rest)), *(_beside(basis, rest, r) for r in others)])
    return least


def _beside(basis, rest, rival: Rival) -> float:
    """What is left of `rest` beside one rival of free strength of its own sign, its part in `basis` aside."""
    own = rival.direction - basis @ (basis.T @ rival.direction)
    share = max(0.0, float(own @ rest)) / max(float(own @ own), 1e-12)
    return float(np.linalg.norm(rest - share * own))


@one_thread
def write(case: ExtraCase, records_folder, truth_folder) -> None:
    """Make a record, and keep it and its truth; see `hide.keep`."""
    keep(case.id, *make(case), records_folder, truth_folder)
