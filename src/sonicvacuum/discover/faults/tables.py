"""Slips of records that have tables of values and no traces.

A value that no other supports is known to its own size only from then on (`spikes`). Rows of two gauges or of
two runs may stand in each other's place, a whole run or two gauges as well, a run may have been struck at
another speed, a bead be miscounted, and stated errors of all values or of one quantity be too small or too
large. What all strikers have in common is told as the effect that is just that; errors of all beads are asked
of traces only: tables of a few numbers do not tell them from a law.
"""

import itertools
import math
from collections import defaultdict
from dataclasses import replace
from functools import partial

import numpy as np

from sonicvacuum.discover.faults import policy, values
from sonicvacuum.discover.faults.course import standing_out
from sonicvacuum.discover.faults.foremost import foremost, held
from sonicvacuum.discover.faults.judged import Judged, Model, scale_gain
from sonicvacuum.discover.faults.slips import Slip, chain_slips, constant, swaps
from sonicvacuum.discover.faults.starts import NEAR
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.records import Record
from sonicvacuum.records.record import observable

# A value that no other supports may be anything of its size, give or take this factor.
ANYTHING = 3.0
# The quantity of a slip that concerns all rows of some runs.
ALL = "all values"
# Stated errors are off by e to this in the usual case, and by ten at most: what leaves more is no noise.
ERRORS, MOST = 2.0, math.log(10.0)
# What is left of noise stands by itself: neighbouring runs have no more in common than this many standard
# deviations of chance; no value is further off than so many errors, and half of them by this share of one
# (0.67 of white noise).
ALIKE, FARTHEST, HALF = 1.7, 4.0, 0.4


def asked(record: Record) -> bool:
    """Whether a record is a table of enough values for some to be held against the others: it has no traces,
    and `policy.FEWEST_VALUES` values or more, bounds and counts of pulses left out.
    """
    count = sum(_is_value(o) for run in record.block.runs for o in run.observables)
    return not record.signals and count >= policy.FEWEST_VALUES


def hypotheses(record: Record, model: Model) -> list[Slip]:
    """The slips of a table worth a look beside a model of it, in the order: chain, speeds, gauges, values,
    exchanged rows and runs, errors.

    Args:
        record: a table, as far as it was put right.
        model: of that record, fitted; its predictions tell where speeds start, which values and exchanges
            gain most (`foremost`), and what is left as noise.
    """
    runs, forward = _runs(record), _with_open_speeds(model.forward)
    start = _at_stated(forward, model.fit)
    whole, off = [], []
    for one in chain_slips(record):
        (off if one.fault == "run-off" else whole).append(one)
    off = _started(off, forward, start)
    gauges = swaps([g.id for g in record.gauges])
    seen = held([(k, j) for k, (_, rows) in enumerate(runs) for j, _ in rows], model, start)
    out = standing_out(runs, start, model)
    rows = [
        *_values(runs, start, model, seen, out.values),
        *_gauges(runs, seen),
        *_exchanged(runs, seen, out.exchanged),
        *_noise(runs, model),
    ]
    return [*whole, *off, *gauges, *rows]


def _runs(record):
    """For each run its id and its observables with their places in the record; counts and bounds left out."""
    return [
        (run.id, [(j, observable(o)) for j, o in enumerate(run.observables) if _is_value(o)])
        for run in record.block.runs
    ]


def _is_value(block):
    return block.bound is None and block.__struct_config__.tag != "pulse_count"


def _with_open_speeds(forward: Forward) -> Forward:
    """The predictor, or one of the same data whose exact speeds have an error: without any, no slope tells
    where a run's values would lead its speed.
    """
    e = forward.experiment
    if all(r.speed_rel_sigma for r in e.runs):
        return forward
    runs = tuple(replace(r, speed_rel_sigma=r.speed_rel_sigma or policy.OPEN_SPEED) for r in e.runs)
    return forward.of(replace(e, runs=runs))


def _at_stated(forward: Forward, one: Fit) -> list[np.ndarray]:
    """(1, 1 + p + local, M) whitened predictions and slopes of every run, where all is as stated but for the
    effects of a fit.
    """
    return forward.columns(one.hypothesis, one.u[None], 0.0 * one.nu[None])


def _started(slips, forward, start):
    """Speeds of single runs, from where their values lead in one step, beside what all runs show; of many
    those that gain most by it.
    """
    led = [_led(s, forward, start) for s in slips]
    sizes, known = (np.array([one[part] for one in led]) for part in (0, 1))
    sizes -= np.median(sizes) if len(sizes) > 2 else 0.0
    chosen = foremost(range(len(slips)), np.tile(np.square(sizes) * known, (2, 1)))
    slips, sizes = [slips[n] for n in chosen], sizes[chosen]
    sizes = np.clip(sizes, -policy.FARTHEST_SPEED, policy.FARTHEST_SPEED)
    far = [abs(size) > NEAR[s.fault] * s.width for s, size in zip(slips, sizes, strict=True)]
    return [replace(s, start=float(x)) if own else s for s, x, own in zip(slips, sizes, far, strict=True)]


def _led(slip, forward, start) -> tuple[float, float]:
    """The logarithm of a run's speed over the stated one to which its values lead in one step, and how well
    they know it: the inverse of its variance.
    """
    run = [r.id for r in forward.experiment.runs].index(slip.run)
    local, at = forward.local(run), forward.layout.speed(run)
    columns = start[run][0]
    # Columns stand in the order: predictions, parameters of effects, nuisances of the run.
    own = columns[len(columns) - len(local) + list(local).index(at)]
    slope, left = own / forward.nuisance_sigma[at], forward.data(run) - columns[0]
    known = float(slope @ slope) + slip.width**-2.0
    return float(slope @ left) / known, known


def _values(runs, start, model, seen, out):
    """Values by themselves."""
    places = list(seen.place)
    chosen = foremost(places, seen.alone(places))
    for k, j in sorted({*chosen, *out}):
        run, rows = runs[k]
        one = dict(rows)[j]
        expected = abs(float(start[k][0, 0, j]) * model.forward.experiment.runs[k].scalars[j].sigma)
        anything = ANYTHING * max(abs(one.value), expected)
        yield Slip(
            "spikes",
            partial(values.unsupported, k, j, anything / one.sigma),
            run,
            _gauges_of(one),
            len(places),
            quantity=one.in_words,
            of_values=True,
            value=partial(constant, None),
            seen=partial(_times, k, j),
            plain=(k, j) in out,
        )


def _gauges_of(one):
    found = tuple(str(one.options[key]) for key in ("sensor", "from", "to") if key in one.options)
    return found[0] if len(found) == 1 else found or None


def _times(k, j, model):
    """How many times what all others make of it a value is."""
    found = model.forward.sampled(model.fit.hypothesis, model.fit.u[None], model.fit.nu[None])[k][0, j]
    one = model.forward.experiment.runs[k].scalars[j]
    return one.value / (float(found) * one.sigma) if found else None


def _gauges(runs, seen):
    """Rows of two gauges in one run."""
    pairs = [
        (k, run, a, b)
        for k, (run, rows) in enumerate(runs)
        for a, b in itertools.combinations(rows, 2)
        if a[1].quantity == b[1].quantity and "sensor" in a[1].options and _level(a[1]) == _level(b[1])
    ]
    gains = seen.exchanged([((k, i), (k, j)) for k, _, (i, _), (j, _) in pairs])
    for k, run, (i, one), (j, other) in foremost(pairs, gains):
        yield Slip(
            "gauges-swapped",
            partial(values.exchange, [((k, i), (k, j))]),
            run,
            (str(one.options["sensor"]), str(other.options["sensor"])),
            len(pairs),
            quantity=one.quantity.replace("_", " "),
            of_values=True,
            value=partial(constant, None),
        )


def _level(one):
    return {key: value for key, value in one.options.items() if key != "sensor"}


def _exchanged(runs, seen, out):
    """Rows of one quantity in two runs, and all rows of two runs."""
    places = [{one.in_words: (k, j) for j, one in rows} for k, (_, rows) in enumerate(runs)]
    pairs = list(itertools.combinations(range(len(runs)), 2))
    single = [(a, b, name) for a, b in pairs for name in places[a] if name in places[b]]
    gains = seen.exchanged([(places[a][name], places[b][name]) for a, b, name in single])
    plain = [one for one in single if (places[one[0]][one[2]], places[one[1]][one[2]]) in out]
    for a, b, name in dict.fromkeys([*plain, *foremost(single, gains)]):
        one = _swapped_runs(runs, a, b, [(places[a][name], places[b][name])], len(single), name)
        yield replace(one, plain=(a, b, name) in plain)
    together: dict[tuple[int, int], np.ndarray] = defaultdict(lambda: np.zeros(2))
    for (a, b, _), gain in zip(single, gains.T, strict=True):
        together[a, b] = together[a, b] + gain
    whole = [(a, b) for a, b in pairs if places[a] and places[a].keys() == places[b].keys()]
    for a, b in foremost(whole, np.array([together[pair] for pair in whole]).reshape(-1, 2).T):
        yield _swapped_runs(runs, a, b, [(places[a][n], places[b][n]) for n in places[a]], len(whole))


def _swapped_runs(runs, a, b, rows, alternatives, name=ALL):
    return Slip(
        "runs-swapped",
        partial(values.exchange, rows),
        f"{runs[a][0]} and {runs[b][0]}",
        None,
        alternatives,
        quantity=name,
        of_values=True,
        value=partial(constant, None),
    )


def _noise(runs, model):
    """Stated errors of another size than what is left, of all values and of each quantity."""
    one = model.fit
    found = model.forward.sampled(one.hypothesis, one.u[None], one.nu[None])
    left = [model.forward.data(k) - value[0] for k, value in enumerate(found)]
    quantities = sorted({o.quantity for _, rows in runs for _, o in rows})
    for name in (None, *(quantities if len(quantities) > 1 else ())):
        rows = [(k, j, o) for k, (_, own) in enumerate(runs) for j, o in own if name in (None, o.quantity)]
        z = {(k, j, o.in_words): float(left[k][j]) for k, j, o in rows}
        # What is fitted follows the noise: of all values the strain of the nuisances makes up for that.
        strain = 0.0 if name else float(one.nu @ one.nu)
        square = (sum(v**2 for v in z.values()) + strain) / len(z)
        factor = math.sqrt(square)
        if abs(math.log(max(factor, 1e-6))) > MOST:
            continue
        if scale_gain(square, len(z)) < policy.LEAST_GAIN or not _random(z, factor):
            continue
        price = math.log(math.sqrt(2.0 * math.pi / (2.0 * len(z))) / (2.0 * ERRORS))
        places = [at[:2] for at in z]
        yield Slip(
            "noise-misstated",
            partial(values.rescaled, places, factor),
            # Whoever misjudges errors mostly misjudges all of them.
            alternatives=2 * len(quantities) if name else 2,
            quantity=name and name.replace("_", " "),
            of_values=True,
            value=partial(constant, factor),
            occam=price,
            undo=partial(values.rescaled, places, 1.0 / factor),
        )


def _random(z, factor) -> bool:
    """Whether what is left of some values is noise: neighbouring runs have nothing in common, none is far,
    nor do a few make up all of it. Quantities that stand once have no neighbours, and are believed.

    Args:
        z: (run, place in it, quantity) → what the model leaves of the value, in stated standard errors.
        factor: root of the mean square of these.
    """
    sizes = np.abs(list(z.values())) / factor
    half = float(np.median(sizes))
    if sizes.max() > FARTHEST or half < HALF:
        return False
    series = defaultdict(list)
    for (_, _, name), value in z.items():
        # The farthest must not hide what all others have in common.
        series[name].append(np.clip(value / factor, -3.0 * half, 3.0 * half))
    pairs = [a * b for own in series.values() for a, b in itertools.pairwise(own)]
    mean = np.mean(np.square([v for own in series.values() for v in own]))
    return not pairs or sum(pairs) < ALIKE * math.sqrt(len(pairs)) * mean


def earned(kept: list[Judged]) -> list[Judged]:
    """Slips without errors of another size where another slip explains more than such errors leave to chance:
    these are asked for again once that is put right.

    Args:
        kept: slips as they were fitted beside one model, the likeliest first, as are those returned.
    """
    return [
        j
        for j in kept
        if not any(beyond_chance(j, other.gain) for other in kept if other.slip.fault != j.slip.fault)
    ]


def beyond_chance(judged: Judged, gain: float) -> bool:
    """Whether something gains more than noise of the size that a slip of errors says would let it.

    Args:
        judged: any slip; False of those that concern no errors.
        gain: Δ(−2 log L) of something else against the same model, errors as they are stated.
    """
    factor = judged.slip.value(judged.size) if judged.slip.fault == "noise-misstated" else None
    return factor is not None and gain > policy.CHANCE * factor**2


def worth(looked: list[Judged]) -> list[Judged]:
    """The best of each kind, of those that gain enough, and what shows by itself; the likeliest first.

    Exchanges and errors of one quantity are another kind than those of all; `looked` at are slips beside one
    model, in any order.
    """
    best = {}
    for judged in looked:
        kind = (judged.slip.fault, judged.slip.quantity in (None, ALL))
        if judged.gain > policy.LEAST_GAIN and (kind not in best or judged.log_odds > best[kind].log_odds):
            best[kind] = judged
    chosen = [*best.values(), *(j for j in looked if j.slip.plain and j not in best.values())]
    return sorted(chosen, key=lambda j: -j.log_odds)
