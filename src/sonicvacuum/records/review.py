"""All that `record check` says of a record, as data and in words: the two say the same."""

import math
from dataclasses import asdict, dataclass
from typing import Any

from sonicvacuum.forward import SOLITARY
from sonicvacuum.records.checks import warnings
from sonicvacuum.records.expected import Expected, Feature, expected
from sonicvacuum.records.record import Record
from sonicvacuum.records.suspects import suspects
from sonicvacuum.records.unshown import unshown

# Traces of four runs, three gauges and 480 samples take 0.4 s on one core where nothing is missing, 1.3 s
# where one effect is, 4 where two are and up to 20 where more is, scalars 2 to 11 s (the blind study of
# docs/study.md); the start and the page 0.5 s more.
SECONDS_PER_VALUE = 2.0 / (4 * 3 * 480)
LEAST_SECONDS = 1.5
UNCERTAIN = 5.0
# Each strike of a chain that speeds at amplitudes ask for: tables of seven over two decades take 6 to 66 s on
# a machine that takes 4 s for traces with one effect.
SECONDS_PER_STRIKE = 2.0
# Of verdicts that leave something unknown one in ten takes more than so many times that, and two in three
# take more than UNCERTAIN, of all others 4 in 100 (traces of that study).
UNEXPLAINED = 24.0
# Speeds and moduli with such errors have fits start from all over what they may be: records of the four shots
# of docs/real-traces.md, of 800 samples, take 60 to 70 s on two cores.
HARDLY_KNOWN, LONGER = 0.1, 30.0
# SI unit → the one in which people read it, and its factor.
_SHOWN = {"s": ("us", 1e6)}
_TITLES = {"arrival": "peak at", "amplitude": "peak", "duration_half": "width at half height",
           "speed": "speed", "width_half": "width"}  # fmt: skip
# Of template.yaml.
TEMPLATE_TITLE = "One line that says what was measured"


@dataclass(frozen=True)
class Review:
    """One record, looked at.

    Attributes:
        record: its folder's name.
        title: its title.
        expected: each number that the nominal model expects beside the measured one.
        warnings: what in the files looks suspicious by itself.
        suspects: what looks so against the nominal model, and slips that the traces show by themselves.
        treatment: what is done to long traces before the search; empty where they are taken as they are.
        discover_s: rough time of `discover` on one core, as it is in most searches.
        longest_s: what it rarely exceeds where something stays unexplained.
        uncalibrated: gauges whose readings are in a unit of their own.
    """

    record: str
    title: str
    expected: Expected
    warnings: tuple[str, ...]
    suspects: tuple[str, ...]
    treatment: tuple[str, ...]
    discover_s: float
    longest_s: float
    uncalibrated: tuple[str, ...] = ()


def review(record: Record, searched: Record | None = None, treatment=(), slips=()) -> Review:
    """Look at a record that can be read.

    Args:
        record: as read.
        searched: the record as the search takes it, long traces cut and thinned; None: as it is.
        treatment: what was done to it for that, a sentence each.
        slips: of the laboratory, as its traces show them by themselves, a sentence each.
    """
    seen = expected(record)
    return Review(
        record=record.name,
        title=record.title,
        expected=seen,
        warnings=(*_untouched(record), *warnings(record)),
        suspects=(*suspects(record, seen), *unshown(record), *slips),
        treatment=tuple(treatment),
        discover_s=_seconds(searched or record),
        longest_s=_longest(searched or record),
        uncalibrated=tuple(g.id for g in record.gauges if not g.calibrated),
    )


def _untouched(record):
    """A line where the record is still the one that `record new` writes."""
    if record.title == TEMPLATE_TITLE:
        yield "title: is still that of the template, whose numbers are the paper's: put your own in"


def _longest(record):
    """The same where something stays unexplained; no less than what is usual."""
    return max(UNEXPLAINED * _plain(record), UNCERTAIN * _seconds(record))


def _plain(record):
    """Rough time of a search on one core, in s, where little is unknown beforehand."""
    return max(LEAST_SECONDS, SECONDS_PER_VALUE * _values(record) + SECONDS_PER_STRIKE * _strikes(record))


def _seconds(record):
    """Rough time of a search on one core, in s."""
    errors = [run.striker.speed_rel_sigma for run in record.runs]
    errors += [record.modulus_rel_sigma(name) or 0.0 for name in record.block.materials]
    errors.append(record.tolerances.speed_common_rel or 0.0)
    return _plain(record) * (LONGER if max(errors) > HARDLY_KNOWN else 1.0)


def _values(record):
    """Samples of all traces, and scalars."""
    traces = sum(s.samples * len(s.readings) for s in record.signals.values())
    return traces + sum(len(run.observables) for run in record.runs)


def _strikes(record):
    """How often each chain is struck for speeds at amplitudes: once for each value, or e-fold if these are
    fewer (`forward.amplitude`).
    """
    tables: dict[tuple[str, str], list[float]] = {}
    for run in record.runs:
        for one in run.observables:
            if one.quantity == SOLITARY:
                tables.setdefault((run.id, one.options["sensor"]), []).append(one.options["amplitude"])
    return sum(min(len(a), 1 + math.ceil(math.log(max(a) / min(a)))) for a in tables.values())


def content(found: Review) -> dict[str, Any]:
    """The review as JSON: format 1, SI units, null where traces or model do not give a number."""
    return {
        "record": found.record,
        "title": found.title,
        "features": [asdict(f) for f in found.expected.features],
        "windows_s": [asdict(w) for w in found.expected.windows],
        "warnings": list(found.warnings),
        "suspects": list(found.suspects),
        "treatment": list(found.treatment),
        "discover_s": {
            "estimate": found.discover_s,
            "low": found.discover_s / UNCERTAIN,
            "high": found.discover_s * UNCERTAIN,
            "unexplained": found.longest_s,
        },
    }


def lines(found: Review) -> list[str]:
    """The comparison in words: one line for each gauge of each run, then the slips, then the time."""
    said = []
    for run in dict.fromkeys(f.run for f in found.expected.features):
        said.append(f"  run {run}, measured (the nominal model):")
        features = [f for f in found.expected.features if f.run == run]
        for gauge in dict.fromkeys(f.gauge for f in features):
            own = [_told(f, gauge in found.uncalibrated) for f in features if f.gauge == gauge]
            said.append(f"    {gauge}: " + "; ".join(own))
        said += [
            f"    recorded {_span(w.recorded)}, needed {_span(w.needed)}"
            for w in found.expected.windows
            if w.run == run
        ]
    said += [f"  warning: {w}" for w in found.warnings]
    said += [f"  check your set-up: {s}" for s in found.suspects]
    said += [] if found.warnings or found.suspects else ["  nothing suspicious"]
    said += [f"  for the search: {t}" for t in found.treatment]
    low, high = found.discover_s / UNCERTAIN, found.discover_s * UNCERTAIN
    low, high, longest = (f"{float(f'{s:.2g}'):g}" for s in (low, high, found.longest_s))
    more = found.longest_s > found.discover_s * UNCERTAIN
    rare = f", up to some {longest} s where something stays unexplained" if more else ""
    return [*said, f"  discover will usually take {low} to {high} s on one core{rare} (rough estimates)"]


def _told(feature: Feature, uncalibrated: bool):
    """`peak 5.4 N (5.38)`; of an uncalibrated gauge `peak 0.017 uncalibrated (5.38 N)`."""
    unit, factor = _SHOWN.get(feature.unit, (feature.unit, 1.0))
    expected, measured = (
        "–" if n is None else f"{n * factor:.4g}" for n in (feature.expected, feature.measured)
    )
    if uncalibrated and feature.quantity == "amplitude":
        return f"{_TITLES[feature.quantity]} {measured} uncalibrated ({expected} {unit})"
    start = f" from {feature.start}" if feature.quantity == "speed" else ""
    return f"{_TITLES[feature.quantity]}{start} {measured} {unit} ({expected})"


def _span(window):
    # To a nanosecond: the first time of a file may be a rounding error.
    begin, end = (round(1e6 * t, 3) + 0.0 for t in window)
    return f"{begin:.4g} to {end:.4g} us"
