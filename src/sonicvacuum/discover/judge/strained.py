"""What the nominal model asks of a record to follow the data: numbers far beyond the errors that it states.

A gauge that reads twice as much leaves no misfit where a gain may be twice as large; what is against that is
the stated error alone. Then the misfit, and what an effect takes away of it, say nothing of what is missing.
"""

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit, simulated
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.nuisances import SCATTER, WORDS, stated

# How the line begins that says so.
ONLY_WITH = "the nominal model comes so near the data only with"
# Stated errors from which it is said, and share of them that has to be gone with what is named.
FAR, GONE = 5.0, 0.5
# A contact that bears less than this share of the stated preload is free of it.
BORNE = 0.2


def lines(forward: Forward, null: Fit, final: Fit | None) -> list[str]:
    """What is worth a look at the record: `told`, and `unpressed` where something is named, by `final`."""
    return told(forward, null, final) + ([] if final is None else unpressed(forward, final))


def told(forward: Forward, null: Fit, final: Fit | None) -> list[str]:
    """What the nominal model strains most, one line; [] where that is little, where it is strained beside the
    named effects as well, and where that brings the model nowhere near. `final` is None where none is named.

    A nominal fit far from the data is held to what the record states; its last step is taken here, and
    simulated.
    """
    gradient, hessian = null.normal.total()
    nu = null.nu + np.linalg.lstsq(hessian[0], gradient[0], rcond=1e-12)[0]
    k = int(np.argmax(np.abs(nu)))
    far = abs(float(nu[k]))
    if far < FAR or (final is not None and abs(float(final.nu[k])) > GONE * far):
        return []
    left = simulated(forward, null.hypothesis, null.u[None], nu[None])[0]
    if not left <= policy.GROSS * data(forward):
        return []
    return [f"{ONLY_WITH} {_moved(forward, k, float(nu[k]))}, {far:.2g} {_errors(forward, k)}"]


def unpressed(forward: Forward, final: Fit) -> list[str]:
    """That what is named takes a stated preload off a contact, one line; [] where it does not.

    No effect makes a preload less than it is stated: a gap, however small, takes it off all contacts behind
    it, and is then named where the chain was not pressed as stated.
    """
    batch = forward.experiment.batches[0]
    nominal = forward.nominal(batch, final.nu[None])
    stated = float(np.max(nominal.chain.static_force))
    if not stated > 0.0:
        return []
    changed = final.hypothesis.change(final.u[None])(nominal, np.zeros(len(batch.runs), dtype=int))
    bears = changed.chain.static_forces(forward.experiment.beads + 1)[1:].min(axis=1)
    free = np.flatnonzero(bears < BORNE * stated)
    if not len(free):
        return []
    return [
        f"what is named takes the stated static_force_N of {stated:.3g} N off contact {free[0] + 1}: look "
        "whether the chain was pressed by that much"
    ]


def _errors(forward, k):
    """Whose errors a nuisance is so many of away: the record's, or those taken where it states none."""
    record, place = forward.experiment.record, k - forward.layout.modulus - 1
    if record is not None and place >= -1:
        other = forward.layout.others[place] if place >= 0 else None
        kind, of = (other.kind, other.of) if other else ("modulus", record.specimen.first.surface.name)
        if not stated(record, kind, of):
            size = 100.0 * float(forward.nuisance_sigma[k])
            return f"times the standard error of {size:.2g} % that is taken, as the record states none"
    return "of its stated errors away"


def _moved(forward, k, nu):
    """A nuisance and where it has moved to, in words."""
    e, layout, shift = forward.experiment, forward.layout, nu * float(forward.nuisance_sigma[k])
    ratio, time = f"{np.exp(shift):.3g} times the stated one", f"shifted by {1e6 * shift:.3g} µs"
    for run, one in enumerate(e.runs):
        if k == layout.speed(run):
            return f"the speed of the striker in run {one.id} {ratio}"
        if k == layout.trigger(run):
            return f"the time zero of run {one.id} {time}"
    if k in layout.gains:
        return f"the gain of gauge {e.gauges[int(np.flatnonzero(layout.gains == k)[0])].id} {ratio}"
    if k == layout.modulus:
        return f"the modulus of the beads {ratio}"
    one = layout.others[k - layout.modulus - 1]
    if one.kind == "shared":
        return f"the error common to several quantities, {one.of}"
    if one.kind == "clock":
        return f"the recorder's clock off by {100.0 * shift:.2g} %"
    if one.kind == SCATTER:
        each = shift * np.array(one.weights)
        bead = int(np.argmax(np.abs(each)))
        return f"beads that do not weigh alike, bead {bead + 1} {np.exp(each[bead]):.3g} times what is stated"
    what = WORDS.get(one.kind, one.kind) + f" of {one.of}" * bool(one.of)
    return f"the {what} {time if one.kind == 'delay' else ratio}"
