"""What is measured on the lanes of a batch, for those statements of the paper that need a simulation."""

from collections.abc import Callable, Mapping

import numpy as np

from sonicvacuum.card import Card
from sonicvacuum.physics.touching import touched
from sonicvacuum_paper import gauges, trains
from sonicvacuum_paper.contacts import RISE_LEVEL
from sonicvacuum_paper.one_run import LOWER, UPPER
from sonicvacuum_paper.printed import ASSUMED, PRINTED
from sonicvacuum_paper.uncertainty.batch import Batch, Draws, Lane

BETWEEN = "g9-g5"
Key = tuple[str, str]  # quantity, sensor
Values = dict[Key, np.ndarray]
# Quantity and sensor → function of (lane, level at which durations are read).
OF_LANES: Mapping[Key, Callable] = {
    ("speed", BETWEEN): lambda lane, level: lane.speed(),
    ("amplitude", "g9"): lambda lane, level: gauges.amplitude(lane, lane.gauges["g9"]),
    ("amplitude", "wall"): lambda lane, level: gauges.amplitude(lane, lane.gauges["wall"]),
    ("decay", BETWEEN): lambda lane, level: gauges.decay(lane, lane.gauges["g9"], lane.gauges["g5"]),
    ("arrival", "wall"): lambda lane, level: gauges.arrival(lane, lane.gauges["wall"]),
    ("duration_02", "g9"): lambda lane, level: gauges.duration(lane, lane.gauges["g9"], level),
    ("duration_05", "g9"): lambda lane, level: gauges.duration(lane, lane.gauges["g9"], 0.05),
    ("duration_half", "g9"): lambda lane, level: gauges.duration(lane, lane.gauges["g9"], 0.5),
    ("width_02", "g9"): lambda lane, level: gauges.width(lane, lane.gauges["g9"], level),
    ("duration_half", "wall"): lambda lane, level: gauges.duration(lane, lane.gauges["wall"], 0.5),
    ("pulse_count", "g9"): lambda lane, level: trains.pulse_count(lane, lane.gauges["g9"]),
    ("pulse_count", "wall"): lambda lane, level: trains.pulse_count(lane, lane.gauges["wall"]),
    ("pulse_count_05", "wall"): lambda lane, level: trains.pulse_count_05(lane, lane.gauges["wall"]),
    ("third_pulse_fraction", "wall"): lambda lane, level: trains.third_pulse_fraction(
        lane, lane.gauges["wall"]
    ),
    ("valley_depth", "wall"): lambda lane, level: trains.valley_depth(lane, lane.gauges["wall"]),
    ("valley_depth", "g9"): lambda lane, level: trains.valley_depth(lane, lane.gauges["g9"]),
    ("extra_pulse_fraction", "g9"): lambda lane, level: trains.extra_pulse_fraction(lane, lane.gauges["g9"]),
    ("extra_pulses_upper_stronger", BETWEEN): lambda lane, level: trains.extra_pulses_upper_stronger(
        lane, lane.gauges["g9"], lane.gauges["g5"]
    ),
}


def of_lanes(batch: Batch, wanted: tuple[Key, ...], draws: Draws) -> Values:
    """(lanes,) values of some of `OF_LANES`, NaN where a lane does not have the quantity.

    Speeds and widths are those of a reader who takes the gauges to be where they should be.
    """
    functions = [OF_LANES[key] for key in wanted]
    rows = [_measured(batch.lane(k), functions, float(draws["level"][k])) for k in range(batch.lanes)]
    found = dict(zip(wanted, np.array(rows).T, strict=True))
    seen, lasts = misread(batch.card, draws), 1.0 + draws["reading"]
    errors = {"speed": seen, "duration_02": lasts, "width_02": seen * lasts}
    return {(q, sensor): values * errors.get(q, 1.0) for (q, sensor), values in found.items()}


def misread(card: Card, draws: Draws) -> np.ndarray:
    """(draws,) nominal over true distance between the gauges, by which speeds are misread."""
    return 1.0 / (1.0 + draws["apart_bare" if card.bead.coating_m is None else "apart"])


def _measured(lane: Lane, functions, level):
    found = (function(lane, level) for function in functions)
    return [m.value if m.known else np.nan for m in found]


def of_peaks(batch: Batch, draws: Draws) -> Values:
    """Speed between the gauges and their mean reading, from the first peaks: quick, for sweeps."""
    names = [s.id for s in batch.seen.setup.sensors]
    (first, upper), (second, lower) = (
        _first_peak(batch.seen.readings[:, names.index(f"g{k}")]) for k in (UPPER, LOWER)
    )
    apart = (UPPER - LOWER) * batch.card.bead.diameter_m * misread(batch.card, draws)
    between = (second - first) * batch.seen.history.time[1]
    return {
        # A pulse that has died out has no peak that travels.
        ("speed", BETWEEN): np.where(between > 0.0, apart / np.where(between > 0.0, between, 1.0), np.nan),
        ("reading", BETWEEN): 0.5 * (upper + lower),
        ("amplitude", "g9"): upper,
    }


def _first_peak(signal):
    """Place (in samples) and height of the first peak of each row (lanes, samples) that reaches half of the
    highest point, by the parabola through three samples: the reflection that follows may rise higher.
    """
    lanes = np.arange(len(signal))
    risen = np.maximum.accumulate(signal >= 0.5 * signal.max(axis=1, keepdims=True), axis=1)
    top = np.clip((risen[:, :-1] & (np.diff(signal, axis=1) < 0.0)).argmax(axis=1), 1, signal.shape[1] - 2)
    before, here, after = (signal[lanes, top + k] for k in (-1, 0, 1))
    bend = before - 2.0 * here + after
    shift = np.where(bend < 0.0, 0.5 * (before - after) / np.where(bend < 0.0, bend, 1.0), 0.0)
    return top + shift, here - 0.25 * (before - after) * shift


def of_contacts(batch: Batch) -> Values:
    """What the contact that bears most between the gauges bears; definitions as in `contacts`.

    Of each contact the first peak counts: the reflection comes later.
    """
    chain, bead, history = batch.seen.setup.chain, batch.card.bead, batch.seen.history
    contacts = range(batch.card.beads + 1 - UPPER, batch.card.beads + 1 - LOWER)
    static = chain.static_forces(batch.card.beads + 1)
    forces = np.array([history.of(c) for c in contacts])
    tops, peaks = zip(*(_first_peak(force.T) for force in forces), strict=True)
    which, lanes = np.argmax(peaks, axis=0), np.arange(batch.lanes)
    peak, top = np.array(peaks)[which, lanes], np.array(tops)[which, lanes]
    rest = static[contacts.start + which, lanes]
    risen = (forces[which, :, lanes] >= RISE_LEVEL * peak[:, None]).argmax(axis=1)
    rise = history.time[1] * (top - risen)
    middle = contacts.start + len(contacts) // 2  # contacts between the gauges differ by their load only
    depth, at_rest = chain.depth_at(middle, np.array([peak + rest, rest]))
    (radius,), (concentration,) = touched(chain, middle, depth[None])
    found = {("peak_force", BETWEEN): peak + rest, ("static", BETWEEN): static[list(contacts)].mean(axis=0)}
    if bead.coating_m is None:
        return found
    pressure = (peak + rest) / (np.pi * radius**2) / bead.surface.yield_Pa
    return found | {
        ("mean_pressure_over_yield", BETWEEN): pressure,
        ("peak_pressure_over_onset", BETWEEN): concentration * pressure / ASSUMED.yield_onset,
        ("strain_rate", BETWEEN): (depth - at_rest) / rise / (2.0 * PRINTED.coating),
    }
