"""The next run: which change of the experiment best separates the explanations that are left.

For each change the best fit and its rival predict a new run; the rival may follow the best fit's prediction
with its own parameters and with all nuisances as far as the data at hand allow. The χ² that remains is what
the run is expected to decide (Box & Hill, Technometrics 9, 57, 1967; Buzzi-Ferraris & Forzatti, Chem. Eng.
Sci. 38, 225, 1983).
"""

from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.discover.model.experiment import Batch, Experiment, RunData
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.verdict import Next
from sonicvacuum.laboratory.next_run import FASTEST, MASSES, PRELOADS, SLOWEST, SPEEDS, gauge_beads
from sonicvacuum.laboratory.ranges import likely_ball
from sonicvacuum.laboratory.specimen import GRAVITY
from sonicvacuum.physics.chain import Chain

_RIVALS = 2


def propose(found: Investigation, alike: list[list[str]]) -> Next | None:
    """The run that best separates the named effect from its nearest rival; None without signals or rivals."""
    forward = found.forward
    if not any(r.has_signals for r in forward.experiment.runs):
        return None
    rivals = _rivals(found, alike)
    if len(rivals) < 2:
        return None
    (name, best), others = rivals[0], rivals[1:]
    known = [(fit, precision(forward, fit)) for _, fit in others]
    scored = []
    for change, imagined in changes(forward.experiment):
        if "chain.orientation" in change and any(_depends_on_orientation(fit) for _, fit in rivals):
            continue  # records that hang differently say nothing of such an effect when taken together
        new = Forward(imagined, forward.threads)
        truth = predicted(forward, new, best)
        values = [separation(forward, new, truth, *rival) for rival in known]
        forward.simulations += new.simulations
        scored.append((min(values), change, [name, others[int(np.argmin(values))][0]]))
    if not scored:
        return None
    value, change, separates = max(scored, key=lambda s: s[0])
    return Next(change=change, separates=separates, delta_chi2=float(value))


def _depends_on_orientation(fit):
    """Whether an effect of a fit is off at the recorded orientation."""
    return any(c.effect.depends_on_orientation for c in fit.hypothesis.components)


def _rivals(found: Investigation, alike):
    """(name, fit) of the best explanation and the nearest rivals."""
    if len(found.named) > 1 and "unknown" not in found.named:
        own = set(found.named)
        ranked = [("+".join(c.effects), c.fit) for c in found.combinations]
        ranked = sorted(ranked, key=lambda r: set(r[0].split("+")) != own)
        return ranked[: 1 + _RIVALS]
    ranked = [(c.effect, c.fit) for c in found.candidates if c.gain > 0.0]
    if len(found.named) == 1 and found.named[0] != "unknown":
        ranked = sorted(ranked, key=lambda r: r[0] != found.named[0])
        members = set(alike[0]) if alike else set()
        near = [r for r in ranked if r[0] in members] or ranked[: 1 + _RIVALS]
        return near[: 1 + _RIVALS]
    return [("none", found.null), *ranked[:_RIVALS]] if not found.named else ranked[: 1 + _RIVALS]


@dataclass(frozen=True)
class Means:
    """What a laboratory can change, for the last of its runs.

    Attributes:
        speeds: of the striker in m/s.
        masses: of the striker in kg.
        preloads: static force in N.
        turned: whether the chain can be hung the other way.
        beads: that may hold the first embedded gauge.
    """

    speeds: tuple[float, ...]
    masses: tuple[float, ...]
    preloads: tuple[float, ...]
    turned: bool
    beads: tuple[int, ...]


def means(experiment: Experiment, chain: Chain) -> Means:
    """What the record's `apparatus` allows, or what most laboratories can do where it has none."""
    speed, mass, force = (float(x[0]) for x in (chain.speed, chain.striker_mass, chain.static_force))
    given = experiment.record.block.apparatus if experiment.record is not None else None
    if given is None:
        return Means(
            speeds=tuple(speed * f for f in SPEEDS if SLOWEST <= speed * f <= FASTEST),
            masses=tuple(mass * f for f in MASSES),
            preloads=tuple(force + more for more in PRELOADS),
            turned=True,
            beads=tuple(gauge_beads(experiment.beads)),
        )
    slow, fast = given.speed_m_s or (speed, speed)
    speeds = {slow, fast, *(speed * f for f in SPEEDS if slow <= speed * f <= fast)} - {speed}
    other = "horizontal" if chain.gravity[0] > 0.0 else "vertical"
    return Means(
        speeds=tuple(sorted(speeds)),
        masses=tuple(m / 1e3 for m in given.striker_mass_g if abs(m / 1e3 - mass) > 1e-9 * mass),
        preloads=tuple(f for f in given.static_force_N if f != force),
        turned=other in given.orientation,
        beads=tuple(given.gauge_beads),
    )


def changes(experiment: Experiment):
    """(change, experiment with that one run) for every run that can be imagined; the last run is varied."""
    batch = next(b for b in experiment.batches if experiment.runs[b.runs[0]].has_signals)
    lane = len(batch.runs) - 1
    run = experiment.runs[batch.runs[lane]]
    chain = batch.chain.take([lane])
    speed = float(chain.speed[0])
    can = means(experiment, chain)
    for value in can.speeds:
        changed = chain.struck_at(np.full_like(chain.speed, value))
        imagined = _with(experiment, batch, run, changed, value / speed)
        yield {"striker.speed_m_s": round(value, 4)}, imagined
    for mass in can.masses:
        # The contact keeps its radius, so that a ball keeps its size.
        if likely_ball(mass, float(np.max(chain.striker_radius))):
            changed = replace(chain, striker_mass=np.full_like(chain.striker_mass, mass))
            yield {"striker.mass_g": round(mass * 1e3, 4)}, _with(experiment, batch, run, changed)
    for force in can.preloads:
        changed = replace(chain, static_force=np.full_like(chain.static_force, force))
        yield {"chain.static_force_N": float(force)}, _with(experiment, batch, run, changed)
    if can.turned:
        upright = bool(chain.gravity[0] > 0.0)
        changed = replace(chain, gravity=np.array([0.0 if upright else GRAVITY]))
        imagined = _with(experiment, batch, run, changed)
        yield {"chain.orientation": "horizontal" if upright else "vertical"}, imagined
    yield from _gauges(experiment, batch, run, chain, can.beads)


def _gauges(experiment, batch, run, chain, beads):
    """The first embedded gauge moved to one of some beads."""
    embedded = [k for k, g in enumerate(experiment.gauges) if g.kind == "embedded"]
    for bead in beads if embedded else ():
        gauge = experiment.gauges[embedded[0]]
        moved = tuple(
            replace(g, bead=bead) if k == embedded[0] else g for k, g in enumerate(experiment.gauges)
        )
        if bead != gauge.bead:
            imagined = _with(experiment, batch, run, chain)
            yield {f"sensors.{gauge.id}.bead": bead}, replace(imagined, gauges=moved)


def _with(experiment, batch, run, chain, faster: float = 1.0):
    """The experiment that consists of one imagined run; slower pulses are watched for longer."""
    longer = max(1.0, faster**-0.2)
    step = run.interval
    samples = int(len(run.time) * longer)
    time = run.time[0] + step * np.arange(samples)
    data = RunData("next", time, np.zeros((len(experiment.gauges), samples)), (), run.speed_rel_sigma)
    new = Batch(chain, (0,), batch.interval, batch.duration + step * (samples - len(run.time)))
    return replace(experiment, runs=(data,), batches=(new,), smooth=None, slow=None)


def predicted(old: Forward, new: Forward, fit) -> np.ndarray:
    """(M,) data of a new run over their noise, as a fit of the old runs has them."""
    return new.sampled(fit.hypothesis, fit.u[None], _shared(old, new, fit)[None])[0][0]


def separation(old: Forward, new: Forward, truth: np.ndarray, rival, known: np.ndarray) -> float:
    """χ² by which a new run is expected to tell what made it from a rival.

    The rival's parameters and the shared nuisances (gains, modulus) move within what the old data leave
    them; speed and trigger of the new run are free within their errors.

    Args:
        old, new: the old runs and the new one.
        truth: (M,) data of the new run over their noise, see `predicted`.
        rival: fit of the rival to the old runs.
        known: its `precision`.
    """
    columns = new.columns(rival.hypothesis, rival.u[None], _shared(old, new, rival)[None])[0][0]
    miss, slopes = truth - columns[0], columns[1:]
    projection = slopes @ miss
    explained = projection @ np.linalg.lstsq(slopes @ slopes.T + known, projection, rcond=1e-12)[0]
    return float(max(miss @ miss - explained, 0.0))


def _shared(old, new, fit):
    """(q,) nuisances of the new run: what is shared as fitted, speed and trigger at zero."""
    nu = np.zeros(new.layout.size)
    nu[new.layout.shared] = fit.nu[old.layout.shared]
    return nu


def precision(old: Forward, fit) -> np.ndarray:
    """(n, n) precision of the columns of a new run: parameters and shared nuisances from the old data, 1 for
    its own.
    """
    _, hessian = fit.normal.total()
    free = fit.normal.free
    kept = np.array([*range(free), *(free + old.layout.shared)])
    covariance = np.linalg.pinv(hessian[0], rcond=1e-12, hermitian=True)[np.ix_(kept, kept)]
    known = np.linalg.pinv(covariance, rcond=1e-12, hermitian=True)
    count = len(kept) + 2
    result = np.eye(count)
    # Columns run: parameters, modulus, speed, trigger, gains, others; speed and trigger are its own.
    shared = np.array([*range(free + 1), *range(free + 3, count)])
    result[np.ix_(shared, shared)] = known
    return result
