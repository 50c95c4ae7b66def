"""What a colleague at the bench would say of a record: slips of the set-up that its traces show.

Traces differ from the nominal model for two reasons: a slip (a trigger, volts, a bead counted wrongly, the
wrong ball), or physics that the model lacks, which is what `discover` is for. Only differences that no effect
of the catalogue usually makes are told here: a common shift of all arrivals, amplitudes off by a factor, an
arrival that fits another bead, a mass that the material does not have.
"""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from sonicvacuum.laboratory.blocks import bead_blocks
from sonicvacuum.physics.scales import WAVE_POWER
from sonicvacuum.physics.theory import bead_mass
from sonicvacuum.records.expected import Expected
from sonicvacuum.records.record import Record

# A ball's mass off its material's density by more than this is told.
DENSITY = 0.10
# Amplitudes off by this factor: more than losses or a wrong modulus usually make along a chain.
FACTOR = 2.0
# Arrivals: relative error of the model's speed, and of single arrivals in passages of a bead.
SLOWNESS, SCATTER = 0.1, 0.1
# At one place only a shift beyond this share of the arrival is told: half the modulus makes a third.
ALONE = 0.4
# A shift of the trigger counts beyond so many of its standard errors and of the pulse's half widths.
SIGMAS, HALF_WIDTHS = 5.0, 0.5
# A moved gauge must explain the arrivals better by so much (in chi²) than none, and than any other one.
GAIN, LEAD = 25.0, 9.0
# An unknown time zero has a standard error of this many passages of a bead.
_FREE = 1e3


def suspects(record: Record, expected: Expected) -> list[str]:
    """One sentence for each likely slip, beginning with the place it concerns."""
    found = [*_masses(record), *copies(record)]
    counted = [*_beads(record, expected)]
    for run in () if counted else expected.bead_passage:
        found += _trigger(record, expected, run)
    found += [*counted, *_amplitudes(record, expected), *_windows(expected)]
    return found


def copies(record: Record) -> list[str]:
    """Runs and gauges whose traces are those of another, sample by sample; of noise that cannot be."""
    return [*(_copy(record, *one) for one in copied(record)), *(_twin(record, *one) for one in twins(record))]


def _copy(record, a, b, ids):
    """A sentence on traces of one run that are those of an earlier one."""
    if all(id in ids for id in record.signals[b].readings if id in record.signals[a].readings):
        return f"run {b}: holds the same samples as run {a}, to the last digit: one file was taken for both"
    gauges = f"gauge {ids[0]} reads" if len(ids) == 1 else f"gauges {', '.join(ids)} read"
    return f"run {b}: {gauges} the same samples as in run {a}, to the last digit: a trace was taken for both"


def _twin(record, one, two, runs):
    """A sentence on a gauge whose traces are an earlier one's."""
    said = f"gauge {two}: reads the same samples as gauge {one}, to the last digit"
    if len(runs) < len(record.signals):
        said += f", in {'run' if len(runs) == 1 else 'runs'} {', '.join(runs)}"
    return f"{said}: a column was taken for both"


def copied(record: Record) -> Iterator[tuple[str, str, list[str]]]:
    """A run, a later one, and the gauges whose traces are the same in both, sample by sample, and not
    constant.
    """
    for a, b in itertools.combinations(record.signals, 2):
        one, other = record.signals[a].readings, record.signals[b].readings
        same = [id for id in one if id in other and np.array_equal(one[id], other[id])]
        if ids := [id for id in same if np.ptp(one[id]) > 0.0]:
            yield a, b, ids


def twins(record: Record) -> Iterator[tuple[str, str, list[str]]]:
    """A gauge, a later one, and the runs in which both have the same trace, sample by sample, that is not
    constant.
    """
    for one, two in itertools.combinations([g.id for g in record.gauges], 2):
        both = {run: s.readings for run, s in record.signals.items() if {one, two} <= s.readings.keys()}
        same = [run for run, own in both.items() if np.array_equal(own[one], own[two])]
        if runs := [run for run in same if np.ptp(both[run][one]) > 0.0]:
            yield one, two, runs


@dataclass(frozen=True)
class Weight:
    """A ball's stated mass beside that of a solid one of its size and material.

    Attributes:
        key: where the mass stands in the record.
        given, usual: stated mass, and that of the material's density, in kg.
        diameter: in m.
        material: its name, that of the core of a coated ball.
        striker: whether it is a striker.
    """

    key: str
    given: float
    usual: float
    diameter: float
    material: str
    striker: bool

    @property
    def off(self) -> bool:
        """Whether material and size do not make the mass."""
        return abs(self.given / self.usual - 1.0) > DENSITY


def weights(record: Record) -> Iterator[Weight]:
    """Beads and strikers that are balls of materials whose density is known."""
    bodies = record.specimen.bodies
    for (place, _), bead in zip(bead_blocks(record.block.chain).kinds, bodies.kinds, strict=True):
        inner = bead.core or bead.surface
        if bead.flat or inner.density_kg_m3 is None or bead.surface.density_kg_m3 is None:
            continue
        coating = bead.coating_m or 0.0
        densities = inner.density_kg_m3, bead.surface.density_kg_m3
        usual = float(bead_mass(bead.diameter_m / 2.0 - coating, coating, *densities))
        yield Weight(f"{place}.mass_g", bead.mass_kg, usual, bead.diameter_m, inner.name, False)
    for k, run in enumerate(record.runs):
        s = run.striker
        if record.beads and math.isfinite(s.radius_m) and s.surface.density_kg_m3:
            usual = float(bead_mass(s.radius_m, 0.0, s.surface.density_kg_m3, s.surface.density_kg_m3))
            key = f"runs[{k}].striker.mass_g ({run.id})"
            yield Weight(key, s.mass_kg, usual, 2.0 * s.radius_m, s.surface.name, True)


def _masses(record) -> Iterator[str]:
    """Balls that do not weigh what their materials weigh."""
    for one in weights(record):
        if one.off:
            yield (
                f"{one.key}: is {one.given * 1e3:.4g} g, but a ball of {one.diameter * 1e3:.4g} mm of "
                f"{one.material} weighs {one.usual * 1e3:.4g} g: is it another material or size, or is it "
                "hollow or bored?"
            )


def _arrivals(expected, run):
    """Gauges, arrivals as expected and as measured, and passage of one bead in s, of one run."""
    features = expected.of("arrival", run)
    model, data = (np.array([getattr(f, key) for f in features]) for key in ("expected", "measured"))
    return [f.gauge for f in features], model, data, expected.bead_passage[run]


def _fit(trigger, model, data, passage):
    """Misfit in chi² of measured = shift + (1 + slowness) expected, for a trigger known to so many s."""
    sigma = SCATTER * passage
    trigger = min(trigger, _FREE * passage)
    rows = np.column_stack([np.ones(len(model)), model]) / sigma
    rows = np.vstack([rows, [1.0 / max(trigger, 1e-3 * passage), 0.0], [0.0, 1.0 / SLOWNESS]])
    values = np.concatenate([(data - model) / sigma, [0.0, 0.0]])
    best = np.linalg.lstsq(rows, values, rcond=None)[0]
    return float(np.sum((rows @ best - values) ** 2))


def _trigger(record, expected, run) -> Iterator[str]:
    """A common shift of all arrivals that the stated trigger error does not cover."""
    if math.isinf(record.trigger_sigma_s):
        return
    gauges, model, data, passage = _arrivals(expected, run)
    lasting = [f.expected for f in expected.of("duration_half", run)]
    if not gauges or not lasting:
        return
    slower = SLOWNESS
    if np.ptp(model) > 0.5 * passage:
        slope, shift = np.polyfit(model, data, 1)
        if abs(slope - 1.0) > 3.0 * SLOWNESS:
            return  # the wave itself is slower or faster: no matter of the trigger alone
    else:
        # At one place a late trigger and a slow wave look alike.
        shift, slower = np.mean(data - model), ALONE
    if abs(shift) > max(SIGMAS * record.trigger_sigma_s, HALF_WIDTHS * max(lasting), slower * model.max()):
        late = "early" if shift < 0.0 else "late"
        where = "every gauge" if len(gauges) > 1 else f"gauge {gauges[0]}"
        cure = "a gauge that triggers, or a pretrigger that was not subtracted?"
        yield (
            f"run {run}: the pulse is {abs(shift) * 1e6:.4g} us too {late} at {where}, trigger_sigma_us "
            f"is {record.trigger_sigma_s * 1e6:g}: {cure} Time 0 is the impact: shift the times, or write "
            "trigger_sigma_us: unknown"
        )


def _beads(record, expected) -> Iterator[str]:
    """A gauge whose arrivals in all runs fit another bead, or two that fit each other's, better than a late
    trigger does.
    """
    inside = {g.id: g.bead for g in record.gauges if g.bead is not None}
    moves = [((g, at - b),) for g, b in inside.items() for at in range(1, record.beads + 1) if at != b]
    pairs = itertools.combinations(inside, 2)
    moves += [((a, inside[b] - inside[a]), (b, inside[a] - inside[b])) for a, b in pairs]
    stated = record.trigger_sigma_s
    moved = {move: _misfit(expected, stated, dict(move)) for move in moves}
    if not moved:
        return
    plain, shifted = (_misfit(expected, sigma, {}) for sigma in (stated, math.inf))
    (best, cost), *others = sorted(moved.items(), key=lambda item: item[1])
    ahead = min((c for _, c in others), default=math.inf)
    ahead = min(ahead, shifted)
    if plain - cost > GAIN and ahead - cost > LEAD:
        if len(best) > 1:
            names = " and ".join(gauge for gauge, _ in best)
            yield f"gauges {names}: each one's pulses come when the other's should: are cables exchanged?"
            return
        ((gauge, step),) = best
        # Unlike beads do not all take as long to pass: how many the gauge is off is not known.
        where = f"bead {inside[gauge] + step}" if record.specimen.bodies.uniform else _side(step)
        yield (
            f"gauge {gauge}: its pulses come when they should at {where}, not at bead "
            f"{inside[gauge]}; bead 1 is the struck one: is the number of the bead right?"
        )


def _side(step):
    return f"a bead {'further from' if step > 0 else 'nearer to'} the striker"


def _misfit(expected, trigger, steps):
    """chi² of all runs' arrivals with some gauges moved by so many beads, gauge → `steps`, for a trigger
    known to so many s.
    """
    total = 0.0
    for run in expected.bead_passage:
        gauges, model, data, passage = _arrivals(expected, run)
        shifted = model + np.array([steps.get(g, 0) * passage for g in gauges])
        total += _fit(trigger, shifted, data, passage) if gauges else 0.0
    return total


def _amplitudes(record, expected) -> Iterator[str]:
    """Gauges whose scale, and strikers whose strength, the amplitudes put in doubt."""
    known = {g.id for g in record.gauges if g.calibrated}
    ratios = {
        (f.run, f.gauge): f.ratio for f in expected.of("amplitude") if f.gauge in known and f.ratio > 0.0
    }
    runs = {run: _typical(r for (k, _), r in ratios.items() if k == run) for run, _ in ratios}
    gauges = {g: _typical(r / runs[k] for (k, s), r in ratios.items() if s == g) for _, g in ratios}
    if len(gauges) > 1:
        for gauge, factor in gauges.items():
            if _off(factor):
                yield (
                    f"gauge {gauge}: its peaks are {factor:.3g} times what the other gauges make likely: is "
                    "its sensitivity or its unit right, or is it another channel?"
                )
    for run, factor in runs.items():
        if _off(factor):
            yield f"run {run}: peaks are {factor:.3g} times the expected ones{_why(expected, run, factor)}"


def _typical(ratios):
    return float(np.exp(np.median(np.log(list(ratios)))))


def _off(factor):
    return not 1.0 / FACTOR <= factor <= FACTOR


def _why(expected, run, factor):
    """Whether the wave's speed goes with its strength: then the striker is in doubt, else the scale is."""
    fast = [f.ratio for f in expected.of("speed", run) if f.ratio > 0.0]
    if not fast:
        return ": are they in N, not in V, and are the striker's mass and speed right?"
    speed = math.log(_typical(fast))
    strength = WAVE_POWER * math.log(factor)
    if abs(speed - strength) < abs(speed):
        return " and the wave is as fast as one so strong: are the striker's mass, material and speed right?"
    return ", yet the wave is not as fast as one so strong: are they in V, mN or kN?"


def _windows(expected) -> Iterator[str]:
    for w in expected.windows:
        (begin, end), (first, last) = w.needed, w.recorded
        run, needed = f"run {w.run}:", f"{begin * 1e6:.4g} to {end * 1e6:.4g} us are needed"
        if last < end:
            yield f"{run} ends at {last * 1e6:.4g} us; {needed} for the pulse at every gauge: record longer"
        if first > begin:
            yield f"{run} begins at {first * 1e6:.4g} us; {needed} with a rest before it: start earlier"
