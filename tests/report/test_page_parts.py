"""What a page adds to a verdict: where the data come from, what is folded, what it says of nothing."""

import html
import json
import re

import pytest
from made_chains import STEEL, record
from made_verdicts import model, verdict, write
from msgspec.structs import replace

from sonicvacuum.discover import given
from sonicvacuum.discover.verdict import write_json
from sonicvacuum.files import InputError
from sonicvacuum.report import next_run
from sonicvacuum.report.record import write_page


def test_a_page_opens_with_verdict_bench_chain_and_origin(folder):
    slow = {"slow": 1.04, "fast": 1.001}
    write_json(replace(model(verdict()), speed_ratio=slow), folder / "model.json")
    page = write_page(folder).read_text(encoding="utf-8")
    order = [
        "Steel balls &lt;in&gt; a row</h1>", "What is missing: Visco", "Check your set-up first", "<svg role",
        "12 beads of bearing-steel, 10 mm, 4 g, horizontal", "2026-05-01", "SHA-256 abab", "sonicvacuum 0.",
        "g1: 3 spikes left out.", "Where they disagree", "What it is", "How sure", "What else it could be",
        "How the gap shrinks", "What the others could still be", "What experiment would settle it",
    ]  # fmt: skip
    places = [page.index(part) for part in order]
    assert places == sorted(places)
    asked = (
        "speed in run slow: with what was named the data still ask for 1.04 times what is stated, 3.9 of the"
    )
    assert asked in html.unescape(page)
    assert "speed in run fast" not in page


def test_words_of_statisticians_stay_folded(folder):
    page = write_page(folder).read_text(encoding="utf-8")
    open_part = re.sub(r"<(details|script|style|svg).*?</\1>", "", page, flags=re.DOTALL)
    for jargon in ("χ", "Bayes", "posterior", "nuisance", "residual", "p-value", "likelihood"):
        assert jargon not in open_part


def test_runs_are_counted_without_the_line_of_all(folder):
    page = write_page(folder).read_text(encoding="utf-8")
    assert "Run by run (1)" in page  # the made table holds the run `slow` and a line `all`


def test_nothing_is_proposed_where_nothing_is_open(folder):
    sure = {"none": 0.0, "unknown": 0.001, "kuwabara-kono": 0.999}
    write_json(verdict(probabilities=sure), folder / "verdict.json")
    assert "What experiment" not in write_page(folder).read_text(encoding="utf-8")
    assert next_run.settled(verdict(probabilities=sure))
    assert not next_run.settled(verdict(probabilities=sure, confusable=[["kuwabara-kono", "tsuji"]]))
    assert not next_run.settled(verdict())


def test_a_folder_of_older_days_has_a_page_without_origin(tmp_path):
    page = write_page(write(tmp_path / "made", "single")).read_text(encoding="utf-8")
    assert "<h1>made</h1>" in page
    assert 'class="sketch"' not in page


def test_beads_that_differ_come_back_by_their_numbers(tmp_path):
    """JSON has texts for keys, a record has numbers of beads: a sensor of another mass ended every page."""
    chain = {"beads": 12, "orientation": "vertical", "bead": STEEL, "wall": {"material": "brass"}}
    one = record(chain=chain | {"bodies": {5: {"mass_g": 4.5, "faces": "flat"}}})
    made = write(tmp_path / "made", "single")
    write_json(given.inputs((one,)), made / given.FILE)
    _, (read,) = given.read(made)
    assert read.block == one.block
    assert "bead 5 bearing-steel, 10 mm, 4.5 g, flat faces" in write_page(made).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "text", ["{", '{"format": 1}', json.dumps({"version": "1", "records": [{"name": 3}]})]
)
def test_a_damaged_origin_is_refused(folder, text):
    (folder / given.FILE).write_text(text)
    with pytest.raises(InputError, match=r"given\.json: not what sonicvacuum discover writes"):
        write_page(folder)


def test_data_that_test_nothing_have_a_page_without_probabilities(folder):
    blank = verdict(named=[], parameters={}, upper_limits={}, not_testable=["gravity"])
    write_json(blank, folder / "verdict.json")
    page = write_page(folder).read_text(encoding="utf-8")
    sure = page[page.index("How sure") : page.index("What else it could be")]
    assert "can test no effect of the catalogue, so no probabilities are given" in sure
    assert "bars" not in sure
