"""A ball described by options: what no laboratory has is refused in one line that names the option."""

import math
from dataclasses import replace

import pytest
from made_balls import BALL, asked

from sonicvacuum import cli
from sonicvacuum.export.session import by_hand, export
from sonicvacuum.files import InputError

SOUND = {"mass_g": "4", "diameter_mm": "10", "material": "brass"}


@pytest.mark.parametrize(
    ("changed", "speeds", "told"),
    [
        ({"mass_g": "nan"}, ("0.1", "1"), "--mass_g: is nan g"),
        ({"mass_g": "inf"}, ("0.1", "1"), "--mass_g: is inf g"),
        ({"diameter_mm": "nan"}, ("0.1", "1"), "--diameter_mm: is nan mm"),
        ({"mass_g": "1e9", "diameter_mm": "1e-9"}, ("0.1", "1"), "--diameter_mm: is 1e-09 mm"),
        ({"mass_g": "400"}, ("0.1", "1"), "--mass_g: is 400 g, which at a diameter of 10 mm is a density"),
        ({"material": "bras"}, ("0.1", "1"), "--material: 'bras' is not in the table"),
        ({"wall": "bras"}, ("0.1", "1"), "did you mean brass?"),
        ({}, ("nan", "nan"), "--speeds: is nan m/s"),
        ({}, ("0.5", "inf"), "--speeds: is inf m/s"),
        ({"error": "nan"}, ("0.1", "1"), "--error: is nan"),
    ],
)
def test_what_no_ball_has_is_refused_by_option(monkeypatch, capsys, tmp_path, changed, speeds, told):
    monkeypatch.chdir(tmp_path)
    given = [part for name, value in (SOUND | changed).items() for part in (f"--{name}", value)]
    call = ("export", "--law", "tsuji", "--alpha", "0.1", *given, "--speeds", *speeds, "--out", "law.txt")
    monkeypatch.setattr("sys.argv", ["sonicvacuum", *call])
    with pytest.raises(SystemExit) as end:
        cli.main()
    assert end.value.code == 2
    shown = capsys.readouterr().err
    assert told in shown
    assert shown.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (("tsuji", "--alpha", "-2"), "--alpha: is -2; use a value from 0 to"),
        (("tsuji", "--time_us", "2"), "no such option: --time_us; tsuji has --alpha"),
        (("tsuji", "--alpha", "0.1"), "--mass_g, --diameter_mm, --material, --speeds missing"),
    ],
)
def test_a_law_is_looked_at_before_what_else_is_missing_is_asked_for(monkeypatch, capsys, given, told):
    monkeypatch.setattr("sys.argv", ["sonicvacuum", "export", "--law", *given])
    with pytest.raises(SystemExit) as end:
        cli.main()
    assert end.value.code == 2
    assert told in capsys.readouterr().err


def test_so_it_is_in_python():
    with pytest.raises(InputError, match="--mass_g: is nan"):
        by_hand(**BALL | {"mass_g": math.nan}, speeds=(0.1, 1.0), effects={})
    with pytest.raises(InputError, match="--error: is inf"):
        export(asked(), error=math.inf)
    with pytest.raises(InputError, match="--speeds: is nan"):
        export(replace(asked(), speeds=(math.nan, 1.0)))
