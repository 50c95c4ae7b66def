"""What `make slurm` compares of a study that was made on a cluster with one that was made here."""

import csv
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "workflow/scripts"))

import cluster  # noqa: E402
import cluster_study  # noqa: E402


def study(folder, batches):
    """A folder with a study of two records a batch."""
    rows = []
    for batch in range(batches):
        for record in (f"a{batch}", f"b{batch}"):
            for kind in ("records", "truth", "verdicts"):
                path = folder / cluster_study.STUDY / kind / str(batch) / record / "file.csv"
                path.parent.mkdir(parents=True)
                path.write_text(f"{kind} of {record}")
            rows.append({"id": record, "named": "tsuji", "seconds": str(id(folder))})
    with open(folder / cluster_study.TARGET, "w", newline="") as stream:
        table = csv.DictWriter(stream, rows[0])
        table.writeheader()
        table.writerows(rows)
    return folder


@pytest.fixture
def both(tmp_path):
    """A study of three batches, and the first of them made elsewhere."""
    return study(tmp_path / "whole", 3), study(tmp_path / "part", 1)


def test_a_part_that_is_the_same_is_the_same(both):
    assert cluster_study.unequal(*both) == []


@pytest.mark.parametrize(
    ("place", "differs"),
    [
        ("verdicts/0/a0/file.csv", True),
        ("records/0/b0/more.csv", True),
        ("truth/2/a2/file.csv", False),  # the part does not hold it
    ],
)
def test_another_file_within_the_part_is_told(both, place, differs):
    (both[0] / cluster_study.STUDY / place).write_text("otherwise")
    assert cluster_study.unequal(*both) == ([place] if differs else [])


def test_another_score_is_told_and_times_are_none(both):
    path = both[1] / cluster_study.TARGET
    path.write_text(path.read_text().replace("tsuji", "gravity"))
    assert cluster_study.unequal(*both) == ["score.csv"]


def test_tables_count_where_both_are_whole(tmp_path):
    whole, other = (study(tmp_path / name, 2) for name in ("whole", "other"))
    (whole / cluster_study.STUDY / "summary.csv").write_text("measure,value\nexact,0.9\n")
    (other / cluster_study.STUDY / "summary.csv").write_text("measure,value\nexact,0.8\n")
    assert cluster_study.unequal(whole, other) == ["summary.csv"]


def test_all_records_are_the_study_as_it_is_made():
    told = (ROOT / "workflow/rules/blind_common.smk").read_text()
    assert int(re.search(r'"full_batches", (\d+)', told)[1]) == cluster_study.BATCHES
    whole = cluster_study.whole()
    assert cluster_study.size(whole, whole)[1:3] == ("full_batches=100", "full_taken=100")
    assert cluster_study.size(whole, 43)[1:3] == ("full_batches=100", "full_taken=1")
    assert cluster_study.size(4, 4)[1:3] == (f"full_batches={whole // 2}", "full_taken=2")


def test_jobs_wait_as_long_as_the_profile_says():
    assert "runtime=60" in cluster.OPTIONS


def test_jobs_of_earlier_starts_are_counted_too(tmp_path):
    first = cluster_study.ended(None, tmp_path, {}, lambda slurm: {"1": 2.0, "2": 3.0})
    second = cluster_study.ended(None, tmp_path, {"1"}, lambda slurm: {"1": 9.0, "2": 4.0})
    assert sum(first.values()) == 5.0
    assert sum(second.values()) == 9.0


def test_the_folder_of_a_run_is_kept(tmp_path):
    (tmp_path / "study").mkdir()
    (tmp_path / "study/made").write_text("before")
    assert (cluster_study.kept(tmp_path / "study") / "made").read_text() == "before"
