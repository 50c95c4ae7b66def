"""The comparison behind the reproducibility check finds what differs and forgives what it may."""

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum.files import InputError
from sonicvacuum_paper.report.agreement import differences, read_tolerances, readable


def tolerances(absolute=0.0, relative=1e-3, column="value"):
    row = {"table": "t", "column": column, "absolute": absolute, "relative": relative, "reason": "test"}
    return pd.DataFrame([row])


def table(*values):
    return pd.DataFrame({"name": ["a"] * len(values), "value": list(values)}, dtype=str)


@given(st.floats(1e-6, 1e6), st.floats(-9e-4, 9e-4))
def test_numbers_within_the_tolerance_agree(value, change):
    assert differences("t", table(repr(value)), table(repr(value * (1 + change))), tolerances()) == []


@given(st.floats(1e-6, 1e6), st.floats(2e-3, 0.5))
def test_numbers_beyond_it_are_named_with_their_place(value, change):
    (found,) = differences("t", table(repr(value)), table(repr(value * (1 + change))), tolerances())
    assert (found["column"], found["row"]) == ("value", "2")


def test_words_must_be_equal_and_numbers_inside_them_close():
    rule = tolerances(relative=0.01)
    assert differences("t", table("219.7 against 197 m/s"), table("219.8 against 197 m/s"), rule) == []
    assert differences("t", table("219.7 against 197 m/s"), table("219.7 beyond 197 m/s"), rule)
    assert differences("t", table("219.7 against 197 m/s"), table("250.1 against 197 m/s"), rule)


def test_a_value_that_vanishes_is_a_difference():
    assert differences("t", table("1.0"), table(""), tolerances())


def test_columns_without_tolerance_must_be_equal():
    assert differences("t", table("1.0"), table("1.00001"), tolerances(column="name"))
    assert differences("t", table("1.0"), table("1.00001"), tolerances(column="*")) == []


def test_other_shapes_are_differences():
    (found,) = differences("t", table("1"), table("1", "2"), tolerances())
    assert found["column"] == "(rows)"
    (found,) = differences("t", table("1"), table("1").rename(columns={"value": "v"}), tolerances())
    assert found["column"] == "(columns)"


def test_the_readable_table_counts_what_it_leaves_out():
    found = differences("t", table(*"1234"), table(*"5678"), tolerances())
    assert "and 2 more" in readable(found, most=2)
    assert readable([]) == "no differences"


def test_every_tolerance_in_git_has_a_reason(request, tmp_path):
    kept = read_tolerances(request.config.rootpath / "workflow/resources/tolerances.csv")
    assert {"fig3", "fig4", "fig5", "fig6", "ledger"} <= set(kept["table"])
    bare = tmp_path / "t.csv"
    bare.write_text("table,column,absolute,relative,reason\nfig3,*,1,1,\n")
    with pytest.raises(InputError, match="line 2: no reason"):
        read_tolerances(bare)
