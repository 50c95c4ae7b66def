"""What the nominal model asks of a record to follow the data: numbers far beyond the errors that it states.

A gauge that reads twice as much leaves no misfit where a gain may be twice as large; what is against that is
the stated error alone. Then the misfit, and what an effect takes away of it, say nothing of what is missing.
"""

import numpy as np

from sonicvacuum.discover import policy
from sonicvacuum.discover.fit.enough import data
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model.forward import Forward

# How the line begins that says so.
ONLY_WITH = "the nominal model comes so near the data only with"
# Stated errors from which it is said, and share of them that has to be gone with what is named.
FAR, GONE = 5.0, 0.5
_WHAT = {
    "modulus": "the modulus of {}",
    "bead-mass": "the mass of the beads",
    "bead-diameter": "the diameter of the beads",
    "coating": "the thickness of the coating",
    "striker-mass": "the mass of the striker",
    "speed-common": "the speed of the striker in all runs",
    "gain-common": "the gain of all gauges",
    "clock": "the rate of the recorder's clock",
}


def told(forward: Forward, null: Fit, final: Fit) -> list[str]:
    """What the nominal model strains most, one line; [] where that is little, where it is strained beside the
    named effects as well, and where that brings the model nowhere near.

    A nominal fit far from the data is held to what the record states, and its last step is taken here.
    """
    gradient, hessian = null.normal.total()
    step = np.linalg.lstsq(hessian[0], gradient[0], rcond=1e-12)[0]
    nu = null.nu + step
    left = null.objective - float(gradient[0] @ step) - float(nu @ nu)
    k = int(np.argmax(np.abs(nu)))
    far = abs(float(nu[k]))
    if far < FAR or abs(float(final.nu[k])) > GONE * far or left > policy.GROSS * data(forward):
        return []
    what, shift = _name(forward, k), float(nu[k] * forward.nuisance_sigma[k])
    timed = what.startswith(("the time zero", "the delay"))
    size = f"shifted by {1e6 * shift:.3g} µs" if timed else f"{np.exp(shift):.3g} times the stated one"
    return [f"{ONLY_WITH} {what} {size}, {far:.2g} of its stated errors away"]


def _name(forward, k):
    """A nuisance in words."""
    e, layout = forward.experiment, forward.layout
    names = {layout.modulus: "the modulus of the beads"}
    for run, one in enumerate(e.runs):
        names[layout.speed(run)] = f"the speed of the striker in run {one.id}"
        names[layout.trigger(run)] = f"the time zero of run {one.id}"
    names |= {int(at): f"the gain of gauge {g.id}" for at, g in zip(layout.gains, e.gauges, strict=True)}
    for at, one in enumerate(layout.others, start=layout.modulus + 1):
        other = f"the {one.kind} of {one.of}" if one.of else f"the {one.kind}"
        names[at] = _WHAT.get(one.kind, other).format(one.of)
    return names[k]
