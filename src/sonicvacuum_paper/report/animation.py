"""Two moving pictures: a ball as heavy as a bead makes one solitary wave, one of five beads a train of them.

Each is an SVG that moves by itself (SMIL), a few kilobytes, from an ideal chain of steel beads: every bead
stands where the simulation has it, its displacement drawn much larger than it is, and is the darker the
faster it moves.
"""

import numpy as np

import sonicvacuum as sv
from sonicvacuum.files import InputError
from sonicvacuum.physics.run import simulate
from sonicvacuum.simulation import set_up
from sonicvacuum_paper.shown import ANIMATIONS

BEADS, FRAMES, SECONDS = 30, 48, 6
# The greatest displacement, as drawn, in diameters.
_SHIFT = 1.2
_SIZE = 20  # of a bead, units of the SVG
_SPEED_M_S = 0.5


def animation(name: str) -> str:
    """The SVG text of `solitary` or `train`; equal for equal code.

    Raises:
        InputError: for another name.
    """
    if name not in ANIMATIONS:
        raise InputError(f"animation {name!r}: unknown; use one of {', '.join(ANIMATIONS)}")
    ratio, told = ANIMATIONS[name]
    place, speed = _motion(ratio)
    beads = [_bead(body, place[:, body], speed[:, body]) for body in range(BEADS + 1)]
    width, height = (BEADS + 3) * _SIZE, 2 * _SIZE
    frame = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img">'
    wall = f'<rect x="{width - _SIZE}" y="2" width="6" height="{height - 4}" fill="#595959"/>'
    return "\n".join([frame, f"<title>{told}</title>", *beads, wall, "</svg>"]) + "\n"


def _motion(ratio):
    """(frames, bodies) displacements over the greatest, and speeds from 0 to 1, the striker first."""
    ball = {"diameter_mm": 5.0, "mass_g": 0.51, "material": "bearing-steel"}
    card = sv.case(
        chain={
            "beads": BEADS,
            "orientation": "horizontal",
            "bead": ball,
            "wall": {"material": ball["material"]},
        },
        striker={"shape": "sphere", **_heavier(ball, ratio), "speed_m_s": _SPEED_M_S},
        sensors=[{"id": "wall", "kind": "wall"}],
        duration_us=1.0,
    )
    interval = 0.25e-6
    bodies = range(BEADS + 1)
    duration = 1.25 * (BEADS + 1) * 5e-3 / 530.0  # until the wave is at the wall: Eq. (6), a little slower
    history = simulate(set_up(card).chain, (BEADS,), duration, interval, bodies=bodies)
    speed = history.velocity[:, :, 0]
    moved = np.cumsum(speed, axis=0) * interval
    frames = np.linspace(0, len(speed) - 1, FRAMES).astype(int)
    return moved[frames] / moved[:, 1:].max(), np.clip(speed[frames] / speed[:, 1:].max(), 0.0, 1.0)


def _heavier(ball, ratio):
    """A ball of the same material and so many times the mass."""
    return ball | {
        "mass_g": ball["mass_g"] * ratio,
        "diameter_mm": ball["diameter_mm"] * ratio ** (1.0 / 3.0),
    }


def _bead(body, place, speed):
    """A circle that moves and darkens; the striker is orange."""
    rest = (body + 0.75) * _SIZE
    x = ";".join(f"{v:.1f}" for v in rest + _SHIFT * _SIZE * np.clip(place, -0.6, 1.0))
    dark = ";".join(f"{v:.2f}" for v in 0.15 + 0.85 * speed)
    color = "#D55E00" if body == 0 else "#0072B2"
    timing = f'dur="{SECONDS}s" repeatCount="indefinite"'
    return (
        f'<circle cx="{rest:.1f}" cy="{_SIZE}" r="{_SIZE / 2 - 0.8:.1f}" fill="{color}" fill-opacity="0.15" '
        f'stroke="{color}"><animate attributeName="cx" {timing} values="{x}"/>'
        f'<animate attributeName="fill-opacity" {timing} values="{dark}"/></circle>'
    )
