"""What callers get wrong: a channel that does not exist, a file given twice, an interval without its unit."""

import shutil

import pytest
from made_files import PULSE, TIMES, tbs

from sonicvacuum.files import InputError
from sonicvacuum.scope.importing import import_files
from sonicvacuum.scope.options import options


@pytest.fixture
def file(tmp_path):
    (tmp_path / "shot.csv").write_bytes(tbs(TIMES, PULSE))
    return tmp_path / "shot.csv"


def refusal(files, tmp_path, **given):
    with pytest.raises(InputError) as caught:
        import_files(files, tmp_path / "r", options(**given))
    assert not (tmp_path / "r").exists()
    return str(caught.value)


def test_a_channel_that_does_not_exist_is_named_beside_those_that_do(tmp_path, file):
    said = refusal([file], tmp_path, channel=("CH1=g5", "CH9=g6"))
    assert said == "--channel CH9=g6: no channel is called 'CH9'; there are CH1, CH2"


def test_a_file_given_twice_is_told_as_that(tmp_path, file):
    again = tmp_path / "x" / ".." / "shot.csv"
    (tmp_path / "x").mkdir()
    assert refusal([file, again], tmp_path).endswith("shot.csv: is given twice; give it once")
    assert "is given twice" in refusal([], tmp_path, run=(f"a={file},{again}",))


def test_one_file_may_serve_two_runs(tmp_path, file):
    shutil.copy(file, tmp_path / "other.csv")
    import_files([tmp_path / "other.csv"], tmp_path / "r", options(run=(f"a={file}", f"b={file}")))
    assert len(list((tmp_path / "r").glob("*.csv"))) == 3


@pytest.mark.parametrize("interval", ["2", "500", "20ms"])
def test_an_interval_that_no_trace_has_is_refused(tmp_path, file, interval):
    said = refusal([file], tmp_path, interval=interval)
    assert said.startswith("--interval: is ") and said.endswith("with its unit, as in 2us")
