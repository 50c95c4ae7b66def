"""The free-form contact law as the verdict tells it: its surface, the names that come nearest, a formula."""

import math

from msgspec import Struct

from sonicvacuum.discover.judge.law import Surface, formula, nearest, surface
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.search.free_law import FreeLaw
from sonicvacuum.effects.base import MICRO

# Distance from which a law is hardly nearer than the nominal one.
FAR = 0.8


class Near(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A contact law of the catalogue, and how far its best fit is from the free-form law: 0 is the same, 1 no
    better than the nominal law.
    """

    effect: str
    distance: float


class Law(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The free-form contact law that was fitted to what is left, between two beads.

    Attributes:
        depth_um: compressions.
        speed_m_s: rates of compression, positive while approaching.
        force_N: force by compression, then by rate.
        band_N: its standard error, likewise.
        visited: whether contacts were there, likewise.
        nearest: contact laws of the catalogue, nearest first.
        formula: short, of what is there besides the nominal force K δ^1.5.
        log10_bayes: against the model without it.
        closed: share of what was left that it closes on runs left out of its fit; null with one run.
    """

    depth_um: list[float]
    speed_m_s: list[float]
    force_N: list[list[float]]
    band_N: list[list[float]]
    visited: list[list[bool]]
    nearest: list[Near]
    formula: str
    log10_bayes: float
    closed: float | None


def told(law: FreeLaw, found: Investigation) -> Law:
    """The law as the verdict has it; `found` is the investigation that left something unexplained."""
    seen, size = surface(law), found.sizes
    before, after = (float((part - size).sum()) for part in (law.held_out_before, law.held_out))
    near = nearest(law, found.null, found.forward, found.candidates)
    return Law(
        depth_um=(seen.depth / MICRO).tolist(),
        speed_m_s=seen.rate.tolist(),
        force_N=seen.force.tolist(),
        band_N=seen.band.tolist(),
        visited=seen.visited.tolist(),
        nearest=[Near(effect=name, distance=far) for name, far in near[:5]],
        formula=formula(seen),
        log10_bayes=float(law.log_bayes) / math.log(10.0),
        closed=1.0 - after / before if len(size) > 1 else None,
    )


def reasons(law: Law) -> list[str]:
    """What is said of it, one line."""
    share = (
        ""
        if law.closed is None
        else f" closes {min(law.closed, 1.0):.0%} of what is left on runs left out of its fit and"
    )
    return [f"a free-form contact law{share} is in the model: {law.formula}{_nearest(law.nearest)}"]


def _nearest(names: list[Near]) -> str:
    """Which name comes nearest, or that none comes near."""
    if not names:
        return ""
    told = f"{names[0].effect}, distance {names[0].distance:.2f}"
    return f"; nearest name: {told}" if names[0].distance < FAR else f"; no name comes near ({told})"


def rows(seen: Surface):
    """Header and rows of the surface."""
    header = ["depth_um", "speed_m_s", "hertz_N", "force_N", "band_N", "visited"]
    return header, (
        (
            seen.depth[i] / MICRO, seen.rate[k], seen.hertz[i], seen.force[i, k], seen.band[i, k],
            int(seen.visited[i, k]),
        )
        for i in range(len(seen.depth))
        for k in range(len(seen.rate))
    )  # fmt: skip
