"""The next run is one that the laboratory can make."""

from types import SimpleNamespace

import numpy as np
import pytest
from made_records import SIGMA, block, made

from sonicvacuum.discover import next_experiment, session
from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.imagined import changes, changes_of_two, together
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.next_experiment import put_behind, resolved
from sonicvacuum.discover.search import singles
from sonicvacuum.discover.verdict import Next
from sonicvacuum.effects import effect
from sonicvacuum.files import InputError
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.reader import parse
from sonicvacuum.report import next_run, words

SPEED = 0.5


def proposals(apparatus=None):
    """What could be changed in the last run of a record with this apparatus."""
    content = block([SPEED]) | ({"apparatus": apparatus} if apparatus is not None else {})
    time = np.arange(0.0, 300.0)
    quiet = Signals(time, {s["id"]: np.zeros(len(time)) for s in content["sensors"]})
    return [change for change, _ in changes(experiment(Record(parse(content), {"v0": quiet})))]


def test_without_apparatus_anything_usual_is_tried():
    keys = {key for change in proposals() for key in change}
    assert {"striker.speed_m_s", "striker.mass_g", "chain.static_force_N", "chain.orientation"} <= keys


def test_within_the_apparatus_nothing_else_is_proposed():
    found = proposals({"speed_m_s": [0.2, 0.8], "static_force_N": [0.0, 3.0], "gauge_beads": [2, 4]})
    assert {key for change in found for key in change} == {
        "striker.speed_m_s", "chain.static_force_N", "sensors.g4.bead"
    }  # fmt: skip
    speeds = [c["striker.speed_m_s"] for c in found if "striker.speed_m_s" in c]
    assert speeds == pytest.approx([0.2, 0.25, 0.8])
    assert {"chain.static_force_N": 3.0} in found
    assert {"sensors.g4.bead": 2} in found


def test_an_empty_apparatus_leaves_nothing_to_propose():
    assert proposals({}) == []


@pytest.mark.parametrize(
    ("apparatus", "told"),
    [
        ({"speed_m_s": [2.0, 1.0]}, "slowest first"),
        ({"speed_m_s": [1.0, 2000.0]}, "mm/s"),
        ({"gauge_beads": [40]}, "no such bead"),
        ({"speeds": [1.0]}, "speed"),
    ],
)
def test_an_apparatus_that_cannot_be_is_refused(apparatus, told):
    with pytest.raises(InputError, match=told):
        parse(block([SPEED]) | {"apparatus": apparatus})


def worth(weights, *apart):
    """Probability that each run leaves one explanation alone."""
    return resolved(weights, put_behind(weights, np.array(apart)))


def between(*pairs, count=3):
    """Matrix of χ² between pairs (i, j, χ²), 0 between the others."""
    found = np.zeros((count, count))
    for i, j, value in pairs:
        found[i, j] = found[j, i] = value
    return found


def test_a_run_that_tells_nothing_apart_resolves_nothing_and_a_decisive_one_all():
    found = worth(np.zeros(3), np.zeros((3, 3)), np.full((3, 3), 200.0))
    assert found == pytest.approx([0.0, 1.0], abs=1e-6)  # 191 of 200 more than asked, scatter 28


def test_a_run_that_separates_the_best_alone_is_worth_no_more_than_the_best_is_likely():
    """Which of the others is true stays open after it."""
    weights = np.log([0.4, 0.3, 0.3])
    best_alone = between((0, 1, 300.0), (0, 2, 300.0))
    all_three = between((0, 1, 40.0), (0, 2, 40.0), (1, 2, 40.0))
    one, other = worth(weights, best_alone, all_three)
    assert one == pytest.approx(0.4, abs=1e-6)  # scatter of 300 is 35
    assert other > 0.9


def test_what_a_run_decides_is_half_open_where_it_takes_as_much_as_is_asked():
    """A χ² of 9 has to be gained, and its mean is 9: as often more as less."""
    assert worth(np.zeros(2), between((0, 1, 9.0), count=2)) == pytest.approx([0.5])


def test_what_no_run_tells_apart_decides_nothing_between_runs():
    """The first two are limits of one another; runs are told by what they say of the third."""
    weak, strong = between((0, 2, 5.0), (1, 2, 5.0)), between((0, 2, 90.0), (1, 2, 90.0))
    one, other = worth(np.zeros(3), weak, strong)
    assert one < 0.4 < 0.99 < other


def test_two_changes_are_of_different_quantities_and_leave_the_chain_as_it_hangs():
    content = block([SPEED])
    time = np.arange(0.0, 300.0)
    quiet = Signals(time, {s["id"]: np.zeros(len(time)) for s in content["sensors"]})
    found = [change for change, _ in changes_of_two(experiment(Record(parse(content), {"v0": quiet})))]
    assert found and all(len(change) == 2 for change in found)
    assert all(sum(key.startswith("sensors.") for key in change) < 2 for change in found)
    assert "chain.orientation" not in {key for change in found for key in change}


def test_runs_imagined_side_by_side_tell_apart_what_they_do_one_by_one(hidden):
    """Also those with a gauge elsewhere, and those that are watched for longer."""
    old = Forward(experiment(hidden))
    setup, null = singles.setup_of(old), wide.nominal(old)
    law = Hypothesis((Component(effect("viscous-drag"), variants(effect("viscous-drag"), setup)[0]),))
    fits = [null, fit(old, law, np.array([[-1.0]]), null.nu[None])]
    known = [next_experiment.precision(old, one) for one in fits]
    every = [*changes(old.experiment), *list(changes_of_two(old.experiment))[::9]]
    assert len({one.gauges for _, one in every}) > 2 < len({one.batches[0].duration for _, one in every})
    assert {"sensors", "striker", "chain"} <= {key.split(".")[0] for change, _ in every for key in change}
    abreast = next_experiment.separations(old, Forward(together([one for _, one in every])), fits, known)
    alone = [next_experiment.separations(old, Forward(one), fits, known) for _, one in every]
    # The last digits of a chain depend on those beside it, and differences of chains have fewer.
    np.testing.assert_allclose(abreast, np.concatenate(alone), rtol=1e-6, atol=1e-6)
    assert abreast[:, 0, 1].min() > 0.0 and np.ptp(abreast[:, 0, 1]) > 1.0


ONE, TWO = {"striker.speed_m_s": 2.0}, {"striker.speed_m_s": 2.0, "striker.mass_g": 1.0}


def proposed(monkeypatch, apart_by_one, apart_by_two):
    """What is proposed between three explanations as likely as each other, and whether two were asked for."""
    asked = []

    def tried(forward, left, known, imagined):
        asked.append(imagined)
        change, apart = {"one": (ONE, apart_by_one), "two": (TWO, apart_by_two)}[imagined]
        return [change], np.array([apart])

    for name, value in (("_tried", tried), ("precision", lambda *rest: None)):
        monkeypatch.setattr(next_experiment, name, value)
    for name, value in (("changes", "one"), ("changes_of_two", "two")):
        monkeypatch.setattr(next_experiment, name, lambda seen, value=value: value)
    explanations = [next_experiment.Explanation(name, 0.0, None) for name in "abc"]
    monkeypatch.setattr(next_experiment, "_left", lambda *rest: explanations)
    seen = SimpleNamespace(runs=[SimpleNamespace(has_signals=True)])
    found = SimpleNamespace(forward=SimpleNamespace(experiment=seen))
    return next_experiment.propose(found, [["a", "b", "c"]]), "two" in asked


def test_two_quantities_are_changed_only_where_one_does_not_decide(monkeypatch):
    decisive, weak = np.full((3, 3), 200.0), np.full((3, 3), 12.0)
    for by_one, change, asked in ((decisive, ONE, False), (weak, TWO, True)):
        wanted = Next(change=change, separates=["a", "b"], delta_chi2=200.0)
        assert proposed(monkeypatch, by_one, decisive) == (wanted, asked)


def test_a_second_change_that_helps_little_is_left_out(monkeypatch):
    weak, hardly_better = np.full((3, 3), 12.0), np.full((3, 3), 12.2)
    found, asked = proposed(monkeypatch, weak, hardly_better)
    assert asked and found.change == ONE


def searched(named, probabilities, singles=(), sets=()):
    """A search that fitted these effects and sets, the likeliest first."""
    return SimpleNamespace(
        named=named,
        probabilities=probabilities,
        null=None,
        candidates=[
            SimpleNamespace(effect=e, log_bayes=-k, gain=9.0, fit=None) for k, e in enumerate(singles)
        ],
        combinations=[SimpleNamespace(effects=e, log_bayes=-9 * k, fit=None) for k, e in enumerate(sets)],
    )


@pytest.mark.parametrize(
    ("found", "alike", "left"),
    [
        # The second is ruled out: no run is made to tell the first from it, nor from a pair without a fit.
        (searched(["viscous-drag"], {"viscous-drag": 0.96, "relaxing-contact": 2e-94,
                                     "tsuji + viscous-drag": 0.04}, ["viscous-drag", "relaxing-contact"]),
         [], ["viscous-drag"]),
        (searched(["tsuji"], {"tsuji": 0.9, "gravity": 0.05, "hunt-crossley": 1e-9},
                  ["tsuji", "gravity", "hunt-crossley"]), [], ["tsuji", "gravity"]),
        (searched(["tsuji"], {"tsuji": 0.99, "gravity": 1e-4}, ["tsuji", "gravity"]),
         [["tsuji", "gravity"]], ["tsuji", "gravity"]),
        (searched([], {"none": 0.95, "tsuji": 0.008, "gravity": 1e-7}, ["tsuji", "gravity"]),
         [], ["none", "tsuji"]),
        (searched(["tsuji", "gravity"], {"gravity + tsuji": 0.7, "hunt-crossley + tsuji": 0.3,
                                         "hunt-crossley + mass-defect": 1e-30},
                  sets=[("tsuji", "gravity"), ("tsuji", "hunt-crossley"), ("mass-defect", "hunt-crossley")]),
         [["gravity", "hunt-crossley"]], ["tsuji+gravity", "tsuji+hunt-crossley"]),
        # What is unknown is none of them: they are the nearest to it, ruled out as they are.
        (searched(["unknown"], {"unknown": 1.0}, ["tsuji", "gravity"]), [], ["tsuji", "gravity"]),
    ],
)  # fmt: skip
def test_what_the_data_rule_out_is_no_rival(found, alike, left):
    assert [one.name for one in next_experiment._left(found, alike)] == left


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (ONE, "with the striker at 2 m/s"),
        (TWO, "with a striker of 1 g at 2 m/s"),
        ({"striker.mass_g": 1.5, "chain.static_force_N": 0.5}, "with a striker of 1.5 g and under a static"),
        ({"striker.speed_m_s": 2.0, "sensors.g1.bead": 3}, "at 2 m/s and with gauge g1 in bead 3"),
    ],
)
def test_a_run_is_said_in_words(change, told):
    proposal = Next(change=change, separates=["tsuji", "viscous-drag"], delta_chi2=25.0)
    text = next_run.experiment(proposal)
    assert told in text and "5 standard errors" in text


def seen_from(bead, seed):
    """The verdict on a gap at contact 3 that one gauge saw from a bead."""
    gauge = {"id": "g", "kind": "embedded", "bead": bead, "sigma_N": SIGMA, "gain_rel_sigma": 0.02}
    record, _ = made([("contact-gap", {"gap_um": 0.6, "contact": 3})], seed=seed, sensors=[gauge])
    found = session.discover(record, threads=1).verdict
    return found, [line for line in found.reasons if "sits at" in line]


def test_what_is_clear_but_for_its_place_is_asked_where_it_sits():
    """From bead 7 a gap at contact 3 looks like one at contact 2; from between them it does not. A load
    would close it.
    """
    found, unsure = seen_from(7, seed=3)
    assert found.named == ["contact-gap"] and not found.confusable and unsure
    proposal = found.next_experiment
    assert proposal.places == [{"contact-gap": 3}, {"contact-gap": 2}]
    assert "at contact 3 and gap in the chain at contact 2" in next_run.experiment(proposal)
    assert not next_run.settled(found)
    assert not {"chain.static_force_N", "chain.orientation"} & proposal.change.keys()
    found, unsure = seen_from(proposal.change["sensors.g.bead"], seed=4)
    assert found.parameters["contact-gap"]["contact"].value == 3 and not unsure


def test_a_gauge_is_called_by_its_name_where_an_effect_is_said_to_sit():
    assert words.placed("sensor-gain+tsuji", {"sensor-gain": "g4"}).startswith("sensor gain at gauge g4 and ")
