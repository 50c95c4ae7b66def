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
# Step in units of the time in which damping stops a bead: accurate to the stepper's order, and stable where
# steps are three times as long, as searches take them beside noise (2.3 of these times are not).
DECAY_STEP = 0.25
# The same once the strike is over: fine steps of the strike set the error, the rest need only be stable, so
# searches take no longer ones.
LATE_DECAY_STEP = 0.75
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
    return np.maximum(impact, _compression_at_rest(chain))


def _compression_at_rest(chain):
    """(lanes,) m, of Hertz contacts under the static load."""
    return np.cbrt(np.square(chain.load / chain.stiffness))


def damping_rates(chain: Chain, laws: LawSet, table: np.ndarray, mass: np.ndarray) -> tuple:
    """(lanes,) greatest rates in 1/s at which contacts stop a bead, in the strike and when its jump is over;
    and at which what acts on bodies does.
    """
    lightest, delta = _typical(chain, table, mass)
    speed = np.broadcast_to(chain.speed, delta.shape)
    elastic = elastic_at(laws, table, delta)
    damping, contacts = _damping(laws, table, lightest, delta, speed)
    # The speed that damping would take on the way to such a depth. A heavy striker goes on pushing.
    taken = contacts * delta / np.square(np.maximum(1.0, chain.striker_mass / lightest))
    if np.any(taken > speed):
        delta = _where_stopped(chain, laws, table, lightest, delta, contacts, taken)
        damping, contacts = _damping(laws, table, lightest, delta, speed)
    settled = contacts
    # Across a gap, each strike is as sharp as the first.
    if np.any(damping > elastic) and not chain.gaps(len(table)).any():
        settled = _settled(laws, table, lightest, delta, speed, (elastic, damping, contacts))
    bodies = np.zeros(chain.lanes)
    for term in laws.in_slot("body"):
        # Friction stops the slow sooner than the fast.
        speeds, columns = (speed, CREEP * speed), columns_of(laws, term, table)
        falls = (np.abs(np.broadcast_to(term.formula(v, *columns), v.shape) / v) for v in speeds)
        bodies = bodies + np.maximum(*(fall.max(axis=0) for fall in falls))
    return contacts.max(axis=0), settled.max(axis=0), bodies


def _damping(laws, table, lightest, delta, speed):
    """(bodies, lanes) forces in N that damp contacts of such depth and speed, and how soon they stop a bead,
    as rates in 1/s.
    """
    full, half = np.zeros(delta.shape), np.zeros(delta.shape)
    force = elastic_at(laws, table, delta)
    for term in laws.in_slot("force"):
        columns = columns_of(laws, term, table)
        full = full + term.formula(delta, speed, force, *columns)
        half = half + term.formula(delta, 0.5 * speed, force, *columns)
    return np.abs(full), np.abs(2.0 * (full - half) / (speed * lightest))


def _where_stopped(chain, laws, table, lightest, delta, contacts, taken):
    """(bodies, lanes) m: `delta`, or the depth at which rates, `contacts` at `delta`, have stopped a bead.

    Rates like δ^p stop a bead of speed v where ∫ rate dδ = rate δ/(p + 1) = v; if only the deepest rise so
    steeply, sooner.
    """
    _, halved = _damping(laws, table, lightest, 0.5 * delta, np.broadcast_to(chain.speed, delta.shape))
    with np.errstate(divide="ignore", invalid="ignore"):
        power = np.maximum(np.log2(contacts / halved), 0.0)
        share = ((power + 1.0) * chain.speed / taken) ** (1.0 / (power + 1.0))
    depth = np.where(taken > chain.speed, np.minimum(share, 1.0), 1.0) * delta
    return np.maximum(depth, _compression_at_rest(chain))


def _settled(laws, table, lightest, delta, speed, strike):
    """(bodies, lanes) rates in 1/s at the speed where damping bears no more than an elastic impact does.

    `strike` holds what the impact and damping bear in N at `speed`, and how soon damping stops a bead then.
    """
    elastic, damping, contacts = strike
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        # Forces like v^p; if only the fastest rise so steeply, the speed is lower still.
        power = -np.log2(1.0 - 0.5 * contacts * speed * lightest / damping)
        slower = np.minimum((elastic / damping) ** (1.0 / power), 1.0)
    steep = (damping > elastic) & (power > 1.0)
    _, rates = _damping(laws, table, lightest, delta, np.where(steep, slower, 1.0) * speed)
    return rates


def memory_time(chain: Chain, laws: LawSet, table: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """(lanes,) shortest time in s in which a contact forgets; infinite where none remembers."""
    fastest = np.zeros(chain.lanes)
    _, delta = _typical(chain, table, mass)
    force = elastic_at(laws, table, delta)
    for term in laws.in_slot("memory"):
        columns = columns_of(laws, term, table)
        fall = term.growth(force, force, *columns) - term.growth(force, 0.5 * force, *columns)
        fastest = np.maximum(fastest, np.abs(2.0 * fall / force).max(axis=0))
    with np.errstate(divide="ignore", over="ignore"):  # next to nothing takes as long as nothing
        return 1.0 / fastest


def _typical(chain, table, mass):
    """(lanes,) lightest mass in kg; (bodies, lanes) typical compressions in m."""
    lightest = mass.min(axis=0)
    return lightest, np.broadcast_to(_typical_compression(chain, lightest), (len(table), chain.lanes))


def choose_steps(
    chain: Chain, laws: LawSet, table: np.ndarray, mass: np.ndarray, refine: float = 1.0
) -> tuple:
    """Steps in s of each chain: (lanes,) before and after the end of the early phase, and that end in s.

    Args:
        chain, laws, table, mass: as `time_scale` takes them.
        refine: how many times as fine as standard; below 1, coarser where that is stable.
    """
    stepper = "splitting" if laws.splits else "runge-kutta"
    late = STEP[stepper] / refine * time_scale(chain, laws, table, mass)
    early = late / EARLY_REFINEMENT
    struck = chain.first.mass
    until = EARLY_CONTACT_TIMES * contact_time(struck, chain.striker_stiffness, chain.speed)
    if not laws.is_positional:
        contacts, settled, bodies = damping_rates(chain, laws, table, mass)
        with np.errstate(divide="ignore", over="ignore"):  # next to nothing takes as long as nothing
            early = np.minimum(early, DECAY_STEP / refine / EARLY_REFINEMENT / (contacts + bodies))
            stable = max(refine, 1.0) / LATE_DECAY_STEP
            late = np.minimum(late, 1.0 / (stable * settled + refine / DECAY_STEP * bodies))
            until = np.minimum(until, EARLY_DECAYS / contacts)
    heavy = np.maximum(1.0, chain.striker_mass / struck)
    if laws.in_slot("memory"):
        most = MEMORY_STEP / refine * memory_time(chain, laws, table, mass)
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
