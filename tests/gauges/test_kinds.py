"""Kinds of gauges: what each feels of a simulated chain; a kind of one's own needs one entry only."""

import numpy as np
import pytest

from sonicvacuum.gauges import KINDS, Gauge, Kind, needed, position, reading
from sonicvacuum.gauges.electronics import filtered
from sonicvacuum.laboratory.bodies import to_wall
from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.run import simulate

STEEL = Elastic("steel", 193e9, 0.3)
BEAD = Body(STEEL, 0.45e-3, 2.38e-3)
BEADS, MASS = 12, 0.45e-3


@pytest.fixture(scope="module")
def history():
    """A steel chain of twelve beads and all that its gauges may need."""
    chain = Chain(
        beads=BEADS, bodies=BEAD, striker=STEEL, wall=STEEL, striker_radius=2.38e-3, striker_mass=MASS,
        speed=0.4,
    )  # fmt: skip
    return simulate(chain, (12,), 3e-4, 0.5e-6, bodies=(0, 5))


@pytest.mark.parametrize(
    ("kind", "bead", "felt"),
    [
        ("embedded", 5, lambda h: 0.5 * h.of(4) + 0.5 * h.of(5)),
        ("wall", None, lambda h: h.of(12)),
        ("velocity", 5, lambda h: h.velocity_of(5)),
        ("acceleration", 5, lambda h: h.acceleration_of(5)),
    ],
)
def test_each_kind_reads_its_motion_through_the_same_electronics(history, kind, bead, felt):
    plain = Gauge("g", kind, bead)
    np.testing.assert_array_equal(reading(plain, history, BEADS), felt(history))
    real = Gauge("g", kind, bead, droop_s=1e-4, lowpass_s=2e-6, gain=3.0)
    shown = 3.0 * filtered(felt(history), 0.5e-6, 2e-6, 1e-4)
    np.testing.assert_allclose(reading(real, history, BEADS), shown, rtol=1e-12)  # a few roundings


def test_acceleration_gauge_is_the_net_force_on_its_bead(history):
    shown = reading(Gauge("a", "acceleration", 5), history, BEADS)
    net = (history.of(4) - history.of(5)) / MASS
    np.testing.assert_allclose(shown, net, rtol=0, atol=1e-12 * np.abs(net).max())  # a few roundings


def test_what_has_to_be_recorded_follows_from_the_kinds():
    gauges = [
        Gauge("v", "velocity", 7),
        Gauge("w", "wall"),
        Gauge("e", "embedded", 3),
        Gauge("a", "acceleration", 2),
    ]
    assert needed(gauges, 12) == ((2, 3, 12), (2, 7))
    assert needed([], 12) == ((), ())


def test_a_bead_of_a_chain_moves_towards_the_wall_first(history):
    velocity = reading(Gauge("v", "velocity", 5), history, BEADS)[:, 0]
    loudest = np.flatnonzero(np.abs(velocity) > 0.05 * velocity.max())[0]
    assert velocity[loudest] > 0.0


def test_keys_units_and_places_of_the_kinds():
    keys = {k.id: (k.unit, k.noise_key, k.in_bead) for k in KINDS.values()}
    assert keys == {
        "embedded": ("N", "sigma_N", True),
        "wall": ("N", "sigma_N", False),
        "velocity": ("m/s", "sigma_m_s", True),
        "acceleration": ("m/s2", "sigma_m_s2", True),
    }
    assert position(Gauge("v", "velocity", 13), 21, 4.86e-3) == position(
        Gauge("e", "embedded", 13), 21, 4.86e-3
    )


@pytest.mark.parametrize("kind", ["velocity", "acceleration", "wall"])
def test_only_an_embedded_gauge_can_sit_off_the_middle(kind):
    with pytest.raises(ValueError, match="sensor g: offset_fraction"):
        Gauge("g", kind, None if kind == "wall" else 3, offset_fraction=0.1)


def test_what_was_not_recorded_is_named():
    chain = Chain(
        beads=2, bodies=BEAD, striker=STEEL, wall=STEEL, striker_radius=2e-3, striker_mass=MASS, speed=0.4,
    )  # fmt: skip
    seen = simulate(chain, (0,), 2e-5, 1e-6)
    with pytest.raises(ValueError, match="velocity of body 1 was not recorded"):
        reading(Gauge("v", "velocity", 1), seen, 2)
    with pytest.raises(ValueError, match="force of contact 1 was not recorded"):
        reading(Gauge("e", "embedded", 1), seen, 2)


def _feel(gauge, motion, beads):
    return motion.velocity_of(0) - motion.velocity_of(0)[0]


STRIKER_VELOCITY = Kind(
    id="striker-velocity",
    title="Velocity of the striker",
    unit="m/s",
    suffix="m_s",
    in_bead=False,
    feel=_feel,
    distance=lambda gauge, beads, diameter: to_wall(diameter, 1, beads),
    bodies=lambda gauge, beads: (0,),
)


@pytest.fixture
def own_kind(monkeypatch):
    """The kind of the package's documentation, registered as one line there would."""
    monkeypatch.setitem(KINDS, STRIKER_VELOCITY.id, STRIKER_VELOCITY)


@pytest.mark.usefixtures("own_kind")
def test_a_kind_of_ones_own_is_one_entry(history, tmp_path):
    from sonicvacuum.records import Record, Signals, read, write
    from sonicvacuum.records.predict import predict
    from sonicvacuum.records.reader import parse

    shown = reading(Gauge("s", "striker-velocity"), history, BEADS)[:, 0]
    assert shown[0] == 0.0
    assert shown[-1] == history.striker_speed[0] - 0.4
    ball = {"shape": "sphere", "diameter_mm": 4.76, "material": "stainless-steel", "mass_g": 0.45}
    block = parse({
        "format": 1,
        "title": "a laser on the striker",
        "chain": {
            "beads": BEADS,
            "orientation": "horizontal",
            "bead": {"diameter_mm": 4.76, "mass_g": 0.45, "material": "stainless-steel"},
            "wall": {"material": "stainless-steel"},
        },
        "sensors": [{"id": "laser", "kind": "striker-velocity", "sigma_m_s": 1e-3}],
        "runs": [{"id": "one", "striker": ball | {"speed_m_s": 0.4}, "signals": "one.csv"}],
    })  # fmt: skip
    time = np.arange(0.0, 250.0, 0.5)
    write(Record(block, {"one": Signals(time, {"laser": np.zeros(len(time))})}), tmp_path)
    again = read(tmp_path)
    assert again.gauges[0].sigma == 1e-3
    predicted = predict(again)[0].readings["laser"]
    # Two steps and two interpolations of the same motion; both are good to 1e-5 of the speed.
    np.testing.assert_allclose(predicted, shown[: len(time)], atol=1e-4 * 0.4)


def test_a_kind_that_nobody_registered_is_refused():
    with pytest.raises(ValueError, match="kind is 'striker-velocity'; it must be one of embedded, wall"):
        Gauge("s", "striker-velocity")
