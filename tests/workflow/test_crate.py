"""The check of an RO-Crate finds what does not fit, and the table of a plain processor what differs."""

import hashlib
import json
import os
import sys

import pandas as pd
import pytest

sys.path.insert(0, f"{os.path.dirname(__file__)}/../../workflow/scripts")

import crate
import generic
import generic_verdicts


@pytest.fixture
def folder(tmp_path):
    """A crate of one product."""
    (tmp_path / "ledger.csv").write_text("claim,verdict\n")
    digest = hashlib.sha256((tmp_path / "ledger.csv").read_bytes()).hexdigest()
    root = {key: "x" for key in ("name", "description", "license", "datePublished")}
    graph = [
        {"@id": "./", "@type": "Dataset", "mainEntity": {"@id": "Snakefile"}, **root},
        {"@id": "Snakefile", "@type": ["File", "ComputationalWorkflow"]},
        {"@id": "ledger.csv", "@type": "File", "sha256": digest},
        {
            "@id": "#run",
            "@type": "CreateAction",
            "instrument": {"@id": "Snakefile"},
            "object": [{"@id": "Snakefile"}],
            "result": [{"@id": "ledger.csv"}],
        },
    ]
    (tmp_path / "ro-crate-metadata.json").write_text(json.dumps({"@graph": graph}))
    return tmp_path


def test_a_whole_crate_has_no_fault(folder):
    assert crate.faults(folder) == []


def test_a_folder_of_any_name_is_found(folder):
    (folder / "a b #%41 ü").mkdir()
    (folder / "ledger.csv").rename(folder / "a b #%41 ü/ledger.csv")
    path = folder / "ro-crate-metadata.json"
    path.write_text(path.read_text().replace("ledger.csv", "a%20b%20%23%2541%20%C3%BC/ledger.csv"))
    assert crate.faults(folder) == []


def test_a_product_that_was_changed_or_lost_is_named(folder):
    (folder / "ledger.csv").write_text("claim,verdict\nx,agrees\n")
    assert crate.faults(folder) == ["ledger.csv: not the file that is described"]
    (folder / "ledger.csv").unlink()
    assert crate.faults(folder) == ["ledger.csv: missing"]


@pytest.mark.parametrize(
    ("removed", "told"),
    [
        ("Snakefile", ["mainEntity: no ComputationalWorkflow", "Snakefile: not described"]),
        ("ledger.csv", ["ledger.csv: not described"]),
        ("#run", ["no CreateAction"]),
    ],
)
def test_what_the_profile_asks_for_is_missed(folder, removed, told):
    path = folder / "ro-crate-metadata.json"
    graph = [entity for entity in json.loads(path.read_text())["@graph"] if entity["@id"] != removed]
    path.write_text(json.dumps({"@graph": graph}))
    assert crate.faults(folder) == told


def test_the_table_of_a_plain_processor_counts_what_lies_beyond():
    kept = pd.DataFrame({"name": ["a", "b"], "value": ["1.0", "-2.0"]})
    rule = {"table": "t", "column": "value", "absolute": 0.0, "relative": 1e-3, "reason": "test"}
    for fresh, beyond in ((["1.0001", "-2.0"], 0), (["1.0", "-2.01"], 1)):
        found = generic.rows(kept, kept.assign(value=fresh), "t", pd.DataFrame([rule]))
        assert [(row["column"], row["beyond_tolerance"]) for row in found] == [
            ("value", beyond),
            ("(words)", 0),
        ]
    assert float(found[0]["largest_difference"]) == pytest.approx(0.01)
    assert float(found[0]["relative"]) == pytest.approx(0.005)
    words = generic.rows(kept, kept.assign(name=["a", "c"]), "t", pd.DataFrame([rule]))
    assert words[-1]["beyond_tolerance"] == 1


def test_verdicts_are_apart_by_their_numbers_and_wholly_by_their_names():
    value = {"value": 1.0, "sigma": 0.1}
    one = {
        "named": ["tsuji"], "confusable": [], "not_testable": [],
        "probabilities": {"tsuji": 0.9, "none": 0.1},
        "parameters": {"tsuji": {"alpha": value}}, "upper_limits": {"gravity": {"fraction": 2.0}},
        "gap": {"fitted": {"before": 9.0, "after": 1.0}},
    }  # fmt: skip
    assert set(generic_verdicts.apart(one, one).values()) == {0.0}
    other = one | {
        "probabilities": {"tsuji": 0.8, "none": 0.1, "hunt-crossley": 0.15},
        "parameters": {"tsuji": {"alpha": value | {"value": 1.01}}},
        "upper_limits": {"gravity": {"fraction": 2.2}},
        "gap": {"fitted": {"before": 9.5, "after": 1.0}},
    }
    found = generic_verdicts.apart(one, other)
    assert found == pytest.approx(
        {"probabilities": 0.15, "gap": 0.5, "parameters, in errors": 0.1, "limits": 0.1}
    )
    assert set(generic_verdicts.apart(one, one | {"named": ["unknown"]}).values()) == {float("inf")}
