"""A sketch of a chain with its striker, its gauges and its wall, as SVG that takes the colours of its page.

Lengths in units of the drawing, `WIDTH` wide; a page shows it at about this size in pixels, so that the text
stays legible on a telephone.
"""

import math

from markupsafe import Markup, escape

from sonicvacuum.laboratory.specimen import Bead
from sonicvacuum.records import Gauge, Record

WIDTH = 360.0
# Room for striker and wall beside the beads; height of the beads, of a line of text; width of a letter.
LEFT, RIGHT, MIDDLE, LINE, LETTER = 46.0, 30.0, 44.0, 14.0, 6.2
LARGEST = 13.0  # radius
# Beads beyond this number are drawn at the ends and where gauges sit only.
MOST = 60


def sketch(record: Record) -> Markup:
    """The chain of a record: bead 1, which is struck, on the left, the wall on the right."""
    beads = record.beads
    span = WIDTH - LEFT - RIGHT
    radii = _radii(record, span)
    centres = _centres(radii, span)
    end = centres[beads] + radii[beads] if beads else LEFT
    shown = _shown(record)
    held = {g.bead: g for g in record.gauges if g.bead}
    parts = [_striker(record, LEFT if not beads else centres[1] - radii[1])]
    parts += [_line(centres, radii)] if len(shown) < beads else []
    parts += [_bead(record.specimen.bodies[k], centres[k], radii[k], k in held) for k in shown]
    parts += [_wall(end, record.specimen.wall.name, bool(record.beads))]
    labels, rows = _labels(record, centres, end)
    height = MIDDLE + LARGEST + 12.0 + LINE * (rows + 1)
    told = _told(record)
    return Markup(
        f'<svg role="img" aria-label="{escape(told)}" class="sketch" viewBox="0 0 {WIDTH:g} {height:g}">'
        f"<title>{escape(told)}</title>{''.join(parts)}{''.join(labels)}</svg>"
    )


def _radii(record, span):
    """Bead → radius in the drawing, one scale for all."""
    real = {k: record.specimen.bodies[k].diameter_m / 2.0 for k in range(1, record.beads + 1)}
    total, largest = 2.0 * sum(real.values()), max(real.values(), default=1.0)
    scale = min(span / total if total else 1.0, LARGEST / largest)
    return {k: r * scale for k, r in real.items()}


def _centres(radii, span):
    """Bead → place of its centre; beads touch."""
    place, found = LEFT + 0.5 * (span - 2.0 * sum(radii.values())), {}
    for k, radius in radii.items():
        found[k] = place + radius
        place += 2.0 * radius
    return found


def _shown(record):
    if record.beads <= MOST:
        return list(range(1, record.beads + 1))
    held = {g.bead for g in record.gauges if g.bead}
    return sorted(held | {1, 2, 3, record.beads - 2, record.beads - 1, record.beads})


def _line(centres, radii):
    first, last = min(centres), max(centres)
    return (
        f'<line class="row" x1="{centres[first]:.1f}" x2="{centres[last]:.1f}" y1="{MIDDLE}" y2="{MIDDLE}" '
        f'stroke-width="{2.0 * max(radii.values()):.2f}"/>'
    )


def _bead(bead: Bead, x, radius, held):
    kind = "bead held" if held else "bead"
    if bead.flat:
        return (
            f'<rect class="{kind}" x="{x - radius:.2f}" y="{MIDDLE - radius:.2f}" width="{2 * radius:.2f}" '
            f'height="{2 * radius:.2f}"/>'
        )
    ring = ""
    if bead.coating_m and radius > 3.0:
        ring = f'<circle class="core" cx="{x:.2f}" cy="{MIDDLE}" r="{0.75 * radius:.2f}"/>'
    return f'<circle class="{kind}" cx="{x:.2f}" cy="{MIDDLE}" r="{radius:.2f}"/>{ring}'


def _striker(record, edge):
    """The striker with an arrow, left of the first bead."""
    flat = not record.runs[0].striker.radius_m < 1.0
    arrow = f'<path class="arrow" d="M{edge - 34:.1f} {MIDDLE - 18} h22 m-6 -4 l6 4 l-6 4"/>'
    if flat:
        body = (
            f'<rect class="striker" x="{edge - 16:.1f}" y="{MIDDLE - 10}" width="12" height="20" rx="1.5"/>'
        )
    else:
        body = f'<circle class="striker" cx="{edge - 13:.1f}" cy="{MIDDLE}" r="9"/>'
    name = "striker" if record.beads else "ball"
    return f'{arrow}{body}<text x="{max(edge - 34.0, 0.0):.1f}" y="{MIDDLE - 26}">{name}</text>'


def _wall(x, material, chain):
    marks = "".join(f"M{x + 1:.1f} {y} l7 -7 " for y in range(int(MIDDLE) - 13, int(MIDDLE) + 21, 7))
    name = f"wall: {material}"
    # Above the wall, beside the word `striker`, and within the drawing.
    wide = LETTER * len(name)
    end, y = min(max(x + 8.0 + 0.5 * wide, LEFT + 20.0 + wide), WIDTH - 2.0), MIDDLE - 26
    if not chain:  # with nothing else on its right
        end, y = x + 14.0 + wide, MIDDLE + 4
    return (
        f'<line class="wall" x1="{x:.1f}" x2="{x:.1f}" y1="{MIDDLE - 20}" y2="{MIDDLE + 20}"/>'
        f'<path class="hatch" d="{marks}"/>'
        f'<text x="{end:.1f}" y="{y}" text-anchor="end">{escape(name)}</text>'
    )


def _labels(record, centres, end):
    """Names of gauges below their places, in as many rows as they need; bead numbers beside them."""
    gauges = sorted(record.gauges, key=lambda g: g.bead or record.beads + 1)
    places = [centres[g.bead] if g.bead else end for g in gauges]
    names = [_named(g) for g in gauges]
    wide = [LETTER * len(name) for name in names]
    # From the left, or from the right in the mirror, whichever crosses less.
    mirrored = _placed([WIDTH - x for x in reversed(places)], wide[::-1])
    other = [(WIDTH - left - w, row) for (left, row), w in zip(reversed(mirrored), wide, strict=True)]
    ways = (_placed(places, wide), other)
    found = []
    chosen = min(ways, key=lambda way: _crossings(places, wide, way))
    for x, name, (left, row) in zip(places, names, chosen, strict=True):
        y = MIDDLE + LARGEST + 14.0 + LINE * (row + 1)
        found.append(
            f'<path class="lead" d="M{x:.1f} {MIDDLE + 3:.1f} V{y - 11:.1f}"/>'
            f'<text class="gauge" x="{left:.1f}" y="{y:.1f}">{escape(name)}</text>'
        )
    return found, max((row + 1 for _, row in chosen), default=0)


def _placed(places, wide):
    """Left edge and row of each name. None is crossed by the line down to another: each ends before the line
    of the next gauge where there is room, and begins behind those that go down further.
    """
    found, free = [], []
    for x, width, after in zip(places, wide, [*places[1:], math.inf], strict=False):
        room = after - 4.0 - width if after > x else math.inf  # two gauges may share a place
        left = max(min(x - 0.5 * width, WIDTH - width, room), 0.0)
        row = next((k for k, edge in enumerate(free) if left > edge + 4.0), len(free))
        free[row : row + 1] = [left + width]
        free[:row] = [max(edge, x) for edge in free[:row]]
        found.append((left, row))
    return found


def _crossings(places, wide, way):
    """How many lines cross names that stand above their own."""
    return sum(
        left < x < left + width and below > row
        for x, (_, below) in zip(places, way, strict=True)
        for width, (left, row) in zip(wide, way, strict=True)
    )


def _named(gauge: Gauge):
    place = f"bead {gauge.bead}" if gauge.bead else "wall"
    return gauge.id if gauge.id == place else f"{gauge.id}, {place}"


def _told(record):
    kind = "One ball on a wall" if record.beads == 0 else f"A chain of {record.beads} beads"
    gauges = ", ".join(map(_named, record.gauges))
    return f"{kind}, struck on the left" + (f"; gauges: {gauges}" if gauges else "")
