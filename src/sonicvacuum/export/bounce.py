"""One ball of a model, bounced by the engine: what the contact alone does to restitution and contact time.

Gravity, preload and gauges are left aside: a simulator has its own gravity, and the coefficient of a contact
is the same under it.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from sonicvacuum.effects import Catalogue
from sonicvacuum.effects.base import Setup
from sonicvacuum.export.base import Ball
from sonicvacuum.files import InputError
from sonicvacuum.observe.contacts import contact_duration
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.scales import impact_scales, sampling_of

# Simulated for so many Hertz contact times: heavily damped balls creep out of their dent.
CONTACTS = 8.0


@dataclass(frozen=True)
class Subject:
    """A model of one ball on a wall.

    Attributes:
        chain: one lane, with the model's laws, without gravity.
        effects: effect → parameters, in the order applied.
        law: of these, the ones that are force laws of the contact.
        moot: effect → why it does not act on one ball.
    """

    chain: Chain
    effects: dict[str, dict[str, float]]
    law: tuple[str, ...]
    moot: dict[str, str]


def subject(nominal: Chain, effects: dict[str, dict[str, float]], catalogue: Catalogue) -> Subject:
    """A nominal ball (beads 0, one lane) with the effects that act on one ball.

    Raises:
        InputError: for a chain of beads, or parameters that an effect refuses.
    """
    if nominal.beads:
        raise InputError(f"the chain has {nominal.beads} beads; export takes one ball (beads: 0)")
    setup = Setup(replace(nominal.take([0]), gravity=np.zeros(1), static_force=np.zeros(1)))
    law, moot = [], {}
    for name, parameters in effects.items():
        one = catalogue.effect(name)
        why = one.why_not(setup)
        if why is not None:
            moot[name] = why
            continue
        before = len(setup.chain.actions)
        try:
            setup = one.apply(setup, **parameters)
        except ValueError as error:
            raise InputError(f"the model does not fit one ball: {error}") from None
        if len(setup.chain.actions) > before:
            law.append(name)
    return Subject(setup.chain, effects, tuple(law), moot)


def bounces(chain: Chain, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Restitution and contact time in s, (speeds,) each, of a ball at speeds in m/s.

    Args:
        chain: beads 0, with one lane for all speeds or as many lanes as speeds.
        speeds: (speeds,).

    Returns:
        NaN where the ball has not come out of its dent in the time simulated.
    """
    lanes = np.zeros(len(speeds), dtype=int) if chain.lanes == 1 else np.arange(len(speeds))
    found = [_bounce(chain.take([lane]), speed) for lane, speed in zip(lanes, speeds, strict=True)]
    return np.array([e for e, _ in found]), np.array([t for _, t in found])


def _bounce(one, speed):
    """One ball, sampled in its own contact time."""
    # And with it compiled code: not before what is asked is known.
    from sonicvacuum.physics.run import simulate

    chain = replace(one, speed=np.array([float(speed)]))
    length = CONTACTS * impact_scales(chain)[1]
    history = simulate(chain, [0], length, sampling_of(chain), refine=4.0)
    force = history.of(0)[:, 0]
    # Not the sum of the force over samples: that is good to 1e-4 where a dashpot lets it start steeply.
    rebound = -float(history.striker_speed[0]) / float(speed) if force[-1] == 0.0 else math.nan
    return rebound, contact_duration(history.time, force).value


def ball_of(chain: Chain, speed: float) -> Ball:
    """The ball of a chain with its impact at a speed in m/s.

    Raises:
        InputError: for a ball that stays in its dent.
    """
    (rebound,), (time,) = bounces(chain, np.array([speed]))
    if not (np.isfinite(rebound) and np.isfinite(time)):
        raise InputError(
            f"at {speed:g} m/s the ball of this model does not rebound; there is nothing to export"
        )
    return Ball(
        mass=float(chain.masses(1)[0, 0]),
        radius=float(chain.striker_radius if np.ndim(chain.striker_radius) == 0 else chain.striker_radius[0]),
        stiffness=float(chain.stiffnesses(1)[0, 0]),
        poisson=float(chain.striker.poisson),
        speed=speed,
        restitution=float(rebound),
        duration=float(time),
    )
