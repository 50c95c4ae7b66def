"""Records with hidden effects: valid, reproducible, and silent about what is in them."""

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from sonicvacuum import records
from sonicvacuum.cli import cli
from sonicvacuum.files import InputError
from sonicvacuum_blind import catalogue, design, extra_cases, foreign, study
from sonicvacuum_blind.hide import Spec, hide, write

CASES = [
    Spec("a", "single", "traces", "white", ("viscous-drag",), 10.0, 5, 0),
    Spec("b", "null", "traces", "ar1", (), 0.0, 5, 1),
    Spec("c", "null", "one-speed", "quantised", (), 0.0, 5, 2),
    Spec("d", "single", "ball", "white", ("hunt-crossley",), 10.0, 5, 3),
    Spec("e", "foreign", "one-speed", "white", ("dimer",), 10.0, 5, 4),
    Spec("f", "pair", "one-speed", "white", ("sensor-gain", "contact-exponent"), 10.0, 5, 5),
    Spec("g", "single", "scalars", "white", ("sensor-gain",), 10.0, 5, 6),
    Spec("h", "beside", "one-speed", "white", ("sensor-gain", "dimer"), 10.0, 5, 7),
]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Folders of records and truths."""
    root = tmp_path_factory.mktemp("hidden")
    for spec in CASES:
        write(spec, root / "records", root / "truth")
    return root


def truth(root, id):
    return json.loads((root / "truth" / id / "truth.json").read_text())


@pytest.mark.parametrize("spec", CASES, ids=lambda s: s.id)
def test_records_are_valid(made, spec):
    record = records.read(made / "records" / spec.id)
    assert len(record.runs) == truth(made, spec.id)["runs"]


def test_a_speed_of_pulses_found_in_the_wrong_order_is_not_written_down(tmp_path):
    """In the first design drawn for this case the laboratory would read -33 m/s; another is drawn then."""
    spec = Spec("x", "single", "scalars", "white", ("dynamic-modulus",), 10.0, 4_176_103, 324)
    write(spec, tmp_path / "records", tmp_path / "truth")
    speeds = [o.value for r in records.read(tmp_path / "records" / "x").runs for o in r.observables]
    assert min(speeds) > 0.0


def test_same_spec_same_bytes(made, tmp_path):
    for spec in (CASES[1], CASES[3]):
        write(spec, tmp_path / "records", tmp_path / "truth")
        for kind in ("records", "truth"):
            for path in sorted((made / kind / spec.id).iterdir()):
                assert (tmp_path / kind / spec.id / path.name).read_bytes() == path.read_bytes()


def test_places_give_different_data():
    one, _ = hide(Spec("x", "null", "one-speed", "white", (), 0.0, 5, 20))
    other, _ = hide(Spec("x", "null", "one-speed", "white", (), 0.0, 5, 21))
    assert one.block != other.block


def test_records_do_not_tell(made):
    """No name of an effect, no strength, no truth anywhere among the records."""
    words = [*catalogue.BY_ID, *foreign.BY_ID, "truth", "d_prime", "null", "pair", "foreign", "single"]
    for path in (made / "records").rglob("*"):
        assert path.suffix in ("", ".yaml", ".csv")
        text = path.read_text() if path.is_file() else path.name
        assert not [w for w in words if w in text.replace("single-", "")], path
    assert not list((made / "records").rglob("truth*"))


def test_truth_states_the_strength_reached(made):
    told = truth(made, "a")
    (hidden,) = told["hidden"]
    assert hidden["id"] == "viscous-drag"
    assert hidden["d_prime"] == pytest.approx(10.0, rel=0.01)
    assert hidden["parameters"]["rate_per_s"] > 0.0
    assert truth(made, "e")["leftover_d_prime"] == pytest.approx(10.0, rel=0.05)
    assert [h["d_prime"] for h in truth(made, "f")["hidden"]] == pytest.approx([10.0, 10.0], rel=0.01)


def before_arrival(made, id):
    """(runs, samples) of the first gauge before the wave, in units of the stated noise."""
    record = records.read(made / "records" / id)
    gauge = record.gauges[0]
    quiet = min(int(np.argmax(np.abs(run.signals.readings["g1"]) > 8.0 * gauge.sigma)) for run in record.runs)
    return np.array([run.signals.readings["g1"][: quiet // 2] for run in record.runs]) / gauge.sigma


def test_noise_is_as_stated(made):
    quiet = before_arrival(made, "a")
    assert np.std(quiet) == pytest.approx(1.0, abs=4.0 / np.sqrt(2.0 * quiet.size))  # 4 standard errors


def test_coloured_noise_has_the_stated_correlation(made):
    quiet = before_arrival(made, "b")
    told = truth(made, "b")["noise_drawn"]["correlation"]
    found = np.mean(quiet[:, 1:] * quiet[:, :-1]) / np.mean(quiet**2)
    assert found == pytest.approx(told, abs=4.0 / np.sqrt(quiet.size))  # 4 standard errors


def test_quantised_readings_are_whole_steps(made):
    record = records.read(made / "records" / "c")
    step = truth(made, "c")["noise_drawn"]["lsb_sigma"]
    for gauge in record.gauges:
        counts = record.runs[0].signals.readings[gauge.id] / (step * gauge.sigma)
        assert np.abs(counts - np.round(counts)).max() < 1e-6


@pytest.mark.parametrize(
    "change, message",
    [
        ({"kind": "triple"}, "kind is 'triple'"),
        ({"noise": "pink"}, "noise is 'pink'"),
        ({"effects": ()}, "hides 1 effects"),
        ({"effects": ("magic",)}, "effect 'magic'"),
        ({"seed": -1}, "seed is -1"),
        ({"place": -1}, "place is -1"),
        ({"d_prime": -5.0}, "d_prime is -5"),
        ({"d_prime": float("nan")}, "d_prime is nan"),
        ({"d_prime": float("inf")}, "d_prime is inf"),
    ],
)
def test_bad_specs_are_refused(change, message):
    good = {"id": "x", "kind": "single", "design": "traces", "noise": "white", "effects": ("tsuji",)}
    with pytest.raises(ValueError, match=message):
        Spec(**{**good, "d_prime": 10.0, "seed": 1, "place": 0, **change})


def test_effects_that_cannot_act_are_refused():
    with pytest.raises(ValueError, match="cannot act"):
        hide(Spec("x", "single", "ball", "white", ("sensor-gain",), 10.0, 1, 0))


def test_an_effect_and_one_from_outside_are_hidden_together(made):
    """As strong as asked: the effect by itself, the other by what no effect of the catalogue explains."""
    found = truth(made, "h")
    assert [h["id"] for h in found["hidden"]] == ["sensor-gain", "dimer"]
    assert found["hidden"][0]["d_prime"] == pytest.approx(10.0, rel=0.01)  # scaled to half a per cent
    assert found["hidden"][1]["d_prime"] >= 0.99 * 10.0  # as for the first, and what effects explain besides
    with pytest.raises(ValueError, match="dimer"):
        Spec("x", "beside", "one-speed", "white", ("dimer", "sensor-gain"), 10.0, 5, 7)


def test_studies_cover_what_is_asked(tmp_path):
    small, full = study.cases("small"), study.cases("full")
    assert len(small) >= 24
    assert len(full) >= 2000
    assert {s.kind for s in full} == {"null", "single", "pair", "set", "foreign"}
    assert sum(s.noise == "ar1" for s in full if s.kind == "null") >= 300
    assert {s.d_prime for s in full if s.design == "traces" and s.kind == "single"} >= {3.0, 500.0}
    assert {s.design for s in full if s.kind == "pair"} == set(design.KINDS)
    for specs in (small, full):
        assert len({s.id for s in specs}) == len(specs)
        places = [s.place for s in specs]
        assert places == sorted(set(places))
    assert {s.effects[0] for s in full if s.kind == "single"} == set(catalogue.BY_ID)
    laws = study.cases("laws")
    assert {s.effects[0] for s in full if s.kind == "foreign"} == set(foreign.STUDIED)
    assert {s.effects[0] for s in laws} == set(foreign.LAWS)
    assert set(foreign.STUDIED) | set(foreign.LAWS) == set(foreign.BY_ID)
    for name in ("beside", "beside-training"):
        together = study.cases(name)
        assert {s.effects[1] for s in together} == set(foreign.STUDIED)
        assert {s.effects[0] for s in together} <= set(catalogue.STUDIED)
        assert {s.d_prime for s in together} == set(study.OUTSIDE)
    study.write_cases(full, tmp_path / "cases.csv")
    assert study.read_cases(tmp_path / "cases.csv") == full
    parts = [study.batch(small, k, 5) for k in range(5)]
    assert sorted((s for p in parts for s in p), key=lambda s: s.id) == small


def test_what_a_study_has_besides_its_main_list_is_known_by_seed_and_place():
    """The main list has the shares of the studies before."""
    added = study.added(study.SEEDS["full"])
    main = [s for s in study.cases("full") if s.place not in added]
    besides = [s for s in study.cases("full") if s.place in added]
    again = study.cases("again")
    assert Counter((s.kind, s.design, s.noise) for s in main) == Counter(
        (s.kind, s.design, s.noise) for s in again
    )
    assert len(besides) == len(added)
    assert {s.kind for s in besides} == {"null", "single", "pair"}
    assert min(s.d_prime for s in besides if s.kind != "null" and s.design != "ball") >= 40.0
    assert study.added(study.SEEDS["again"]) == study.added(None) == frozenset()


def test_the_full_study_has_one_ball_as_often_as_elsewhere_besides():
    """The wall acts on one ball too, and the main list, whose cases are those of other seeds, has it not."""
    added = study.added(study.SEEDS["full"])
    cases = study.cases("full")
    balls = Counter(
        s.effects[0] for s in cases if s.place in added and s.design == "ball" and s.kind == "single"
    )
    assert balls == dict.fromkeys(study.BALL, 4) | {study.ON_BALL_BESIDES: 8}


def test_records_of_the_small_study_keep_their_numbers():
    """Its list had 36 records once, which docs/benchmark.md names by their numbers."""
    small = {s.id: s for s in study.cases("small")}
    assert len(small) == 36 - len(study.LEFT_OUT["small"])
    assert (small["small-0019"].kind, small["small-0019"].design) == ("null", "one-speed")
    assert small["small-0020"].effects == ("mass-defect",)
    assert small["small-0030"].place == 30
    assert {s.kind for s in small.values()} == {"single", "pair", "null", "foreign"}


def test_a_longer_catalogue_redraws_no_study(monkeypatch):
    drawn = {name: study.cases(name) for name in study.SEEDS}
    for module in (catalogue, foreign):
        extra = replace(module.ENTRIES[0], id="extra")
        monkeypatch.setattr(module, "ENTRIES", (extra, *module.ENTRIES))
        monkeypatch.setitem(module.BY_ID, "extra", extra)
    for name, cases in drawn.items():
        # Not by `==` alone: the comparison of two thousand cases would be printed.
        assert all(a == b for a, b in zip(study.cases(name), cases, strict=True))


def test_bad_case_lists_name_the_line(tmp_path):
    path = Path(tmp_path / "cases.csv")
    study.write_cases(CASES[:2], path)
    path.write_text(path.read_text().replace("ar1", "pink"))
    with pytest.raises(Exception, match=r"line 3: case b: noise is 'pink'"):
        study.read_cases(path)


@pytest.mark.parametrize(
    "old, new, words",
    [
        (",ar1,", ",pink,", "line 5: case b: noise is 'pink'"),
        (",5,1\n", ",-5,1\n", "line 5: case b: seed is -5"),
        (",0.0,", ",nan,", "line 5: case b: d_prime is nan"),
        ("\nb,", "\na,", "line 5: id a stands in line 3 already"),
        (",5,1\n", ",5\n", "line 5 has another number of cells"),
    ],
)
def test_lines_are_counted_as_an_editor_counts_them(tmp_path, old, new, words):
    path = tmp_path / "cases.csv"
    study.write_cases(CASES[:2], path)
    header, *lines = path.read_text().replace(old, new).splitlines()
    path.write_text("\n\n".join([header, *lines]) + "\n")
    with pytest.raises(InputError, match=words):
        study.read_cases(path)


@pytest.mark.parametrize("verb", ["hide", "ideal", "follow"])
def test_a_case_that_cannot_be_made_is_named_with_its_list(tmp_path, verb):
    """Gravity acts in chains alone: no design of one ball that is drawn lets it act."""
    path = tmp_path / "cases.csv"
    study.write_cases([Spec("x", "single", "ball", "white", ("gravity",), 10.0, 1, 0)], path)
    outputs = {
        "hide": [f"--records={tmp_path / 'records'}", f"--truth={tmp_path / 'truth'}"],
        "ideal": [f"--out={tmp_path / 'ideal.csv'}"],
        "follow": [f"--records={tmp_path / 'more'}", f"--verdicts={tmp_path / 'found'}", "--choice=proposed"],
    }
    (tmp_path / "found" / "x").mkdir(parents=True)
    proposal = {"named": ["gravity"], "confusable": [["gravity", "tsuji"]], "next_experiment": {"change": {}}}
    (tmp_path / "found" / "x" / "verdict.json").write_text(json.dumps(proposal))
    done = CliRunner().invoke(cli, ["blind", verb, f"--cases={path}", *outputs[verb]])
    assert isinstance(done.exception, InputError), done.exception
    assert str(done.exception).startswith(f"{path}: case x: gravity cannot act in designs ball")
    assert not (tmp_path / "ideal.csv").exists()


def test_extras_that_cannot_be_made_are_named(tmp_path, monkeypatch):
    case = extra_cases.ExtraCase(Spec("x", "single", "ball", "white", ("gravity",), 10.0, 1, 0), 0.0)
    monkeypatch.setattr(extra_cases, "cases", lambda seed: [case])
    folders = [f"--records={tmp_path / 'records'}", f"--truth={tmp_path / 'truth'}"]
    done = CliRunner().invoke(cli, ["blind", "extras", "--seed=1", *folders])
    assert isinstance(done.exception, InputError), done.exception
    assert "case x: gravity cannot act" in str(done.exception)


@pytest.mark.parametrize("name", ["../../a", "/a", "..", "", "a/b", "a\nb", "a\n", "A"])
def test_a_case_is_written_nowhere_else(tmp_path, name):
    path = tmp_path / "cases.csv"
    study.write_cases([CASES[0], replace(CASES[1], id=name)], path)
    with pytest.raises(InputError, match=r"cases.csv, line 3: id "):
        study.read_cases(path)


def test_an_error_that_takes_the_place_of_its_effect_is_no_end_of_the_study(tmp_path):
    # A striker 40 standard errors too fast leaves no pulses where rivals of that size are tried.
    spec = Spec("x", "single", "scalars", "white", ("striker-error",), 40.0, 88_822_325, 684)
    write(spec, tmp_path / "records", tmp_path / "truth")
    assert records.read(tmp_path / "records/x").runs
    assert np.isfinite(truth(tmp_path, "x")["leftover_d_prime"])
