"""Cubic polynomials between the ends of a step, in plain arithmetic as force laws are."""

from sonicvacuum.physics.lanes import positive, root, select


def hermite(x, v, y, w, fraction):
    """Cubic between values x and y with slopes v and w per step, at a fraction of the step."""
    gap = y - x
    square = 3.0 * gap - 2.0 * v - w
    cube = v + w - 2.0 * gap
    return x + fraction * (v + fraction * (square + fraction * cube))


def highest(v, w, gain):
    """Largest value during a step of the cubic that goes from 0 to `gain`, first at the rate v, last at w.

    Rates per step. Only the maximum of a curve that rises first and falls last counts.
    """
    square = 3.0 * gain - 2.0 * v - w
    cube = v + w - 2.0 * gain
    turns = select(v, select(-w, 1.0, 0.0), 0.0)
    below = root(square * square - 3.0 * cube * v) - square
    moment = v / select(turns, below, 1.0)
    top = moment * (v + moment * (square + moment * cube))
    return select(turns, top, positive(gain))
