"""The step of each chain, from the time scales of its own contacts by the law in force.

The step is a fraction of the time of a Hertz impact, (m²/(K² v))^{1/5}. The striker hits with a finite
speed, and its contact opens abruptly: steps are much finer until that is over.
"""

import numpy as np

from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.contact import contact_time
from sonicvacuum.physics.laws import HERTZ, LawSet, columns_of, elastic_at

# Step in units of the contact time; errors: see the cost-accuracy figure of the benchmarks.
STEP = {"splitting": 0.1, "runge-kutta": 0.05}
EARLY_REFINEMENT = 8
EARLY_CONTACT_TIMES = 4.5
# Step in units of the time in which damping stops a bead: stable where steps are three times as long, as
# searches take them beside noise (2.3 of these times are not), and accurate to the stepper's order.
DECAY_STEP = 0.25
# The fine steps of the strike end with the jump that a contact's damping makes, after so many of its times,
# though the striker may be there for longer.
EARLY_DECAYS = 180.0
# And in units of the time in which a memory forgets, in the early phase too: what is forgotten so soon
# follows the force, and the strike is hardly sharper to it than the rest. With ten times the elastic force
# remembered and 0.3 us to forget it, forces err by 1e-6 of their peak.
MEMORY_STEP = 0.75
# Speed of a body about to stop, in units of the striker's.
CREEP = 1e-4


def time_scale(chain: Chain, laws: LawSet, table: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """(lanes,) shortest time scale in s: of an impact at the striker's speed, or of vibration about rest.

    Args:
        chain: the chains.
        laws: their law set.
        table: (bodies, n, lanes) coefficients of `laws`.
        mass: (bodies, lanes) kg.
    """
    lightest = mass.min(axis=0)
    stiffness = _hertz_like(chain, laws, table, lightest)
    impact = contact_time(lightest, stiffness, chain.speed)
    if not chain.preloaded:
        return impact
    # Highest frequency of the linear chain 2 √(k/m), k = (3/2) K √δ₀ = (3/2) K^{2/3} F₀^{1/3}.
    with np.errstate(divide="ignore"):
        vibration = np.sqrt(lightest / (1.5 * np.cbrt(stiffness**2 * chain.load)))
    return np.minimum(impact, vibration)


def _hertz_like(chain, laws, table, mass):
    """(lanes,) largest K of a Hertz contact as stiff as the law in force at a typical compression."""
    hertz = laws.first_coefficient.get(HERTZ.name)
    if hertz is not None and not (laws.in_slot("factor") or laws.in_slot("path")):
        return table[:, hertz].max(axis=0)
    delta = np.broadcast_to(_typical_compression(chain, mass), (len(table), len(mass)))
    load = elastic_at(laws, table, delta)
    # A contact that unloads along another path is as stiff as that path is steep.
    steepest = np.ones_like(load)
    for term in laws.in_slot("path"):
        columns = columns_of(laws, term, table)
        nearly = 0.99 * delta
        fall = load - term.formula(nearly, elastic_at(laws, table, nearly), delta, load, *columns)
        steepest = np.maximum(steepest, fall / (load * 0.015))
    return (steepest * load / delta**1.5).max(axis=0)


def _typical_compression(chain, mass):
    """(lanes,) m: 1.5 (m v²/K)^{2/5}, of a Hertz contact at the striker's speed; or that at rest."""
    impact = 1.5 * (mass * chain.speed**2 / chain.stiffness) ** 0.4
    return np.maximum(impact, np.cbrt(np.square(chain.load / chain.stiffness)))


def damping_times(chain: Chain, laws: LawSet, table: np.ndarray, mass: np.ndarray) -> tuple:
    """(lanes,) shortest times in s in which contacts, and contacts and what acts on bodies, stop a bead;
    infinite where nothing does.
    """
    contacts, bodies = np.zeros(chain.lanes), np.zeros(chain.lanes)
    lightest, delta, force = _typical(chain, laws, table, mass)
    rate = np.broadcast_to(chain.speed, delta.shape)
    for term in laws.in_slot("force"):
        columns = columns_of(laws, term, table)
        fall = term.formula(delta, rate, force, *columns) - term.formula(delta, 0.5 * rate, force, *columns)
        contacts = contacts + np.abs(2.0 * fall / (rate * lightest)).max(axis=0)
    for term in laws.in_slot("body"):
        # Friction stops the slow sooner than the fast.
        speeds, columns = (rate, CREEP * rate), columns_of(laws, term, table)
        falls = (np.abs(np.broadcast_to(term.formula(v, *columns), v.shape) / v) for v in speeds)
        bodies = bodies + np.maximum(*(fall.max(axis=0) for fall in falls))
    with np.errstate(divide="ignore", over="ignore"):  # next to nothing takes as long as nothing
        return 1.0 / contacts, 1.0 / (contacts + bodies)


def memory_time(chain: Chain, laws: LawSet, table: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """(lanes,) shortest time in s in which a contact forgets; infinite where none remembers."""
    fastest = np.zeros(chain.lanes)
    *_, force = _typical(chain, laws, table, mass)
    for term in laws.in_slot("memory"):
        columns = columns_of(laws, term, table)
        fall = term.growth(force, force, *columns) - term.growth(force, 0.5 * force, *columns)
        fastest = np.maximum(fastest, np.abs(2.0 * fall / force).max(axis=0))
    with np.errstate(divide="ignore", over="ignore"):  # next to nothing takes as long as nothing
        return 1.0 / fastest


def _typical(chain, laws, table, mass):
    """(lanes,) lightest mass in kg; (bodies, lanes) typical compressions in m, their elastic forces in N."""
    lightest = mass.min(axis=0)
    delta = np.broadcast_to(_typical_compression(chain, lightest), (len(table), chain.lanes))
    return lightest, delta, elastic_at(laws, table, delta)


def choose_steps(chain: Chain, laws: LawSet, table: np.ndarray, mass: np.ndarray) -> tuple:
    """Steps in s of each chain: (lanes,) before and after the end of the early phase, and that end in s."""
    stepper = "splitting" if laws.splits else "runge-kutta"
    late = STEP[stepper] * time_scale(chain, laws, table, mass)
    struck = chain.first.mass
    until = EARLY_CONTACT_TIMES * contact_time(struck, chain.striker_stiffness, chain.speed)
    if not laws.is_positional:
        contacts, decay = damping_times(chain, laws, table, mass)
        late, until = np.minimum(late, DECAY_STEP * decay), np.minimum(until, EARLY_DECAYS * contacts)
    early = late / EARLY_REFINEMENT
    heavy = np.maximum(1.0, chain.striker_mass / struck)
    if laws.in_slot("memory"):
        most = MEMORY_STEP * memory_time(chain, laws, table, mass)
        early, late = np.minimum(early, most), np.minimum(late, most)
    return early, late, heavy * until


def reachable_bodies(chain: Chain, duration: float) -> int:
    """Bodies that the wave is expected to reach within `duration` (s), with a margin.

    A solitary wave needs about 1.2 (m²/(K² v))^{1/5} per bead, a linear one √(m/k), of the lightest bead and
    the stiffest contact.
    """
    pace = 1.0 / contact_time(chain.lightest, chain.stiffness, chain.speed)
    load = chain.static_force
    pace = pace + np.sqrt(1.5 * np.cbrt(chain.stiffness**2 * load) / chain.lightest)
    return int(min(1.1 * duration * pace.max(), chain.beads)) + 32
