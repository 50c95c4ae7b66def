"""What an import is told wrongly is refused before anything is written; what it is told right is kept."""

import re

import numpy as np
import pytest
import yaml
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st
from odd_files import PULSE, SECOND, TIMES, rows
from recorded import CONTENT, raw_files

from sonicvacuum.cli import cli
from sonicvacuum.files import InputError
from sonicvacuum.scope.importing import import_files
from sonicvacuum.scope.options import options

HEAD = "Time (s),CH1 (V),CH2 (V)\n"


@pytest.fixture
def shot(tmp_path):
    (tmp_path / "fast.csv").write_text(HEAD + rows(TIMES, PULSE, SECOND))
    return tmp_path / "fast.csv"


def asked(folder, file, *arguments):
    """The refusal of an import, "" where there is none, and whether anything was written."""
    out = folder / "out"
    done = CliRunner().invoke(cli, ["record", "import", str(file), *arguments, "--out", str(out)])
    # The program turns these, and no others, into one line and exit code 2.
    assert isinstance(done.exception, InputError | None), done.exception
    return str(done.exception or ""), out.exists()


WRONG = [
    ("--scale", "CH1=25N/V±2.5.1%"), ("--scale", "CH1=25N/V±.%"), ("--scale", "CH1=1e400N/V"),
    ("--scale", "CH1=1e-400N/V"), ("--scale", "CH1=1e308kN/mV"), ("--speed", "0.5±.%"),
    ("--speed", "1e400"), ("--place", "CH1=²"), ("--place", "CH1=1" + "0" * 30), ("--impact-at", "1e400us"),
    ("--interval", "1e400"), ("--impact-at", "1e300"), ("--interval", "1e300"), ("--speed", "1e300"),
    ("--start", "1e400"), ("--interval", "2 bananas"),
]  # fmt: skip


@pytest.mark.parametrize(("option", "value"), WRONG)
def test_options_that_say_nothing(tmp_path, shot, option, value):
    refusal, written = asked(tmp_path, shot, option, value)
    assert option in refusal and value.split("=")[-1] in refusal and not written


@given(st.sampled_from(["scale", "speed", "place", "impact_at", "interval", "start"]), st.text(max_size=12))
def test_any_text_of_an_option_is_taken_or_refused(option, text):
    value = text if option in ("interval", "start") else [f"CH1={text}"]
    try:
        options(**{option: value})
    except InputError as error:
        assert "--" in str(error)


# Moments of impact on the clock of a record from -100 to 99 us, whose pulses arrive at some 15 us.
MOMENTS = [
    ("12", "is 12 s, behind the recording, which lasts from -0.0001 to 9.9e-05 s; give .* as in 12us"),
    ("-12", "is -12 s, more than 3 lengths before the recording"),
    ("100us", "behind the recording"),
    ("95us", "is 9.5e-05 s, when the pulse has passed every gauge, the last at"),
    ("-1000us", "more than 3 lengths before the recording"),
]


@pytest.mark.parametrize(("moment", "said"), MOMENTS)
def test_an_impact_that_cannot_be_that_of_the_recording(tmp_path, shot, moment, said):
    for text in (moment, f"fast={moment}"):
        refusal, written = asked(tmp_path, shot, "--impact-at", text)
        assert re.search(f"^--impact-at: run fast: .*{said}", refusal) and not written


def test_an_impact_that_is_odd_is_told(tmp_path):
    late = np.roll(PULSE, 40)
    (tmp_path / "fast.csv").write_text(HEAD + rows(TIMES, PULSE, late))
    for moment, said in (
        ("-150us", "5e-05 s before the recording begins"),
        ("30us", "arrival of the pulse at CH1."),
    ):
        found = import_files([tmp_path / "fast.csv"], tmp_path / "r", options(impact_at=[moment]), force=True)
        assert any(said in line for line in found), found
    found = import_files([tmp_path / "fast.csv"], tmp_path / "r", options(impact_at=["0us"]), force=True)
    assert not any("impact is given" in line for line in found)


RECORDS = [
    ({"toleranzes": {"bead_mass_rel": 0.01}}, "toleranzes: a record has no such key; write tolerances"),
    ({"zzz": 1}, "zzz: a record has no such key; there are format, title"),
    ({"runs": [{"observable": []}]}, "runs[0].observable: a record has no such key; write observables"),
    ({"runs": [{"id": "fast", "striker": "flat"}]}, "runs[0].striker: is 'flat'"),
    ({"runs": [1, 2]}, "runs[0]: is 1"),
    ({"runs": 5}, "runs: is 5"),
    ({"runs": [{"id": [1]}]}, "runs[0]: is [1]"),
    ({"runs": [{"id": 1}]}, "runs[0]: is 1"),
    ({"sensors": ["g5"]}, "sensors[0]: is 'g5'"),
]  # fmt: skip


@pytest.mark.parametrize(("content", "said"), RECORDS)
@pytest.mark.parametrize("option", ["--record", "--like"])
def test_records_that_are_none(tmp_path, shot, content, said, option):
    (tmp_path / "record.yaml").write_text(yaml.safe_dump(content))
    refusal, written = asked(tmp_path, shot, option, str(tmp_path / "record.yaml"))
    assert "record.yaml: " + said in refusal and not written


SPEED = {"quantity": "speed", "from": "near", "to": "far", "value": 500.0, "sigma": 9.0, "unit": "m/s"}
PEAK = {"quantity": "amplitude", "sensor": "near", "value": 9.0, "sigma": 1.0, "unit": "N"}
GIVEN = CONTENT | {
    "source": {"citation": "Someone"},
    "trigger_sigma_us": 2.5,
    "clock_rel_sigma": 1e-4,
    "model_floor_rel": 0.01,
    "tolerances": {"bead_mass_rel": 0.01},
    "runs": [
        CONTENT["runs"][1] | {"observables": [SPEED]},
        {"id": "told", "striker": CONTENT["runs"][0]["striker"], "observables": [PEAK]},
    ],
}
USUAL = {"channel": ["CH1=near", "CH2=far"], "scale": ["near=10N/V", "far=-10N/V"]}


def test_all_keys_of_a_given_record_are_kept(tmp_path, shot):
    (tmp_path / "given.yaml").write_text(yaml.safe_dump(GIVEN))
    said = import_files([shot], tmp_path / "r", options(**USUAL), record=tmp_path / "given.yaml")
    written = yaml.safe_load((tmp_path / "r" / "record.yaml").read_text())
    for key in ("source", "chain", "trigger_sigma_us", "clock_rel_sigma", "model_floor_rel", "tolerances"):
        assert written[key] == GIVEN[key], key
    assert [r.get("observables") for r in written["runs"]] == [r["observables"] for r in GIVEN["runs"]]
    assert written["runs"][1]["id"] == "told" and "signals" not in written["runs"][1]
    assert not any("no file is called" in line for line in said)


def test_a_channel_reads_a_gauge_of_the_given_record_or_one_with_a_place(tmp_path, shot):
    (tmp_path / "given.yaml").write_text(yaml.safe_dump(CONTENT))
    given = ["--record", str(tmp_path / "given.yaml"), "--channel", "CH1=g9"]
    refusal, written = asked(tmp_path, shot, *given)
    assert re.search(r"^--channel CH1=g9: .*given\.yaml has no gauge 'g9', but near, far; .*--place", refusal)
    assert not written
    assert asked(tmp_path, shot, *given, "--place", "g9=4") == ("", True)


def test_gauges_of_a_given_record_that_no_channel_reads_are_told(tmp_path, shot):
    (tmp_path / "given.yaml").write_text(yaml.safe_dump(CONTENT))
    told = "as no channel reads them: "
    for chosen, lost in (
        ({}, "near, far; it does not have CH1, CH2 (--channel CH=near says"),
        ({"channel": ["CH2=far"]}, "near (--channel CH=near says"),
        (USUAL, ""),
    ):
        said = import_files(
            [shot], tmp_path / "r", options(**chosen), record=tmp_path / "given.yaml", force=True
        )
        (found,) = [line.partition(told)[2] for line in said if told in line] or [""]
        assert found.startswith(lost) and bool(found) == bool(lost)


def test_gauges_that_only_observables_name_stay(tmp_path, shot):
    (tmp_path / "given.yaml").write_text(yaml.safe_dump(GIVEN))
    one = options(channel=["CH1=near"], scale=["near=10N/V"])
    import_files([shot], tmp_path / "r", one, record=tmp_path / "given.yaml")
    written = yaml.safe_load((tmp_path / "r" / "record.yaml").read_text())
    assert [s["id"] for s in written["sensors"]] == ["near", "far"]


def test_what_was_measured_elsewhere_stays_there(tmp_path, shot):
    (tmp_path / "record.yaml").write_text(yaml.safe_dump(GIVEN))
    import_files([shot], tmp_path / "r", options(**USUAL), like=tmp_path)
    written = yaml.safe_load((tmp_path / "r" / "record.yaml").read_text())
    assert written["clock_rel_sigma"] == GIVEN["clock_rel_sigma"]
    assert written["trigger_sigma_us"] != GIVEN["trigger_sigma_us"]
    assert [r["id"] for r in written["runs"]] == ["fast"] and "observables" not in written["runs"][0]


def listed(folder):
    return np.loadtxt(folder / "r" / "fast.csv", delimiter=",", skiprows=1)[:, 0]


@pytest.mark.parametrize(
    ("head", "times"),
    [
        ("Time,CH1 (V),CH2 (V)\n", TIMES * 1e3),
        (",CH1 (V),CH2 (V)\n", np.arange(200)),
        ("CH1 (V),CH2 (V)\n", None),
    ],
)
def test_a_stated_interval_overrules_the_file(tmp_path, head, times):
    columns = [PULSE, SECOND] if times is None else [times, PULSE, SECOND]
    (tmp_path / "fast.csv").write_text(head + rows(*columns))
    said = import_files(
        [tmp_path / "fast.csv"], tmp_path / "r", options(interval="1us", start="-100us", keep_all=True)
    )
    assert listed(tmp_path) == pytest.approx(TIMES * 1e6, abs=1e-6)
    assert any("as given" in line for line in said)


def test_a_stated_interval_scales_the_start(tmp_path):
    (tmp_path / "fast.csv").write_text("Time,CH1 (V),CH2 (V)\n" + rows(TIMES * 1e3, PULSE, SECOND))
    said = import_files([tmp_path / "fast.csv"], tmp_path / "r", options(interval="1us", keep_all=True))
    assert listed(tmp_path) == pytest.approx(TIMES * 1e6, abs=1e-6)
    assert any("in place of the file's 0.001 s" in line for line in said)


TAKEN = "times of fast: no unit is given, so they were taken as seconds"


def test_times_without_a_unit_are_seconds_and_the_terminal_says_so(tmp_path):
    file = tmp_path / "fast.csv"
    file.write_text("time,CH1 (V)\n" + rows(TIMES, PULSE))
    said = import_files([file], tmp_path / "r", options(keep_all=True))
    assert listed(tmp_path) == pytest.approx(TIMES * 1e6, abs=1e-6)
    assert any(line.startswith(TAKEN) and "give --interval with its unit" in line for line in said)
    assert "s assumed" in (tmp_path / "r" / "record.yaml").read_text()
    for chosen in (options(interval="1us"), options(interval="2us")):
        said = import_files([file], tmp_path / "r", chosen, force=True)
        assert not any("assumed" in line or line.startswith(TAKEN) for line in said)
    file.write_text("Time (s),CH1 (V)\n" + rows(TIMES, PULSE))
    assert not any(
        line.startswith(TAKEN) for line in import_files([file], tmp_path / "r", options(), force=True)
    )


def test_times_without_a_unit_that_cannot_be_seconds_are_refused(tmp_path):
    """Microseconds as seconds made trigger_sigma_us 1e6, which a check told to be in ns."""
    file = tmp_path / "fast.csv"
    file.write_text("time,CH1 (V)\n" + rows(TIMES * 1e6, PULSE))
    refusal, written = asked(tmp_path, file, "--impact-at", "5")
    assert re.search(r"fast\.csv: channel CH1: its times have no unit.* 1 s apart; .*--interval 1us", refusal)
    assert not written
    assert asked(tmp_path, file, "--impact-at", "5us", "--interval", "1us") == ("", True)


@pytest.mark.parametrize("day", [45_231.4242, 43_769.4242, 738_000.4242], ids=["1900", "1904", "MATLAB"])
def test_numbers_of_days_are_no_seconds(tmp_path, day):
    """What a spreadsheet made of a clock was read as seconds: a pulse of 0.6 ns beyond the speed of light."""
    file = tmp_path / "fast.csv"
    days = [f"{day + 1000.0 * t / 86_400.0:.11f}" for t in TIMES]
    body = "".join(f"{a},{b:.6f}\n" for a, b in zip(days, PULSE, strict=True))
    file.write_text("Time,CH1 (V)\n" + body)
    refusal, written = asked(tmp_path, file)
    assert re.search(r"fast\.csv: channel CH1: No time: .*numbers of days.*0\.001 s.*--interval", refusal)
    assert not written
    # What tells the interval, a header or the user, is taken.
    file.write_text("Sample Interval,1e-03 s\nTime,CH1 (V)\n" + body)
    assert asked(tmp_path, file) == ("", True)
    # A unit is believed, and seconds since midnight are some.
    file.write_text("Time (s),CH1 (V)\n" + body)
    assert asked(tmp_path, file, "--force")[0] == ""


def test_readings_without_a_unit_are_told_as_written(tmp_path):
    (tmp_path / "fast.csv").write_text("Time (s),CH1\n" + rows(TIMES, PULSE))
    said = import_files([tmp_path / "fast.csv"], tmp_path / "r", options())
    assert any(re.search(r"baseline \S+ as written removed", line) for line in said)


def test_seconds_since_midnight_are_seconds(tmp_path):
    file = tmp_path / "fast.csv"
    times = [f"{45_231.4242 + t:.6f}" for t in TIMES]
    file.write_text("Time,CH1 (V)\n" + "".join(f"{a},{b:.6f}\n" for a, b in zip(times, PULSE, strict=True)))
    assert asked(tmp_path, file) == ("", True)


def test_times_in_ms_taken_as_seconds_are_not_told_to_be_converted(tmp_path):
    (tmp_path / "given.yaml").write_text(yaml.safe_dump(CONTENT))
    (tmp_path / "fast.csv").write_text("time,CH1 (V),CH2 (V)\n" + rows(TIMES * 1e3, PULSE, SECOND))
    given = tmp_path / "given.yaml"
    said = import_files([tmp_path / "fast.csv"], tmp_path / "r", options(**USUAL), like=given)
    assert "column time_us" in said[-1] and said[-1].endswith("; seconds were assumed, as said above")


def test_an_interval_beyond_what_a_trigger_may_be_known_to_leaves_it_unknown(tmp_path):
    (tmp_path / "fast.csv").write_text("Time (s),CH1 (V)\n" + rows(TIMES * 1e6, PULSE))
    import_files([tmp_path / "fast.csv"], tmp_path / "r", options(impact_at=["5"]))
    assert yaml.safe_load((tmp_path / "r" / "record.yaml").read_text())["trigger_sigma_us"] == "unknown"


def test_samples_that_are_cut_are_counted(tmp_path):
    trace = np.concatenate([np.resize(PULSE[:60], 600), PULSE, np.resize(PULSE[:60], 600)])
    (tmp_path / "fast.csv").write_text("Time (s),CH1 (V)\n" + rows(1e-6 * np.arange(1400), trace))
    said = import_files([tmp_path / "fast.csv"], tmp_path / "r", options())
    kept = len(listed(tmp_path))
    (told,) = [line for line in said if "Cut from" in line]
    pattern = rf"Cut from 1400 to {kept} samples, without (\d+) before the pulse .*, (\d+) behind it .*all"
    assert sum(map(int, re.search(pattern, told).groups())) == 1400 - kept
    assert f"# {told}" in (tmp_path / "r" / "record.yaml").read_text()
    said = import_files([tmp_path / "fast.csv"], tmp_path / "r", options(keep_all=True), force=True)
    assert len(listed(tmp_path)) == 1400 and not any("Cut" in line for line in said)


def test_the_ends_that_thinning_needs_are_counted(tmp_path):
    files, like = raw_files(tmp_path)
    said = import_files(files[:1], tmp_path / "r", options(channel=["CH1=near"]), like=like)
    (told,) = [line for line in said if "Cut from" in line]
    assert "80 at the ends, which the low-pass needs" in told


def test_channels_of_different_lengths_are_told(tmp_path):
    short = [f"{v:.5f}" for v in SECOND[:180]] + [""] * 20
    (tmp_path / "fast.csv").write_text(HEAD + rows(TIMES, PULSE, short))
    said = import_files([tmp_path / "fast.csv"], tmp_path / "r", options(keep_all=True))
    assert any("Cut from 200 to 180 samples, those of the shortest channel" in line for line in said)


@pytest.mark.parametrize("key", ["4", "CH4", "channel 4"])
def test_channels_are_called_by_their_numbers(tmp_path, key):
    (tmp_path / "fast.csv").write_text("x-axis,1,4\nsecond,Volt,Volt\n" + rows(TIMES, SECOND, PULSE))
    import_files([tmp_path / "fast.csv"], tmp_path / "r", options(channel=[f"{key}=wall"], keep_all=True))
    written = np.loadtxt(tmp_path / "r" / "fast.csv", delimiter=",", skiprows=1)
    assert np.ptp(written[:, 1]) == pytest.approx(np.ptp(PULSE), rel=1e-3)


def test_a_scale_for_another_unit_is_refused(tmp_path):
    (tmp_path / "fast.csv").write_text("Time (s),F5 (counts)\n" + rows(TIMES, PULSE))
    with pytest.raises(InputError, match="is in counts; give newtons"):
        import_files([tmp_path / "fast.csv"], tmp_path / "r", options(scale=["F5_counts=25N/V"]))


def test_lost_samples_in_a_row_are_located(tmp_path):
    column = [f"{v:.4f}" for v in PULSE]
    column[30:39] = ["NaN"] * 9
    (tmp_path / "fast.csv").write_text(HEAD + rows(TIMES, column, SECOND))
    said = r"fast.csv: channel CH1 .* 9 samples in a row are lost, from sample 31 at -7e-05 s on; cut"
    with pytest.raises(InputError, match=said):
        import_files([tmp_path / "fast.csv"], tmp_path / "r", options())


def test_a_file_that_is_too_short_says_so(tmp_path):
    (tmp_path / "fast.csv").write_text(HEAD + rows(TIMES[:12], PULSE[:12], SECOND[:12]))
    with pytest.raises(InputError, match=r"fast.csv: channel CH1 holds 12 samples, less than the 16"):
        import_files([tmp_path / "fast.csv"], tmp_path / "r", options())


def test_a_folder_is_no_file(tmp_path):
    assert "is a folder; give the files in it" in asked(tmp_path, tmp_path)[0]


def test_remarks_on_time_zero_do_not_contradict_each_other(tmp_path):
    """Without times, zero is the first sample and not the trigger; the pulse lies within it here."""
    (tmp_path / "fast.csv").write_text("Sample Interval,1e-6\nCH1 (V)\n" + rows(PULSE))
    said = "\n".join(import_files([tmp_path / "fast.csv"], tmp_path / "r", options()))
    assert "Time counts from the first sample" in said
    assert "Time counts from the recorder's zero" in said and "from the trigger" not in said


def test_a_record_that_begins_on_the_pulse_has_no_known_sign(tmp_path):
    late = np.concatenate([PULSE[118:], np.resize(PULSE[:60], 400)])
    (tmp_path / "fast.csv").write_text("Time (s),CH1 (V)\n" + rows(1e-6 * np.arange(len(late)), late))
    said = "\n".join(import_files([tmp_path / "fast.csv"], tmp_path / "r", options()))
    assert "sign of the pulse are uncertain" in said
    assert "negative --scale" not in said
