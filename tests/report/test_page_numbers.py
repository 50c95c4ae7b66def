"""Numbers of a page: digits that say something, no certainty, one order of columns."""

import html
from types import SimpleNamespace

import numpy as np
import pytest
from made_verdicts import model, verdict, write
from msgspec.structs import replace

from sonicvacuum.discover.draws import SAMPLED, Draws
from sonicvacuum.discover.judge.strained import ONLY_WITH
from sonicvacuum.discover.verdict import Value, write_json
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.report import bench, inline, record, rows, tables
from sonicvacuum.report.record import write_page


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        ("1.0001", "1.000"),
        ("0.99996", "1.000"),
        ("15478.2", "15478"),
        ("0.0308", "0.03080"),
        ("0", "0"),
        ("", ""),
    ],
)
def test_numbers_of_one_column_keep_their_zeros(value, shown):
    assert tables.digits(value) == shown


def test_models_are_told_to_the_decimals_of_what_was_measured():
    row = {
        "run": "v0", "quantity": "restitution", "measured": "0.982", "sigma": "0.005",
        "unit": "1", "bound": "",
        "nominal": "1", "extended": "0.96824", "held_out": "",
    }  # fmt: skip
    (told,) = rows.quantities([row])
    assert [told[k] for k in ("measured", "nominal", "extended", "held_out")] == [
        "0.982 ± 0.005", "1.000", "0.968", "",
    ]  # fmt: skip


def test_an_interval_that_leans_to_one_side_keeps_two_digits_there():
    value = np.linspace(0.0003, 0.12, 1001)
    share = np.exp(-value / 0.03) / np.exp(-value / 0.03).sum()
    drawn = Draws("tsuji", "alpha", SAMPLED, value, share)
    found = verdict(parameters={"tsuji": {"alpha": Value(value=0.02, sigma=0.03)}})
    (one,) = rows.effects(found, CATALOGUE, {("tsuji", "alpha"): drawn})
    low, high = one["parameters"][0]["interval"].split(" to ")
    assert (len(low), len(high)) == (6, 6) and float(low) > 0.0  # 0.0018 and 0.0826


def test_candidates_are_told_without_their_ids_and_never_with_certainty():
    row = {"effects": "mass-defect", "parameters": "mass-defect mass_ratio 1.142541; mass-defect bead 8"}
    told = rows.candidate(row | {"probability": "0.99999"}, [], CATALOGUE)
    assert told["parameters"] == "mass_ratio 1.143; bead 8" and told["probability"] == "above 0.99"
    assert rows.candidate(row | {"probability": "0.0"}, [], CATALOGUE)["probability"] == "below 1e-300"


def test_features_stand_in_one_order_whatever_the_first_gauge_shows():
    cells = [
        {"run": "a", "sensor": g, "feature": f, "z_before": "1"}
        for g, f in (("g1", "baseline"), ("g2", "amplitude"), ("g2", "mine"), ("g2", "tail"))
    ]
    found = rows.grid(cells)
    assert found["features"] == ["amplitude", "tail", "baseline", "mine"]
    assert found["gaps"] and not rows.grid(cells[:1])["gaps"]  # which the page explains


def test_a_page_is_set_with_the_signs_of_print(tmp_path):
    """Minus signs and powers of ten in sentences too, and no line that begins with a per cent sign."""
    said = f"{ONLY_WITH} the time zero of run slow shifted by -2.3 µs, 7.7 of its stated errors away"
    folder = write(tmp_path / "made", "single")
    write_json(verdict(reasons=[said], alarms={"none": 3.9e-253}), folder / "verdict.json")
    text = html.unescape(write_page(folder).read_text(encoding="utf-8"))
    assert "shifted by −2.3 µs" in text and "shifted by -2.3" not in text
    assert "with probability 3.9\N{NO-BREAK SPACE}×\N{NO-BREAK SPACE}10⁻²⁵³" in text
    assert "99.9\N{NO-BREAK SPACE}% of the gap closed" in text
    assert inline.typeset("SHA-256 12e5…, run1e-3 and 1e6") == "SHA-256 12e5…, run1e-3 and 10⁶"


def test_a_page_on_several_records_has_all_their_titles():
    of = [SimpleNamespace(title=name) for name in ("Monday", "Tuesday", "Monday")]
    assert record._title(of) == "Monday; Tuesday"
    assert record._title([SimpleNamespace(title=str(k)) for k in range(9)]) == "0 and 8 further records"


@pytest.mark.parametrize(("kind", "held_out"), [("single", True), ("scalars", False)])
def test_a_page_on_one_run_has_no_columns_of_what_was_left_out(tmp_path, kind, held_out):
    text = write_page(write(tmp_path / "made", kind)).read_text(encoding="utf-8")
    assert ("Left out, nominal" in text) == held_out == ("There is one run only" not in text)


def test_what_stays_as_recorded_has_gauges_only_where_there_are_any():
    still = {"modulus_ratio": 1.0, "speed_ratio": {"v0": 1.0}, "trigger_us": {"v0": 0.0}}
    ball = replace(model(verdict()), **still, gain={})
    assert bench.nuisances(ball, verdict()) == (
        "What has an error in the record (speeds, modulus) stays as recorded."
    )
    assert "time zeros, gains" in bench.nuisances(replace(ball, gain={"g1": 1.0}), verdict())
