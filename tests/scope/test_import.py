"""From raw files to a record that checks and that discover takes, and what stands in the way."""

import json

import numpy as np
import pytest
import yaml
from click.testing import CliRunner
from made_files import PULSE, TIMES, table, tbs
from recorded import GAINS, NOISE_V, STEP_V, TRUE, raw_files

from sonicvacuum.cli import cli
from sonicvacuum.files import InputError
from sonicvacuum.records import read as read_record
from sonicvacuum.records.checks import check
from sonicvacuum.scope import draft, listing
from sonicvacuum.scope.importing import import_files
from sonicvacuum.scope.options import options

SCALES = tuple(f"{g}={1e3 * v!r} mV/N ± 2 %" for g, v in GAINS.items())
CHANNELS = ("CH1=near", "CH2=far")


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    """Two runs with both gauges in one file each, imported like the record that they were made of."""
    folder = tmp_path_factory.mktemp("raw")
    files, like = raw_files(folder)
    chosen = options(
        channel=CHANNELS, scale=SCALES, speed=("slow=0.2", "fast=0.44"), impact_at=("slow=30us", "fast=30us")
    )
    return folder / "record", import_files(files, folder / "record", chosen, like=like)


def test_the_record_is_complete_and_sound(imported):
    folder, said = imported
    assert any("complete; next" in line for line in said)
    assert check(folder) == []


def test_traces_come_back_in_newtons_from_the_impact(imported):
    record = read_record(imported[0])
    for run in record.runs:
        true = TRUE.signals[run.id]
        assert run.signals.interval_s > 2.0 * true.interval_s  # thinned
        for gauge in record.gauges:
            expected = np.interp(run.signals.time_us, true.time_us, true.readings[gauge.id])
            off = run.signals.readings[gauge.id] - expected
            # Six standard deviations of the noise of one sample, and the baseline's error.
            assert np.abs(off).max() < 6.0 * gauge.sigma
            assert gauge.gain_rel_sigma == 0.02


def test_one_speed_is_that_of_all_runs_but_those_named(tmp_path):
    files, like = raw_files(tmp_path)
    chosen = options(
        channel=CHANNELS, scale=SCALES, speed=("0.3±20%", "fast=0.44 +- 2 %"), impact_at=("30us",)
    )
    import_files(files, tmp_path / "record", chosen, like=like)
    struck = {run.id: run.striker for run in read_record(tmp_path / "record").runs}
    assert (struck["slow"].speed_m_s, struck["slow"].speed_rel_sigma) == (0.3, 0.2)
    assert (struck["fast"].speed_m_s, struck["fast"].speed_rel_sigma) == (0.44, 0.02)


def test_a_title_names_as_many_runs_as_a_line_holds():
    assert draft._title(["slow", "fast"]) == "Imported: slow, fast"
    assert draft._title([f"shot-{k}" for k in range(30)]).endswith("shot-6 and 23 more")
    assert len(draft._title(["x" * 300])) < 80


def test_noise_is_that_of_the_thinned_samples(imported):
    record = read_record(imported[0])
    raw = np.hypot(NOISE_V, STEP_V / 12.0**0.5)
    for gauge in record.gauges:
        factor = record.runs[0].signals.interval_s / TRUE.signals["slow"].interval_s
        # The low-pass takes all noise beyond the new Nyquist frequency; 20 %: two errors of 100 samples.
        assert gauge.sigma == pytest.approx(raw / GAINS[gauge.id] / factor**0.5, rel=0.2)


def test_discover_takes_it(imported, tmp_path):
    done = CliRunner().invoke(
        cli, ["discover", str(imported[0]), "--out", str(tmp_path), "--no-figures", "--threads", "1"]
    )
    assert done.exit_code == 0, done.output
    verdict = json.loads((tmp_path / "verdict.json").read_text())
    assert verdict["gap"]["fitted"]["after"] < 2.0


def test_what_is_missing_is_named(tmp_path):
    (tmp_path / "shot.csv").write_bytes(tbs(TIMES, PULSE))
    done = CliRunner().invoke(
        cli, ["record", "import", str(tmp_path / "shot.csv"), "--out", str(tmp_path / "r")]
    )
    assert done.exit_code == 0, done.output
    with pytest.raises(InputError) as error:
        read_record(tmp_path / "r")
    for key in ("chain", "sensors[0].kind", "sensors[1].kind", "runs[0].striker.speed_m_s"):
        assert key in str(error.value)
    text = (tmp_path / "r" / "record.yaml").read_text()
    assert "its gain is unknown" in text and "# To be filled in: the chain" in text
    written = yaml.safe_load(text)
    assert written["runs"][0]["signals"] == "shot.csv"


def test_nothing_is_overwritten_without_force(tmp_path):
    (tmp_path / "shot.csv").write_bytes(tbs(TIMES, PULSE))
    import_files([tmp_path / "shot.csv"], tmp_path / "r", options())
    with pytest.raises(InputError, match="--force"):
        import_files([tmp_path / "shot.csv"], tmp_path / "r", options())
    import_files([tmp_path / "shot.csv"], tmp_path / "r", options(), force=True)


def test_raw_files_are_never_overwritten(tmp_path):
    (tmp_path / "shot.csv").write_bytes(tbs(TIMES, PULSE))
    with pytest.raises(InputError, match="one of the files to import"):
        import_files([tmp_path / "shot.csv"], tmp_path, options(), force=True)
    (tmp_path / "r").mkdir()
    (tmp_path / "r" / "shot.csv").write_text("mine")
    with pytest.raises(InputError, match="exists already"):
        import_files([tmp_path / "shot.csv"], tmp_path / "r", options())
    assert (tmp_path / "r" / "shot.csv").read_text() == "mine"


def one_channel(volts):
    return table(["Time (s),Ampl (V)"], (TIMES, volts), form="{:.6e}")


def test_files_of_one_channel_each_are_one_run(tmp_path):
    files = [tmp_path / "F0000CH1.CSV", tmp_path / "F0000CH2.CSV"]
    for k, file in enumerate(files):
        file.write_bytes(one_channel((k + 1) * PULSE))
    import_files(files, tmp_path / "r", options())
    head = (tmp_path / "r" / "F0000.csv").read_text().split("\n")[0]
    assert head == "time_us,CH1,CH2"
    import_files(
        files, tmp_path / "s", options(run=(f"v1={files[1]},{files[0]}",), channel=("CH2=g9", "CH1=g5"))
    )
    assert (tmp_path / "s" / "v1.csv").read_text().startswith("time_us,g9,g5\n")


def test_a_run_has_the_name_of_its_file_and_that_of_the_given_record_is_missed(tmp_path):
    # Rohde & Schwarz call a file of samples shot1.Wfm.csv.
    file = tmp_path / "shot1.Wfm.csv"
    file.write_bytes(one_channel(PULSE))
    given = tmp_path / "chain.yaml"
    for id, missed in (("shot1", False), ("v044", True)):
        given.write_text(f"runs: [{{id: {id}, striker: {{speed_m_s: 0.44}}}}]\n")
        said = import_files([file], tmp_path / id, options(), record=given)
        assert (tmp_path / id / "shot1.csv").exists()
        assert any("no file is called like v044" in line and "--run v044=" in line for line in said) == missed


def test_a_name_of_a_file_writes_no_key_into_the_record(tmp_path):
    file = tmp_path / "shot\x1b[31m\nmaterials: {evil: 1}\n.csv"
    file.write_bytes(one_channel(PULSE))
    import_files([file], tmp_path / "r", options())
    written = (tmp_path / "r/record.yaml").read_text()
    assert "materials" not in yaml.safe_load(written)
    assert "\x1b" not in written
    assert "\x1b" not in listing.text(listing.listing([file]))


def test_lost_and_clipped_samples(tmp_path):
    volts = [f"{v}" for v in PULSE]
    volts[30], volts[118:123] = "NaN", ["overrange"] * 5
    rows = [f"{t:.6e},{v}" for t, v in zip(TIMES, volts, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join(["time (s),g (V)", *rows]))
    said = "\n".join(import_files([tmp_path / "a.csv"], tmp_path / "r", options()))
    assert "5 samples over range" in said and "1 lost" in said and "clipped" in said
    volts[30:60] = ["NaN"] * 30
    rows = [f"{t:.6e},{v}" for t, v in zip(TIMES, volts, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join(["time (s),g (V)", *rows]))
    with pytest.raises(InputError, match="30 samples in a row are lost"):
        import_files([tmp_path / "a.csv"], tmp_path / "q", options())


REFUSED = [
    ({"scale": ("CH1=12.5",)}, "two units"),
    ({"scale": ("g9=12.5N/V",)}, "no channel is 'g9'"),
    ({"scale": ("CH1=2N/Pa",)}, "is for N and Pa"),
    ({"scale": ("CH1",)}, "write it as in"),
    ({"channel": ("CH9=g9",)}, "named by --channel"),
    ({"place": ("CH1=first",)}, "number of its bead"),
    ({"speed": ("v9=1",)}, "no run is 'v9'"),
    ({"speed": ("-1",)}, "must be above 0"),
    ({"impact_at": ("3 V",)}, "number in s"),
    ({"run": ("v 1=a.csv",)}, "letters, digits"),
]


@pytest.mark.parametrize(("given", "said"), REFUSED)
def test_refused_options(given, said, tmp_path):
    (tmp_path / "shot.csv").write_bytes(tbs(TIMES, PULSE))
    with pytest.raises(InputError, match=said):
        import_files([tmp_path / "shot.csv"], tmp_path / "r", options(**given))
    assert not (tmp_path / "r").exists()


def test_listing(tmp_path):
    (tmp_path / "shot.csv").write_bytes(tbs(TIMES, PULSE))
    (tmp_path / "bad.csv").write_text("nothing here\n")
    files = [str(tmp_path / "shot.csv"), str(tmp_path / "bad.csv")]
    done = CliRunner().invoke(cli, ["record", "import", *files[:1], "--list", "--json"])
    assert done.exit_code == 0
    (entry,) = json.loads(done.stdout)
    assert (entry["file"], entry["layout"]) == (files[0], "tektronix")
    assert set(entry["channels"][0]) == {
        "name", "unit", "samples", "interval_s", "start_s", "minimum", "maximum", "notes"
    }  # fmt: skip
    assert entry["channels"][1]["maximum"] == pytest.approx(-PULSE.min())
    done = CliRunner().invoke(cli, ["record", "import", *files, "--list"])
    assert done.exit_code == 2
    assert "CH2" in done.stdout and "bad.csv" in done.stderr
    assert done.output.count("bad.csv") == 1


def test_columns_of_one_gauge_are_shots(tmp_path):
    raw = tmp_path / "shots.csv"
    raw.write_bytes(table(["time_us,shot1_V,shot2_V,other_V"], (1e6 * TIMES, PULSE, 0.5 * PULSE, PULSE)))
    chosen = options(channel=("shot1=g", "shot2=g"), scale=("g=1N/V",))
    import_files([raw], tmp_path / "record", chosen)
    record = yaml.safe_load((tmp_path / "record" / "record.yaml").read_text())
    assert [r["id"] for r in record["runs"]] == ["shots-1", "shots-2"]
    peaks = [
        np.genfromtxt(tmp_path / "record" / r["signals"], delimiter=",", names=True)["g"].max()
        for r in record["runs"]
    ]
    assert peaks[1] == pytest.approx(0.5 * peaks[0], rel=0.02)  # two per cent of noise on the baseline


def test_columns_that_do_not_pair_up_are_refused(tmp_path):
    raw = tmp_path / "shots.csv"
    raw.write_bytes(table(["time_us,a_V,b_V,c_V"], (1e6 * TIMES, PULSE, PULSE, PULSE)))
    with pytest.raises(InputError, match="two channels are g"):
        import_files(
            [raw], tmp_path / "record", options(channel=("a=g", "b=g", "c=h"), scale=("g=1N/V", "h=1N/V"))
        )
