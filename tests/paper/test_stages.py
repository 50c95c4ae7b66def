"""The stages as the command line calls them: files in, files out, the same bytes again."""

from pathlib import Path

import pytest

from sonicvacuum.files import InputError
from sonicvacuum_paper.rows import read_rows, write_rows
from sonicvacuum_paper.stages import write_assumptions, write_ledger, write_metrics

RESOURCES = Path(__file__).parents[2] / "workflow" / "resources"


def made(folder, simulated, cases):
    for name, rows in simulated.items():
        write_rows(rows, folder / "metrics" / f"{name}.csv")
    write_metrics([folder / "metrics" / f"{name}.csv" for name in simulated], cases, folder / "metrics.csv")
    write_ledger(folder / "metrics.csv", RESOURCES / "claims.csv", cases, folder / "ledger.csv")
    write_assumptions(
        folder / "metrics.csv", RESOURCES / "assumptions.csv", cases, folder / "assumptions.csv"
    )
    return {path.name: path.read_bytes() for path in folder.glob("*.csv")}


def test_tables_are_complete_and_repeatable(tmp_path, simulated, cases, all_rows):
    first = made(tmp_path / "one", simulated, cases)
    assert set(first) == {"metrics.csv", "absent.csv", "ledger.csv", "assumptions.csv"}
    assert first == made(tmp_path / "other", simulated, cases)
    back = read_rows(tmp_path / "one" / "metrics.csv", tmp_path / "one" / "absent.csv")
    assert {r.key for r in back} == {r.key for r in all_rows}
    assert all(r.reason for r in back if not r.known)


def test_a_configuration_of_one_case_still_makes_all_tables(tmp_path, simulated, cases):
    # fig3a alone: what needs other cases is not testable, nothing fails
    few = type(cases)(cases={"fig3a": cases.cases["fig3a"]}, ledger=cases.ledger)
    only = {name: rows for name, rows in simulated.items() if name.startswith("fig3a.")}
    text = made(tmp_path, only, few)["ledger.csv"].decode()
    assert "fig3b/speed/g9-g5 has not been found in any column" in text
    assert "layer, 2.76 GPa: speed 226.8 against 197" in text


def test_without_fig3a_no_column_has_a_modulus(tmp_path, simulated, cases):
    few = type(cases)(cases={"fig3b": cases.cases["fig3b"]}, ledger=cases.ledger)
    only = {name: rows for name, rows in simulated.items() if name.startswith("fig3b.")}
    text = made(tmp_path, only, few)["ledger.csv"].decode()
    assert "theory/core_contact_force/ has not been found" in text


def test_metrics_of_some_cards_only_are_refused(tmp_path, simulated, cases):
    some = {name: rows for name, rows in simulated.items() if name.startswith("fig3b.")}
    with pytest.raises(InputError, match="no modulus of fig3a in the column"):
        made(tmp_path, some, cases)
    assert not (tmp_path / "metrics.csv").exists()
