"""One ball on a wall, for simulators of particles and robots: its law in their own numbers.

    from sonicvacuum.export import SIMULATORS

Adding a simulator is one file with a `SIMULATOR` (see `base`) and its name in the two lists below. Whatever
it writes is checked: `tests/export` integrates the equation as documented with the numbers as written, and
compares rebound and contact time with the engine's.
"""

from sonicvacuum.export import drake, lammps, liggghts, mujoco, yade
from sonicvacuum.export.base import Simulator

SIMULATORS: dict[str, Simulator] = {
    one.SIMULATOR.id: one.SIMULATOR for one in (lammps, liggghts, yade, mujoco, drake)
}
