"""Pulses of all traces of a record beside the nominal model's: which are missing, which are upside down."""

from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np

from sonicvacuum.discover.faults import expected
from sonicvacuum.discover.faults.heard import at_rest
from sonicvacuum.gauges import position
from sonicvacuum.records import Record

# Run id → gauge id → (T,) readings.
Readings = dict[str, dict[str, np.ndarray]]


@dataclass
class Pulses:
    """What was found.

    Attributes:
        blank: runs without a pulse in any gauge.
        silent: (run id, gauge id) of traces without a pulse.
        dead, inverted: gauge id → its runs, of gauges that show no pulse, or one upside down.
    """

    blank: list[str] = field(default_factory=list)
    silent: set[tuple[str, str]] = field(default_factory=set)
    dead: dict[str, list[str]] = field(default_factory=dict)
    inverted: dict[str, list[str]] = field(default_factory=dict)


def pulses(record: Record, readings: Readings, predicted: Readings, spared: Collection[tuple[str, str]] = ()):
    """The `Pulses` of a record.

    Args:
        record: as read.
        readings: its readings, spikes taken off.
        predicted: readings of the nominal model.
        spared: as `examine` has them.
    """
    found, words, noise = Pulses(), {}, at_rest(record)
    for run in readings:
        own = [g for g in record.gauges if g.id in readings[run] and g.id in predicted.get(run, {})]
        judged = _judged(record, run, own, readings[run], predicted.get(run, {}), noise)
        dying = ("run-without-impact", run) in spared
        judged |= {g.id: "" for g in own if dying or ("gauge-dead", g.id) in spared}
        silent = {(run, id) for id, word in judged.items() if word == "silent"}
        found.silent |= silent
        if own and len(silent) == len(own):
            found.blank.append(run)
        words |= {(run, id): word for id, word in judged.items()}
    weak = _unheard(found, readings, noise) if not spared else {}
    found.blank += weak
    found.silent |= {(run, id) for run, own in weak.items() for id in own}
    for gauge in record.gauges:
        runs = [run for run in readings if gauge.id in readings[run]]
        struck = [k for k in runs if k not in found.blank]
        dead = _dead(gauge, struck, found.silent, readings, noise[gauge.id])
        if dead:
            found.dead[gauge.id] = dead
            found.silent |= {(run, gauge.id) for run in dead}
        if ("gauge-inverted", gauge.id) not in spared:
            told = {run: words.get((run, gauge.id), "") for run in runs}
            inverted = _inverted(gauge, told, readings, predicted, noise[gauge.id])
            found.inverted |= {gauge.id: inverted} if inverted else {}
    return found


def _unheard(found, readings, noise) -> Readings:
    """Runs of which so little is expected that their silence says nothing, where all others are blank: no
    effect explains any of them then.
    """
    rest = {run: own for run, own in readings.items() if run not in found.blank and own}
    read = [(id, trace) for own in rest.values() for id, trace in own.items()]
    silent = found.blank and all(expected.quiet(trace, noise[id]) for id, trace in read)
    return rest if silent else {}


def _judged(record, run, own, readings, model, noise):
    """Gauge id → word of `expected.verdict`; nothing is said of gauges whose pulse comes after the record's
    end if it is as late as others, or dies out before it arrives if it falls as it does ahead of them.
    """
    judged = {g.id: expected.verdict(readings[g.id], model[g.id], noise[g.id], g.what.echo) for g in own}
    ways = {g.id: record.beads - position(g, record.beads, 1.0) for g in own}
    heard = [id for id, word in judged.items() if word != "silent"]
    ahead = [(ways[id], expected.share(readings[id], model[id])) for id in heard]
    time = record.signals[run].time_us
    delays = [expected.delay(readings[id], model[id], time) for id in heard if np.abs(model[id]).max() > 0.0]
    clear = any(expected.found(readings[g.id], model[g.id], noise[g.id]) for g in own)
    for gauge in own:
        id = gauge.id
        if judged[id] != "silent":
            continue
        late = expected.still_to_come(model[id], time, delays)
        # Where no gauge has a clear pulse, one that would hardly stand out says nothing by its absence.
        faint = float(np.abs(model[id]).max()) <= expected.EXPECTED * noise[id] and not clear
        faint = faint and not expected.still(readings[id])
        if late or faint or expected.fades(ways[id], model[id], noise[id], ahead):
            judged[id] = ""
    return judged


def _dead(gauge, runs, silent, readings, sigma):
    """Runs in which a gauge is dead: one that is silent where a pulse is expected is so where less is
    expected of it, too.
    """
    dead = [run for run in runs if (run, gauge.id) in silent]
    rest = [run for run in runs if run not in dead]
    if dead and all(expected.quiet(readings[run][gauge.id], sigma) for run in rest):
        return runs
    return dead


def _inverted(gauge, told, readings, predicted, sigma):
    """Runs in which a gauge is upside down: where little is expected of it, it is as its own pulse says, or,
    where that says little, as in all runs that can be judged.
    """
    if "inverted" not in told.values():
        return []
    ways = {
        run: word or expected.way(readings[run][gauge.id], model, sigma, gauge.what.echo)
        for run, word in told.items()
        if word != "silent" and (model := predicted.get(run, {}).get(gauge.id)) is not None
    }
    sure = set(filter(None, ways.values()))
    return [run for run, way in ways.items() if way == "inverted" or (not way and sure == {"inverted"})]
