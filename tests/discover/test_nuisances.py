"""Nuisances: columns against finite differences, closed forms of what is marginalised, exact means exact."""

import math

import msgspec
import numpy as np
import pytest
from made_records import block, made

from sonicvacuum.discover import session, verdict
from sonicvacuum.discover.faults import changes
from sonicvacuum.discover.fit import unequal
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.nuisances import SCATTER, Layout, Shared, assumed, exact
from sonicvacuum.discover.model.problem import experiment, together
from sonicvacuum.discover.model.scatter import DIRECTIONS
from sonicvacuum.discover.model.slow import columns
from sonicvacuum.discover.search import directions, screen
from sonicvacuum.discover.search.singles import setup_of
from sonicvacuum.files import InputError
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.reader import parse

TOLERANCES = {
    "bead_mass_rel": 0.01,
    "bead_diameter_rel": 0.005,
    "striker_mass_rel": 0.01,
    "speed_common_rel": 0.02,
    "gain_common_rel": 0.03,
}


def with_keys(record: Record, sensors=None, materials=None, **keys) -> Record:
    """The record with other errors: `sensors` go to every gauge, `materials` are added."""
    content = block([r.striker.speed_m_s for r in record.block.runs])
    content["sensors"] = [{**s, **(sensors or {})} for s in content["sensors"]]
    content["materials"] |= materials or {}
    return Record(parse({**content, **keys}), record.signals, "other")


@pytest.fixture(scope="module")
def quiet():
    """A record of the nominal model, nuisances at zero, its noise left out."""
    return made(noise=0.0)[0]


def test_every_column_is_the_slope_of_the_predictions(quiet):
    open_ = with_keys(
        quiet,
        sensors={"delay_sigma_us": 0.4},
        materials={"stainless-steel": {"modulus_rel_sigma": 0.1}, "alumina": {"modulus_rel_sigma": 0.1}},
        tolerances=TOLERANCES,
        clock_rel_sigma=1e-4,
    )
    forward = Forward(experiment(open_))
    kinds = [one.kind for one in forward.layout.others]
    assert kinds.count("modulus") == 2 and kinds.count("delay") == 3 and len(kinds) == 11 + DIRECTIONS
    at = 0.3 * np.ones((1, forward.layout.size))
    found = forward.columns(Hypothesis(), np.zeros((1, 0)), at, precise=True)
    step, (mass,) = 1e-3, forward.layout.other("bead-mass")
    around = np.concatenate([at + step * np.eye(at.size), at - step * np.eye(at.size)])
    values = forward.sampled(Hypothesis(), np.zeros((len(around), 0)), around)
    for run, value in enumerate(values):
        slopes = (value[: at.size] - value[at.size :]) / (2.0 * step)
        for column, place in enumerate(forward.layout.local(run)):
            error = np.linalg.norm(found[run][0, 1 + column] - slopes[place])
            # The clock and delays move readings by interpolation of degree 5, whose slopes are good to 1 %.
            # Beads that differ make up for one another: steps are for what they change together.
            single = place in forward.layout.other(SCATTER)
            whole = np.linalg.norm(slopes[mass if single else place])
            assert error < (0.03 if single else 0.01) * whole + 1e-6, (run, place)


def test_what_is_exact_has_no_column_and_changes_nothing(quiet):
    exact = with_keys(quiet, tolerances=dict.fromkeys(TOLERANCES, 0.0), clock_rel_sigma=0.0)
    assert experiment(exact).shared == () == experiment(with_keys(quiet)).shared
    known = with_keys(quiet, materials={"parylene-c": {"modulus_rel_sigma": 0.0}})
    forward = Forward(experiment(known))
    assert forward.nuisance_sigma[forward.layout.modulus] == 0.0
    one = forward.columns(Hypothesis(), np.zeros((1, 0)), np.zeros((1, forward.layout.size)))[0]
    assert not np.any(one[0, 1])


def test_places_of_shared_and_local_ones_agree():
    layout = Layout(3, 2, (Shared("bead-mass", 0.01), Shared("clock", 1e-4), Shared("delay", 1e-6, "g", 1)))
    assert layout.size == 2 * 3 + 2 + 1 + 3
    np.testing.assert_array_equal(np.delete(layout.local(1), [1, 2]), layout.shared)
    assert sorted({int(k) for run in range(3) for k in layout.local(run)}) == list(range(layout.size))
    assert layout.simulated == [layout.modulus, layout.other("bead-mass")[0]]


def test_a_baseline_and_a_drift_weigh_as_their_covariance_says():
    errors = {"baseline_sigma_N": 0.05, "drift_sigma_N": 0.1}
    e = experiment(with_keys(made()[0], sensors=errors))
    assert not np.any(e.correlation)
    rng = np.random.default_rng(np.random.SeedSequence(4))
    trace = rng.normal(size=len(e.runs[0].time))
    alone = np.zeros((1, len(e.gauges), len(trace)))
    alone[0, 0] = trace
    part = columns(e.runs[0].time, 0.05, 0.1)
    covariance = e.sigma[0] ** 2 * np.eye(len(trace)) + part @ part.T
    white = e.whiten(0, alone, np.zeros((1, 0)))[0]
    assert white @ white == pytest.approx(trace @ np.linalg.solve(covariance, trace), rel=1e-9)


def test_drift_begins_at_zero_and_ends_as_stated():
    part = columns(np.linspace(0.0, 1.0, 200), 0.0, 2.0)
    variance = np.square(part).sum(axis=1)
    assert variance[0] == pytest.approx(0.0, abs=1e-20)
    # Four terms of the series hold 95 % of the variance at the end: Σ 2/((k − ½) π)² = 0.95.
    assert variance[-1] == pytest.approx(4.0, rel=0.06)


def test_heavier_beads_are_no_misfit_where_their_tolerance_allows():
    heavier = [("mass", bead, 1.03) for bead in range(1, 11)]
    record, _ = made(departures=heavier, noise=1.0, seed=5)
    sharp = {"parylene-c": {"modulus_rel_sigma": 0.001}}
    exact, open_ = (
        nominal(Forward(experiment(with_keys(record, materials=sharp, tolerances={"bead_mass_rel": sigma}))))
        for sigma in (0.0, 0.03)
    )
    data = 2 * 3 * 700
    # A χ² of 4200 data has the standard deviation 92.
    assert exact.objective > data + 5 * 92 and open_.objective < data + 3 * 92


def test_beads_that_differ_within_their_tolerance_are_no_misfit():
    """One bead lighter, the next heavier: what all beads have in common does not make up for that."""
    rng = np.random.default_rng(np.random.SeedSequence(9))
    ratios = np.exp(0.02 * rng.normal(size=10))
    unequal = [("mass", bead, float(ratio)) for bead, ratio in enumerate(ratios, start=1)]
    record, _ = made(departures=unequal, noise=1.0, seed=5)
    exact, open_ = (
        nominal(Forward(experiment(with_keys(record, tolerances={"bead_mass_rel": sigma}))))
        for sigma in (0.0, 0.02)
    )
    data = 2 * 3 * 700
    assert exact.objective > data + 5 * 92 and open_.objective < data + 3 * 92


def test_directions_that_data_do_not_show_are_empty(empty):
    """Errors of masses ten times smaller show in fewer directions, and the rest adds little to chi2."""

    def shown(sigma):
        data = experiment(with_keys(empty, tolerances={"bead_mass_rel": sigma}))
        return sum(any(one.weights) for one in data.shared if one.kind == SCATTER)

    assert shown(0.03) > shown(0.003) > shown(0.00003) == 0


def test_beads_that_differ_are_followed_to_a_lower_minimum():
    """A fit from beads that weigh alike ends 17 above one from draws about them; the same in any order."""
    rng = np.random.default_rng(np.random.SeedSequence(9))
    unequal_ = [("mass", bead, float(np.exp(0.02 * rng.normal()))) for bead in range(1, 11)]
    record, _ = made(departures=unequal_, noise=0.2, seed=5)
    forward, exact = (
        Forward(experiment(with_keys(record, tolerances={"bead_mass_rel": sigma}))) for sigma in (0.02, 0.0)
    )
    start = np.zeros((1, forward.layout.size))
    one = fit(forward, Hypothesis(), np.zeros((1, 0)), start)
    found = [unequal.lower(forward, one) for _ in range(2)]
    assert found[0].objective < one.objective - 10.0
    np.testing.assert_array_equal(found[0].nu, found[1].nu)
    alike = fit(exact, Hypothesis(), np.zeros((1, 0)), np.zeros((1, exact.layout.size)))
    assert unequal.lower(exact, alike) is alike


def test_single_beads_differ_in_as_many_directions_in_any_record(empty):
    """None of them moves all beads alike; where masses are exact there are none."""
    open_ = experiment(with_keys(empty, tolerances={"bead_mass_rel": 0.003}))
    weights = np.array([one.weights for one in open_.shared if one.kind == SCATTER])
    assert weights.shape == (DIRECTIONS, 10)
    shown = int(weights.any(axis=1).sum())
    assert 4 <= shown <= 9  # these data show half of the contrasts of ten beads, or more
    np.testing.assert_allclose(weights @ weights.T, np.diag(np.arange(DIRECTIONS) < shown), atol=1e-9)
    np.testing.assert_allclose(weights.sum(axis=1), 0.0, atol=1e-9)
    assert not any(one.kind == SCATTER for one in experiment(empty).shared)
    # What all beads have in common is told, patterns of many that nobody could weigh are not; those that the
    # data do not show take no simulation: modulus, mass of all, speed remain.
    forward = Forward(open_)
    assert len(forward.slopes.simulated) == 3 + shown
    assert len(forward.layout.empty) == DIRECTIONS - shown
    assert set(verdict.nuisances(forward, nominal(forward))) == {"bead-mass"}


def test_speeds_that_are_high_together_are_no_striker_error_where_that_may_be():
    record, _ = made([("striker-error", {"speed_ratio": 1.048, "mass_ratio": 1.0})], seed=6)

    def score(tolerances):
        forward = Forward(experiment(with_keys(record, tolerances=tolerances)))
        fit = nominal(forward)
        seen = screen.screen(forward, fit, directions.catalogue(setup_of(forward), ()))
        names = [(d.effect, d.strength) for d in seen.directions]
        return abs(seen.z[names.index(("striker-error", "speed_ratio"))]), forward, fit

    alone, _, _ = score({})
    together, forward, fit = score({"speed_common_rel": 0.02})
    place = forward.layout.other("speed-common")[0]
    assert together < 0.6 * alone
    assert fit.nu[place] * forward.nuisance_sigma[place] == pytest.approx(math.log(1.048), abs=0.02)


def delayed(record: Record, shifts) -> Record:
    """The record with the time zero of each run moved, in µs, and unknown."""
    content = block([r.striker.speed_m_s for r in record.block.runs])
    moved = {
        r: Signals(s.time_us + shift, s.readings)
        for (r, s), shift in zip(record.signals.items(), shifts, strict=True)
    }
    return Record(parse({**content, "trigger_sigma_us": "unknown"}), moved, "free")


def test_a_time_zero_that_nobody_knows_is_found():
    record, _ = made(noise=0.0, seed=8)
    shifts = (-83.4, 212.7)
    e = experiment(delayed(record, shifts))
    known = nominal(Forward(experiment(record)))
    forward = Forward(e)
    free = nominal(forward)
    found = [
        1e6 * (r.shift + free.nu[forward.layout.trigger(k)] * e.trigger_sigma) for k, r in enumerate(e.runs)
    ]
    np.testing.assert_allclose([1e6 * r.shift for r in e.runs], shifts, atol=2.0)  # two samples
    np.testing.assert_allclose(found, shifts, atol=0.5)  # what noise and interpolation leave
    assert free.objective < known.objective + 10.0


@pytest.mark.parametrize("late", [{}, {"delay_sigma_us": 3.0}])
def test_no_more_is_simulated_than_is_read(late):
    """A time zero that nobody knows asks for long chains only until it is found."""
    sensors = [{**sensor, **late} for sensor in block([0.3])["sensors"]]
    record, _ = made(seed=8, sensors=sensors)
    content = block([r.striker.speed_m_s for r in record.block.runs], sensors=sensors)
    free = Record(parse({**content, "trigger_sigma_us": "unknown"}), record.signals, "free")

    class Whole(Forward):
        def _lasting(self, batch, nu):
            return batch.first_s

    class Told(Forward):
        def simulate(self, batch, setup, duration=None):
            lasted.append(duration / batch.first_s)
            return super().simulate(batch, setup, duration)

    lasted, e = [], experiment(free)
    forward = Told(e)
    random = np.random.default_rng(np.random.SeedSequence(5))
    nu = random.standard_normal((6, forward.layout.size))
    u = np.zeros((6, 0))
    for own, whole in zip(
        forward.sampled(Hypothesis(), u, nu), Whole(e).sampled(Hypothesis(), u, nu), strict=True
    ):
        # In standard errors of single samples; chains are dealt to lanes otherwise, which is rounding.
        np.testing.assert_allclose(own, whole, rtol=0.0, atol=1e-6)
    assert max(lasted) < 0.9
    # Where time zero lies far before the trace there is no end to what is read but that of the simulation.
    far = np.zeros((1, forward.layout.size))
    far[0, forward.layout.trigger(0)] = -1e3
    forward.sampled(Hypothesis(), u[:1], far)
    assert lasted[-1] == 1.0


def test_the_speed_may_be_known_to_a_third_only():
    record, _ = made([("striker-error", {"speed_ratio": 1.25, "mass_ratio": 1.0})], seed=9)
    content = block([r.striker.speed_m_s for r in record.block.runs])
    for run in content["runs"]:
        run["striker"]["speed_rel_sigma"] = 0.3
    free = nominal(Forward(experiment(Record(parse(content), record.signals, "free"))))
    data = 2 * 3 * 700
    assert free.settled and free.objective < data + 3 * 92  # three standard deviations of χ²
    # The speeds were drawn with 1 %; gains and modulus leave them open by about as much.
    np.testing.assert_allclose(np.exp(0.3 * free.nu[:2]), 1.25, rtol=0.04)


def test_priors_of_the_record_reach_the_search(quiet):
    stated = experiment(with_keys(quiet, priors={"coating-thickness": 10.0, "tsuji": 0}))
    assert stated.prior_odds == {"coating-thickness": 10.0, "tsuji": 0.0}
    assert stated.excluded == ("tsuji",)
    setup = setup_of(Forward(stated))
    asked = {e.id for e in setup.catalogue.candidates(setup, stated.excluded)}
    assert "tsuji" not in asked
    assert "kuwabara-kono" in asked
    with pytest.raises(InputError, match=r"/record.yaml: priors\.gremlins: is 2: no such effect"):
        experiment(with_keys(quiet, priors={"gremlins": 2.0}))


def test_what_counts_as_exact_is_said(empty):
    bodies = "the beads' mass, the beads' diameter, the striker's mass"
    assert exact(empty, experiment(empty).shared) == f"{bodies}: taken as exact, no tolerance being stated"
    some = with_keys(empty, tolerances={"bead_mass_rel": 0.002, "bead_diameter_rel": 0.0005})
    words = exact(some, experiment(some).shared)
    assert words == "the striker's mass: taken as exact, no tolerance being stated"
    assert exact(some, experiment(with_keys(empty, tolerances=TOLERANCES)).shared) == ""


def test_what_is_taken_of_moduli_is_said(empty):
    chains = [batch.chain for batch in experiment(empty).batches]
    taken = "errors of moduli taken so, none being stated"
    assert assumed(empty, chains) == f"alumina 5 %, stainless-steel 1 %: {taken}"
    given = {name: {"modulus_rel_sigma": 0.02} for name in ("alumina", "stainless-steel")}
    assert (
        assumed(with_keys(empty, materials={"alumina": given["alumina"]}), chains)
        == f"stainless-steel 1 %: {taken}"
    )
    assert assumed(with_keys(empty, materials=given), chains) == ""
    steel = wall_of(empty, "stainless-steel", {"modulus_rel_sigma": 0.0}, "bearing-steel")
    unstated = msgspec.structs.replace(steel.block, materials={})
    assert "bearing-steel 5 %" in assumed(
        Record(unstated, empty.signals, "other"), [experiment(steel).batches[0].chain]
    )


def test_a_static_force_has_an_error_where_there_is_one(empty):
    chain = {**block((0.3, 0.9))["chain"], "static_force_N": 2.0}
    pressed = Record(parse({**block((0.3, 0.9)), "chain": chain}), empty.signals, "pressed")
    kinds = {one.kind: one.sigma for one in experiment(pressed).shared}
    assert kinds["static-force"] == 0.02
    assert "static-force" not in {one.kind for one in experiment(empty).shared}
    assert "static force 2 %" in assumed(pressed, [b.chain for b in experiment(pressed).batches])
    known = with_keys(pressed, tolerances={"static_force_rel": 0.0})
    assert "static-force" not in {one.kind for one in experiment(known).shared}
    assert "static force" not in assumed(known, [b.chain for b in experiment(known).batches])


def test_materials_of_all_strikers_are_open_in_an_order_of_their_own():
    """Where runs are exchanged their strikers are; what a slip is weighed in must stay as it is."""
    given = block((0.3, 0.6, 0.9))
    for run, material in zip(given["runs"], ("ptfe", "nylon", "delrin"), strict=True):
        run["striker"] = {**run["striker"], "material": material}
    record, _ = made(seed=5, given=given)
    names = [one.of for one in experiment(record).shared if one.kind == "modulus"]
    assert names == ["delrin", "nylon", "ptfe"]
    turned = changes.runs_swapped(record, "v0", "v2")
    assert [one.of for one in experiment(turned).shared if one.kind == "modulus"] == names
    assert session.discover(turned).verdict.faults[0].fault == "runs-swapped"


def wall_of(record: Record, name: str, given: dict | None, bead: str = "brass") -> Record:
    """The record with solid beads of `bead` on a wall of a material, of which `given` is stated."""
    content = block([r.striker.speed_m_s for r in record.block.runs])
    solid = {k: v for k, v in content["chain"]["bead"].items() if k not in ("coating_um", "core")}
    content["chain"] |= {"bead": solid | {"material": bead}, "wall": {"material": name}}
    content["materials"] = {bead: {"modulus_rel_sigma": 0.05}} | ({name: given} if given else {})
    return Record(parse(content), record.signals, "other")


@pytest.mark.parametrize(
    ("name", "given", "error"),
    [
        ("stainless-steel", None, 0.01),  # 20 samples within 1 %, see materials.py
        ("stainless-steel", {"modulus_GPa": 193.0}, 0.01),  # key by key: the error stays the table's
        ("tool-steel", {"modulus_GPa": 207.0, "poisson": 0.3}, 0.01),
        ("glass", None, 0.05),
        ("plate", {"modulus_GPa": 207.0, "poisson": 0.3}, 0.05),
        ("stainless-steel", {"modulus_rel_sigma": 0.1}, 0.1),
    ],
)
def test_a_wall_is_as_well_known_as_its_material(quiet, name, given, error):
    moduli = {o.of: o.sigma for o in experiment(wall_of(quiet, name, given)).shared if o.kind == "modulus"}
    assert moduli[name] == error


def test_beads_without_a_stated_error_are_known_to_a_twentieth_whatever_they_are_made_of(quiet):
    content = wall_of(quiet, "glass", None, "stainless-steel").block
    unstated = msgspec.structs.replace(content, materials={})
    assert experiment(Record(unstated, quiet.signals, "other")).modulus_rel_sigma == 0.05


def test_so_are_beads_of_every_material_of_a_pattern(quiet):
    given = block((0.3, 0.9))
    bead = given["chain"].pop("bead")
    given["chain"]["pattern"] = [{**bead, "material": name} for name in ("delrin", "stainless-steel")]
    record = Record(parse({**given, "materials": {}}), quiet.signals, "dimer")
    assert (
        record.taken_modulus_rel_sigma("delrin") == record.taken_modulus_rel_sigma("stainless-steel") == 0.05
    )
    assert record.taken_modulus_rel_sigma("bearing-steel") == 0.01


def test_a_static_force_of_any_record_of_several_is_open():
    records = []
    for force in (0.0, 2.0):
        given = block((0.3, 0.9))
        given["chain"]["static_force_N"] = force
        records.append(made(seed=7, given=given)[0])
    for order in (records, records[::-1]):
        assert [one.kind for one in together(order).shared] == ["static-force"]
