"""What follows the main pulse in one run: trains, small later pulses, valleys, all before the reflection.

Definitions in `workflow/resources/claims.md`, "One run: gauges". Each function takes the run and a gauge,
or a pair, and returns a number, or the reason why there is none.
"""

from sonicvacuum.gauges import Gauge
from sonicvacuum.observe import quantities as q
from sonicvacuum.observe.pulse import Pulse, pulses
from sonicvacuum.observe.trace import Measured, missing
from sonicvacuum_paper.one_run import OneRun

# Peaks of at least this part of the main one are looked for where small pulses count.
FINE = 0.01
TRAIN = 0.05
# A later pulse rises so far, in parts of the main one; so much stronger is "stronger".
EXTRA = 0.005
# Guard before the reflection's peak, in widths at half height.
GUARD = 1.25
# Two pulses with a valley of this depth between them have split.
SEPARATE = 0.5
# The train has settled before this bead (from the bottom), which the reflection reaches last.
FAR = 17


def train(run: OneRun, gauge: str, threshold: float, prominence: float = FINE) -> list[Pulse]:
    """Separate pulses before the reflection, the main one first."""
    view, main = run.view, run.view.main(gauge)
    if not main.found:
        return []
    return list(pulses(view.trace(gauge), main, view.free_until(gauge), threshold, prominence))


def pulse_count(run: OneRun, gauge: Gauge) -> Measured:
    """Pulses of at least 0.15 of the main one."""
    return q.pulse_count(run.view, gauge.id)


def pulse_count_05(run: OneRun, gauge: Gauge) -> Measured:
    """Pulses of at least 0.05 of the main one."""
    found = train(run, gauge.id, TRAIN)
    return Measured(float(len(found))) if found else missing(run.view.main(gauge.id).reason)


def third_pulse_fraction(run: OneRun, gauge: Gauge) -> Measured:
    """Third highest peak over the first; 0 if there is none.

    By height and not by order in time: without the gauges' discharge a ripple of 2 % that the steel wall
    sends back stands between the second and the third wave, and is none.
    """
    found = train(run, gauge.id, FINE)
    if not found:
        return missing(run.view.main(gauge.id).reason)
    highest = sorted((p.force for p in found), reverse=True)
    return Measured(highest[2] / found[0].force if len(found) > 2 else 0.0)


def extra_pulse_fraction(run: OneRun, gauge: Gauge) -> Measured:
    """Largest later peak over the main one; 0 if there is none."""
    return q.extra_pulse_fraction(run.view, gauge.id)


def valley_depth(run: OneRun, gauge: Gauge) -> Measured:
    """Depth of the valley between the first two pulses; 0 if there is one only."""
    return q.valley_depth(run.view, gauge.id)


def window_over_train(run: OneRun, gauge: Gauge) -> Measured:
    """Time before the reflection over the length of the train of three at the gauge, guards included."""
    view, top = run.view, run.bead(run.card.beads + 1 - FAR)
    if top is None:
        return missing("absent: no gauge in the 17th bead from the bottom")
    lengths = []
    for gauge_id in (top, run.wall.id):
        found = train(run, gauge_id, TRAIN)
        if len(found) < 3:
            return missing(
                f"absent: {len(found)} of three pulses at {'g17' if gauge_id == top else 'the wall'}"
            )
        lengths.append(found[2].time - found[0].time)
    part = view.geometry.position(gauge.id) / view.geometry.position(top)
    length = lengths[1] + part * (lengths[0] - lengths[1])
    half, back = q.duration_half(view, gauge.id), q.reflection_time(view, gauge.id)
    if not (half.known and back.known):
        return back if half.known else half
    guard = GUARD * half.value
    return Measured((back.value - view.main(gauge.id).time - guard) / (length + guard))


def extra_pulses_upper_stronger(run: OneRun, upper: Gauge, lower: Gauge) -> Measured:
    """1 if the largest later peak is stronger at the upper gauge, looked for over one common time."""
    view = run.view
    mains = [view.main(s.id) for s in (upper, lower)]
    if not all(m.found for m in mains):
        return missing(next(m.reason for m in mains if not m.found))
    both = list(zip((upper, lower), mains, strict=True))
    common = min(view.free_until(s.id) - m.time for s, m in both)
    parts = []
    for s, m in both:
        later = pulses(view.trace(s.id), m, m.time + common, 0.0, EXTRA)[1:]
        parts.append(max((p.force for p in later), default=0.0) / m.force)
    return Measured(float(parts[0] > parts[1] + EXTRA))


def split_distance(run: OneRun) -> Measured:
    """First bead from the top at which the valley between the first two pulses is half deep."""
    for bead in range(1, run.card.beads + 1):
        gauge = run.bead(bead)
        if gauge is None:
            return missing("absent: not all contacts were kept")
        depth = q.valley_depth(run.view, gauge)
        if depth.known and depth.value >= SEPARATE:
            return Measured(float(bead))
    return missing(f"absent: in no bead is the valley {SEPARATE:g} deep before the reflection")
