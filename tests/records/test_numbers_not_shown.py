"""Numbers of which the nominal model shows none: the check says so, and why."""

import pytest
from record_cases import CONTENT, STRIKER, content

from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse
from sonicvacuum.records.review import SECONDS_PER_STRIKE, review

TABLE = [
    {"quantity": "speed_at_amplitude", "amplitude_N": a, "sensor": "near", "value": 430.0, "sigma": 5.0,
     "unit": "m/s"}
    for a in (2.0, 20.0)
]  # fmt: skip


def table_at(bead, table=TABLE) -> Record:
    """Speeds at amplitudes, two if not given, that a gauge in a bead reads."""
    return Record(
        parse(
            content(
                CONTENT,
                sensors=[{"id": "near", "kind": "embedded", "bead": bead}],
                runs=[{"id": "table", "striker": STRIKER, "observables": table}],
            )
        )
    )


@pytest.mark.parametrize("bead", [1, 5])
def test_numbers_that_the_model_shows_are_not_suspected(bead):
    assert not [line for line in review(table_at(bead)).suspects if "shows none" in line]


def test_amplitudes_at_the_last_bead_are_told_to_lie_under_the_reflection():
    """They were silent, and a bead more, behind the gauge, explained that there are speeds at all."""
    (told,) = [line for line in review(table_at(10)).suspects if "shows none" in line]
    assert told.startswith("run table: 2 × speed_at_amplitude near: the nominal model shows none (")


@pytest.mark.parametrize(
    ("amplitudes", "strikes"), [((2.0,), 1), ((2.0, 20.0), 2), (tuple(range(10, 51)), 3)]
)
def test_a_table_takes_as_long_as_its_strikes(amplitudes, strikes):
    """Values that are denser than an e-fold share strikes: from 10 to 50 N stand three, ln 5 = 1.6 apart."""
    table = [TABLE[0] | {"amplitude_N": float(a)} for a in amplitudes]
    told = review(table_at(5, table)).discover_s
    assert told == pytest.approx(SECONDS_PER_STRIKE * strikes, rel=0.05)  # and hardly anything per value
