"""What the tests of workflow and command share: a running Snakemake, and a small case."""

import re
from collections import Counter

import pytest
from commands import CONFIG, call
from planner import Planner
from small_pipeline import TARGET, without_batch


@pytest.fixture(scope="session")
def snakemake():
    """Call of snakemake in a folder: (returncode, said)."""
    with Planner() as planner:
        yield planner


@pytest.fixture(scope="session")
def planned(snakemake):
    """Call: rule → number of jobs that a run in a folder would start now."""

    def plan(folder, *targets):
        done = snakemake(folder, "--dry-run", *(targets or [TARGET]))
        assert done.returncode == 0, done.said
        rows = re.findall(r"^(\w+)\s+(\d+)$", done.said, flags=re.MULTILINE)
        jobs = Counter()
        for rule, count in dict(rows).items():  # a dry run tells its jobs twice
            jobs[without_batch(rule)] += int(count)
        return {rule: count for rule, count in jobs.items() if rule != "total"}

    return plan


@pytest.fixture
def config(tmp_path):
    """A configuration of one small case."""
    path = tmp_path / "config.yaml"
    path.write_text(CONFIG)
    return path


@pytest.fixture
def card(monkeypatch, config, tmp_path):
    """The card of that case."""
    path = tmp_path / "small.nominal.json"
    assert call(monkeypatch, "card", "--config", config, "--case", "small", "--out", path) == 0
    return path
