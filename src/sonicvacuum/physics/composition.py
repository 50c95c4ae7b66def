"""What a stepper is compiled for, and the arrays that it shares with its callers: what stands where.

All numbers of one body (or of the contact behind it) stand side by side in one row of the *table*,
an array (groups, bodies + 1, columns, lanes) whose last body is the wall, always at rest:

    U, V, INVERSE_MASS          displacement from rest, velocity, 1/mass
    REST, REST_FORCE            compression and force of the contact at rest; only if it may be preloaded
    coefficients, memory        of the law set
    increments, old, blend, slopes, turn  work space of Runge and Kutta's stepper and of samples between steps
"""

from dataclasses import dataclass
from functools import cached_property

from sonicvacuum.physics.laws import LawSet

U, V, INVERSE_MASS, REST, REST_FORCE = range(5)

# Entries of a group's status: bodies stepped, entries of the balance, whether the wave ran out of the table,
# steps made, and whether to stop, which another thread may say.
STEPPED, BALANCED, RAN_OUT, MADE, STOP = range(5)
STATUS_ENTRIES = 5

# Rows of a group's clock: what each chain needs besides its bodies.
FINE_STEP, STEP, FINE_UNTIL, LAST, WEIGHT, THRESHOLD, TOLERANCE, DUE = range(8)
CLOCK_ROWS = 8

# What is said of a recorded body: its number, and the rows of the recorded contacts before and behind it; the
# striker has none before it.
BODY, BEFORE, BEHIND = range(3)


@dataclass(frozen=True)
class Frame:
    """What a stepper is, whatever the laws.

    Attributes:
        width: chains stepped together, 1 or `lanes.LANES`.
        splits: whether positions and velocities are advanced in turn, or both by Runge and Kutta.
        audited: whether the energy and momentum balance is kept.
        watched: whether the motion of bodies is recorded.
    """

    width: int
    splits: bool = True
    audited: bool = False
    watched: bool = False

    @property
    def name(self) -> str:
        """Key of the compiled code."""
        stepper = "splitting" if self.splits else "runge-kutta"
        return f"{stepper}x{self.width}{'+audit' * self.audited}{'+motion' * self.watched}"


@dataclass(frozen=True)
class Composition:
    """What a stepper is compiled for.

    Attributes:
        laws: all terms that act.
        width, audited, watched: see `Frame`.
    """

    laws: LawSet
    width: int
    audited: bool = False
    watched: bool = False

    @cached_property
    def frame(self) -> Frame:
        """The stepper that suits the laws."""
        return Frame(self.width, self.laws.splits, self.audited, self.watched)

    @cached_property
    def name(self) -> str:
        """Key of the compiled code."""
        return f"{self.laws.name} {self.frame.name}"

    @property
    def preloaded(self) -> bool:
        """Whether contacts may bear a static force or have a gap at rest."""
        return self.laws.preloaded

    @property
    def first_coefficient(self) -> int:
        """Column of the law set's first coefficient."""
        return REST_FORCE + 1 if self.laws.preloaded else REST

    @property
    def memories(self) -> int:
        """Remembered numbers per contact."""
        return len(self.laws.memory_of)

    @property
    def first_memory(self) -> int:
        """Column of the first remembered number."""
        return self.first_coefficient + self.laws.coefficients

    @property
    def first_increment(self) -> int:
        """Column of the increments of displacement, velocity and memory."""
        return self.first_memory + self.memories

    @property
    def first_old(self) -> int:
        """Column of the memory at the step's start, for samples between steps."""
        return self.first_increment + 2 + self.memories

    @property
    def first_blend(self) -> int:
        """Column of the memory at a moment between steps."""
        return self.first_old + self.memories

    @property
    def first_slope(self) -> int:
        """Column of the change per step of the memory at the step's start, and behind it of that at its end;
        kept where a memory has a rate of its own.
        """
        return self.first_blend + self.memories

    @property
    def first_turn(self) -> int:
        """Column of approach and rate at the step's start, kept where a path is to be followed."""
        return self.first_slope + (2 * self.memories if self.laws.in_slot("memory") else 0)

    @property
    def columns(self) -> int:
        """Numbers per body."""
        if self.laws.splits:
            return self.first_increment
        return self.first_turn + (2 if self.laws.in_slot("path") else 0)

    def __hash__(self):
        return hash(self.name)
