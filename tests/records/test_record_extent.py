"""A record whose search would never end, or fill the memory, is refused before anything is computed."""

import pytest
from click.testing import CliRunner
from record_cases import BALL, CONTENT, TIME, TRACES, content, put

from sonicvacuum.cli import cli
from sonicvacuum.discover import session
from sonicvacuum.files import InputError
from sonicvacuum.records.extent import check_expected, check_extent
from sonicvacuum.records.reader import parse
from sonicvacuum.records.record import Record
from sonicvacuum.records.signals import Signals
from sonicvacuum.report import checked


@pytest.mark.parametrize("base", [CONTENT, BALL])
def test_what_a_laboratory_measures_passes(base):
    check_extent(Record(parse(base), TRACES if base is CONTENT else {}, "made-up"))


def test_more_beads_than_are_ever_strung_are_refused():
    record = Record(parse(content(chain__beads=10**9)), TRACES, "made-up")
    with pytest.raises(InputError, match=r"made-up: asks for 1e\+09 beads, more than .*--no-limits"):
        check_extent(record)


def test_a_trace_in_seconds_that_was_meant_in_microseconds_is_refused():
    slow = {name: Signals(1e6 * TIME, trace.readings) for name, trace in TRACES.items()}
    with pytest.raises(InputError, match=r"made-up: asks for .* samples per contact.*are all units right"):
        check_extent(Record(parse(CONTENT), slow, "made-up"))


def test_the_verb_refuses_and_may_be_overruled(tmp_path, monkeypatch):
    class Reached(Exception):
        pass

    def search(*records, **_):
        raise Reached

    monkeypatch.setattr(session.competition, "discover", search)
    folder = put(tmp_path / "rec", chain__beads=10**9)
    call = ["discover", str(folder), "--out", str(tmp_path / "out"), "--no-figures"]
    refused = CliRunner().invoke(cli, call)
    assert isinstance(refused.exception, InputError)
    assert "rec: asks for 1e+09 beads" in str(refused.exception)
    assert isinstance(CliRunner().invoke(cli, [*call, "--no-limits"]).exception, Reached)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("beads", [10**6, 10**9])
def test_a_look_at_it_is_refused_as_well_and_may_be_overruled(tmp_path, monkeypatch, beads):
    # What is expected of a chain is simulated until its pulse has come back, however short the record is.
    class Reached(Exception):
        pass

    def look(record):
        raise Reached

    monkeypatch.setattr(checked, "looked_through", look)
    folder = put(tmp_path / "rec", chain__beads=beads)
    call = ["record", "check", str(folder)]
    refused = CliRunner().invoke(cli, call)
    assert isinstance(refused.exception, InputError)
    assert "rec: asks for" in str(refused.exception)
    assert "fewer beads" in str(refused.exception)
    assert isinstance(CliRunner().invoke(cli, [*call, "--no-limits"]).exception, Reached)


def test_one_ball_asks_for_nothing():
    check_expected(Record(parse(BALL), {}, "made-up"))
