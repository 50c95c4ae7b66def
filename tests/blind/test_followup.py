"""One more run: what is made is what discover imagines, in the laboratory of the record."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from case_files import put
from click.testing import CliRunner

from sonicvacuum import records
from sonicvacuum.cli import cli
from sonicvacuum.discover.imagined import changes, changes_of_two
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.files import InputError
from sonicvacuum.laboratory.specimen import GRAVITY
from sonicvacuum_blind import followup, study
from sonicvacuum_blind.followup import ambiguous, follow, offers, random_change, under
from sonicvacuum_blind.foretold import foretold, summary
from sonicvacuum_blind.hide import TOLERANCE, Spec, hide, laboratory
from sonicvacuum_blind.prediction import predict
from sonicvacuum_blind.score import SummaryLine, read_table

SPEC = Spec("a", "single", "one-speed", "white", ("sensor-gain",), 10.0, 5, 40)
SCALARS = Spec("s", "null", "scalars", "white", (), 0.0, 5, 41)


@pytest.fixture(scope="module")
def own():
    """The laboratory of `SPEC`."""
    return laboratory(SPEC)


@pytest.fixture(scope="module")
def imagined():
    """[(change, experiment)] of everything that discover could propose on the record of `SPEC`."""
    return list(changes(experiment(hide(SPEC)[0])))


def test_the_same_changes_are_offered(own, imagined):
    def ordered(found):
        return sorted((k, v) for change in found for k, v in change.items())

    ours, theirs = ordered(offers(own.design)), ordered(change for change, _ in imagined)
    assert [k for k, _ in ours] == [k for k, _ in theirs]
    for (_, one), (_, other) in zip(ours, theirs, strict=True):
        assert one == (other if isinstance(other, str) else pytest.approx(other, rel=1e-9))  # units converted


def test_what_is_made_is_what_is_imagined(own, imagined):
    assert {key.split(".")[0] for change, _ in imagined for key in change} == {"striker", "chain", "sensors"}
    of_two = list(changes_of_two(experiment(hide(SPEC)[0])))
    assert all(len(change) == 2 for change, _ in of_two)
    for change, wanted in [*imagined, *of_two[::6]]:
        made = experiment(follow(SPEC, own, change))
        (run,), (batch,) = made.runs, made.batches
        # Values are proposed to four decimals, of which speeds of 0.02 m/s and more keep 0.3 %.
        for name in ("speed", "striker_mass", "static_force", "gravity"):
            one, other = getattr(batch.chain, name), getattr(wanted.batches[0].chain, name)
            assert one == pytest.approx(other, rel=3e-3), change
        # The length follows from the rounded speed: a sample at most.
        assert len(run.time) == pytest.approx(len(wanted.runs[0].time), abs=1), change
        assert run.interval == pytest.approx(wanted.runs[0].interval, rel=1e-9)
        assert run.time[0] == pytest.approx(wanted.runs[0].time[0], abs=1e-15)  # rounding of 1e-4 s
        assert [(g.id, g.bead) for g in made.gauges] == [(g.id, g.bead) for g in wanted.gauges]
        np.testing.assert_allclose(made.gain_rel_sigma, wanted.gain_rel_sigma)
        assert made.modulus_rel_sigma == wanted.modulus_rel_sigma


def test_gain_modulus_and_what_is_hidden_stay(own):
    """Without noise and errors of speed and trigger, a run at the record's speed repeats the record."""
    silent = replace(
        own.design,
        sigma=tuple(1e-12 * s for s in own.design.sigma),
        speed_sigma=0.0,
        trigger_sigma=0.0,
    )
    quiet = replace(own, case=replace(own.case, frame=replace(own.case.frame, design=silent)))
    again = follow(SPEC, quiet, {"striker.speed_m_s": own.design.runs[-1].speed}).signals["r1"].readings
    first = predict(silent, own.case.change, own.errors, TOLERANCE).traces[0]
    nominal = predict(silent).traces[0]
    for k, gauge in enumerate(own.design.reference.gauges):
        peak = first[k].max()
        # Noise at 1e-12 of the stated one, a hundredth of the peak.
        np.testing.assert_allclose(again[gauge.id], first[k], atol=1e-9 * peak)
        assert np.abs(again[gauge.id] - nominal[k]).max() > 1e-3 * peak


def test_speed_trigger_and_noise_are_fresh(own):
    first = hide(SPEC)[0].signals["r1"].readings
    again = follow(SPEC, own, {"striker.speed_m_s": own.design.runs[-1].speed}).signals["r1"].readings
    for k, gauge in enumerate(own.design.reference.gauges):
        early = slice(0, own.design.samples // 20)  # before the wave arrives: noise alone
        difference = again[gauge.id][early] - first[gauge.id][early]
        # Independent noise has twice the variance; 4 standard errors of that of 24 samples.
        assert np.mean(difference**2) / own.design.sigma[k] ** 2 == pytest.approx(
            2.0, abs=8.0 * math.sqrt(2.0 / len(difference))
        )


def test_the_same_case_gives_the_same_run(own):
    change = random_change(SPEC, own.design)
    assert change == random_change(SPEC, laboratory(SPEC).design)
    assert change in offers(own.design)
    one, other = (follow(SPEC, lab, change).signals["r1"] for lab in (own, laboratory(SPEC)))
    assert all(np.array_equal(one.readings[g], other.readings[g]) for g in one.readings)


def test_random_changes_are_spread_over_the_offers(own):
    specs = [Spec("x", "null", "one-speed", "white", (), 0.0, 5, k) for k in range(200)]
    drawn = [offers(own.design).index(random_change(s, own.design)) for s in specs]
    count = np.bincount(drawn, minlength=len(offers(own.design)))
    mean = len(specs) / len(count)
    # χ² with n − 1 degrees of freedom stays below its mean by 4 standard deviations with fixed seeds.
    assert np.sum((count - mean) ** 2 / mean) < len(count) - 1 + 4.0 * math.sqrt(2.0 * len(count))


@pytest.mark.parametrize(("density", "offered"), [(7800.0, [0.25]), (3900.0, [0.25, 4.0]), (1150.0, [4.0])])
def test_a_ball_is_not_replaced_by_one_that_no_solid_makes(own, density, offered):
    ball = replace(own.design.runs[-1], striker_radius=2e-3)
    ball = replace(ball, striker_mass=density * 4.0 / 3.0 * math.pi * ball.striker_radius**3)
    made = replace(own.design, runs=(ball,))
    masses = [c["striker.mass_g"] for c in offers(made) if "striker.mass_g" in c]
    assert masses == [pytest.approx(f * ball.striker_mass * 1e3, rel=1e-3) for f in offered]  # four decimals
    for mass in masses:
        under(made, {"striker.mass_g": mass})


def test_slow_pulses_are_watched_for_longer(own):
    last = own.design.runs[-1]
    slow = under(own.design, {"striker.speed_m_s": last.speed / 32.0})
    assert slow.samples == pytest.approx(2 * own.design.samples, abs=1)  # 32^{1/5} = 2, cut to a whole number
    assert under(own.design, {"striker.speed_m_s": last.speed * 3.0}).samples == own.design.samples


def test_each_quantity_is_changed(own):
    last = own.design.runs[-1]
    assert under(own.design, {"striker.mass_g": 2.5}).runs[0].striker_mass == pytest.approx(2.5e-3)
    assert under(own.design, {"chain.static_force_N": 3.0}).runs[0].static_force == 3.0
    turned = "horizontal" if last.gravity else "vertical"
    assert under(own.design, {"chain.orientation": turned}).runs[0].gravity == GRAVITY - last.gravity
    moved = under(own.design, {"sensors.g1.bead": 2}).runs[0].gauges
    assert [g.bead for g in moved] == [2, *(g.bead for g in last.gauges[1:])]


@pytest.mark.parametrize(
    "change",
    [{}, {"striker.colour": 1.0}, {"sensors.g9.bead": 2}, {"chain.orientation": "inclined"}],
    ids=str,
)
def test_other_changes_are_refused(own, change):
    with pytest.raises(ValueError, match="change"):
        under(own.design, change)


def test_records_without_traces_have_no_further_run():
    made = laboratory(SCALARS).design
    assert offers(made) == []
    with pytest.raises(ValueError, match="without traces"):
        random_change(SCALARS, made)
    with pytest.raises(ValueError, match="with traces"):
        under(made, {"striker.speed_m_s": 1.0})


def verdict(named=("sensor-gain",), left=("sensor-gain", "tsuji"), change=None):
    proposal = {"change": change or {"striker.speed_m_s": 1.0}, "delta_chi2": 50.0}
    return {"named": list(named), "confusable": [list(left)] if left else [], "next_experiment": proposal}


def test_ambiguous_cases():
    assert ambiguous(SPEC, verdict())
    assert ambiguous(SPEC, verdict(["tsuji"], ["tsuji", "sensor-gain"]))
    assert not ambiguous(SPEC, verdict(["tsuji"], ["tsuji", "gravity"]))
    assert not ambiguous(SPEC, verdict(left=()))
    assert not ambiguous(SPEC, verdict(["unknown"]))
    assert not ambiguous(SPEC, verdict(["sensor-gain", "tsuji"]))
    assert not ambiguous(SPEC, verdict() | {"next_experiment": None})
    assert not ambiguous(SCALARS, verdict())


def test_command_makes_the_runs_of_ambiguous_cases(tmp_path):
    study.write_cases([SPEC, SCALARS], tmp_path / "cases.csv")
    given = {"a": verdict(change={"striker.mass_g": 2.5}), "s": verdict([], ())}
    for id, content in given.items():
        (tmp_path / "verdicts" / id).mkdir(parents=True)
        (tmp_path / "verdicts" / id / "verdict.json").write_text(json.dumps(content))
    call = ["blind", "follow", "--cases", "cases.csv", "--verdicts", "verdicts", "--choice", "proposed"]
    call = [str(tmp_path / c) if c in ("cases.csv", "verdicts") else c for c in call]
    done = CliRunner().invoke(cli, [*call, "--records", str(tmp_path / "out")], catch_exceptions=False)
    assert done.output.split() == ["a"]
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["a"]
    assert records.read(tmp_path / "out" / "a").runs[0].striker.mass_kg == pytest.approx(2.5e-3)
    told = json.loads((tmp_path / "out" / "a" / followup.FILE).read_text())
    assert told == {"choice": "proposed", "change": {"striker.mass_g": 2.5}}
    (tmp_path / "verdicts" / "s" / "verdict.json").unlink()
    refused = CliRunner().invoke(cli, [*call, "--records", str(tmp_path / "out")])
    assert isinstance(refused.exception, InputError)
    assert "no verdict for 1 of 2 cases, first s" in str(refused.exception)


def test_fresh_runs_are_held_against_both_models(tmp_path):
    """Two runs whose gaps of 0.5 and 0.3 shrink to 0.1 each: three quarters of them are closed."""
    for id, before in (("a", 1.5), ("b", 1.3)):
        for name, content in (
            ("truth/truth", {"kind": "single", "effects": ["tsuji"], "d_prime": 10.0}),
            ("found/verdict", {"named": ["tsuji"]}),
            ("fresh/compared", {"data": 100, "gap": {"before": before, "after": 1.1}}),
        ):
            folder, stem = name.split("/")
            (tmp_path / folder / id).mkdir(parents=True)
            (tmp_path / folder / id / f"{stem}.json").write_text(json.dumps(content))
    call = ["blind", "foretold", "--out", "rows.csv", "--summary", "fresh.csv"]
    for option, folder in (("truth", "truth"), ("verdicts", "found"), ("compared", "fresh")):
        call += [f"--{option}", str(tmp_path / folder)]
    call = [str(tmp_path / part) if part.endswith(".csv") else part for part in call]
    done = CliRunner().invoke(cli, call, catch_exceptions=False)
    assert done.exit_code == 0
    lines = {one.group: one for one in read_table(SummaryLine, tmp_path / "fresh.csv")}
    assert lines["single, gaps added up"].value == pytest.approx(0.75)
    assert lines["single, model found, names exact, median"].value == pytest.approx(1.1)
    with pytest.raises(InputError, match="is empty"):
        foretold(tmp_path / "truth", tmp_path / "found", tmp_path / "truth")


def test_an_effect_beside_one_from_outside_has_lines_of_its_own(tmp_path):
    for id, named in (("a", ["tsuji", "unknown"]), ("b", ["tsuji"])):
        put(
            tmp_path / "truth",
            id,
            "truth.json",
            {"kind": "beside", "effects": ["tsuji", "dimer"], "d_prime": 20},
        )
        put(tmp_path / "found", id, "verdict.json", {"named": named})
        put(tmp_path / "fresh", id, "compared.json", {"data": 100, "gap": {"before": 1.5, "after": 1.1}})
    lines = {
        one.group: one for one in summary(foretold(*(tmp_path / n for n in ("truth", "found", "fresh"))))
    }
    assert lines["beside, gaps added up"].value == pytest.approx(0.8)
    assert lines["beside, model found, names exact, median"].count == 1


def test_laws_of_no_particular_form_are_told_with_what_they_close(tmp_path):
    """Three records: a law kept that closes nine tenths, one that closes half, and none."""
    near = [{"effect": "tsuji", "distance": 0.2}, {"effect": "linear-dashpot", "distance": 0.31}]
    for id, after, law in (("a", 2.0, True), ("b", 6.0, True), ("c", 11.0, False)):
        told = {"named": ["unknown"]} | ({"law": {"nearest": near}} if law else {})
        for name, content in (
            ("truth/truth", {"kind": "foreign", "effects": ["depth-damping"], "d_prime": 30.0}),
            ("found/verdict", told),
            ("fresh/compared", {"data": 100, "gap": {"before": 11.0, "after": after}}),
        ):
            folder, stem = name.split("/")
            (tmp_path / folder / id).mkdir(parents=True)
            (tmp_path / folder / id / f"{stem}.json").write_text(json.dumps(content))
    rows = foretold(tmp_path / "truth", tmp_path / "found", tmp_path / "fresh")
    assert [r.law for r in rows] == [1, 1, 0]
    assert rows[0].nearest == "tsuji 0.20 linear-dashpot 0.31"
    lines = {(one.measure, one.group): one.value for one in summary(rows)}
    assert lines["free law kept", "foreign"] == pytest.approx(2 / 3)
    closed = "gap closed on fresh runs"
    assert lines[closed, "foreign, free law, gaps added up"] == pytest.approx(0.7)
    assert lines[closed, "foreign, depth-damping, median"] == pytest.approx(0.5)
