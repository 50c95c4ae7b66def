"""Smooth systematic errors and sets of effects: their law, what an ideal test sees, how verdicts count."""

import math

import numpy as np
import pytest
from click.testing import CliRunner

from sonicvacuum.blas import one_thread
from sonicvacuum.cli import cli
from sonicvacuum.files import InputError
from sonicvacuum_blind import extra_cases, extra_score, table_page
from sonicvacuum_blind.catalogue import STUDIED
from sonicvacuum_blind.cli.options import keep
from sonicvacuum_blind.score import Row, write_table
from sonicvacuum_blind.stated import Parameter
from sonicvacuum_blind.systematics import Smooth

SPEEDS = np.array([0.2, 0.4, 0.8])
SIGMA = np.array([0.1, 0.2])
TIME = np.arange(110.0)
# Pulses of two gauges at three speeds, 15 samples wide at half height.
PULSES = np.exp(-np.square((TIME - np.array([45.0, 70.0])[:, None]) / 8.5)) * SPEEDS[:, None, None]


@pytest.fixture
def smooth():
    return Smooth(PULSES, SPEEDS, 0.02, 0.8)


def random():
    return np.random.default_rng(np.random.SeedSequence(5))


@one_thread
def test_a_systematic_error_is_its_share_of_the_peak_once_the_pulse_has_begun(smooth):
    drawn = smooth.drawn(random()) / PULSES.max(axis=2, keepdims=True)
    assert not drawn[:, 0, :22].any()  # more than 1.5 widths before the peak
    # Six correlation times, three runs half alike, two gauges: a deviation known to 18 %, three of these.
    assert drawn[:, 0, 45:].std() == pytest.approx(0.02, rel=0.5)


def test_it_is_alike_within_a_width_and_in_neighbouring_runs(smooth):
    correlation, deviation = smooth.covariance(0)
    one, wide, runs = 60, 15, len(TIME)  # a sample behind the peak; samples above half of the peak
    assert deviation[one] == pytest.approx(0.02 * PULSES[0, 0].max())
    assert correlation[one, one + wide] == pytest.approx(math.exp(-0.5 / 0.8**2))
    assert correlation[one, one + runs] == pytest.approx(
        math.exp(-0.5 * (math.log(2.0) / math.log(2.2)) ** 2)
    )


@one_thread
def test_an_ideal_test_sees_less_beside_it_and_all_without(smooth):
    change = (0.01 * np.gradient(PULSES, axis=2) / SIGMA[:, None]).ravel()
    none = np.zeros((change.size, 0))
    bare = Smooth(PULSES, SPEEDS, 0.0, 0.8)
    assert bare.seen(change, none, SIGMA) == pytest.approx(float(np.linalg.norm(change)), rel=1e-9)
    assert 0.0 < smooth.seen(change, none, SIGMA) < bare.seen(change, none, SIGMA)
    # An error of the record that is the change itself leaves d′/√(1 + d′²).
    d = float(np.linalg.norm(change))
    assert bare.seen(change, change[:, None], SIGMA) == pytest.approx(d / math.sqrt(1.0 + d**2), rel=1e-6)


def test_the_list_holds_every_effect_with_every_size_and_is_the_same_each_time():
    made = extra_cases.cases()
    assert made == extra_cases.cases()
    assert len({c.id for c in made}) == len(made)
    singles = {(c.spec.effects[0], c.size) for c in made if c.spec.kind == "single"}
    assert singles == {(name, size) for name in STUDIED for size in extra_cases.SIZES}
    sets = [c.spec for c in made if c.spec.kind == "set"]
    assert {len(s.effects) for s in sets} == {3, 4}
    assert {s.d_prime for s in sets} == {20.0}
    assert all(not c.size for c in made if c.spec.kind == "set")
    other = extra_cases.cases(7)
    assert other != made
    assert sorted(c.size for c in other) == sorted(c.size for c in made)
    assert {c.spec.seed for c in other} == {7}


TRUTH = {"id": "x", "kind": "single", "effects": ["tsuji"], "size": 0.01, "d_prime": 50.0}
TRUTH |= {"d_prime_hidden": [50.0], "d_prime_beside": 12.0, "chi2_systematic": 0.5}
VERDICT = {"confusable": [], "timing_s": {"total": 1.0}, "gap": {"fitted": {"before": 11.5, "after": 1.5}}}


@pytest.mark.parametrize(
    ("named", "counted"),
    [
        (["tsuji"], (1, 1, 0, 0)),
        (["tsuji", "unknown"], (1, 1, 0, 0)),
        (["tsuji", "gravity", "unknown"], (1, 0, 1, 0)),
        (["linear-dashpot"], (0, 0, 1, 1)),
        ([], (0, 0, 0, 0)),
    ],
)
def test_what_is_named_counts(named, counted):
    known = sorted(n for n in named if n != "unknown")
    key = " + ".join([*known, *(["unknown"] * ("unknown" in named))]) or "none"
    row = extra_score.row(TRUTH, VERDICT | {"named": named, "probabilities": {key: 0.97}})
    assert (row.found, row.exact, row.wrong, row.confident_wrong) == counted
    assert row.confidence == 0.97
    assert row.closed == 1.0  # down to what is left of noise and systematic error


def test_a_name_that_is_called_confusable_is_wrong_and_within_the_class():
    told = VERDICT | {"confusable": [["linear-dashpot", "tsuji"]], "named": ["linear-dashpot"]}
    row = extra_score.row(TRUTH, told | {"probabilities": {"linear-dashpot": 0.6}})
    assert (row.wrong, row.wrong_class) == (1, 0)


def test_shares_tell_apart_what_an_ideal_test_could_name():
    faint = TRUTH | {"d_prime_beside": 2.0}
    told = VERDICT | {"named": [], "probabilities": {"none": 1.0}}
    seen = VERDICT | {"named": ["tsuji"], "probabilities": {"tsuji": 1.0}}
    rows = [extra_score.row(faint, told), extra_score.row(TRUTH, seen)]
    lines = {(x.measure, x.group): x for x in extra_score.summary(rows)}
    assert lines["truth among what is named", "systematic errors, singles"].value == 0.5
    assert lines["truth among what is named", "systematic errors, singles of d′ ≥ 5 beside it"].count == 1


def test_the_page_has_its_table_and_keeps_its_words(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(f"Before.\n\n{table_page.BEGIN}\nold\n{table_page.END}\nAfter.\n")
    rows = [extra_score.row(TRUTH, VERDICT | {"named": ["tsuji"], "probabilities": {"tsuji": 1.0}})]
    table_page.write(extra_score.summary(rows), page)
    told = page.read_text()
    assert told.startswith("Before.") and told.endswith("After.\n") and "old" not in told
    assert "| truth among what is named | systematic errors, singles | 1 | 1 | 0.207 to 1 | ≥ 0.9 |" in told


@pytest.mark.parametrize(
    "text",
    [
        "no place for a table",
        f"{table_page.END}\n{table_page.BEGIN}\n",
        f"{table_page.BEGIN}\n{table_page.END}\n" * 2,
    ],
)
def test_a_page_without_a_place_for_its_table_is_refused_before_anything_is_written(tmp_path, text):
    page, rows = tmp_path / "page.md", [extra_score.row(TRUTH, VERDICT | {"named": [], "probabilities": {}})]
    page.write_text(text)
    with pytest.raises(InputError, match="end of table"):
        keep(
            rows,
            extra_score.ExtraRow,
            extra_score.summary(rows),
            tmp_path / "a.csv",
            tmp_path / "b.csv",
            page,
        )
    study = tmp_path / "study"
    study.mkdir()
    write_table([], Row, study / "score.csv")
    write_table([], Parameter, study / "parameters.csv")
    done = CliRunner().invoke(
        cli, ["blind", "tables", str(study), f"--out={tmp_path / 'out'}", f"--page={page}"]
    )
    assert isinstance(done.exception, InputError) and "end of table" in str(done.exception)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["page.md", "study"]
    assert page.read_text() == text
