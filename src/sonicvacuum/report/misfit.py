"""What a record's page tells of the misfit: where it is, how it shrinks, whether what is left is noise."""

import math
from collections import Counter
from collections.abc import Sequence

from sonicvacuum.discover.judge.locate import DISCOVERY_RATE
from sonicvacuum.discover.judge.strained import ONLY_WITH
from sonicvacuum.discover.verdict import Gap, Verdict
from sonicvacuum.report.phrases import chance, joined, plural
from sonicvacuum.report.tables import digits, number
from sonicvacuum.report.words import effects_of

# A gap is told as closed by a share where it is so many times the scatter that noise gives the mean.
SHOWS = 3.0

# Feature → what a measured one is that lies above, and below, the prediction.
SIDES = {
    "precursor": ("more force before the pulse", "less force before the pulse"),
    "amplitude": ("a higher peak", "a lower peak"),
    "delay": ("a later pulse", "an earlier pulse"),
    "width": ("a wider pulse", "a narrower pulse"),
    "asymmetry": ("a pulse leaning more backwards", "a pulse leaning more forwards"),
    "tail": ("more force behind the pulse", "less force behind the pulse"),
    "decay": ("stronger later pulses", "weaker later pulses"),
    "reflection": ("a stronger reflection", "a weaker reflection"),
    "baseline": ("a higher baseline", "a lower baseline"),
}


def where(verdict: Verdict, cells: list[dict], quantities: Sequence[dict] = ()) -> str:
    """Where the nominal model and the data disagree.

    The verdict keeps the largest disagreements; `cells`, the rows of where.csv, are all comparisons made;
    `quantities`, of `rows.quantities`, are those of them without a gauge, in the same order.
    """
    traces = any(c["sensor"] for c in cells)
    failing = [c["feature"] for c in cells if float(c["q_before"] or 1.0) < DISCOVERY_RATE]
    kind = "run, gauge and feature of the trace" if traces else "run and measured quantity"
    found = effects_of(verdict)
    if not cells:
        return "There was nothing to compare by feature."
    strained = _strained(verdict)
    if not (failing and verdict.where):
        spread = " What is missing is spread over them, and shows where all are fitted at once."
        return (
            f"Nowhere: of {plural(len(cells), 'comparison')} ({kind}), none stands out beyond what so many "
            "comparisons give by chance."
            + (f"{strained}: that is what speaks against it." if strained else spread * bool(found))
        )
    first = verdict.where[0]
    groups = joined([f"{name.replace('_', ' ')} ({count})" for name, count in Counter(failing).most_common()])
    place = f"run {first.run}" + (f", gauge {first.sensor}" if first.sensor else "")
    size = number(str(abs(first.z)), 3)
    return (
        f"In {len(failing)} of {plural(len(cells), 'comparison')} ({kind}) the nominal model fails: "
        f"{groups}. The largest is in {place}: {_side(first)} than predicted, by "
        f"{size} standard errors.{_common(cells, quantities)}{strained and f'{strained}.'}"
    )


def _common(cells, quantities):
    """That an error which several quantities share is counted, where one of them fails: it may lie within
    that, and fail all the same.
    """
    alone = [c for c in cells if not c["sensor"]]
    if len(alone) != len(quantities):  # of a verdict that was written before quantities were
        return ""
    names = dict.fromkeys(
        name
        for cell, one in zip(alone, quantities, strict=True)
        for name in one["common"]
        if float(cell["q_before"] or 1.0) < DISCOVERY_RATE
    )
    if not names:
        return ""
    return (
        f" What several quantities have in common ({', '.join(names)}) is counted: it shifts them together, "
        "to where it suits all the data best. One that lies within its errors by itself may fail for that, "
        "where others would have the shift the other way."
    )


def _strained(verdict: Verdict) -> str:
    """What the nominal model asks of the record to come so near, without a stop; "" where that is little."""
    said = next((r for r in verdict.reasons if r.startswith(ONLY_WITH)), "")
    return said and f" T{said[1:]}"


def _side(cell):
    """On which side of the prediction the data lie; quantities measured without traces have no gauge here."""
    above = cell.z > 0.0
    if cell.sensor and cell.feature in SIDES:
        return f"the data show {SIDES[cell.feature][0 if above else 1]}"
    what = _WHAT.get(cell.feature, cell.feature.replace("_", " "))
    sides = _LONG.get(cell.feature, ("higher", "lower"))
    return f"the measured {what} is {sides[0 if above else 1]}"


_WHAT = {"speed_at_amplitude": "speed at the stated amplitude"}
_LONG = {"duration": ("longer", "shorter"), "width": ("larger", "smaller")}


def gap(verdict: Verdict, runs: int = 0, data: int = 0) -> str:
    """How the misfit shrinks, of so many runs and data; 0 where that is not known."""
    fitted, held_out = verdict.gap.fitted, verdict.gap.held_out
    if not effects_of(verdict) and not verdict.law:
        text = (
            f"The nominal model leaves a mean squared misfit of {digits(fitted.before)} times that of the "
            "noise; 1 is expected."
        )
        if not verdict.named:
            return f"{text} As nothing was added, nothing changes."
        if fitted.after == fitted.before:
            return f"{text} As no effect is named, none was added."
        return f"{text} The nearest model that was found, which is not named, leaves {digits(fitted.after)}."
    scatter = math.sqrt(2.0 / data) if data else 0.0
    shows = fitted.before - fitted.floor > SHOWS * scatter
    text = (
        f"The nominal model leaves a mean squared misfit of {digits(fitted.before)} times that of the noise, "
        f"the extended model {digits(fitted.after)}{_closed(fitted) if shows else ''}; 1 is expected."
    )
    if not shows:
        text += _unseen(verdict, scatter)
    return f"{text} {_left_out(held_out, runs, shows)}"


def _unseen(verdict, scatter):
    """That noise alone makes up a gap, so that no share of it says anything, and what speaks for the name."""
    why = "what is named takes less of it away than that, but in a shape of its own"
    if _strained(verdict):
        why = "what speaks for the name is what the nominal model would have of the record, as told above"
    return f" Noise alone makes such a mean scatter by {scatter:.2g}, so that no gap is seen in it: {why}."


def _left_out(held_out, runs, shows):
    """How the misfit of runs left out of the fit shrinks."""
    if held_out is None:
        return "There is one run only, so that none could be held out."
    if held_out.after == held_out.before:
        one = "run does not show the effect by itself"
        others = one if runs == 2 else "runs do not show the effect by themselves"
        return f"Runs left out of the fit are not predicted better, because the remaining {others}."
    before, after = digits(held_out.before), digits(held_out.after)
    if before == after:
        return f"On runs left out of the fit it stays at {after}."
    falls = "falls" if held_out.after < held_out.before else "rises"
    closed = _closed(held_out) if shows else ""
    return f"On runs left out of the fit it {falls} from {before} to {after}{closed}."


def _closed(one: Gap):
    if one.closed is None or one.before <= one.floor:
        return ""
    closed = 100.0 * min(one.closed, 1.0)
    return f" ({closed:.3g} % of the gap closed)" if closed > 0.0 else " (the gap is not closed)"


def _there(p: float, traces: int) -> str:
    """The probability in a trace, and in some trace of many: the worst of them is told."""
    if traces < 2:
        return f"there with probability {chance(p)}"
    some = chance(1.0 if p >= 1.0 else -math.expm1(traces * math.log1p(-p)))
    if some == chance(p):
        return f"there, as in some trace of {traces}, with probability {some}"
    return f"there with probability {chance(p)}, in some trace of {traces} with {some}"


def goodness(verdict: Verdict) -> str:
    """Whether what the model leaves looks like noise; empty for verdicts that did not ask."""
    fit = verdict.fit
    if fit is None or not fit.extended:
        return ""
    worst = max(fit.extended, key=lambda c: c.chi2)
    text = (
        f"The largest mean squared misfit of a trace is {digits(worst.chi2, 3)} times that of the noise (run "
        f"{worst.run}, gauge {worst.sensor}), which noise alone would give "
        f"{_there(worst.p, len(fit.extended))}."
    )
    if fit.smooth_rel:
        text += (
            f" A smooth misfit of {100.0 * fit.smooth_rel:.2g} % of the peak counts as noise in errors and "
            "upper limits."
        )
    if fit.wider > 1.0:
        text += f" For what is left, errors behind the upper limits are {fit.wider:.3g} times as large."
    return text
