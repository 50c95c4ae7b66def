"""A chain of steel balls, and the folder of a verdict on it with the origin of its data."""

from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse

STEEL = {"diameter_mm": 10, "mass_g": 4, "material": "bearing-steel"}

STRIKER = {"shape": "sphere", "speed_m_s": 0.5, "speed_rel_sigma": 0.01, **STEEL}


def record(beads=12, **changes) -> Record:
    """A chain of steel balls with a gauge in a bead and one at the wall."""
    content = {
        "format": 1,
        "title": "Steel balls <in> a row",
        "chain": {"beads": beads, "orientation": "horizontal", "bead": STEEL, "wall": {"material": "brass"}},
        "materials": {"bearing-steel": {"modulus_rel_sigma": 0.02}},
        "sensors": [
            {"id": "g1", "kind": "embedded", "bead": 5, "gain_rel_sigma": 0.02},
            {"id": "wall", "kind": "wall", "gain_rel_sigma": 0.02},
        ],
        "trigger_sigma_us": 1.0,
        "runs": [
            {"id": run, "striker": STRIKER, "observables": [
                {"quantity": "amplitude", "sensor": "g1", "value": 30.0, "sigma": 1.0, "unit": "N"}]}
            for run in ("slow", "fast")
        ],
        **changes,
    }  # fmt: skip
    return Record(parse(content), name="made", digest="ab" * 32)
