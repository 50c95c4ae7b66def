"""The blind study's tables in README and report."""

import math

import pytest
from click.testing import CliRunner

from sonicvacuum.baselines import names
from sonicvacuum.baselines.table import Line as Baseline
from sonicvacuum.blind.score import Line, write_table
from sonicvacuum.cli import cli
from sonicvacuum.files import InputError
from sonicvacuum.report import study

NAN = math.nan
README = f"# Title\n\n{study.BEGIN}\nformer text\n{study.END}\n\nafter\n"


@pytest.fixture
def paths(tmp_path):
    """Paths of a summary and a table of baselines."""
    lines = [
        Line("exact name", "traces, d' 10", 200, 0.96, 0.92, 0.98, 0.97, 0.99, ">= 0.95"),
        Line("named on null", "white", 300, 0.02, 0.01, 0.05, NAN, NAN, "<= 0.01"),
        Line("90 % interval holds truth", "named rightly", 50, 0.9, 0.8, 0.96, NAN, NAN, "0.87 to 0.93"),
        Line("exact name", "scalars", 0, NAN, NAN, NAN, NAN, NAN, ">= 0.83"),
        Line("seconds per record", "single, median", 220, 3.0, 2.8, 3.2, NAN, NAN, "<= 5"),
        Line("seconds per record", "single, 90th percentile", 220, 6.0, 5.0, 7.0, NAN, NAN, ""),
        Line("seconds per record", "null, median", 300, 2.0, 1.8, 2.2, NAN, NAN, ""),
    ]
    rivals = [
        Baseline("sonicvacuum", names.EXACT, names.SINGLES, 220, 0.955, 0.92, 0.975, ""),
        Baseline("bic", names.EXACT, names.SINGLES, 220, 0.7, 0.64, 0.76, ""),
        Baseline("bic", names.ALARM, names.NULLS, 40, 0.5, 0.35, 0.65, ""),
        Baseline("ideal rule", names.EXACT, names.SINGLES, 220, 0.97, NAN, NAN, "computed"),
    ]
    found = tmp_path / "summary.csv", tmp_path / "baselines.csv"
    write_table(lines, Line, found[0])
    write_table(rivals, Baseline, found[1])
    return found


def test_goals_are_held_against_what_was_found(paths):
    header, rows = study.results(study.read(*paths)[0])
    assert len(header) == len(rows[0])
    assert [row[-1] for row in rows][:3] == ["met", "missed", "met"]
    assert rows[0][3:7] == ["0.96", "0.92 to 0.98", "0.97", "≥ 0.95"]


def test_rules_stand_in_one_line_each_in_the_order_of_the_words(paths):
    header, rows = study.rivals(study.read(*paths)[1])
    assert header == ["rule", "exact name", "false alarm", "wrong name", "remarks"]
    assert [row[0] for row in rows] == ["this method", "ideal rule (computed)", "BIC"]
    assert rows[1][1] == "97.0 %, 220 cases"
    assert rows[2][1:4] == ["70.0 % (64.0 to 76.0), 220 cases", "50.0 % (35.0 to 65.0), 40 cases", "–"]


def test_markdown_and_html_hold_the_same_cells(paths):
    tables = study.read(*paths)
    text, page = study.markdown(*tables), study.html(*tables)
    assert text.startswith("520 records. Of 4 goals set beforehand 3 are met, 1 missed")
    assert text.count("\n| ") + text.startswith("| ") == 4 + 1 + 7 + 1
    assert page.count("<tr>") == 7 + 4
    assert "&lt;" not in page
    assert "95 % intervals" in text


def test_publish_keeps_tables_and_renews_the_readme(paths, tmp_path):
    readme, reference = tmp_path / "README.md", tmp_path / "reference"
    readme.write_text(README)
    reference.mkdir()
    files = [f"--summary={paths[0]}", f"--baselines={paths[1]}"]
    done = CliRunner().invoke(
        cli, ["publish-study", *files, f"--readme={readme}", f"--reference={reference}"]
    )
    assert done.exit_code == 0, done.output
    assert (reference / "blind_full.csv").read_bytes() == paths[0].read_bytes()
    assert (reference / "blind_full_baselines.csv").read_bytes() == paths[1].read_bytes()
    assert "former text" not in readme.read_text()
    assert readme.read_text().endswith(f"{study.END}\n\nafter\n")


def test_readme_without_markers_leaves_everything_as_it_was(paths, tmp_path):
    readme = tmp_path / "README.md"
    readme.write_text("# Title\n")
    with pytest.raises(InputError, match="markers are missing"):
        study.publish(*paths, readme, tmp_path)
    assert readme.read_text() == "# Title\n"
    assert not (tmp_path / "blind_full.csv").exists()


def test_committed_readme_has_the_markers(pytestconfig):
    text = (pytestconfig.rootpath / "README.md").read_text(encoding="utf-8")
    assert text.count(study.BEGIN) == text.count(study.END) == 1
