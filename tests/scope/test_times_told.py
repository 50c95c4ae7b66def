"""What `record import` tells of a trace, and what the help of two verbs says of the speed."""

from click.testing import CliRunner

from sonicvacuum.cli import cli


def test_arrivals_are_told_in_microseconds(tmp_path):
    rows = "\n".join(f"{k * 2e-6:.6g},{10.0 * (90 <= k < 110) + 0.01 * (-1) ** k:.4g}" for k in range(300))
    (tmp_path / "v1.csv").write_text(f"time (s),force (N)\n{rows}\n")
    done = CliRunner().invoke(
        cli, ["record", "import", str(tmp_path / "v1.csv"), "--out", str(tmp_path / "made")]
    )
    assert " us of the recorder, " in done.output and " us wide at half height" in done.output


def test_no_help_speaks_of_an_option_that_its_verb_lacks():
    for verb, has in (("predict", True), ("design", False)):
        assert ("--aim" in CliRunner().invoke(cli, [verb, "--help"]).output) == has


def test_times_that_are_not_read_are_told_behind_a_count_of_scans(tmp_path):
    rows = "\n".join(f"{k},03/02/2020 10:11:12:{k:03d},{0.1 * (k % 7)}" for k in range(1, 100))
    (tmp_path / "v1.csv").write_text(f"Scan,Time,F (N)\n{rows}\n")
    done = CliRunner().invoke(
        cli, ["record", "import", str(tmp_path / "v1.csv"), "--out", str(tmp_path / "made")]
    )
    told = "line 2, column 2: '03/02/2020 10:11:12:001' is no number; give --interval"
    assert told in str(done.exception) and not (tmp_path / "made").exists()
