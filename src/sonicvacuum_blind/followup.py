"""One more run in the laboratory of a case: the one that `discover` proposes, or any that it could propose.

Beads, hidden effects, gains and modulus are those of the case's record, errors included; the errors of speed
and trigger and the noise are drawn anew, alike for every change, so that changes differ in nothing else.
"""

import json
from dataclasses import replace
from pathlib import Path

from sonicvacuum import records
from sonicvacuum.blas import one_thread
from sonicvacuum.files import replacing
from sonicvacuum.laboratory.next_run import FASTEST, MASSES, PRELOADS, SLOWEST, SPEEDS, gauge_beads
from sonicvacuum.laboratory.ranges import likely_ball
from sonicvacuum.laboratory.specimen import GRAVITY
from sonicvacuum_blind.design import Design
from sonicvacuum_blind.hide import TOLERANCE, Laboratory, Spec, drawn_errors, laboratory, noisy, stream
from sonicvacuum_blind.plan import Plan
from sonicvacuum_blind.prediction import Errors, predict
from sonicvacuum_blind.record import as_record

ORIENTATIONS = {"horizontal": 0.0, "vertical": GRAVITY}
CHOICES = ("proposed", "random")
# The same run as a random one, of every record: what a verdict foretells of a run that it never had.
FRESH = "fresh"
# Beside the further run's record; the laboratory knows it.
FILE = "change.json"

Change = dict[str, float | int | str]


def ambiguous(spec: Spec, verdict: dict) -> bool:
    """Whether one effect is hidden and a verdict names one, but others are left, the hidden one among them.

    Raises:
        KeyError: for a verdict without `named`, `confusable` or `next_experiment`.
    """
    named, left = verdict["named"], {name for names in verdict["confusable"] for name in names}
    if spec.kind != "single" or len(named) != 1 or named == ["unknown"]:
        return False
    return bool(left) and verdict["next_experiment"] is not None and spec.effects[0] in {*named, *left}


def offers(made: Design) -> list[Change]:
    """Every change that may be proposed to the laboratory of a record, each of one quantity of the last run;
    none without traces.
    """
    if not made.samples:
        return []
    last = made.runs[-1]
    speeds = [last.speed * f for f in SPEEDS if SLOWEST <= last.speed * f <= FASTEST]
    found: list[Change] = [{"striker.speed_m_s": round(v, 4)} for v in speeds]
    masses = [last.striker_mass * f for f in MASSES]
    found += [{"striker.mass_g": round(m * 1e3, 4)} for m in masses if likely_ball(m, last.striker_radius)]
    found += [{"chain.static_force_N": last.static_force + f} for f in PRELOADS]
    found.append({"chain.orientation": "horizontal" if last.gravity else "vertical"})
    return found + _moves(last)


def _moves(plan):
    """The first embedded gauge moved near either end."""
    gauge = next((g for g in plan.gauges if g.kind == "embedded"), None)
    beads = gauge_beads(plan.beads) if gauge else ()
    return [{f"sensors.{gauge.id}.bead": bead} for bead in beads if bead != gauge.bead]


def random_change(spec: Spec, made: Design) -> Change:
    """One of the `offers`, all equally likely; the same for the same case.

    Raises:
        ValueError: for a record without traces.
    """
    found = offers(made)
    if not found:
        raise ValueError(f"case {spec.id}: a record without traces has no next run")
    return found[int(stream(spec, "choice").integers(len(found)))]


def under(made: Design, change: Change) -> Design:
    """The design of the one further run; slower pulses are watched for longer, as the proposal imagines.

    Raises:
        ValueError: for a record without traces, or a change of an unknown quantity, or of none.
    """
    if not made.samples or not change:
        raise ValueError(f"change {change}: change something, of a record with traces")
    plan = last = made.runs[-1]
    for key, value in change.items():
        plan = _changed(plan, key, value)
    # Pulses travel at a speed that grows as the striker's to the power 1/5 (Nesterenko 1983).
    longer = max(1.0, (plan.speed / last.speed) ** -0.2)
    return replace(made, runs=(plan,), samples=int(made.samples * longer), scalars=())


def _changed(plan: Plan, key, value):
    if key == "striker.speed_m_s":
        return replace(plan, speed=float(value))
    if key == "striker.mass_g":
        return replace(plan, striker_mass=1e-3 * value)
    if key == "chain.static_force_N":
        return replace(plan, static_force=float(value))
    if key == "chain.orientation" and value in ORIENTATIONS:
        return replace(plan, gravity=ORIENTATIONS[value])
    moved = tuple(replace(g, bead=value) if key == f"sensors.{g.id}.bead" else g for g in plan.gauges)
    if moved == plan.gauges:
        raise ValueError(f"change {key}: {value!r} changes nothing that a further run could change")
    return replace(plan, gauges=moved)


def follow(spec: Spec, own: Laboratory, change: Change) -> records.Record:
    """The record of one further run under a change of the last one.

    Args:
        spec: the case.
        own: its laboratory (`hide.laboratory`).
        change: quantity → new value, as a verdict's `next_experiment.change` states it.

    Raises:
        ValueError: for a change that cannot be made.
    """
    made, random = under(own.design, change), stream(spec, "further run")
    fresh = drawn_errors(made, random)
    errors = Errors(fresh.speeds, own.errors.modulus, own.errors.gains, fresh.triggers)
    clean = predict(made, own.case.change, errors, TOLERANCE)
    traces, _ = noisy(made, clean.traces, spec.noise, own.correlation, random)
    return as_record(made, traces, clean.scalars, title=f"Data set {spec.id}, one more run")


@one_thread
def write(spec: Spec, verdict: dict, choice: str, folder) -> None:
    """Make the further run that a verdict proposes, or a random one, as `folder/<id>/`; the change beside it.

    Raises:
        ValueError: for a change that cannot be made.
    """
    own = laboratory(spec)
    proposed = choice == "proposed"
    change = verdict["next_experiment"]["change"] if proposed else random_change(spec, own.design)
    made = follow(spec, own, change)
    # First: a record that stands without this file was not made here.
    with replacing(Path(folder) / spec.id / FILE) as stream_out:
        json.dump({"choice": choice, "change": change}, stream_out, indent=1)
        stream_out.write("\n")
    records.write(made, Path(folder) / spec.id)
