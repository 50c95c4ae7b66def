"""What the gauges of one run give of the main pulse; definitions in `workflow/resources/claims.md`.

Each function takes the run and a gauge, or a pair, and returns the value in the unit that `metrics` states,
or the reason why there is none.
"""

import numpy as np

from sonicvacuum.gauges import Gauge
from sonicvacuum.gauges.electronics import high_passed
from sonicvacuum.observe import quantities as q
from sonicvacuum.observe.pulse import main_pulse
from sonicvacuum.observe.trace import Measured, Trace, missing
from sonicvacuum.physics.solitary import SolitaryWave
from sonicvacuum_paper.one_run import OneRun
from sonicvacuum_paper.printed import PRINTED

MICRO = 1e6


def scaled(measured: Measured, factor: float) -> Measured:
    """A value in another unit."""
    return Measured(measured.value * factor, measured.reason)


def amplitude(run: OneRun, gauge: Gauge) -> Measured:
    """Peak of the signal in N."""
    return q.amplitude(run.view, gauge.id)


def arrival(run: OneRun, gauge: Gauge) -> Measured:
    """Time of the peak in us from first touch."""
    return scaled(q.arrival(run.view, gauge.id), MICRO)


def duration(run: OneRun, gauge: Gauge, level: float = 0.01) -> Measured:
    """Time in us above a level; absent where the reflection comes before the signal has fallen to it."""
    view = run.view
    lasting = q.duration(view, gauge.id, level)
    if lasting.known and view.edge(gauge.id, level, rising=False).value > view.free_until(gauge.id):
        return missing(f"merged: the reflection comes before the signal falls to {level:g} of the peak")
    return scaled(lasting, MICRO)


def width(run: OneRun, gauge: Gauge, level: float = 0.01) -> Measured:
    """Duration times speed between the gauges, in diameters."""
    lasting, speed = duration(run, gauge, level), run.speed()
    if not (lasting.known and speed.known):
        return speed if lasting.known else lasting
    return Measured(lasting.value / MICRO * speed.value / run.diameter)


def preload_over_amplitude(run: OneRun, gauge: Gauge) -> Measured:
    """Static force over amplitude; an embedded gauge bears the mean of its two contacts."""
    peak = amplitude(run, gauge)
    contacts = (run.card.beads,) if gauge.kind == "wall" else (gauge.bead - 1, gauge.bead)
    static = float(np.mean([run.static_force(c) for c in contacts]))
    return Measured(static / peak.value, peak.reason)


def gauge_over_contact(run: OneRun, gauge: Gauge) -> Measured:
    """Amplitude over the larger dynamic peak of the gauge's two contacts."""
    peak = amplitude(run, gauge)
    found = [main_pulse(run.contact(c)) for c in (gauge.bead - 1, gauge.bead)]
    if not all(p.found for p in found):
        return missing(next(p.reason for p in found if not p.found))
    return Measured(peak.value / max(p.force for p in found), peak.reason)


def droop_peak(run: OneRun, gauge: Gauge) -> Measured:
    """Part of the peak lost through the gauge's discharge (RC about 1000 us)."""
    peak, after = _undrooped(run, gauge), main_pulse(_discharged(run, gauge))
    if not (peak.found and after.found):
        return missing(after.reason if peak.found else peak.reason)
    return Measured(1.0 - after.force / peak.force)


def droop_undershoot(run: OneRun, gauge: Gauge) -> Measured:
    """Lowest reading below zero after the discharge, over the amplitude, before the reflection."""
    peak, main = _undrooped(run, gauge), run.view.main(gauge.id)
    if not (peak.found and main.found):
        return missing(peak.reason or main.reason)
    drooped = _discharged(run, gauge)
    last = min(run.view.free_until(gauge.id) / drooped.interval, len(drooped.force))
    lowest = drooped.force[: 1 + int(last)].min()
    return Measured(-float(lowest) / peak.force)


def offset_amplitude(run: OneRun, gauge: Gauge) -> Measured:
    """Largest relative change of the peak when the gauge sits 1 mm off the middle of its bead."""
    peak = _undrooped(run, gauge)
    if not peak.found:
        return missing(peak.reason)
    e = PRINTED.gauge_offset / run.diameter
    shifted = [_shifted(run, gauge, s) for s in (e, -e)]
    if not all(p.found for p in shifted):
        return missing(next(p.reason for p in shifted if not p.found))
    return Measured(max(abs(p.force / peak.force - 1.0) for p in shifted))


def offset_speed(run: OneRun, upper: Gauge, lower: Gauge) -> Measured:
    """Largest relative change of the speed when each gauge sits 1 mm off the middle of its bead.

    As `offset_amplitude`: a gauge off the middle weighs its two contacts unequally. The sum of two pulses one
    diameter apart is nearly flat on top, so that its peak moves further than the gauge.
    """
    e = PRINTED.gauge_offset / run.diameter
    times = [[_shifted(run, gauge, s) for s in (-e, 0.0, e)] for gauge in (upper, lower)]
    if not all(p.found for of_gauge in times for p in of_gauge):
        return missing(next(p.reason for of_gauge in times for p in of_gauge if not p.found))
    (first, middle, last), (early, centre, late) = ([p.time for p in of_gauge] for of_gauge in times)
    apart = centre - middle
    return Measured(max(abs(apart / (b - a) - 1.0) for a, b in ((first, late), (last, early))))


def _shifted(run, gauge, e):
    """Main pulse of a gauge e diameters from the middle of its bead towards the striker, no electronics."""
    before, after = (run.contact(c).force for c in (gauge.bead - 1, gauge.bead))
    return main_pulse(Trace(0.0, run.simulation.interval, (0.5 + e) * before + (0.5 - e) * after))


def shape_deviation(run: OneRun, gauge: Gauge) -> Measured:
    """Width at half height against that of the exact travelling wave seen by the same kind of gauge."""
    around = run.bead(gauge.bead - 2), run.bead(gauge.bead + 2)
    if None in around:
        return missing("absent: no gauges two beads up and down")
    half, speed = q.duration_half(run.view, gauge.id), q.speed(run.view, *around)
    if not (half.known and speed.known):
        return speed if half.known else half
    exact = SolitaryWave.compute().gauge_width(0.5)
    return Measured(abs(half.value * speed.value / run.diameter / exact - 1.0))


def speed(run: OneRun, upper: Gauge, lower: Gauge) -> Measured:
    """Distance over the time from peak to peak, in m/s; absent of two gauges in one bead."""
    if upper.bead == lower.bead:
        return missing("absent: both gauges sit in one bead")
    return q.speed(run.view, upper.id, lower.id)


def decay(run: OneRun, upper: Gauge, lower: Gauge) -> Measured:
    """Amplitude of the second gauge over that of the first."""
    return q.decay(run.view, upper.id, lower.id)


def speed_change(run: OneRun) -> Measured:
    """Relative change of speed from g17-g9 to g9-g5."""
    if run.span is None:
        return run.speed()
    above = run.bead(run.span[0].bead - 8)
    if above is None:
        return missing("absent: no gauge eight beads above the upper one")
    before, after = q.speed(run.view, above, run.span[0].id), run.speed()
    if not (before.known and after.known):
        return after if before.known else before
    return Measured(abs(after.value / before.value - 1.0))


def _undrooped(run, gauge):
    return main_pulse(_plain(run, gauge))


def _plain(run, gauge):
    """Reading without electronics."""
    if gauge.kind == "wall":
        return run.contact(run.card.beads)
    force = 0.5 * (run.contact(gauge.bead - 1).force + run.contact(gauge.bead).force)
    return Trace(0.0, run.simulation.interval, force)


def _discharged(run, gauge):
    whole = _plain(run, gauge)
    return Trace(0.0, whole.interval, high_passed(whole.force, whole.interval, PRINTED.gauge_rc))
