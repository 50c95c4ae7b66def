"""The numbers printed in docs/layer.md are those of the solution, digit by digit."""

from pathlib import Path

import numpy as np
import pytest
from test_layered import HAYES, HAYES_RADII, STEEL

from sonicvacuum.physics import layer_law
from sonicvacuum.physics.layered import Layer, solve

PAGE = Path(__file__).parents[2] / "docs" / "layer.md"


def columns(first):
    """(n, m) numbers of the table whose first cells are these."""
    lines = PAGE.read_text().splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith(first)) + 2
    rows = []
    for line in lines[start:]:
        if not line.startswith("|"):
            return np.array(rows)
        rows.append([float(cell) for cell in line.strip("|").split("|")])
    return np.array(rows)


def printed(shown, exact):
    """Whether numbers are those printed: half a unit of the third decimal."""
    return shown == pytest.approx(np.asarray(exact), abs=5.1e-4)


def test_the_exact_contact_and_the_kernels_form():
    radius, chi, exact, form, _, wide, pointed = columns("| a/t | chi |").T
    found = solve(Layer(0.388, STEEL, 0.3), radius)
    deep, powers = layer_law.coefficients(0.388, np.array([STEEL]), 0.3)
    assert printed(chi, found.width) and printed(exact, found.factor)
    assert printed(form, layer_law.factor(found.width, deep[0], powers[0]))
    assert printed(wide, radius / found.width) and printed(pointed, found.concentration)


def test_the_flat_punch_beside_what_is_published():
    table = columns("| a/t | ν = 0.3 |")
    assert tuple(table[:, 0]) == HAYES_RADII
    for own, published, poisson in ((1, 2, 0.3), (3, 4, 0.4), (5, 6, 0.5)):
        assert printed(table[:, own], solve(Layer(poisson), HAYES_RADII).flat)
        assert tuple(table[:, published]) == HAYES[poisson]
