"""The table of all fresh samples in docs/again.md says what the tables kept beside it do."""

import re
from pathlib import Path

import pandas as pd
import pytest

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "workflow/resources/reference/blind_again"
PAGE = (ROOT / "docs/again.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| (\w+) \| [0-9a-f]{7} \| (.*) \|$", PAGE, re.M)
OUTSIDE = "outside the catalogue"


@pytest.mark.parametrize(("sample", "cells"), ROWS, ids=[name for name, _ in ROWS])
def test_a_row_is_its_summary(sample, cells):
    folder = KEPT if sample == "first" else KEPT / sample
    table = pd.read_csv(folder / "summary.csv", keep_default_na=False).set_index(["measure", "group"])

    def found(measure, group):
        row = table.loc[(measure, group)]
        return int(float(row["count"])), float(row["value"])

    def counted(*keys):
        shares = [found(*key) for key in keys]
        return f"{sum(round(n * share) for n, share in shares)} of {sum(n for n, _ in shares)}"

    (one, single), (two, pair) = found("exact name", "all"), found("exact pair", "all")
    (records, ece), (many, held) = (
        found("calibration error (ECE)", "all"),
        found("90 % interval holds truth", "all"),
    )
    assert cells.split(" | ") == [
        f"{single:.2f} of {one}",
        f"{pair:.2f} of {two}",
        counted(*(("named on null", noise) for noise in ("white", "ar1", "quantised"))),
        counted(("says unknown", f"{OUTSIDE}, leftover d' 8 and more")),
        counted(("wrong name, unqualified", OUTSIDE)),
        f"{ece:.3f} ({records})",
        f"{held:.2f} of {many}",
    ]


def test_all_samples_have_a_row():
    assert len(ROWS) == 18
