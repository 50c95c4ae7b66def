"""The free-form contact law: closes gaps that no name explains, on runs it has not seen, and nothing else."""

import pickle
from dataclasses import replace

import deep_damping
import numpy as np
import pytest
from made_records import made
from msgspec import structs

from sonicvacuum.discover import law as telling
from sonicvacuum.discover import policy, verdict
from sonicvacuum.discover.compare import compare, read_model
from sonicvacuum.discover.fit import reach as far
from sonicvacuum.discover.fit.reach import reach
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.judge.law import formula, surface
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.free_law import of_some
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search import free_law as module
from sonicvacuum.discover.search.free_law import free_law
from sonicvacuum.effects import CATALOGUE, Setup
from sonicvacuum.effects.free_form import held_force
from sonicvacuum.figures import force_law
from sonicvacuum.figures.drawing import Curve, Text
from sonicvacuum.physics.run import simulate
from sonicvacuum.records.blocks import TolerancesBlock
from sonicvacuum.tables import read_csv

SPEEDS = 0.3, 0.5, 0.9  # m/s
DAMPING = 2e5  # kg/(s m): the law outside the catalogue is F = K δ^1.5 + b δ v


def hidden(seed, speeds):
    own = CATALOGUE.extended([deep_damping.EFFECT])
    return made([("deep-damping", {"damping_kg_s_m": DAMPING})], seed=seed, speeds=speeds, catalogue=own)[0]


@pytest.fixture(scope="module")
def found():
    forward = Forward(experiment(hidden(3, SPEEDS)))
    return free_law(forward, nominal(forward))


def model_of(parameters):
    return verdict.Model(
        record="made",
        effects={"free-form": parameters},
        speed_ratio={},
        trigger_us={},
        gain={},
        modulus_ratio=1.0,
    )


def test_it_closes_the_gap_on_runs_it_has_not_seen(found, tmp_path):
    size = sum(found.forward.experiment.size(k) for k in range(3))
    left, before = found.held_out.sum() - size, found.held_out_before.sum() - size
    assert left < 0.2 * before  # what is asked of it; about 1 % is left
    verdict.write_json(model_of(found.parameters), tmp_path / "model.json")
    score = compare(read_model(tmp_path / "model.json"), hidden(9, (0.4, 0.8)))
    assert score.gap.closed > 0.8
    assert not score.warnings


def test_it_is_held_beyond_the_data_it_was_fitted_to(found):
    """A polynomial may take all of a force away, or double it, where nothing was measured."""
    depth, rate = found.reach.depth, found.reach.rate
    end = found.component.effect.apply(
        Setup(experiment(hidden(3, (0.3,))).batches[0].chain), **found.parameters
    ).chain.actions[-1]
    own = [float(np.ravel(c)[0]) for c in end.table(None, np.ones(1), np.ones(1))[0]]
    assert held_force(4 * depth, 4 * rate, 1.0, *own) == held_force(depth, rate, 1.0, *own)
    assert held_force(0.5 * depth, 4 * rate, 1.0, *own) == held_force(0.5 * depth, rate, 1.0, *own)
    assert held_force(4 * depth, -0.5 * rate, 1.0, *own) == held_force(depth, -0.5 * rate, 1.0, *own)
    assert held_force(0.9 * depth, 0.5 * rate, 1.0, *own) != held_force(depth, 0.5 * rate, 1.0, *own)


def test_reach_is_that_of_the_impact_and_of_the_largest_force(empty):
    """Rates are highest as the striker hits, compressions (integrated rates) go with the largest force."""
    forward = Forward(experiment(empty))
    reached = reach(forward, nominal(forward))
    (batch,) = forward.experiment.batches
    assert reached.rate == pytest.approx(batch.chain.speed.max(), rel=0.05)  # fitted speeds differ by 2 %
    contacts = range(batch.chain.beads + 1)
    forces = simulate(batch.chain, contacts, batch.duration, batch.interval).force.max(axis=0)
    depths = [batch.chain.depth_at(k, f[None]) for k, f in enumerate(forces)]
    assert reached.depth == pytest.approx(np.max(depths), rel=0.05)  # as above


def test_reach_counts_the_compression_at_rest(empty):
    pressed = structs.replace(empty.block.chain, static_force_N=50.0)
    exact = TolerancesBlock(static_force_rel=0.0)  # the nuisances of the record without a load are its own
    loaded = Forward(
        experiment(replace(empty, block=structs.replace(empty.block, chain=pressed, tolerances=exact)))
    )
    forward = Forward(experiment(empty))
    one = nominal(forward)
    chain = loaded.experiment.batches[0].chain
    at_rest = chain.depth_at(0, chain.static_forces(1)[0][None]).max()
    assert reach(loaded, one).depth > max(at_rest, reach(forward, one).depth)


def test_reach_of_a_long_chain_is_seen_in_its_first_contacts_and_the_wall(empty, monkeypatch):
    forward = Forward(experiment(empty))
    one = nominal(forward)
    whole = reach(forward, one)
    monkeypatch.setattr(far, "CONTACTS", 2)
    ((depth, rate),) = far.approaches(forward, one)
    assert depth.shape == rate.shape == (len(depth), 3, len(empty.runs))
    assert reach(forward, one) == whole


def test_a_record_of_faster_impacts_is_told_to_go_beyond_it(found):
    score = compare(model_of(found.parameters), hidden(9, (0.4, 4.0)))
    (line,) = score.warnings
    assert "free-form law" in line
    assert f"{found.reach}" in line


def test_its_surface_is_the_hidden_law_where_contacts_have_been(found):
    seen = surface(found)
    truth = DAMPING * seen.depth[:, None] * seen.rate[None]
    error = np.abs(seen.beside - truth)[seen.visited].max()
    assert error < 0.1 * np.abs(truth[seen.visited]).max()  # five coefficients stand for a power they lack


def test_its_formula_has_the_powers_of_the_hidden_law(found):
    seen = surface(found)
    depth_power, rate_power = (
        float(part.split()[0]) for part in formula(seen).replace("|v/(m/s)|^", "^").split("^")[2:]
    )
    assert depth_power == pytest.approx(1.0, abs=0.3)  # what ten per cent of the surface allow
    assert rate_power == pytest.approx(1.0, abs=0.15)


def test_nothing_is_fitted_to_noise(empty):
    forward = Forward(experiment(empty))
    assert free_law(forward, nominal(forward)) is None


def test_a_law_with_evidence_that_explains_nothing_more_is_none(empty, monkeypatch):
    """Nuisances that are hardly known can be worth evidence alone; a search of slips ended in an error."""
    forward = Forward(experiment(empty))
    base = nominal(forward)
    monkeypatch.setattr(module, "_fitted", lambda *_: (policy.LAW_LOG_BAYES + 1.0, 1.0, base, forward))
    assert free_law(forward, base) is None


def test_off_is_absent():
    (effect,) = CATALOGUE.besides
    chain = experiment(hidden(3, (0.3,))).batches[0].chain
    setup = Setup(chain)
    assert effect.apply(setup, depth_um=1.0, speed_m_s=1.0, force_N=1.0) is setup
    assert effect.id in CATALOGUE
    assert effect.id not in CATALOGUE.ids


def test_runs_that_do_not_count_leave_no_trace(empty):
    whole = experiment(empty)
    first = of_some(whole, [0])
    assert first.size(0) == whole.size(0)
    assert first.size(1) == 0
    assert not np.any(first.whitened(1))


def test_what_is_told_of_it(found):
    told = telling.Law(
        depth_um=[1.0],
        speed_m_s=[0.0],
        force_N=[[1.0]],
        band_N=[[0.1]],
        visited=[[True]],
        nearest=[telling.Near(effect="tsuji", distance=0.3)],
        formula="F = K δ^1.5",
        log10_bayes=20.0,
        closed=0.9,
    )
    (line,) = telling.reasons(told)
    assert "90% of what is left" in line
    assert "tsuji, distance 0.30" in line
    header, rows = telling.rows(surface(found))
    assert len(list(rows)) == 21 * 21
    assert header[0] == "depth_um"


def test_it_is_drawn_where_contacts_have_been(found, tmp_path):
    verdict.write_table(tmp_path / "law.csv", *telling.rows(surface(found)))
    page = force_law.law(read_csv(tmp_path / "law.csv"))
    colours = {stroke.color for stroke in force_law.STROKES}
    lines = [
        m for m in page.marks if isinstance(m, Curve) and m.clip and m.stroke and m.stroke.color in colours
    ]
    seen = surface(found)
    for line in lines[:3]:
        shown = np.isfinite(line.points[:, 1])
        assert any(np.array_equal(shown, column) for column in seen.visited.T)
    assert any("m/s" in m.words for m in page.marks if isinstance(m, Text))
    assert force_law.law([]) is None


def test_the_law_that_is_held_is_the_law_within_its_data(found):
    """Compiled and stepped, far from where it is held: the same numbers but for rounding."""
    chain = experiment(hidden(3, (0.3,))).batches[0].chain
    wide = {"deepest_um": 1e6, "fastest_m_s": 1e6}
    free, held = (
        found.component.effect.apply(Setup(chain), **found.parameters | reach).chain
        for reach in ({"deepest_um": np.inf, "fastest_m_s": np.inf}, wide)
    )
    forces = [simulate(one, (0, 5), 2e-4, 1e-6).force for one in (free, held)]
    assert np.abs(forces[0]).max() > 1.0
    np.testing.assert_allclose(*forces, rtol=0, atol=1e-9)  # N: another kernel rounds otherwise


def test_a_law_that_comes_back_from_a_copy_of_the_process_is_the_same(found):
    """Its term was known by being the same object, which it is in one process only: on two processors the law
    had no strength beside rivals, and names that it beat were others.
    """
    other = pickle.loads(pickle.dumps(found))
    here, there = (
        law.forward.sampled(law.fit.hypothesis, law.fit.u[None], law.fit.nu[None]) for law in (found, other)
    )
    for own, copied in zip(here, there, strict=True):
        np.testing.assert_array_equal(own, copied)
