"""What a page says of the run that would settle a verdict: what to change, what that tells apart, and how far
beyond what was measured it lies.
"""

import math
import re
from collections.abc import Sequence

from sonicvacuum.discover.judge import explanations
from sonicvacuum.discover.verdict import Next, Verdict
from sonicvacuum.effects import CATALOGUE, Catalogue
from sonicvacuum.records import Record
from sonicvacuum.report.phrases import SURE, joined
from sonicvacuum.report.tables import number
from sonicvacuum.report.words import LEAST_RIVAL, LEAST_TOLD, effects_of, placed, plain

# χ² below which a run would hardly decide: three standard errors.
_LITTLE = 9.0


def told(
    verdict: Verdict, cells: list[dict], records: Sequence[Record] = (), catalogue: Catalogue = CATALOGUE
) -> str:
    """All that is said of a next run; "" where nothing is left to settle.

    Args:
        verdict: on the records.
        cells: rows of where.csv.
        records: what it is on, as far as kept.
        catalogue: knows the effects.
    """
    if settled(verdict):
        return ""
    proposal = verdict.next_experiment
    if proposal is None:
        return _none(verdict, any(c["sensor"] for c in cells), catalogue)
    text = _unforeseen(proposal, catalogue) if "unknown" in verdict.named else experiment(proposal, catalogue)
    return text + _beyond(proposal, verdict, records)


def settled(verdict: Verdict) -> bool:
    """Whether nothing is left that a further run would have to decide."""
    sure = (verdict.probability or 0.0) >= SURE[0][0]
    somewhere = verdict.next_experiment is not None and bool(verdict.next_experiment.places)
    return sure and not verdict.confusable and "unknown" not in verdict.named and not somewhere


def _none(verdict, traces, catalogue):
    """Why there is no proposal."""
    if not traces:
        return "No proposal: the gain of a further run is predicted for traces, and this record has none."
    found = effects_of(verdict)
    if not found or "unknown" in verdict.named:
        return "No proposal: no rivals are left to separate."
    own = set(found)
    odds = ((set(explanations.effects(name)), p) for name, p in verdict.probabilities.items())
    more = any(own < names and p >= LEAST_TOLD for names, p in odds)
    if verdict.probabilities.get("none", 0.0) >= LEAST_RIVAL:
        text = "No proposal: these data rule out every other effect that was fitted."
        return text + (
            " Whether it is that or a slip told above, the set-up tells: check it there, and measure again."
            if verdict.faults
            else " Whether it is there at all, more runs of the same kind would tell."
        )
    text = "No proposal: these data rule out every other explanation that was fitted."
    named = joined([plain(name, catalogue) for name in found])
    return text + (
        f" What is open is whether something small hides beside {named}: how large it could be stands above."
        if more
        else ""
    )


def experiment(proposal: Next, catalogue: Catalogue = CATALOGUE) -> str:
    """The experiment that would settle it."""
    text = (
        f"One more run {_steps(proposal)} would most likely leave one explanation alone: "
        f"{_two(proposal, catalogue)}, its nearest rival there, would differ by about {_errors(proposal)}."
    )
    return text + (" That would hardly decide." if proposal.delta_chi2 < _LITTLE else "")


def _unforeseen(proposal, catalogue):
    """The same where what is missing is unknown: what that would do in a run, no model says."""
    return (
        "What is unknown cannot be foretold of a run that was not made. Of what comes nearest to it in the "
        f"catalogue one more run {_steps(proposal)} would tell most: {_two(proposal, catalogue)} would "
        f"differ there by about {_errors(proposal)}."
    )


def _steps(proposal):
    return joined(_changes(proposal.change))


def _errors(proposal):
    return f"{number(f'{math.sqrt(max(proposal.delta_chi2, 0.0)):.2g}', 2)} standard errors"


def _two(proposal, catalogue):
    """What a run tells apart: what both explanations have is said once, so that each is seen to end."""
    where = proposal.places or [{}, {}]
    one, other = (
        [placed(name, places, catalogue) for name in names.split("+")]
        for names, places in zip(proposal.separates[:2], where, strict=True)
    )
    both = [name for name in one if name in other]
    own, rival = ([name for name in names if name not in both] for names in (one, other))
    if not both:
        return f"{_set(one)} and {_set(other)}"
    if not rival:
        return f"{joined(both)} with {joined(own)} and the same without"
    if not own:
        return f"{joined(both)} alone and the same with {joined(rival)}"
    return f"beside {joined(both)}, {_set(own)} and {_set(rival)}"


def _set(names):
    """Effects of one explanation; several in brackets."""
    return names[0] if len(names) == 1 else f"({joined(names, 'with')})"


def _changes(change: dict) -> list[str]:
    """What is changed, one phrase for a striker that is another one and strikes at another speed."""
    rest = dict(change)
    if {"striker.speed_m_s", "striker.mass_g"} <= set(rest):
        speed, mass = rest.pop("striker.speed_m_s"), rest.pop("striker.mass_g")
        return [f"with a striker of {mass:.4g} g at {speed:.4g} m/s", *_changes(rest)]
    return [_change(key, value) for key, value in rest.items()]


def _change(key, value):
    known = {
        "striker.speed_m_s": "with the striker at {} m/s",
        "striker.mass_g": "with a striker of {} g",
        "chain.static_force_N": "under a static force of {} N",
        "chain.orientation": "with the chain {}",
    }
    shown = f"{value:.4g}" if isinstance(value, float) else str(value)
    if key.startswith("sensors."):
        return f"with gauge {key.split('.')[1]} in bead {shown}"
    return known.get(key, f"with {key} = {{}}").format(shown)


def _beyond(proposal, verdict, records):
    """That a run is faster than all that were measured, and pressed contacts beyond yield before; else ""."""
    speed = proposal.change.get("striker.speed_m_s")
    fastest = max((run.striker.speed_m_s for one in records for run in one.runs), default=math.inf)
    if not isinstance(speed, float) or not speed > fastest:
        return ""
    text = (
        f" That is {speed / fastest:.2g} times the fastest speed of the record, {fastest:.4g} m/s: beyond "
        "what was measured, a model foretells only as far as it holds there."
    )
    share = _over_yield(verdict)
    if not share:
        return text
    return (
        f"{text} At the speeds of the record the pressure reaches {share} times the yield strength already, "
        "and more at this one: look whether the beads bear it, or change less."
    )


def _over_yield(verdict):
    """How many times the yield strength the pressure reaches, as the verdict's warnings have it; else ""."""
    found = (re.search(r"(\S+) times the yield strength", line) for line in verdict.warnings or ())
    return next((one[1] for one in found if one), "")
