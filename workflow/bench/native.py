"""Codes written in C for this benchmark: the hardware's limit, and an adaptive integrator at its best."""

import ctypes
import shutil
import subprocess
import time
from functools import cache
from pathlib import Path

import numpy as np
from problems import INTERVAL, STEP

HERE = Path(__file__).parent
LIBRARY = Path("results/bench/libbench.so")
FLAGS = ["-O3", "-march=native", "-ffast-math", "-mprefer-vector-width=512", "-fPIC", "-shared"]
LANES = 8


def missing():
    """Why these codes cannot run, or None."""
    return None if shutil.which("gcc") else "no gcc"


@cache
def library():
    """The compiled library."""
    LIBRARY.parent.mkdir(parents=True, exist_ok=True)
    sources = [str(HERE / name) for name in ("limit.c", "dop853.c")]
    flags = FLAGS
    try:
        subprocess.run(["gcc", *flags, *sources, "-o", LIBRARY, "-lm"], check=True, capture_output=True)
    except subprocess.CalledProcessError:
        # Machines without 512-bit registers do not know the width.
        flags = [f for f in FLAGS if "width" not in f]
        subprocess.run(["gcc", *flags, *sources, "-o", LIBRARY, "-lm"], check=True)
    return ctypes.CDLL(str(LIBRARY.resolve()))


def _pointer(array):
    assert array.flags.c_contiguous
    return array.ctypes.data_as(ctypes.c_void_p)


def _aligned(shape):
    size = int(np.prod(shape))
    buffer = np.zeros(size + 8)
    start = -(buffer.ctypes.data // 8) % 8
    return buffer[start : start + size].reshape(shape)


def limit(problem):
    """Velocity Verlet at `STEP`, eight lanes for many chains, blocks for one."""
    return _lanes(problem) if len(problem.moduli) > 1 else _chain(problem)


def _lanes(problem):
    stiffness, mass = problem.arrays()
    bodies, chains = stiffness.shape
    start = _aligned((chains // LANES, bodies, 4, LANES))
    start[:, 0, 1] = 0.44
    # Positions start half a step behind.
    start[:, 0, 0] = -0.5 * STEP * 0.44
    for column, values in ((2, stiffness), (3, STEP / mass)):
        start[:, :, column] = values.reshape(bodies, -1, LANES).transpose(1, 0, 2)
    state = _aligned(start.shape)
    out = _aligned((len(start), problem.samples - 1, LANES))
    every = round(INTERVAL / STEP)
    function, step = library().verlet_lanes, ctypes.c_double(STEP)
    sizes = [ctypes.c_long(n) for n in (len(start), bodies, problem.samples - 1, every)]

    def run():
        state[:] = start
        function(*sizes, step, ctypes.c_long(problem.contact), _pointer(state), _pointer(out))
        return np.vstack((np.zeros(chains), out.transpose(1, 0, 2).reshape(-1, chains)))

    return run


def _chain(problem):
    stiffness, mass = (values[:, 0] for values in problem.arrays())
    bodies = len(mass)
    # Zeros beyond the last body: constants of no contact, bodies that nothing moves.
    u, v, k, gain = _aligned((4, (bodies // LANES + 2) * LANES))
    k[:bodies], gain[:bodies] = stiffness, STEP / mass
    out = np.zeros(problem.samples - 1)
    every = round(INTERVAL / STEP)
    step = ctypes.c_double(STEP)
    sizes = [ctypes.c_long(n) for n in (bodies, problem.samples - 1, every)]

    def run(function):
        u[:], v[:] = 0.0, 0.0
        v[0], u[0] = 0.44, -0.5 * STEP * 0.44
        arrays = (_pointer(a) for a in (u, v, k, gain))
        function(*sizes, step, ctypes.c_long(problem.contact), *arrays, _pointer(out))
        return np.append(0.0, out)[:, None]

    def seconds(function):
        start = time.perf_counter()
        run(function)
        return time.perf_counter() - start

    # Whichever is faster on this problem: eight bodies at a time, or one.
    both = (library().verlet_chain, library().verlet_chain_scalar)
    best = min(both, key=lambda f: min(seconds(f) for _ in range(3 if bodies < 10_000 else 1)))
    return lambda: run(best)


def dop853(problem, rtol):
    """DOP853 with compiled right-hand side, each chain on its own."""
    from scipy.integrate._ivp import dop853_coefficients as tables

    coefficients = [np.ascontiguousarray(getattr(tables, name)) for name in ("A", "B", "E3", "E5", "D")]
    stiffness, mass = problem.arrays()
    stiffness, inverse_mass = np.ascontiguousarray(stiffness.T), np.ascontiguousarray(1.0 / mass.T)
    chains, bodies = stiffness.shape
    tolerance = rtol * np.repeat([1e-6, 1.0], bodies)
    y, contacts = np.zeros(2 * bodies), np.array([problem.contact])
    out = np.zeros((chains, problem.samples))
    function = library().dop853
    real, long = ctypes.c_double, ctypes.c_long

    def run():
        for q in range(chains):
            y[:] = 0.0
            y[bodies] = 0.44
            function(
                long(bodies),
                _pointer(stiffness[q]),
                _pointer(inverse_mass[q]),
                _pointer(y),
                *map(_pointer, coefficients),
                real(rtol),
                _pointer(tolerance),
                real(1e-8),
                real(INTERVAL),
                long(problem.samples),
                long(1),
                _pointer(contacts),
                _pointer(out[q]),
            )
        return out.T

    return run
