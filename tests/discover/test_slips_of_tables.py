"""Slips in tables of values without traces."""

from collections import Counter
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from made_records import BEADS
from made_tables import ball, chain, changed

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, judged, policy, tables
from sonicvacuum.discover.faults.found import Bench
from sonicvacuum.discover.faults.ranking import Ranking
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis, variants
from sonicvacuum.discover.search import singles
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.report import bench


def discovered(record):
    return session.discover(record, threads=1, limits=False).verdict


def ranked_of(record, threads=1):
    return Ranking(Bench(record), CATALOGUE, threads, [])


@pytest.fixture(scope="module")
def mistyped():
    """What is found where one rebound lacks a digit."""
    return discovered(changed(ball(), 2, 0, value=lambda v: 0.1 * v))


def test_a_mistyped_value_is_named_with_its_place_and_by_how_much(mistyped):
    assert mistyped.named == []
    (one,) = mistyped.faults
    assert (one.fault, one.run, one.quantity) == ("spikes", "v2", "restitution")
    assert one.probability > 0.95
    assert one.value == pytest.approx(0.1, rel=0.03)


def test_the_page_says_which_value_no_other_supports(mistyped):
    (said,) = bench.slips(mistyped)
    assert said.startswith("Restitution is 0.1") and "no other supports in run v2: look it up" in said


@pytest.mark.parametrize("error", [0.0, 0.01])
def test_a_run_at_another_speed_is_told_by_all_its_values(error):
    found = discovered(changes.strikers(chain(speed_error=error), "speed_m_s", -np.log(2.0), ("v1",)))
    assert found.named == []
    (one,) = found.faults
    assert (one.fault, one.run) == ("run-off", "v1") and one.probability > 0.95
    assert one.value == pytest.approx(2.0, rel=0.03)


def test_where_a_speed_moves_one_value_only_both_may_be_wrong():
    # The contact time follows the speed by its fifth root, so that a factor of four moves it by a third.
    found = discovered(changes.strikers(ball(), "speed_m_s", -np.log(4.0), ("v3",)))
    assert found.named == []
    shares = {(f.fault, f.run): f for f in found.faults}
    assert shares.keys() == {("run-off", "v3"), ("spikes", "v3")}
    assert shares["run-off", "v3"].value == pytest.approx(4.0, rel=0.3)
    assert min(f.probability for f in found.faults) > 0.05


def test_rows_of_two_gauges_in_each_others_place():
    record = chain()
    high, wall = (record.block.runs[1].observables[k].value for k in (0, 2))
    record = changed(changed(record, 1, 0, value=lambda _: wall), 1, 2, value=lambda _: high)
    found = discovered(record)
    assert found.named == []
    (one,) = found.faults
    assert (one.fault, one.run, one.sensor) == ("gauges-swapped", "v1", ["g4", "wall"])
    (said,) = bench.slips(found)
    assert said.startswith("Amplitude of gauges g4 and wall look exchanged in run v1: check the rows")


def test_runs_exchanged_as_a_whole_are_looked_up_in_their_rows():
    record = chain()
    first, second = (record.block.runs[k].observables for k in (0, 2))
    for place in range(5):
        for run, other in ((0, second), (2, first)):
            value = other[place].value
            record = changed(record, run, place, value=lambda _, v=value: v)
    found = discovered(record)
    assert found.named == []
    (one,) = found.faults
    assert (one.fault, one.run, one.quantity) == ("runs-swapped", "v0 and v2", tables.ALL)
    (said,) = bench.slips(found)
    assert said.startswith("All values of runs v0 and v2 look exchanged: check the rows of both runs")


def test_errors_that_are_too_small_are_told_and_nothing_is_named():
    record = ball(speeds=tuple(0.1 * 1.3**k for k in range(12)), seed=3)
    for run in range(12):
        for place in range(2):
            record = changed(record, run, place, sigma=lambda s: s / 4.0)
    found = discovered(record)
    assert found.named == []
    assert {f.fault for f in found.faults} == {"noise-misstated"}
    assert sum(f.probability for f in found.faults) > 0.9
    assert bench.slips(found)[0].startswith("The errors of ")


def test_slips_beside_an_effect_at_the_last_bead_leave_it_its_place():
    ranking = ranked_of(chain(departures=[("mass", BEADS, 2.5)]))
    model = ranking.nominal()
    setup, defect = singles.setup_of(model.forward), CATALOGUE.effect("mass-defect")
    beside = Hypothesis((Component(defect, variants(defect, setup)[0], place=BEADS),))
    one = fit(model.forward, beside, np.full((1, 1), np.log(2.5)), model.fit.nu[None])
    # A bead less has none of that number; a bead more has it elsewhere.
    assert "bead-count" in {j.slip.fault for j in ranking.ranked(model)}
    assert "bead-count" not in {j.slip.fault for j in ranking.ranked(replace(model, fit=one))}


def test_what_is_left_counts_as_noise_only_where_it_looks_like_it():
    random = np.random.default_rng(5)
    places = [(k, j, f"q{j}") for k in range(6) for j in range(4)]
    noise = dict(zip(places, 3.0 * random.normal(size=24), strict=True))
    factor = float(np.sqrt(np.mean(np.square(list(noise.values())))))
    assert tables._random(noise, factor)
    # An effect leaves the same in neighbouring runs; a value that is off makes up all there is.
    assert not tables._random({(k, j, q): factor * (-1) ** j for k, j, q in places}, factor)
    one = {at: 0.3 * (-1) ** at[0] for at in places} | {places[7]: 12.0}
    assert not tables._random(one, float(np.sqrt(np.mean(np.square(list(one.values()))))))


def test_quantities_that_stand_once_have_no_neighbours_to_be_alike():
    noise = [-0.4, 1.1, 0.6, -1.6, 0.9, -0.7, 1.2, 0.3]
    values = {(0, j, f"q{j}"): 5.0 * z for j, z in enumerate(noise)}
    assert tables._random(values, 5.0 * float(np.sqrt(np.mean(np.square(noise)))))


def test_a_table_of_few_values_is_not_asked():
    assert tables.asked(ball())
    assert not tables.asked(ball(speeds=(0.2, 0.5, 1.0)))


@pytest.mark.parametrize("count", [6, 18])
def test_no_more_slips_are_looked_at_for_more_runs(count):
    """As many values and exchanges as there are rows and pairs of rows, of which a few explain anything."""
    record = ball(speeds=[0.1 * 20.0 ** (k / count) for k in range(count)])
    first, second = (record.block.runs[k].observables[1] for k in (2, 4))
    record = changed(record, 2, 1, value=lambda _: second.value)
    record = changed(record, 4, 1, value=lambda _: first.value)
    ranking = ranked_of(record)
    model = ranking.nominal()
    slips = tables.hypotheses(record, model)
    kinds = Counter((s.fault, s.quantity == tables.ALL) for s in slips)
    assert max(kinds.values()) <= policy.LOOKED_AT
    # All that there are count in the prior.
    pairs = count * (count - 1) // 2
    exchanges = {s.alternatives for s in slips if s.fault == "runs-swapped"}
    assert exchanges == {pairs, 2 * pairs}
    best = ranking.ranked(model)[0].slip
    # Rebounds of an elastic ball tell no speed, so that all rows may be exchanged as well.
    assert (best.fault, best.run) == ("runs-swapped", "v2 and v4")


def test_simulations_are_counted_alike_on_more_threads():
    record = changes.strikers(ball(), "speed_m_s", -np.log(2.0), ("v3",))
    counts = []
    for threads in (1, 2):
        ranking = ranked_of(record, threads)
        ranking.ranked(ranking.nominal())
        counts.append(ranking.simulations)
    assert counts[0] == counts[1]


def test_errors_far_too_large_make_a_table_suspicious():
    fit = SimpleNamespace(objective=2.0, nu=np.zeros(3), normal=SimpleNamespace(chi2=np.array(2.0)))
    runs = [SimpleNamespace(has_signals=False)]
    forward = SimpleNamespace(experiment=SimpleNamespace(runs=runs, size=lambda _: 24))
    model = judged.Model(None, forward, fit)
    assert judged.suspicious(model)
    runs[0].has_signals = True
    assert not judged.suspicious(model)


def test_gauges_swapped_in_a_table_take_their_amplitudes_along():
    record = changes.gauges_swapped(chain(), "g4", "wall")
    assert [o.sensor for o in record.block.runs[0].observables[:3]] == ["wall", "g7", "g4"]
    assert record.block.runs[0].observables[3].from_ == "g4"
