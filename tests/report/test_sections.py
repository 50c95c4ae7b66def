"""The sections of the report on discoveries and on the blind test."""

import pandas as pd
import pytest
from made_verdicts import write

from sonicvacuum.files import InputError
from sonicvacuum_blind import report as study
from sonicvacuum_blind.page import build as blind_page
from sonicvacuum_paper.report import publish, tables
from sonicvacuum_paper.report.page import CLAIMS, Sources, build, sure

FIRST = ("measure", "group", "count", "value", "low", "high", "goal")
SUMMARY = [
    ("named on null", "white", "8", "0", "0", "0.324", "<= 0.01"),
    ("exact pair", "each d' 10", "0", "nan", "nan", "nan", ">= 0.86"),
    ("seconds per record", "median", "36", "12.3", "1", "20", ""),
]


@pytest.fixture
def summary(tmp_path):
    path = tmp_path / "summary.csv"
    table = pd.DataFrame(SUMMARY, columns=FIRST).reindex(columns=study.SUMMARY, fill_value="nan")
    table.to_csv(path, index=False)
    return path


@pytest.fixture
def empty(tmp_path):
    """Paths of the pipeline's tables, without rows."""
    columns = {"ledger": tables.LEDGER, "assumptions": tables.ASSUMPTIONS, "metrics": tables.METRICS}
    for name, header in {**columns, "claims": CLAIMS}.items():
        pd.DataFrame(columns=header).to_csv(tmp_path / f"{name}.csv", index=False)
    return [tmp_path / f"{name}.csv" for name in ("ledger", "assumptions", "metrics", "claims")]


def test_the_report_says_what_is_found_in_each_record_and_links_its_page(empty, tmp_path):
    folder = write(tmp_path / "found", "single")
    page = build(Sources(*empty, discoveries=[folder]))
    assert 'id="record-made"' in page
    assert 'href="discover/made/index.html"' in page
    assert "What is missing: Viscoelastic Hertz contact (kuwabara-kono)" in page


def test_a_report_without_discoveries_and_studies_says_so(empty):
    page = build(Sources(*empty))
    assert "No record has been looked into." in page
    assert "No table of the full study has been made." in page
    assert blind_page().count("No table of this study has been made.") == 2


def test_what_the_paper_leaves_open_has_a_page_of_its_own_where_one_is_linked(empty):
    inside, apart = build(Sources(*empty)), build(Sources(*empty, linked=["sure.html"]))
    assert "Nothing has been drawn." in inside
    assert 'href="sure.html"' in apart
    assert "Nothing has been drawn." not in apart
    assert "Nothing has been drawn." in sure(Sources(*empty))


def test_rows_without_cases_and_times_are_left_out(summary):
    (row,) = study.findings(tables.read(summary, study.SUMMARY)).rows
    assert row == ["effect named where none is hidden", "white noise", "8", "0", "0 to 0.324", ""]


def test_a_summary_with_other_columns_is_refused(tmp_path):
    path = tmp_path / "summary.csv"
    path.write_text("measure,share\nnamed,1\n")
    with pytest.raises(InputError, match=r"summary\.csv: columns are measure,share"):
        study.read(tmp_path)


def test_the_full_study_stands_with_its_pictures_before_the_small_one(empty, summary, tmp_path):
    drawing = tmp_path / "blind_accuracy.svg"
    drawing.write_text('<svg width="500pt"><g id="a"/></svg>')
    page = blind_page(summary, tmp_path, [(drawing, "What the picture shows.")])
    assert "36 records. Of 1 goals 0 are met, 1 open and 0 missed" in page
    assert page.index("What the picture shows.") < page.index("The small study of this run</h2>")
    assert "<td>effect named where none is hidden</td><td>white noise</td>" in page
    assert "No table of this study has been made." not in page
    assert "36 records; of 1 goals" in build(Sources(*empty, blind_full=tmp_path))


def test_what_is_kept_of_a_study_is_its_naming(tmp_path):
    scores, kept = tmp_path / "score.csv", tmp_path / "kept.csv"
    scores.write_text("id,kind,effects,named,exact,seconds\na,single,tsuji,tsuji,1,3.2\nb,null,,,1,2.1\n")
    publish.publish_study(scores, kept)
    assert kept.read_text() == "id,kind,effects,named,exact\na,single,tsuji,tsuji,1\nb,null,,,1\n"
    scores.write_text("id,kind\n")
    with pytest.raises(InputError, match="no column effects"):
        publish.naming(scores)


def test_printed_values_are_set_with_powers_of_ten(empty):
    row = dict.fromkeys(tables.LEDGER, "") | {
        "claim": "theory-exponent", "section": "Eq. 6", "kind": "theory", "quantity": "slope", "unit": "1",
        "measured": "0.1666667", "sigma": "1e-6", "verdict": "agrees", "reason": "slope 0.1666667.",
    }  # fmt: skip
    pd.DataFrame([row]).to_csv(empty[0], index=False)
    claim = dict.fromkeys(CLAIMS, "") | {
        "claim": "theory-exponent",
        "statement": "As a root.",
        "test": "equals",
    }
    pd.DataFrame([claim]).to_csv(empty[3], index=False)
    told = build(Sources(*empty)).split('id="claim-theory-exponent"')[1].split("</tr>")[0]
    assert "1e-6" not in told and "10⁻⁶" in told
