"""What a page says of the bench: slips of the laboratory, and what had to move for model and data to agree.

What a record states with an error (speeds, time zeros, gains, modulus) follows the data; where it has to
leave its stated error to do so, that is worth a look at the bench before any effect is believed.
"""

import math
import re
from collections.abc import Iterator, Sequence

from sonicvacuum.discover.faults.table import header
from sonicvacuum.discover.model.nuisances import WORDS, stated
from sonicvacuum.discover.verdict import PUT_RIGHT, Fault, Model, Verdict
from sonicvacuum.gauges import KINDS
from sonicvacuum.records import Record
from sonicvacuum.report.phrases import in_words, joined
from sonicvacuum.report.tables import digits, number, unit_of, with_error
from sonicvacuum.report.words import effects_of

# A modulus that moved by more than this, in its logarithm, is told first.
FAR = 0.2
# Kinds of what all runs share that add to a reading; all others are factors.
_SHIFTS = ("delay", "clock", "shared")
# What has moved by more of its stated standard errors than this has left them.
STRAINED = 2.5
# What has moved by less of its stated standard error is not worth a word.
MOVED = 0.1
# Data that leave less than this of a stated error have measured it.
TOLD = 0.5
# What a factor is of, unless the record states nothing.
_STATED = "what is stated"
# What the data ask for of the extended model.
_STILL = "with what was named the data still ask for"


def slips(verdict: Verdict, records: Sequence[Record] = ()) -> list[str]:
    """What to check at the bench first, one line for each slip of the laboratory; most probable first."""
    return [_slip(one, records) for one in verdict.faults]


def _slip(one, records) -> str:
    # The name of a gauge keeps its spelling.
    kind, said = _header(one), slip(one, records)
    if kind.says.startswith("{sensor}") and not _tabled(one):
        said = f"Gauge {said}"
    said = said[0].upper() + said[1:]
    text = f"{said}: {kind.look_up if _tabled(one) else kind.check}"
    return f"{text}. That it is so is {in_words(one.probability)}."


def corrected(verdict: Verdict) -> str:
    """That what follows is of the record put right, "" where nothing was."""
    said = _put_right(verdict)
    # Ids of slips in plain words; minus signs stay.
    right = re.sub(r"(?<=[a-z])-(?=[a-z])", " ", said)
    return f"All that follows is of the record with this put right{right}." if said else ""


def _put_right(verdict):
    """Ids of the slips that were put right, as the reasons have them, "" where none was."""
    return next((r for r in verdict.reasons if r.startswith(PUT_RIGHT)), "").removeprefix(PUT_RIGHT)


def _header(one):
    return header(one.fault, one.run, one.sensor)


def _tabled(one) -> bool:
    """Whether a slip concerns values of a table: one quantity or all, or errors of no gauge."""
    return bool(_header(one).of_table and (one.quantity or (one.sensor is None and not one.run)))


def slip(one: Fault, records: Sequence[Record] = ()) -> str:
    """One slip in a few words; the `records` know the unit of a gauge."""
    kind, quantity = _header(one), one.quantity or "all values"
    sensors = [one.sensor] if isinstance(one.sensor, str) else (one.sensor or ["a gauge"])
    says, number = kind.of_table if _tabled(one) else kind.says, one.value
    if number is not None and number < 0.0 and kind.negative:
        says, number = kind.negative, -number
    if one.sensor and kind.of_gauge and not _tabled(one):
        says = kind.of_gauge
    if number is None and kind.valueless:
        says = kind.valueless
    value = "some" if number is None else f"{number:.4g}"
    if kind.of_reading and number is not None:
        value += _unit_of_gauge(sensors[0], records)
    text = says.format(
        sensor=joined(list(sensors)), run=one.run or "all runs", value=value, quantity=quantity
    )
    place = one.run and "{run}" not in says
    return f"{text} in run {one.run}" if place else text


def _unit_of_gauge(name, records):
    """The unit of what a gauge reads, with a space before it; "" where it is not known."""
    kinds = (g.kind for r in records for g in r.gauges if g.id == name and math.isfinite(g.gain_rel_sigma))
    return next((unit_of(KINDS[kind].unit) for kind in kinds), "")


def nuisances(model: Model, verdict: Verdict) -> str:
    """How far what the record states with an error has moved; of a gauge that nobody calibrated it states
    none, see `measured`.
    """
    uncalibrated = {name.removeprefix("gain ") for name in verdict.nuisances or {}}
    gains = [ratio for gauge, ratio in model.gain.items() if gauge not in uncalibrated]

    def farthest(values):
        return max((abs(v - 1.0) for v in values), default=0.0)

    parts = []
    if abs(model.modulus_ratio - 1.0) >= 5e-4:
        parts.append(f"modulus of the beads' material times {model.modulus_ratio:.4g}")
    if farthest(model.speed_ratio.values()) >= 5e-5:
        parts.append(f"striker speeds by up to {_short(100.0 * farthest(model.speed_ratio.values()))} %")
    if farthest(gains) >= 5e-5:
        parts.append(f"gauge gains by up to {_short(100.0 * farthest(gains))} %")
    shift = max((abs(v) for v in model.trigger_us.values()), default=0.0)
    if shift >= 5e-3:
        parts.append(f"time zeros by up to {_short(shift)} µs")
    parts += _shared(verdict)
    if not parts:
        gauges = "time zeros, gains, " if model.gain else ""
        return f"What has an error in the record (speeds, {gauges}modulus) stays as recorded."
    return f"What has an error in the record, stated or taken, has followed the data: {joined(parts)}."


def _shared(verdict):
    """What all runs share that has moved by a tenth of its error and more."""
    for name, known in (verdict.nuisances or {}).items():
        if not known.prior:
            continue
        kind, _, of = name.partition(" ")
        away = known.value if kind in _SHIFTS else math.log(known.value)
        if abs(away) >= MOVED * known.prior:
            what = f"the error that quantities share, {of}," if kind == "shared" else _named(kind, of)
            yield f"{what} by {_short(abs(away) / known.prior)} of its standard errors"


def _named(kind, of):
    """Something that all runs share, as a reader calls it."""
    what = WORDS.get(kind, kind.replace("-", " "))
    return f"{what} of {of}" if of else what


def measured(verdict: Verdict, records: Sequence[Record] = ()) -> str:
    """What the data know better than the record does: moduli, masses and sizes, calibrations; else empty. Of
    an error that none of the `records` states it is said that it is taken.
    """
    parts = []
    for name, known in (verdict.nuisances or {}).items():
        kind, _, of = name.partition(" ")
        told = known.prior is None or known.sigma < TOLD * known.prior
        if kind in _SHIFTS or not 0.0 < known.sigma < math.inf or not told:
            continue
        what = WORDS.get(kind, "calibration" if kind == "gain" else kind)
        how = "stated" if all(stated(one, kind, of) for one in records) else "taken as known"
        before = "" if known.prior is None else f" ({how} to {_short(100.0 * known.prior)} %)"
        value = with_error(known.value, known.value * known.sigma)
        parts.append(f"{what}{f' of {of}' if of else ''} {value}{before}")
    said = "The data measure what the record leaves open, as factors of what it says"
    return f"{said}: {joined(parts)}." if parts else ""


def moved_modulus(verdict: Verdict, model: Model) -> str:
    """A word on a modulus that had to move far for the nominal model to explain the data; else empty."""
    if verdict.named or abs(math.log(model.modulus_ratio)) < FAR:
        return ""
    return (
        " For that, the modulus of the beads' material, which is known only with an error, has to be "
        f"{model.modulus_ratio:.3g} times as large as recorded."
    )


def strained(verdict: Verdict, model: Model, record: Record) -> list[str]:
    """What has to leave its error for the model to follow the data, one line each; largest first."""
    told = [said for _, said in sorted(_moves(verdict, model, record), reverse=True)]
    if effects_of(verdict):  # the nominal model asked for something else, see `misfit.where`
        told = [said.replace(": the data ask for", f": {_STILL}") for said in told]
    return told


def _moves(verdict, model, record) -> Iterator[tuple[float, str]]:
    """(shift over its error, sentence)."""
    told = {f.run for f in verdict.faults if f.fault == "time-zero" and f.fault in _put_right(verdict)}
    for run in record.runs:
        ratio, shift = model.speed_ratio.get(run.id, 1.0), model.trigger_us.get(run.id, 0.0)
        said = _asked(f"the striker's speed in run {run.id}", ratio)
        yield from _far(math.log(ratio), run.striker.speed_rel_sigma, said)
        if not told & {None, run.id}:
            said = f"Check the time zero of run {run.id}: the data ask for a shift of {shift:.3g} µs"
            yield from _far(shift / 1e6, record.trigger_sigma_s, said)
    for gauge in record.gauges:
        ratio = model.gain.get(gauge.id, 1.0)
        said = f"Check the calibration of gauge {gauge.id}: it reads {ratio:.3f} times what the model expects"
        yield from _far(math.log(ratio), gauge.gain_rel_sigma, said)
    name = record.specimen.first.surface.name
    said = _asked(f"the modulus of {name}", model.modulus_ratio)
    known = stated(record, "modulus", name)
    yield from _far(math.log(model.modulus_ratio), record.taken_modulus_rel_sigma(name), said, known)
    yield from _others(verdict, record)


def _others(verdict, record):
    """What else the record leaves open."""
    for name, known in (verdict.nuisances or {}).items():
        if known.prior:
            kind, _, of = name.partition(" ")
            away = known.value if kind in _SHIFTS else math.log(known.value)
            yield from _far(away, known.prior, _told_of(kind, of, known), stated(record, kind, of))


def _told_of(kind, of, known):
    """What to check where all runs share it, and how far off it is."""
    if kind == "shared":
        return f"Check the error common to several quantities, {of}: the data ask for a shift"
    if kind == "delay":
        return f"Check the delay of gauge {of}: the data ask for {known.value:.3g} µs"
    if kind == "clock":
        return f"Check the recorder's clock: the data ask for one that is off by {100.0 * known.value:.2g} %"
    # A wider error than the stated one is that of a misfit which is left: no measurement.
    error = known.sigma if known.sigma < known.prior else 0.0
    return _asked(f"the {_named(kind, of)}", known.value, error)


def _short(value: float) -> str:
    """Two digits, without powers of ten where people write none."""
    return number(f"{value:.2g}", 2)


def _asked(what, ratio, error=0.0):
    """What to check; `error` is the standard error of the ratio, relative."""
    asked = with_error(ratio, ratio * error) if 0.0 < error < math.inf else f"{ratio:.3g}"
    return f"Check {what}: the data ask for {asked} times {_STATED}"


def _far(away, error, said, own=True):
    """A sentence where something is far off its error, the record's `own` or one taken for it."""
    if error and math.isfinite(error) and abs(away) > STRAINED * error:
        score = abs(away) / error
        whose = "of the stated standard errors away"
        if not own:
            whose = f"times the standard error of {_short(100.0 * error)} % that is taken, none being stated"
            said = said.replace(_STATED, "the value used")
        yield score, f"{said}, {digits(score, 2)} {whose}."
