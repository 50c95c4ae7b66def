"""What a page says of the run that would settle a verdict."""

import pytest
from made_verdicts import SPREAD, verdict

import sonicvacuum as sv
from sonicvacuum.discover.verdict import Next
from sonicvacuum.physics import validity
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse
from sonicvacuum.report import next_run

TRACE, SCALAR = [{"sensor": "g1"}], [{"sensor": ""}]


def record(*speeds):
    """A chain of steel balls struck at these speeds."""
    steel = {"diameter_mm": 10, "mass_g": 4, "material": "bearing-steel"}
    number = {"quantity": "amplitude", "sensor": "w", "value": 30.0, "sigma": 1.0, "unit": "N"}
    runs = [
        {"id": f"v{k}", "striker": {"shape": "sphere", "speed_m_s": v, **steel}, "observables": [number]}
        for k, v in enumerate(speeds)
    ]
    content = {
        "format": 1,
        "title": "balls",
        "chain": {"beads": 8, "orientation": "horizontal", "bead": steel, "wall": {"material": "brass"}},
        "sensors": [{"id": "w", "kind": "wall"}],
        "runs": runs,
    }
    return Record(parse(content))


def proposal(*separates, **change):
    return Next(change={"striker.speed_m_s": 6.0, **change}, separates=list(separates), delta_chi2=121.0)


@pytest.mark.parametrize(
    ("one", "other", "said"),
    [
        ("tsuji", "viscous-drag", "damping with constant restitution and viscous drag, its nearest"),
        ("wall-compliance+tsuji", "wall-compliance+viscous-drag",
         "beside wall compliance, damping with constant restitution and viscous drag, its nearest"),
        ("wall-compliance+tsuji", "wall-compliance+viscous-drag+gravity",
         "beside wall compliance, damping with constant restitution and (viscous drag with gravity along"),
        ("wall-compliance+tsuji", "mass-defect+gravity",
         "(wall compliance with damping with constant restitution) and (mass defect with gravity along"),
        ("tsuji+gravity", "tsuji",
         "damping with constant restitution with gravity along the chain and the same without, its nearest"),
        ("tsuji", "tsuji+gravity",
         "damping with constant restitution alone and the same with gravity along the chain, its nearest"),
    ],
)  # fmt: skip
def test_it_is_seen_where_each_of_two_sets_ends(one, other, said):
    assert f"one explanation alone: {said}" in next_run.experiment(proposal(one, other))


def test_a_run_beyond_what_was_measured_says_by_how_much():
    open_ = verdict(next_experiment=proposal("kuwabara-kono", "tsuji"))
    told = next_run.told(open_, TRACE, [record(0.3, 1.2)])
    assert told.endswith("a model foretells only as far as it holds there.")
    assert "That is 5 times the fastest speed of the record, 1.2 m/s" in told
    assert "fastest" not in next_run.told(open_, TRACE, [record(0.3, 6.0)])
    assert "fastest" not in next_run.told(open_, TRACE)  # of a record that was not kept


def test_beyond_yield_it_is_said_that_the_beads_bear_more_there():
    """The warning is the one that `physics.validity` gives of such a chain."""
    steel = sv.bead(diameter_mm=10.0, material="bearing-steel")
    soft = sv.bead(diameter_mm=10.0, material="ptfe")
    case = sv.case(
        sv.chain(pattern=[soft], beads=8),
        sv.striker(steel, speed_m_s=1.2),
        [sv.gauge("wall")],
        duration_us=900,
    )
    (line,) = (w for w in sv.simulate(case).warnings if "yield strength" in w)
    open_ = verdict(next_experiment=proposal("kuwabara-kono", "tsuji"), warnings=[line])
    told = next_run.told(open_, TRACE, [record(1.2)])
    share = line[: line.index(" times the yield")].split()[-1]
    assert float(share) > validity.YIELD
    assert f"reaches {share} times the yield strength already, and more at this one" in told
    assert "yield" not in next_run.told(open_, TRACE, [record(6.0)])


def test_without_a_proposal_it_is_said_why():
    odds = SPREAD | {"kuwabara-kono + viscous-drag": 0.02}
    alone, beside = verdict(next_experiment=None), verdict(next_experiment=None, probabilities=odds)
    ruled_out = "No proposal: these data rule out every other explanation that was fitted."
    assert next_run.told(alone, TRACE) == ruled_out
    assert "whether something small hides beside viscoelastic Hertz contact" in next_run.told(beside, TRACE)
    nothing = verdict(named=[], parameters={}, probabilities={"none": 0.95}, next_experiment=None)
    assert next_run.told(nothing, TRACE) == "No proposal: no rivals are left to separate."
    assert "this record has none" in next_run.told(alone, SCALAR)


def test_of_what_is_unknown_no_run_is_said_to_leave_one_explanation_alone():
    unknown = verdict(named=["unknown"], parameters={}, probabilities={"unknown": 1.0})
    told = next_run.told(unknown, TRACE)
    assert told.startswith("What is unknown cannot be foretold") and "alone" not in told
    assert "viscoelastic Hertz contact and damping with constant restitution would differ there" in told
