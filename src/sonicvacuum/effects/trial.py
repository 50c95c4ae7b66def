"""Whether an effect keeps the contract of the catalogue: its header read, its law tried on a small chain.

The project's own effects are held against more than this by the tests; here a user's effect is refused with a
message before a search stumbles over it.
"""

import inspect
import math
import re
from dataclasses import fields

import numpy as np

from sonicvacuum.effects.base import PLACES, Effect, Parameter, Setup
from sonicvacuum.effects.parameter import NUISANCES, PRIORS
from sonicvacuum.gauges import Gauge
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.run import simulate
from sonicvacuum.physics.tracing import FormulaError

_ID = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
# The lanes of the trial, in typical deviations: off, hardly there, typical.
STRENGTHS = (0.0, 1e-6, 1.0)
# What is off or hardly there may change forces by so much of the largest one.
FAINT = 1e-3
DURATION, INTERVAL = 2e-4, 1e-6


def check(effect: Effect) -> None:
    """Check the header, then try the effect.

    Raises:
        ValueError: naming the effect, the field, what is wrong and the cure.
    """
    try:
        _header(effect)
        for p in effect.parameters:
            _parameter(p)
        _places(effect)
        _try(effect)
    except ValueError as error:
        raise ValueError(f"effect {effect.id!r}: {error}") from None


def _need(good, text):
    if not good:
        raise ValueError(text)


def _header(effect):
    _need(
        isinstance(effect.id, str) and _ID.fullmatch(effect.id),
        "id: use small letters, digits and single hyphens, as in my-law",
    )
    # Annotations of dataclass fields are the types themselves.
    for name in (f.name for f in fields(Effect) if f.type is str and f.name != "id"):
        text = getattr(effect, name)
        _need(isinstance(text, str) and text.strip(), f"{name}: is {text!r}; say it in a line of text")
    given = effect.parameters
    good = isinstance(given, tuple | list) and all(isinstance(p, Parameter) for p in given)
    _need(good, "parameters: give a tuple of Parameter; a tuple of one ends in a comma")
    names = [p.name for p in given]
    _need(len(set(names)) == len(names), f"parameters: {', '.join(names)}: each name once")
    _need(any(p.off is not None for p in given), "parameters: one needs an off value")
    shapes = [p.name for p in given if p.off is None]
    _need(len(shapes) < 2, f"parameters: {', '.join(shapes)}: only one may be without an off value")


def _parameter(p):
    _need(p.prior in PRIORS, f"{p.name}: prior is {p.prior!r}; use one of {', '.join(PRIORS)}")
    _need(p.scale > 0.0, f"{p.name}: scale is {p.scale}; give a typical deviation above 0")
    in_order = p.least <= p.low < p.high <= p.most and math.isfinite(p.high - p.low)
    _need(
        in_order,
        f"{p.name}: low {p.low}, high {p.high}: must be finite, low below high, within least and most",
    )
    _need(p.prior != "log-uniform" or p.low > 0.0, f"{p.name}: low is {p.low}; log-uniform needs it above 0")
    known = ", ".join(filter(None, NUISANCES))
    _need(p.acts_like in NUISANCES, f"{p.name}: acts_like is {p.acts_like!r}; use one of {known}")


def _places(effect):
    known = ", ".join(filter(None, PLACES))
    _need(effect.places in PLACES, f"places: is {effect.places!r}; use one of {known}, or leave it out")
    _need(
        effect.of_several in (None, "material"),
        f"of_several: is {effect.of_several!r}; use material, or leave it out",
    )
    paired = (effect.sits is None) == (effect.choices is None)
    _need(paired, "places (or of_several) and choices: give both, or neither")
    names = [p.name for p in effect.parameters] + ([effect.sits] if effect.sits else [])
    try:
        inspect.signature(effect.change).bind(None, **dict.fromkeys(names))
    except TypeError:
        raise ValueError(f"change: must take (setup, {', '.join(names)})") from None


def sample(coated: bool = False) -> Setup:
    """A short horizontal chain with a gauge in a bead and one at the wall."""
    soft, hard = Elastic("soft", 3e9, 0.4), Elastic("hard", 2e11, 0.3)
    body = Body(soft, 4.5e-4, 2.5e-3, coating=5e-5 if coated else math.inf)
    chain = Chain(4, body, hard, hard, math.inf, 4.5e-4, 0.5)
    gauges = (Gauge("inside", "embedded", 2), Gauge("wall", "wall"))
    return Setup(chain, gauges)


def _try(effect):
    """Simulate the effect off, faint and typical, wherever the sample lets it act."""
    setup = next((s for s in (sample(), sample(coated=True)) if effect.why_not(s) is None), None)
    if setup is None:
        return
    nominal = _simulated(setup.chain)
    for p in (p for p in effect.parameters if p.switches):
        try:
            force = _forces(effect, p, setup)
        except FloatingPointError:
            raise ValueError(f"{p.name}: forces do not stay finite at the typical deviation") from None
        except FormulaError as error:
            raise ValueError(f"its formula cannot be compiled: {error}") from None
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            told = " ".join(str(error).split())
            raise ValueError(f"trial with {p.name}: {type(error).__name__}: {told}") from None
        faint = np.abs(force[..., :-1] - nominal).max() / np.abs(nominal).max()
        _need(
            faint < FAINT,
            f"{p.name}: next to its off value forces change by {faint:.2g} of their peak; it must fade there",
        )


def _forces(effect, p, setup):
    """(samples, contacts, 3) contact forces with one parameter at `STRENGTHS`."""
    strengths = [max(s, p.least_strength) if s else s for s in STRENGTHS]
    values = {p.name: np.array([p.at(s, setup) for s in strengths])}
    place = {effect.places: effect.candidates(setup)[0]} if effect.places else {}
    changed = effect.apply(setup, **values, **place)
    if not isinstance(changed, Setup):
        raise TypeError(f"change returns {type(changed).__name__}; return the changed setup")
    chain = changed.chain if changed.chain.lanes == 3 else changed.chain.take(np.zeros(3, dtype=int))
    return _simulated(chain)


def _simulated(chain):
    """(samples, contacts, lanes) forces of all contacts."""
    return simulate(chain, range(chain.beads + 1), DURATION, INTERVAL).force
