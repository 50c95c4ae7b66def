"""How a simulator can show a model of one ball: by the same law, or by the nearest of its laws, and how well.

The nearest law has the model's restitution and contact time at the reference speed: its damping and its
stiffness are found through the engine, with the effect that the law corresponds to. Elsewhere the two differ,
and by how much is found by bouncing both.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from sonicvacuum.effects import effect
from sonicvacuum.effects.base import Setup
from sonicvacuum.export.base import MOTION, Ball, Law, Simulator, Written
from sonicvacuum.export.bounce import Subject, ball_of, bounces
from sonicvacuum.files import InputError
from sonicvacuum.physics.chain import Chain

# What the same law may differ by: the engine's step and nine digits of the input in restitution; the engine's
# sampling of a contact, 1/600 of it at either end, in its duration.
SAME_RESTITUTION, SAME_DURATION = 1e-4, 4e-3
# Speeds at which laws are compared, and how far beyond the record's they are followed.
SPEEDS, BEYOND, WIDE = 7, 10.0, 20


@dataclass(frozen=True)
class Agreement:
    """How well a written law agrees with the model.

    Attributes:
        low, high: speeds of the record in m/s.
        restitution: largest difference between these speeds.
        duration_rel: largest relative difference of the contact time between them.
        within_low, within_high: speeds in m/s about the reference between which the restitution agrees within
            the error asked for; None, None where the law is the same and they have no end.
    """

    low: float
    high: float
    restitution: float
    duration_rel: float
    within_low: float | None = None
    within_high: float | None = None


@dataclass(frozen=True)
class Match:
    """A law of a simulator for a model: `same` is what is exact ("motion", "restitution") or None."""

    law: Law
    parameters: dict[str, float]
    written: Written
    same: str | None
    agreement: Agreement


def match(
    simulator: Simulator, subject: Subject, ball: Ball, span: tuple[float, float], error: float
) -> Match | str:
    """The simulator's law for a model, or why it has none.

    Args:
        simulator: whose law.
        subject, ball: the model and its reference impact.
        span: lowest and highest speed in m/s.
        error: of restitution within which speeds are counted as agreeing.
    """
    law, parameters = _own(simulator, subject)
    if law is not None:
        try:
            return _exact(law, parameters, subject.chain, ball, span)
        except ValueError as problem:
            return f"{law.title}: {problem}"
    found = [one for one in simulator.laws if _known(one)]
    near = [m for one in found if (m := _near(one, subject.chain, ball, span, error)) is not None]
    if not near:
        return f"none of its laws has a restitution of {ball.restitution:.3g} at {ball.speed:g} m/s"
    return min(near, key=lambda m: (m.agreement.restitution, m.agreement.duration_rel))


def _own(simulator, subject):
    """The law that the model has, with its parameters; the first, without damping, for an elastic contact."""
    if not subject.law:
        first = simulator.laws[0]
        return first, {p.name: float(p.off) for p in effect(first.effect).parameters}
    if len(subject.law) == 1 and (law := simulator.law(subject.law[0])):
        return law, subject.effects[law.effect]
    return None, {}


def _known(law):
    return len(effect(law.effect).parameters) == 1


def _exact(law, parameters, chain, ball, span):
    written = law.write(ball, parameters)
    duration = SAME_DURATION
    if law.same != MOTION:
        speeds = np.geomspace(*span, SPEEDS)
        times = law.duration(ball, parameters, speeds)
        duration += float(np.max(np.abs(times / bounces(chain, speeds)[1] - 1.0)))
    return Match(law, parameters, written, law.same, Agreement(*span, SAME_RESTITUTION, duration))


def _near(law, target: Chain, ball: Ball, span, error) -> Match | None:
    """A law with the ball's restitution and contact time at the reference speed; None where it has none."""
    (name,) = (p.name for p in effect(law.effect).parameters)
    bare = replace(target, actions=())
    try:
        value, near = _fitted(law.effect, name, bare, ball)
        parameters = {name: value}
        stiffness = float(near.stiffnesses(1)[0, 0])
        # Where only the restitution is the same, `write` takes the contact time from the ball.
        written = law.write(replace(ball, stiffness=stiffness), parameters)
    except (ValueError, InputError):
        return None

    def differences(speeds):
        rebound, times = bounces(near, speeds)
        if law.duration is not None:
            times = law.duration(ball, parameters, speeds)
        wanted, lasting = bounces(target, speeds)
        return np.abs(rebound - wanted), np.abs(times / lasting - 1.0)

    rebound, times = differences(np.geomspace(*span, SPEEDS))
    wide = np.geomspace(span[0] / BEYOND, span[1] * BEYOND, WIDE)
    within = _about(wide, differences(wide)[0], error, ball.speed)
    return Match(
        law, parameters, written, None, Agreement(*span, float(rebound.max()), float(times.max()), *within)
    )


def _fitted(id, name, bare: Chain, ball: Ball):
    """Parameter of an effect, and chain, that have the ball's restitution and contact time at its speed.

    Damping first, then stiffness by T ~ K^{-2/5}; three rounds, as the one moves the other little.

    Raises:
        ValueError: where no damping within reason gives that restitution.
    """
    one, chain = effect(id), bare
    p = one.parameters[0]
    low, high = np.log(p.low * 1e-3), np.log(min(p.high * 100.0, p.most))

    def excess(log):
        return (
            bounces(_with(one, chain, {name: float(np.exp(log))}), np.array([ball.speed]))[0][0]
            - ball.restitution
        )

    for _ in range(3):
        value = 0.0
        if excess(low) > 0.0:
            value = float(
                np.exp(
                    scipy.optimize.brentq(lambda x: np.nan_to_num(excess(x), nan=-1.0), low, high, xtol=1e-7)
                )
            )
        near = _with(one, chain, {name: value})
        ratio = (ball_of(near, ball.speed).duration / ball.duration) ** 2.5
        chain = chain.with_defect("stiffness", 0, ratio)
    return value, _with(one, chain, {name: value})


def _with(one, chain, parameters):
    return one.apply(Setup(chain), **parameters).chain


def _about(speeds, difference, error, reference):
    """Speeds (low, high) about the reference, where laws agree, up to which they differ by `error` at most.

    `difference` is at `speeds` (ascending); between them it is taken as straight over log speed.
    """
    log = np.log(np.append(speeds, reference))
    order = np.argsort(log)
    log, over = log[order], np.append(difference, 0.0)[order] - error
    place = int(np.flatnonzero(order == len(speeds))[0])

    def end(step, last):
        k = place
        while k != last and over[k + step] <= 0.0:
            k += step
        if k == last:
            return log[k]
        share = over[k] / (over[k] - over[k + step])
        return log[k] + share * (log[k + step] - log[k])

    return float(np.exp(end(-1, 0))), float(np.exp(end(1, len(log) - 1)))
