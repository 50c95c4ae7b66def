"""The same experiment at another size: a chain of similar bodies of the same materials, struck as fast.

Lengths and times are then `scale` times as large, masses its cube, forces its square (Hertz; K. L. Johnson,
Contact Mechanics, 1985, section 11.4), and a time constant that is found goes with them.
"""

import pytest
from made_records import block

from sonicvacuum.discover import session
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.reader import parse

SPEEDS = (0.3, 0.9)


def similar(record, scale):
    """A record of ten beads (`made_records`) as a laboratory of `scale` times its size would have it."""
    content = block(SPEEDS)
    bead = content["chain"]["bead"]
    bead["diameter_mm"] *= scale
    bead["mass_g"] *= scale**3
    content["trigger_sigma_us"] *= scale
    for sensor in content["sensors"]:
        sensor["sigma_N"] *= scale**2
    for run in content["runs"]:
        run["striker"]["mass_g"] *= scale**3
    signals = {
        run: Signals(s.time_us * scale, {sensor: f * scale**2 for sensor, f in s.readings.items()})
        for run, s in record.signals.items()
    }
    return Record(parse(content), signals, "made")


@pytest.mark.parametrize("scale", [0.2, 20.0], ids=["beads of 1 mm", "balls of 97 mm"])
def test_a_similar_chain_gets_the_same_verdict(hidden, verdict, scale):
    usual, other = verdict.verdict, session.discover(similar(hidden, scale)).verdict
    assert other.named == usual.named == ["kuwabara-kono"]
    found, expected = (v.parameters["kuwabara-kono"]["time_us"] for v in (other, usual))
    # 1e-3: gravity, which has a length of its own, is no part of what is found.
    assert found.value == pytest.approx(scale * expected.value, rel=1e-3)
    assert found.sigma == pytest.approx(scale * expected.sigma, rel=1e-2)  # slopes are differences

    def alike(v):
        """Probability of damping that one law or its fast limit says: bounds decide how it is shared."""
        return v.probabilities["kuwabara-kono"] + v.probabilities["relaxing-contact"]

    # 0.03: the catalogue's shortest relaxation, 0.3 us, is no longer fast beside a contact of 2 us.
    assert alike(other) == pytest.approx(alike(usual), abs=0.03)
