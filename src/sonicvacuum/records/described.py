"""The chain of a record in one line of plain words."""

from sonicvacuum.records.record import Record


def chain_of(record: Record) -> str:
    """`21 beads of parylene-c, 4.86 mm, 0.44 g, vertical`; for one ball also what it falls on."""
    kind = "one ball" if record.beads == 0 else f"{record.beads} beads"
    wall = "" if record.beads else f", on a wall of {record.specimen.wall.name}"
    return f"{kind} of {_beads(record.specimen)}{wall}, {record.block.chain.orientation}"


def _beads(specimen):
    """Material, diameter and mass of the beads, of each kind where they differ."""
    bodies = specimen.bodies
    pattern, single = [_bead(b) for b in bodies.pattern], bodies.exceptions.items()
    return "; ".join([" / ".join(pattern), *(f"bead {k} {_bead(b)}" for k, b in sorted(single))])


def _bead(bead):
    faces = ", flat faces" if bead.flat else ""
    within = f" ({bead.coating_m * 1e6:g} µm on {bead.core.name})" if bead.coating_m and bead.core else ""
    return f"{bead.surface.name}{within}, {bead.diameter_m * 1e3:g} mm, {bead.mass_kg * 1e3:g} g{faces}"
