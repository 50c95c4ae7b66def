"""What the nominal model asks of a record: said where it follows the data by way of stated numbers alone."""

from dataclasses import replace
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
from made_records import block, made

from sonicvacuum.discover import session
from sonicvacuum.discover.fit.normal import Normal
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.judge import strained
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Hypothesis
from sonicvacuum.discover.model.nuisances import SCATTER, Layout, Shared
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.records.blocks import TolerancesBlock


def test_a_gain_that_follows_the_data_far_beyond_its_error_is_said():
    """A gauge that reads 1.5 times as much leaves no misfit; its error, 2 %, is what speaks against that."""
    found = session.discover(made([("sensor-gain", {"gain_ratio": 1.5, "sensor": 0})])[0])
    assert found.verdict.named == ["sensor-gain"]
    (said,) = (r for r in found.verdict.reasons if r.startswith(strained.ONLY_WITH))
    gauge = found.found.forward.experiment.gauges[0]
    assert f"the gain of gauge {gauge.id} 1." in said
    away = float(said.rsplit(",", 1)[1].split()[0])
    # Other gains, speeds and the modulus take over a part of ln 1.5, in units of the gain's error.
    full = np.log(1.5) / found.found.forward.experiment.gain_rel_sigma[0]
    assert 0.5 * full < away < 1.1 * full


@pytest.mark.parametrize(("left", "said"), [(1.0, True), (9.0, False)])
def test_it_is_said_only_where_a_simulation_there_comes_near(monkeypatch, left, said):
    """One number in units of its error, prediction 100 times it, the datum 1000: linear, ten errors away. The
    simulation at ten leaves what it leaves: χ² per datum 1, or 9.
    """
    monkeypatch.setattr(strained, "data", lambda forward: 1)
    monkeypatch.setattr(strained, "_moved", lambda forward, k, nu: f"number {k} at {nu:.3g}")
    forward = SimpleNamespace(
        experiment=SimpleNamespace(record=None),
        layout=Layout(runs=0, gauges=0),
        data=lambda run: np.array([1000.0]),
        sampled=lambda hypothesis, u, nu, places: [100.0 * nu - np.sqrt(left)],
    )
    gradient, hessian = np.full((1, 1, 1), 1e5), np.full((1, 1, 1, 1), 1e4)
    normal = Normal(np.zeros((1, 0)), np.zeros((1, 1)), np.array([[1e6]]), gradient, hessian)
    null = Fit(Hypothesis(), normal)
    rested = SimpleNamespace(nu=np.zeros(1))
    words = [f"{strained.ONLY_WITH} number 0 at 10, 10 of its stated errors away"] if said else []
    # Beside effects that leave it as stated, and where nothing is named.
    assert strained.told(forward, null, rested) == strained.told(forward, null, None) == words


@pytest.mark.parametrize("error", [0.05, None])
def test_an_error_that_the_record_does_not_state_is_not_called_its_own(error):
    """A modulus without one is taken as known to 5 %."""
    given = block((0.3, 0.9))
    given["materials"] = {"parylene-c": {} if error is None else {"modulus_rel_sigma": error}}
    forward = Forward(experiment(made(given=given)[0]))
    record, layout = forward.experiment.record, forward.layout
    assert record.specimen.first.surface.name == "parylene-c"
    said = {
        0.05: "of its stated errors away",
        None: "times the standard error of 5 % that is taken, as the record states none",
    }
    assert strained._errors(forward, layout.modulus) == said[error]
    assert strained._errors(forward, layout.speed(0)) == said[0.05]


def test_nothing_is_said_of_a_record_that_needs_nothing():
    forward = Forward(experiment(made()[0]))
    null = nominal(forward)
    assert strained.lines(forward, null, null) == strained.lines(forward, null, None) == []


@pytest.mark.parametrize("effects", [[("viscous-drag", {"rate_per_s": 100.0})]])
def test_nor_where_the_misfit_itself_is_what_shows(effects):
    v = session.discover(made(effects)[0]).verdict
    assert v.named == ["viscous-drag"]
    assert not any(r.startswith(strained.ONLY_WITH) for r in v.reasons)


@pytest.mark.parametrize(
    ("kind", "of", "sigma", "said"),
    [
        ("modulus", "steel", 0.05, "the modulus of steel 1.65 times the stated one"),
        ("bead-mass", "", 0.05, "the mass of the beads 1.65 times the stated one"),
        ("delay", "g1", 1e-6, "the delay of g1 shifted by 10 µs"),
        ("clock", "", 1e-4, "the recorder's clock off by 0.1 %"),
        ("shared", "rise time", 1.0, "the error common to several quantities, rise time"),
    ],
)
def test_every_kind_has_its_words_and_units(kind, of, sigma, said):
    """Ten stated errors of each: a factor e^0.5, a time, a share, or nothing that has a size of its own."""
    layout = Layout(runs=1, gauges=1, others=(Shared(kind, sigma, of),))
    forward = SimpleNamespace(
        experiment=SimpleNamespace(runs=(SimpleNamespace(id="r1"),), gauges=()),
        layout=layout,
        nuisance_sigma=np.full(layout.size, sigma),
    )
    assert strained._moved(forward, layout.size - 1, 10.0) == said


def test_of_beads_that_do_not_weigh_alike_the_one_that_is_farthest_off_is_said():
    layout = Layout(runs=1, gauges=1, others=(Shared(SCATTER, 0.05, weights=(0.6, -0.8, 0.0)),))
    forward = SimpleNamespace(
        experiment=SimpleNamespace(runs=(SimpleNamespace(id="r1"),), gauges=()),
        layout=layout,
        nuisance_sigma=np.full(layout.size, 0.05),
    )
    said = "beads that do not weigh alike, bead 2 0.67 times what is stated"  # e^(-0.8 * 0.5)
    assert strained._moved(forward, layout.size - 1, 10.0) == said


def test_a_stated_preload_that_was_not_there_is_said(empty):
    """No effect makes a preload less: a gap does it, and is named."""
    chain = msgspec.structs.replace(empty.block.chain, static_force_N=0.5)
    loaded = replace(empty, block=msgspec.structs.replace(empty.block, chain=chain))
    v = session.discover(loaded).verdict
    assert "contact-gap" in v.named
    assert sum("stated static_force_N of 0.5 N off contact" in r for r in v.reasons) == 1


def test_nor_of_one_that_is_there():
    given = block((0.3, 0.9))
    given["chain"]["static_force_N"] = 0.5
    found = session.discover(made([("kuwabara-kono", {"time_us": 0.5})], given=given)[0])
    assert found.verdict.named == ["kuwabara-kono"]
    assert not any("static_force_N" in r for r in found.verdict.reasons)


@pytest.mark.parametrize("ratio", [0.97, 0.9])
def test_a_preload_other_than_stated_is_no_effect(ratio):
    """Its error is 2 % where none is stated; an exponent of the contact was named before, with 0.9."""
    given = block((0.3, 0.9)) | {"tolerances": {"static_force_rel": 0.0}}
    given["chain"]["static_force_N"] = 2.0 * ratio
    record, _ = made(seed=3, given=given)
    chain = msgspec.structs.replace(record.block.chain, static_force_N=2.0)
    stated = msgspec.structs.replace(record.block, chain=chain, tolerances=TolerancesBlock())
    v = session.discover(replace(record, block=stated)).verdict
    assert v.named == []
    # d' of the ratio is some hundreds, so that gains and speeds take up little of it.
    assert v.nuisances["static-force"].value == pytest.approx(ratio, abs=0.02)
