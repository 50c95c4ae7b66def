"""The blind study's tables in README and report."""

import math
import re

import pandas as pd
import pytest
from click.testing import CliRunner

from sonicvacuum.cli import cli
from sonicvacuum.files import InputError
from sonicvacuum_blind import kept, page, published, words
from sonicvacuum_blind import report as study
from sonicvacuum_blind.baselines import names
from sonicvacuum_blind.baselines.table import RuleLine as Baseline
from sonicvacuum_blind.kept import TABLES
from sonicvacuum_blind.score import SummaryLine, write_table

NAN = math.nan
README = f"# Title\n\n{published.BEGIN}\nformer text\n{published.END}\n\nafter\n"


@pytest.fixture
def folder(tmp_path):
    """Folder with all tables of a study."""
    lines = [
        SummaryLine("exact name", "traces, d' 10", 200, 0.96, 0.92, 0.98, 0.97, 0.99, ">= 0.95"),
        SummaryLine("exact name", "traces, d' 20", 200, 0.97, 0.94, 0.985, 0.98, 0.99, ">= 0.99"),
        SummaryLine("named on null", "white", 300, 0.02, 0.01, 0.05, NAN, NAN, "<= 0.01"),
        SummaryLine(
            "90 % interval holds truth", "named rightly", 50, 0.9, 0.8, 0.96, NAN, NAN, "0.87 to 0.93"
        ),
        SummaryLine("exact name", "scalars", 0, NAN, NAN, NAN, NAN, NAN, ">= 0.83"),
        SummaryLine("seconds per record", "single, median", 220, 3.0, 2.8, 3.2, NAN, NAN, "<= 5"),
        SummaryLine("seconds per record", "single, 90th percentile", 220, 6.0, 5.0, 7.0, NAN, NAN, ""),
        SummaryLine("seconds per record", "null, median", 300, 2.0, 1.8, 2.2, NAN, NAN, ""),
    ]
    rivals = [
        Baseline("sonicvacuum", names.EXACT, names.SINGLES, 220, 0.955, 0.92, 0.975, ""),
        Baseline("bic", names.EXACT, names.SINGLES, 220, 0.7, 0.64, 0.76, ""),
        Baseline("bic", names.ALARM, names.NULLS, 40, 0.5, 0.35, 0.65, ""),
        Baseline("ideal rule", names.EXACT, names.SINGLES, 220, 0.97, NAN, NAN, "computed"),
    ]
    followed = [
        SummaryLine("resolved by one more run", "proposed", 40, 0.85, 0.71, 0.93, NAN, NAN, ">= 0.8"),
        SummaryLine("resolved by one more run", "random", 40, 0.4, 0.26, 0.55, NAN, NAN, ""),
    ]
    made = tmp_path / "made"
    for name, rows, kind in (
        ("summary", lines, SummaryLine),
        ("baselines", rivals, Baseline),
        ("resolved_summary", followed, SummaryLine),
    ):
        write_table(rows, kind, made / f"{name}.csv")
    for name in ("confusion", "accuracy", "reliability", "coverage"):
        (made / f"{name}.csv").write_text(f"{name}\n")
    return made


def test_goals_are_held_against_what_was_found(folder):
    found = study.results(study.read(folder).summary)
    assert len(found.header) == len(found.rows[0])
    assert [row[-1] for row in found.rows][:3] == [
        "open",
        "missed, by the ideal rule too",
        "open",
    ]
    assert found.rows[0][3:7] == ["0.96", "0.92 to 0.98", "0.97", "≥ 0.95"]


@pytest.mark.parametrize(
    ("goal", "bounds", "expected"),
    [
        (">= 0.9", (0.91, 0.97), "met"),
        (">= 0.9", (0.89, 0.97), "open"),
        (">= 0.9", (0.85, 0.89), "missed"),
        ("<= 0.05", (0.0, 0.05), "met"),
        (">= 0.97 of ideal", (0.78, 0.9), "met"),  # 0.776 of an ideal of 0.8
        (">= 0.97 of ideal", (0.77, 0.9), "open"),
        ("0.87 to 0.93", (0.88, 0.95), "open"),
        ("<= 0.05", (NAN, NAN), "missed"),  # the value itself, where there is no interval
        ("", (0.1, 0.2), ""),
    ],
)
def test_a_goal_is_open_where_the_interval_straddles_it(goal, bounds, expected):
    low, high = map(str, bounds)
    found = {"value": "0.88", "low": low, "high": high, "ideal": "0.8", "goal": goal}
    assert study.reached(found) == expected


def test_a_small_study_is_shown_without_judgement_and_times(folder):
    found = study.findings(study.read(folder).summary)
    assert [row[0] for row in found.rows] == ["one hidden effect named exactly"] * 2 + [
        "effect named where none is hidden",
        "the stated 90 % interval holds the truth",
    ]
    assert not {"met", "missed"} & {cell for row in found.rows for cell in row}


def test_rules_stand_in_one_line_each_in_the_order_of_the_words(folder):
    found = study.rivals(study.read(folder).baselines)
    rows = found.rows
    assert found.header == ["rule", "exact name", "false alarm", "wrong name", "remarks"]
    assert [row[0] for row in rows] == ["this method", "ideal rule (computed)", "BIC"]
    assert rows[1][1] == "97.0 %, 220 cases"
    assert rows[2][1:4] == ["70.0 % (64.0 to 76.0), 220 cases", "50.0 % (35.0 to 65.0), 40 cases", "–"]


def test_the_readme_holds_all_tables_and_counts_the_goals(folder):
    text = published.markdown(study.read(folder))
    # Lines with cases, then rules, then further runs; each table with a header.
    assert "\n520 records. Of 6 goals 1 are met, 4 open and 1 missed" in text
    assert text.count("\n| ") == (7 + 2) + (3 + 2) + (2 + 2)
    assert "](../figures/blind_accuracy.png)" in text
    alone = "one more run leaves the right name alone"
    assert f"| {alone} | the proposed run | 40 | 0.85 | 0.71 to 0.93 | ≥ 0.8 | open |" in text


def test_publish_keeps_tables_and_renews_the_readme(folder, tmp_path):
    readme, kept = tmp_path / "README.md", tmp_path / "kept"
    readme.write_text(README)
    call = ["blind", "publish", str(folder), f"--page={readme}", f"--keep={kept}"]
    done = CliRunner().invoke(cli, call)
    assert done.exit_code == 0, done.output
    names = sorted(path.name for path in folder.iterdir())
    assert sorted(path.name for path in kept.iterdir()) == names
    assert all((kept / name).read_bytes() == (folder / name).read_bytes() for name in names)
    assert "former text" not in readme.read_text()
    assert readme.read_text().endswith(f"{published.END}\n\nafter\n")


def test_a_table_that_is_no_longer_made_is_not_kept(folder, tmp_path):
    readme = tmp_path / "README.md"
    readme.write_text(README)
    published.publish(folder, readme, tmp_path / "kept")
    (folder / "resolved_summary.csv").unlink()
    published.publish(folder, readme, tmp_path / "kept")
    assert not (tmp_path / "kept" / "resolved_summary.csv").exists()
    assert "one more run" not in readme.read_text()


@pytest.mark.parametrize("fault", ["no markers", "no table"])
def test_what_is_missing_leaves_everything_as_it_was(folder, tmp_path, fault):
    readme = tmp_path / "README.md"
    readme.write_text("# Title\n" if fault == "no markers" else README)
    before = readme.read_text()
    if fault == "no table":
        (folder / "coverage.csv").unlink()
    expected = "markers are missing" if fault == "no markers" else r"coverage\.csv: No such file"
    with pytest.raises(InputError, match=expected):
        published.publish(folder, readme, tmp_path / "kept")
    assert readme.read_text() == before
    assert not (tmp_path / "kept").exists()


def test_the_committed_page_shows_the_committed_tables(pytestconfig):
    text = (pytestconfig.rootpath / "docs/study.md").read_text(encoding="utf-8")
    assert text.count(published.BEGIN) == text.count(published.END) == 1
    made = published.markdown(study.read(pytestconfig.rootpath / TABLES))
    assert published.with_study(text, made) == text
    readme = (pytestconfig.rootpath / "README.md").read_text(encoding="utf-8")
    short = published.in_short(study.read(pytestconfig.rootpath / TABLES))
    assert published.with_study(readme, short, "README.md") == readme


def test_names_given_to_foreign_effects_are_counted_alike_for_both_rules(pytestconfig):
    """Ours without a word of unknown are fewer, but BIC has no such word."""
    tables = study.read(pytestconfig.rootpath / TABLES)
    rows = {(r["rule"], r["measure"]): r for r in tables.baselines.to_dict("records")}
    told = published.in_short(tables).splitlines()[-1]
    for rule in ("bic", "sonicvacuum"):
        assert (
            study.percent(rows[rule, names.WRONG]) in told and study.percent(rows[rule, names.ALARM]) in told
        )
    assert "any name counts, also one beside which something unknown" in told


def test_the_page_of_two_studies_shows_what_their_rows_come_to(pytestconfig, tmp_path):
    kept = pytestconfig.rootpath / "workflow/resources/reference"
    folders = [str(kept / "blind_full"), str(kept / "blind_before")]
    done = CliRunner().invoke(
        cli, ["blind", "tables", *folders, "--out", str(tmp_path)], catch_exceptions=False
    )
    assert done.exit_code == 0
    made, committed = tmp_path / "summary.csv", kept / "blind_both/summary.csv"
    assert made.read_text() == committed.read_text()
    table = study.results(pd.read_csv(committed, keep_default_na=False, dtype=str))
    assert table.markdown in (pytestconfig.rootpath / "docs/both.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("asked", [1, 3])
def test_the_page_says_about_how_many_records_the_ideal_rule_was_asked(asked):
    errors = ["0.5" if k < asked else "nan" for k in range(3)]
    text = published.provenance(pd.DataFrame({"kind": "single", "seconds": 3600.0, "errors_before": errors}))
    assert "3 with one effect" in text and "Verdicts took 3.0 hours" in text
    assert ("The ideal rule was asked about 1 of them" in text) == (asked == 1)
    assert ("ideal rule" in text) == (asked == 1)


def test_no_key_of_the_tables_is_shown_to_readers(pytestconfig):
    """Each measure and group of the study that is kept is told in words."""
    kept = study.read(pytestconfig.rootpath / TABLES).summary
    for measure, group in zip(kept["measure"], kept["group"], strict=True):
        assert words.asked(measure) != measure
        parts = set(words.group(group).split(", "))
        assert not parts & {"single", "pair", "set", "null", "foreign", "white", "ar1", "quantised", "cells"}


def test_the_page_leaves_out_groups_too_small_for_an_interval_and_says_when_a_goal_is_met(pytestconfig):
    text = page.build(full_folder=pytestconfig.rootpath / TABLES)
    fresh = text[text.index("Fresh runs foretold") : text.index('id="small"')]
    counts = [int(n) for n in re.findall(r'<td class="n">(\d+)</td><td class="n">[^<]*</td>', fresh)]
    all_counts = study.read(pytestconfig.rootpath / TABLES).fresh["count"].astype(int)
    assert sorted(counts) == sorted(all_counts[all_counts >= page.FEWEST])
    assert "missed if none of it does, and open otherwise" in text


def test_the_caption_counts_the_empty_records_that_its_picture_leaves_out(pytestconfig):
    folder = pytestconfig.rootpath / TABLES
    rows = pd.read_csv(folder / "confusion.csv", keep_default_na=False)
    shown = rows.loc[rows["hidden"] == "none", "count"].sum()
    rivals = study.read(folder).baselines
    every = rivals.loc[(rivals["rule"] == "sonicvacuum") & (rivals["group"] == names.NULLS), "count"].item()
    assert f" {int(every) - shown} further empty ones" in kept.caption("blind_confusion")
