"""A bead too many or too few, told by the wall alone: it delays pulses as late triggers would."""

from types import SimpleNamespace

import pytest
from made_records import made

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, competition

WALL = [{"id": "wall", "kind": "wall", "sigma_N": 0.02, "gain_rel_sigma": 0.02}]
DRAG = [("viscous-drag", {"rate_per_s": 400.0})]


def told(record):
    """Slips of a verdict that are sure, and what is named."""
    v = session.discover(record).verdict
    return [(f.fault, f.value) for f in v.faults if f.probability > 0.9], v.named


@pytest.fixture(scope="module")
def dragged():
    """Three shots with one gauge, at the wall, and drag."""
    return made(DRAG, seed=5, speeds=(0.2, 0.4, 0.8), sensors=WALL)[0]


@pytest.mark.parametrize("by", [-1, pytest.param(1, marks=pytest.mark.long)])
def test_a_bead_miscounted_beside_an_effect_is_no_time_zero(dragged, by):
    """It was told as time zeros 48 us off, with 0.999."""
    assert told(changes.bead_count(dragged, by)) == ([("bead-count", 10.0)], ["viscous-drag"])


def test_late_triggers_beside_an_effect_are_no_bead_miscounted(dragged):
    """As late in every run as a bead delays the middle one."""
    late = changes.time_zero(dragged, dict.fromkeys(dragged.signals, 46.0), 0.0)
    ((fault, value),), named = told(late)
    assert (fault, named) == ("time-zero", ["viscous-drag"])
    # Triggers scatter by 1 us, and drag delays what is not known yet.
    assert value == pytest.approx(-46.0, abs=4.0)


@pytest.mark.parametrize(
    ("named", "without"),
    [
        (["a"], set()),
        (["a", "b"], {("a",), ("b",)}),
        (["a", "b", "c"], {("b", "c"), ("a", "c"), ("a", "b")}),
    ],
)
def test_slips_are_asked_for_beside_each_effect_of_a_set_alone(monkeypatch, named, without):
    """Drag beside a bead too few was told as drag, a softer modulus and a wall far too stiff, with 0.91."""
    asked = set()
    search = SimpleNamespace(_like_slips=lambda *_: False, _included=lambda *_: [])
    monkeypatch.setattr(competition, "part_without", lambda _, names: asked.add(tuple(names)) or ("", None))
    monkeypatch.setattr(competition, "weight_beside", lambda *_: 0.0)
    assert competition.Search._in_place(search, SimpleNamespace(named=named)) == []
    assert asked == without
