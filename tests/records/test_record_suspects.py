"""Slips of the set-up that traces show: each is made on purpose, and must be the one that is named."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from record_cases import BALL, CONTENT, STRIKER, TRACES, content, made, put

from sonicvacuum.cli.discover import discover
from sonicvacuum.discover.fit.wide import WIDE
from sonicvacuum.records import Record, Signals
from sonicvacuum.records.commands import summary
from sonicvacuum.records.expected import expected
from sonicvacuum.records.reader import parse
from sonicvacuum.records.review import HARDLY_KNOWN, LONGER, review
from sonicvacuum.records.suspects import copies, suspects
from sonicvacuum.report.checked import check


def slip(traces=TRACES, change=None, **changes):
    """What is said of a record whose keys are not those with which its traces were made."""
    signals = {run: change(s) if change else s for run, s in traces.items()}
    record = Record(parse(content(**changes)), signals, "slipped")
    return suspects(record, expected(record))


def one(said, *parts):
    """Whether one sentence for each run, or one in all, has the parts, and nothing else is said."""
    assert 1 <= len(said) <= 2, said
    assert all(part in line for line in said for part in parts), said


def scaled(factor, *gauges):
    """Change of traces: readings times a factor."""
    return lambda s: Signals(
        s.time_us, {g: r * (factor if g in gauges else 1.0) for g, r in s.readings.items()}
    )


def test_of_a_sound_record_nothing_is_said_and_numbers_agree():
    seen = expected(made())
    assert suspects(made(), seen) == []
    assert {f.quantity for f in seen.features} == {
        "arrival", "amplitude", "duration_half", "speed", "width_half"
    }  # fmt: skip
    # The noise is 1 % of the smallest peak; speeds and widths are differences of such times.
    assert all(f.ratio == pytest.approx(1.0, rel=0.03) for f in seen.features)
    assert suspects(made(BALL), expected(made(BALL))) == []


@pytest.mark.parametrize(("shift_us", "word"), [(-25.0, "early"), (40.0, "late")])
def test_a_trigger_off_by_more_than_its_error_is_told(shift_us, word):
    def late(s):
        return Signals(s.time_us + shift_us, s.readings)

    said = [line for line in slip(change=late) if "begins" not in line]
    one(said, f"{abs(shift_us):.0f}"[:1], f"us too {word} at every gauge", "write trigger_sigma_us: unknown")
    assert not [s for s in slip(change=late, trigger_sigma_us="unknown") if "trigger" in s]


def of_gauges(names, traces=TRACES, shift_us=0.0, **keys):
    """What is said of the record with some of its gauges only, its times put later."""
    sensors = [s | keys for s in CONTENT["sensors"] if s["id"] in names]
    runs = [{k: v for k, v in r.items() if k != "observables"} for r in CONTENT["runs"]]
    signals = {
        run: Signals(s.time_us + shift_us, {g: s.readings[g] for g in names}) for run, s in traces.items()
    }
    record = Record(parse(content(sensors=sensors, runs=runs)), signals, "few")
    return [line for line in suspects(record, expected(record)) if "begins" not in line]


@pytest.mark.parametrize(
    ("names", "where"), [(("near",), "gauge near"), (("far",), "gauge far"), (("near", "far"), "every gauge")]
)
def test_a_late_trigger_is_told_by_gauges_at_one_bead_too(names, where):
    told = of_gauges(names, shift_us=250.0, **({"bead": 3} if len(names) > 1 else {}))
    one(told, "us too late at " + where, "write trigger_sigma_us: unknown")
    assert of_gauges(names[:1]) == []


@pytest.mark.parametrize("name", ["near", "far", "wall"])
def test_a_wave_that_is_slower_is_no_late_trigger_of_a_single_gauge(name):
    softer = made(materials={"stainless-steel": {"modulus_GPa": 97.5, "modulus_rel_sigma": 0.03}})
    assert not [line for line in of_gauges([name], softer.signals) if "trigger" in line]


def test_volts_are_told_from_a_striker():
    volts = slip(change=scaled(0.08, "near", "far", "wall"))
    one(volts, "peaks are 0.080", "are they in V, mN or kN?")
    # Traces of a ball four times as fast as the record says.
    fast = [
        r | {"striker": STRIKER | {"speed_m_s": 4.0 * r["striker"]["speed_m_s"]}} for r in CONTENT["runs"]
    ]
    one(slip(made(runs=fast).signals), "are the striker's mass, material and speed right?")


def test_one_gauge_off_is_told_from_all():
    one(slip(change=scaled(5.0, "far")), "gauge far: its peaks are 4.99 times")
    assert slip(change=scaled(5.0, "far"), sensors__1__gain_rel_sigma="unknown") == []


@pytest.mark.parametrize(
    ("sensor", "bead", "said"), [(0, 4, 3), (0, 9, 3), (1, 2, 6), (1, 5, 6), (1, 7, 6), (1, 8, 6)]
)
def test_a_bead_counted_wrongly_is_named_with_the_right_one(sensor, bead, said):
    found = [line for line in slip(**{f"sensors__{sensor}__bead": bead}) if "begins" not in line]
    gauge = CONTENT["sensors"][sensor]["id"]
    one(found, f"gauge {gauge}: its pulses come when they should at bead {said}, not at bead {bead}")


def test_gauges_exchanged_are_not_told_as_one_of_them_elsewhere():
    """The far gauge's pulses were said to come when they should at bead 1, ahead of where any gauge is."""
    found = [line for line in slip(sensors__0__bead=6, sensors__1__bead=3) if "begins" not in line]
    one(found, "gauges near and far: each one's pulses come when the other's should: are cables")


def test_of_unlike_beads_no_number_is_told_but_on_which_side():
    """A gauge one bead off was said to be three off, as a soft bead takes longer to pass than the average."""
    heavier = {"chain__bodies": {8: {"mass_g": 0.46}}}
    found = [line for line in slip(sensors__0__bead=4, **heavier) if "begins" not in line]
    one(found, "gauge near: its pulses come when they should at a bead nearer to the striker, not at bead 4")


def test_a_softer_chain_is_no_slip():
    """What discover is for: a modulus half as large."""
    assert slip(made().signals) == []


def test_masses_are_held_against_densities():
    one(slip(chain__bead__mass_g=0.6), "chain.bead.mass_g: is 0.6 g", "of stainless-steel weighs 0.4518 g")


def test_a_mass_is_named_by_the_bead_that_has_it():
    said = slip(chain__bodies={4: {"mass_g": 0.6}})
    assert any(line.startswith("chain.bodies.4.mass_g: is 0.6 g") for line in said), said


def test_a_window_too_short_is_told_with_the_one_needed():
    def cut(s):
        return Signals(s.time_us[:420], {g: r[:420] for g, r in s.readings.items()})

    one(slip(change=cut), "ends at 94.75 us", "are needed for the pulse at every gauge: record longer")


def test_text_and_json_say_the_same(tmp_path):
    folder = put(tmp_path, chain__bead__mass_g=0.6)
    told = json.loads(check([folder], as_json=True))
    assert set(told) == {"format", "records"}
    (found,) = told["records"]
    assert set(found) == {
        "record", "title", "features", "windows_s", "warnings", "suspects", "treatment", "discover_s"
    }  # fmt: skip
    assert set(found["features"][0]) == {
        "run", "gauge", "start", "quantity", "unit", "expected", "measured"
    }  # fmt: skip
    text = check([folder])
    assert all(line in text for line in (*found["suspects"], *found["warnings"]))
    assert "near: peak at" in text
    assert "needed" in text
    assert "uncalibrated" not in text
    times = [found["discover_s"][key] for key in ("low", "estimate", "high", "unexplained")]
    assert times == sorted(times) and len(set(times)) == 4
    low, _, high, longest = (f"{float(f'{s:.2g}'):g}" for s in times)
    said = f"discover will usually take {low} to {high} s on one core, up to some {longest} s where something"
    assert said in text


def test_what_is_hardly_known_takes_as_long_as_it_usually_does(tmp_path):
    """Of the four shots of docs/real-traces.md all are left with something unexplained."""
    runs = {"runs__0__striker__speed_rel_sigma": 0.2}
    assert "unexplained" not in check([put(tmp_path, **runs)])


def test_readings_of_a_gauge_that_was_never_calibrated_are_no_newtons(tmp_path):
    text = check([put(tmp_path, sensors__0__gain_rel_sigma="unknown")])
    assert re.search(r"near: peak at \S+ us \(\S+\); peak \S+ uncalibrated \(\S+ N\)", text)
    assert re.search(r"near: peak \S+, uncalibrated, \S+ times the noise", text)
    assert re.search(r"far: peak \S+ N, \S+ times the noise", text)


@pytest.mark.parametrize(
    "known",
    [
        lambda error: {
            "runs": [r | {"striker": STRIKER | {"speed_rel_sigma": error}} for r in CONTENT["runs"]]
        },
        lambda error: {"materials": {"stainless-steel": {"modulus_rel_sigma": error}}},
        lambda error: {"tolerances": {"speed_common_rel": error}},
    ],
    ids=["speeds", "a modulus", "a common speed"],
)
def test_a_search_takes_longer_where_speeds_or_moduli_are_hardly_known(known):
    assert HARDLY_KNOWN == WIDE  # from there on fits start all over what they may be
    well, hardly = (
        review(Record(parse(content(**known(error))), TRACES, "made")).discover_s for error in (0.05, 0.2)
    )
    assert hardly == LONGER * well


def test_a_gauge_without_a_pulse_has_no_number():
    quiet = TRACES["fast"]
    still = replace(quiet, readings=quiet.readings | {"far": np.zeros(quiet.samples)})
    record = Record(parse(content()), dict(TRACES) | {"fast": still}, "still")
    missing = [f for f in review(record).expected.features if f.measured is None]
    assert {(f.run, "far" in (f.gauge, f.start)) for f in missing} == {("fast", True)}
    assert "far: peak at – us" in summary(record, review(record))


def test_a_file_that_was_taken_for_two_runs_is_told():
    record = made()
    assert copies(record) == []
    (one_run, traces), (other, _) = list(record.signals.items())[:2]
    (said,) = copies(replace(record, signals={**record.signals, other: traces}))
    assert said.startswith(f"run {other}: holds the same samples as run {one_run}")


def test_a_trace_that_was_taken_for_two_runs_is_told():
    record = made()
    (one_run, traces), (other, own) = list(record.signals.items())[:2]
    mixed = replace(own, readings=own.readings | {"far": traces.readings["far"]})
    (said,) = copies(replace(record, signals={**record.signals, other: mixed}))
    assert said.startswith(f"run {other}: gauge far reads the same samples as in run {one_run}")


def test_a_column_that_was_taken_for_two_gauges_is_told():
    record = made()
    one, two = (gauge.id for gauge in record.gauges[:2])
    taken = {k: replace(s, readings={**s.readings, two: s.readings[one]}) for k, s in record.signals.items()}
    (said,) = copies(replace(record, signals=taken))
    assert said == (
        f"gauge {two}: reads the same samples as gauge {one}, to the last digit: a column was taken for both"
    )
    run = next(iter(taken))
    (said,) = copies(replace(record, signals={**record.signals, run: taken[run]}))
    assert f", in run {run}: a column" in said


@pytest.mark.parametrize(
    ("prior", "odds", "told"),
    [
        ("viscous-drg", 10, "is 10: no such effect; did you mean viscous-drag?"),
        ("none", 10, "is 10: no such effect; the catalogue holds dynamic-modulus, "),
        (
            "my-law",
            "present",
            "is present: no such effect; .*; an effect of your own needs its file",
        ),
        ("gravity", "present", "cannot be present: the record does not say how well fraction is known"),
        ("coating-thickness", "present", "cannot be present: no coating is stated; give coating_um"),
    ],
)
def test_priors_that_a_search_refuses_are_told_by_the_check_too(tmp_path, prior, odds, told):
    folder = put(tmp_path / "mine", priors={prior: odds})
    said = rf"priors\.{prior}: {re.escape(told).replace(re.escape('.*'), '.*')}"
    assert re.search(rf"check your set-up: {said}.*discover refuses it", check([folder]))
    ended = CliRunner().invoke(discover, [str(folder), "--out", str(tmp_path / "found")])
    assert re.match(rf"{re.escape(str(folder / 'record.yaml'))}: {said}", str(ended.exception))
