"""Whether an effect keeps the contract of the catalogue: its header read, its law tried on a small chain.

The project's own effects are held against more than this by the tests; here a user's effect is refused with a
message before a search stumbles over it.
"""

import inspect
import math
import re
import traceback
from contextlib import contextmanager
from dataclasses import fields, replace

import numpy as np

from sonicvacuum.effects.base import PLACES, Effect, Parameter, Setup
from sonicvacuum.effects.parameter import NUISANCES, PRIORS
from sonicvacuum.gauges import Gauge
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.laws import SLOTS
from sonicvacuum.physics.run import simulate
from sonicvacuum.physics.tracing import FormulaError

_ID = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
# The lanes of the trial, in typical deviations: off, hardly there, typical.
STRENGTHS = (0.0, 1e-6, 1.0)
# What is off or hardly there may change forces by so much of the largest one.
FAINT = 1e-3
DURATION, INTERVAL = 2e-4, 1e-6
# What a law that takes energy may seem to create, of the most that a contact took up: the project's own stay
# below 2e-5, what sums over samples miss.
CREATED = 1e-3
# Numbers that formulas are called with twice.
PROBES = np.array([1e-6, 1e-2, 1.0])


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
    with _in_words(effect, "trial"):
        setup = next((s for s in (sample(), sample(coated=True)) if effect.why_not(s) is None), None)
    if setup is None:
        return
    nominal = _simulated(setup.chain).force
    for p in (p for p in effect.parameters if p.switches):
        with _in_words(effect, f"trial with {p.name}"):
            changing = _changing(*(_changed(effect, p, setup, STRENGTHS).chain for _ in range(2)))
            force = _simulated(_changed(effect, p, setup, STRENGTHS).chain).force
            created = _created(_changed(effect, p, setup, (0.0, 1.0)).chain) if effect.dissipative else 0.0
        _need(not changing, f"{p.name}: {changing} gives other numbers when called again; it must not")
        faint = np.abs(force[..., :-1] - nominal).max() / np.abs(nominal).max()
        _need(
            faint < FAINT,
            f"{p.name}: next to its off value forces change by {faint:.2g} of their peak; it must fade there",
        )
        _need(
            created < CREATED,
            f"{p.name}: is declared dissipative and creates energy, {created:.2g} of what a contact takes up "
            "at the typical deviation; turn the sign of the force, or write dissipative=False",
        )


@contextmanager
def _in_words(effect, what):
    """Errors of an effect's own code as ValueError, with the line in its file."""
    try:
        yield
    except FloatingPointError:
        raise ValueError(f"{what}: forces do not stay finite at the typical deviation") from None
    except (Exception, SystemExit) as error:
        told = " ".join(str(error).split())
        if isinstance(error, FormulaError):
            what = "its formula cannot be compiled"
        else:
            told = f"{type(error).__name__}: {told}"
        raise ValueError(f"{_line(error, effect)}{what}: {told}") from None


def _line(error, effect):
    """The last line of the effect's file that an error, or its cause, went through; empty without one."""
    file = getattr(getattr(effect.change, "__code__", None), "co_filename", None)
    frames = [f for e in (error, error.__cause__) if e for f in traceback.extract_tb(e.__traceback__)]
    lines = [f.lineno for f in frames if f.filename == file]
    return f"line {lines[-1]}: " if lines else ""


def _changed(effect, p, setup, strengths):
    """The setup with one parameter at some strengths, a lane for each."""
    strengths = [max(s, p.least_strength) if s else s for s in strengths]
    values = {p.name: np.array([p.at(s, setup) for s in strengths])}
    place = {effect.places: effect.candidates(setup)[0]} if effect.places else {}
    changed = effect.apply(setup, **values, **place)
    if not isinstance(changed, Setup):
        raise TypeError(f"change returns {type(changed).__name__}; return the changed setup")
    if changed.chain.lanes == len(strengths):
        return changed
    return replace(changed, chain=changed.chain.take(np.zeros(len(strengths), dtype=int)))


def _simulated(chain, duration=DURATION, interval=INTERVAL, bodies=()):
    """The history of all contacts."""
    return simulate(chain, range(chain.beads + 1), duration, interval, bodies=bodies)


def _changing(one, other):
    """Which function of two chains, made alike, gives other numbers when it is called again; None if none.

    A formula is compiled from one call of it: a random number in it would be another one in every process.
    """
    bodies = one.beads + 1
    for first, second in zip(one.actions, other.actions, strict=True):
        tables = [
            a.table(c, c.stiffnesses(bodies), c.masses(bodies)) for a, c in ((first, one), (second, other))
        ]
        if not np.array_equal(*tables, equal_nan=True):
            return first.coefficients.__name__
        columns = [tables[0][0, k, -1] for k in range(first.term.coefficients)]
        for what, own in (("formula", SLOTS[first.term.slot]), ("growth", 2), ("start", 2), ("energy", 1)):
            formula = getattr(first.term, what)
            with np.errstate(all="ignore"):
                found = [formula(*[PROBES] * own, *columns) for _ in range(2)] if formula else [0.0, 0.0]
            if not np.array_equal(*found, equal_nan=True):
                return formula.__name__
    return None


def _created(chain):
    """Energy that an effect, in lane 1 of a chain, creates in a cycle of loading and unloading, over the most
    that a contact took up; the larger of what bodies and contacts have together and what a contact gave back.

    Contacts are unloaded at first, so that nothing is stored in them: the work done on one stays above zero
    at every moment. What sums over samples miss is told by lane 0, where the effect is off.
    """
    if np.any(chain.static_force) or np.any(chain.gravity):
        return 0.0
    bodies = range(chain.beads + 1)
    seen = _simulated(chain, 2.0 * DURATION, 0.25 * INTERVAL, bodies)
    behind = np.concatenate([seen.velocity[:, 1:], np.zeros_like(seen.velocity[:, :1])], axis=1)
    power = seen.force * (seen.velocity - behind)
    steps = 0.5 * (power[1:] + power[:-1]) * np.diff(seen.time)[:, None, None]
    work = np.concatenate([np.zeros_like(power[:1]), np.cumsum(steps, axis=0)])
    motion = 0.5 * (chain.masses(len(bodies)) * np.square(seen.velocity)).sum(axis=1)
    balance = (motion - motion[0] + work.sum(axis=1)).max(axis=0)
    most = np.maximum(-work.min(axis=(0, 1)), balance) / work.max(axis=(0, 1))
    return float(most[1] - most[0])
