"""What a simulation recorded: contact forces and motions of bodies in time, one lane for each chain."""

from dataclasses import dataclass, field, replace

import numpy as np


@dataclass(frozen=True)
class History:
    """Forces of one batch.

    Attributes:
        time: (samples,) s, from the moment of impact.
        contacts: recorded contacts: those asked for, and both contacts of each recorded body.
        force: (samples, contacts, lanes) N, without the static part.
        energy: (entries, lanes) total energy in J every so many steps, empty without audit or where the
            law stores no simple energy.
        momentum: (entries, lanes) total momentum less all impulses received (wall, weight), N s.
        striker_speed: (lanes,) speed of the striker at the end in m/s.
        step: (lanes,) step in s after the impact phase.
        bodies: bodies whose motion was recorded, the striker being 0.
        velocity: (samples, bodies, lanes) m/s, positive towards the wall.
        acceleration: (samples, bodies, lanes) m/s²: all forces on the body at that moment over its mass.
    """

    time: np.ndarray
    contacts: tuple[int, ...]
    force: np.ndarray
    energy: np.ndarray
    momentum: np.ndarray
    striker_speed: np.ndarray
    step: np.ndarray
    bodies: tuple[int, ...] = ()
    velocity: np.ndarray = field(default_factory=lambda: np.zeros((0, 0, 0)))
    acceleration: np.ndarray = field(default_factory=lambda: np.zeros((0, 0, 0)))

    @property
    def lanes(self) -> int:
        """Number of chains."""
        return len(self.striker_speed)

    def of(self, contact: int) -> np.ndarray:
        """(samples, lanes) force of one contact in N."""
        return self.force[:, _place(self.contacts, contact, "force of contact")]

    def velocity_of(self, body: int) -> np.ndarray:
        """(samples, lanes) velocity of one body in m/s."""
        return self.velocity[:, _place(self.bodies, body, "velocity of body")]

    def acceleration_of(self, body: int) -> np.ndarray:
        """(samples, lanes) acceleration of one body in m/s²."""
        return self.acceleration[:, _place(self.bodies, body, "acceleration of body")]

    def take(self, lanes) -> "History":
        """The history of some of the chains, by their places or a slice; without the balance."""
        parts = (self.force, self.velocity, self.acceleration)
        force, velocity, acceleration = (p[..., lanes] if p.size else p for p in parts)
        return replace(
            self,
            force=force,
            velocity=velocity,
            acceleration=acceleration,
            energy=self.energy[:0],
            momentum=self.momentum[:0],
            striker_speed=self.striker_speed[lanes],
            step=self.step[lanes],
        )

    def until(self, samples: int) -> "History":
        """The first samples; without the balance."""
        recorded = ("time", "force", "velocity", "acceleration")
        begun = {name: getattr(self, name)[:samples] for name in recorded}
        return replace(self, **begun, energy=self.energy[:0], momentum=self.momentum[:0])

    def without_numbers(self) -> "History":
        """The same with NaN for all forces and motions: what a motion that does not stay finite leaves."""
        lost = {n: np.full_like(getattr(self, n), np.nan) for n in ("force", "velocity", "acceleration")}
        return replace(self, **lost)

    @staticmethod
    def side_by_side(parts) -> "History":
        """Histories of the same times, contacts and bodies as one, their lanes one after the other."""
        joined = ("force", "velocity", "acceleration", "striker_speed", "step")
        return replace(
            parts[0], **{n: np.concatenate([getattr(p, n) for p in parts], axis=-1) for n in joined}
        )


def _place(recorded, wanted, what):
    if wanted not in recorded:
        raise ValueError(f"the {what} {wanted} was not recorded; ask simulate for it")
    return recorded.index(wanted)
