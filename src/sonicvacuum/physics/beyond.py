"""What chains have beyond what their bodies make of them: numbers that are off, and terms of force laws."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sonicvacuum.physics.laws import Term


@dataclass(frozen=True)
class Defect:
    """One number at one place that is not what the bodies make it: a defect of the chain.

    Attributes:
        what: "mass", "stiffness" (factors) or "gap" (m, open at rest).
        index: body for masses, contact otherwise.
        value: (lanes,) factor or gap.
    """

    what: str
    index: int
    value: np.ndarray


@dataclass(frozen=True)
class Action:
    """A term of the force law with its parameters.

    Attributes:
        term: the formula.
        coefficients: function of (chain, stiffness, mass, **parameters), the first arrays (bodies, lanes),
            that returns a list of `term.coefficients` arrays broadcastable to (bodies, lanes): one number
            per contact, or per body for the slot `body`.
        parameters: name → (lanes,) array.
    """

    term: Term
    coefficients: Callable
    parameters: dict[str, np.ndarray]

    def table(self, chain, stiffness, mass):
        """(bodies, n, lanes) coefficients."""
        columns = self.coefficients(chain, stiffness, mass, **self.parameters)
        bodies, *lanes = stiffness.shape
        made = np.empty((bodies, len(columns), *lanes))
        for k, column in enumerate(columns):
            made[:, k] = column
        return made
