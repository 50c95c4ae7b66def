"""Every file that a user can hand over is accepted and means something, or is refused in one line."""

import random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mutants import Files

KINDS = (
    "absent",
    "assumptions",
    "blind verdict",
    "candidates",
    "card",
    "cases",
    "claims",
    "config",
    "figure",
    "gap",
    "history",
    "ledger",
    "limits",
    "metrics",
    "model",
    "points",
    "probable",
    "record",
    "score",
    "signals",
    "summary",
    "truth",
    "verdict",
    "where",
)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return Files(tmp_path_factory.mktemp("handed over"))


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_sound_is_accepted(files, kind):
    file, read = files.readers[kind]
    read(files.folder / file)


@settings(max_examples=300, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(KINDS), st.integers(0, 2**32))
def test_a_mutant_means_something_or_is_refused(files, kind, seed):
    mutation, outcome, told = files.attempt(kind, random.Random(seed))
    assert outcome in ("accepted", "refused"), f"{mutation}: {told}"
