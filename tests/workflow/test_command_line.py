"""The command: every verb explains itself, and bad input ends in one line and exit code 2."""

import hashlib
import io
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import click
import numpy as np
import pytest

from sonicvacuum import cli
from sonicvacuum.cli import VERBS
from sonicvacuum.cli.helped import strayed


def call(monkeypatch, *arguments):
    """Exit code of the command as the shell sees it."""
    monkeypatch.setattr(sys, "argv", ["sonicvacuum", *map(str, arguments)])
    try:
        cli.main()
    except SystemExit as end:
        return end.code or 0
    return 0


CONFIG = """\
ledger: {handbook: [nominal]}
cases:
  small:
    title: Three beads
    chain:
      beads: 3
      orientation: vertical
      bead: {diameter_mm: 5.0, mass_g: 0.5, material: bearing-steel}
      wall: {material: bearing-steel}
    striker: {shape: sphere, diameter_mm: 5.0, material: bearing-steel, mass_g: 0.5, speed_m_s: 0.5}
    sensors: [{id: g2, kind: embedded, bead: 2}, {id: wall, kind: wall}]
    duration_us: 200
"""


@pytest.fixture
def config(tmp_path):
    path = tmp_path / "config.yaml"
    path.write_text(CONFIG)
    return path


@pytest.fixture
def card(monkeypatch, config, tmp_path):
    path = tmp_path / "small.nominal.json"
    assert call(monkeypatch, "card", "--config", config, "--case", "small", "--out", path) == 0
    return path


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_has_help(monkeypatch, capsys, verb):
    assert call(monkeypatch, verb, "--help") == 0
    assert "Usage: " in capsys.readouterr().out


def test_the_help_lists_all_verbs(monkeypatch, capsys):
    assert call(monkeypatch, "--help") == 0
    shown = capsys.readouterr().out
    assert all(f"  {verb}" in shown for verb in VERBS)


def test_from_card_to_signals(monkeypatch, card, tmp_path):
    history, signals, metrics = (tmp_path / name for name in ("h.npz", "s.csv", "m.csv"))
    assert call(monkeypatch, "simulate", card, "--out", history) == 0
    assert (
        call(monkeypatch, "paper", "observe", card, history, "--signals", signals, "--metrics", metrics) == 0
    )
    assert signals.read_text().splitlines()[0] == "run,speed_m_s,time_us,g2,wall"
    table = np.loadtxt(signals, delimiter=",", skiprows=1)
    assert table.shape == (401, 5)
    assert np.all(table[0, 3:] == 0.0)
    assert table[:, 3:].max() > 1.0
    assert metrics.read_text().splitlines()[0] == "case,quantity,sensor,value,unit,numerical_error,reason"


def test_of_several_cards_each_has_the_files_that_it_has_alone(monkeypatch, tmp_path):
    text = CONFIG + "    variants: {nominal: {}, slow: {duration_us: 150}}\n"
    config, alone, many = tmp_path / "config.yaml", tmp_path / "alone", tmp_path / "many"
    config.write_text(text)
    names = ["small.nominal", "small.slow"]
    for name in names:
        card, history = alone / "cards" / f"{name}.json", alone / "histories" / f"{name}.npz"
        outputs = [alone / kind / f"{name}.csv" for kind in ("signals", "metrics")]
        case, variant = name.split(".")
        assert (
            call(monkeypatch, "card", "--config", config, "--case", case, "--variant", variant, "--out", card)
            == 0
        )
        assert call(monkeypatch, "simulate", card, "--out", history) == 0
        told = ("--signals", outputs[0], "--metrics", outputs[1])
        assert call(monkeypatch, "paper", "observe", card, history, *told) == 0
    both = [word for name in names for word in ("--case", name)]
    assert call(monkeypatch, "card", "--config", config, *both, "--out", many / "cards") == 0
    cards = [many / "cards" / f"{name}.json" for name in names]
    assert call(monkeypatch, "simulate", *cards, "--out", many / "histories") == 0
    folders = [word for kind in ("histories", "signals", "metrics") for word in (f"--{kind}", many / kind)]
    assert call(monkeypatch, "paper", "observe", *cards, *folders) == 0
    made = {path.relative_to(alone): path.read_bytes() for path in alone.rglob("*") if path.is_file()}
    assert len(made) == 8
    assert made == {path.relative_to(many): path.read_bytes() for path in many.rglob("*") if path.is_file()}


def test_cards_of_one_name_or_without_a_folder_are_refused(monkeypatch, capsys, card, config, tmp_path):
    twice = ["simulate", card, card, "--out", tmp_path / "histories"]
    assert "small.nominal: given twice" in failing(monkeypatch, capsys, *twice)
    two = ["card", "--config", config, "--case", "small", "--case", "small.nominal"]
    assert "give --out with the folder" in failing(monkeypatch, capsys, *two)
    outputs = ["--signals", tmp_path / "s", "--metrics", tmp_path / "m"]
    assert "--histories" in failing(monkeypatch, capsys, "paper", "observe", card, *outputs)
    assert not [path for path in tmp_path.iterdir() if path not in (card, config)]


def test_the_same_card_gives_the_same_bytes(monkeypatch, card, tmp_path):
    files = [tmp_path / name for name in ("a.npz", "b.npz")]
    for file in files:
        assert call(monkeypatch, "simulate", card, "--out", file) == 0
    assert files[0].read_bytes() == files[1].read_bytes()


def failing(monkeypatch, capsys, *arguments):
    """The one line on standard error of a call that must fail."""
    assert call(monkeypatch, *arguments) == 2
    shown = capsys.readouterr().err
    assert "Traceback" not in shown
    return shown


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        (["discovr"], "Did you mean 'discover'?"),
        (["blind", "scor"], "Did you mean 'score'?"),
        (["hide"], "Did you mean 'blind hide'?"),
        (["draw"], "Did you mean 'blind draw' or 'paper draw'?"),
        (["xyzzy"], "No such command 'xyzzy'."),
    ],
)
def test_an_unknown_verb_is_refused_and_the_nearest_named(monkeypatch, capsys, written, meant):
    assert failing(monkeypatch, capsys, *written).rstrip().endswith(meant)


@pytest.mark.parametrize("group", ["paper", "blind"])
def test_every_verb_of_a_group_has_help(monkeypatch, capsys, group):
    for verb in cli.cli.get_command(None, group).verbs:
        assert call(monkeypatch, group, verb, "--help") == 0
        assert f"sonicvacuum {group} {verb}" in capsys.readouterr().out.replace("__main__.py", "sonicvacuum")


def test_a_missing_file_is_named(monkeypatch, capsys, tmp_path):
    shown = failing(monkeypatch, capsys, "simulate", tmp_path / "none.json", "--out", tmp_path / "h.npz")
    assert "none.json" in shown


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulate", "pipe", "--out", "h.npz"],
        ["card", "--config", "pipe"],
        ["compare", "rec", "--model", "pipe", "--json", "score.json"],
        ["paper", "metrics", "/dev/zero", "--out", "m.csv"],
        ["record", "check", "rec"],
    ],
)
def test_a_pipe_or_a_device_is_refused_and_not_waited_for(monkeypatch, capsys, config, arguments):
    monkeypatch.chdir(config.parent)
    Path("rec").mkdir()
    os.mkfifo("pipe")
    os.mkfifo("rec/record.yaml")
    told = failing(monkeypatch, capsys, *arguments)
    assert "is a pipe or a device" in told or "has no record.yaml" in told


def test_a_card_with_a_fault_is_named_with_its_field(monkeypatch, capsys, card, tmp_path):
    content = json.loads(card.read_text())
    content["bead"]["mass_kg"] = -1.0
    card.write_text(json.dumps(content))
    shown = failing(monkeypatch, capsys, "simulate", card, "--out", tmp_path / "h.npz")
    assert "small.nominal.json: bead.mass_kg: is -1.0" in shown
    assert not (tmp_path / "h.npz").exists()


def test_a_file_that_is_no_card_is_named(monkeypatch, capsys, tmp_path):
    path = tmp_path / "x.json"
    path.write_text("{")
    assert "x.json: not a card" in failing(monkeypatch, capsys, "simulate", path, "--out", tmp_path / "h.npz")
    path.write_text("[1]")
    told = failing(monkeypatch, capsys, "simulate", path, "--out", tmp_path / "h.npz")
    assert "x.json: expected `object`, got `array`; write keys with their values" in told


def packed(**header):
    """An archive of one array, with what its directory and the member itself say of it overwritten."""
    stream = io.BytesIO()
    np.savez(stream, time_s=np.zeros(3))
    archive = bytearray(stream.getvalue())
    # Offsets of two-byte fields in a member's header and in the directory (APPNOTE.TXT, 4.3.7 and 4.3.12).
    for field, value in header.items():
        for start, at in (
            (b"PK\x03\x04", {"flags": 6, "method": 8}),
            (b"PK\x01\x02", {"flags": 8, "method": 10}),
        ):
            place = archive.index(start) + at[field]
            archive[place : place + 2] = value.to_bytes(2, "little")
    return bytes(archive)


@pytest.mark.parametrize(
    "content", [b"nothing", packed(flags=1), packed(method=99)], ids=["text", "encrypted", "packed"]
)
def test_a_file_that_is_no_history_is_named(monkeypatch, capsys, card, tmp_path, content):
    history = tmp_path / "h.npz"
    history.write_bytes(content)
    outputs = ("--signals", tmp_path / "s.csv", "--metrics", tmp_path / "m.csv")
    shown = failing(monkeypatch, capsys, "paper", "observe", card, history, *outputs)
    assert "h.npz: damaged, or not what is read here" in shown
    assert not (tmp_path / "s.csv").exists()


def test_a_bad_configuration_is_named_with_its_key(monkeypatch, capsys, config):
    config.write_text(CONFIG.replace("mass_g: 0.5,", "mass_g: 5e-1,"))
    shown = failing(monkeypatch, capsys, "card", "--config", config)
    assert "cases.small.chain.bead.mass_g: is '5e-1'" in shown
    assert "write 5.0e-1" in shown


def test_an_unknown_figure_is_refused(monkeypatch, capsys, tmp_path):
    shown = failing(
        monkeypatch,
        capsys,
        "paper",
        "draw",
        "fig9",
        "--cards",
        tmp_path,
        "--histories",
        tmp_path,
        "--out",
        tmp_path,
    )
    assert "'fig9': unknown; use one of fig3" in shown


def leaves(group, path=()):
    """(words, command) of every verb, those in groups included."""
    for name in group.list_commands(None):
        command = group.get_command(None, name)
        below = isinstance(command, click.Group)
        yield from leaves(command, (*path, name)) if below else [((*path, name), command)]


@pytest.mark.parametrize(("words", "command"), list(leaves(cli.cli)))
def test_the_help_of_every_verb_ends_with_examples_that_parse(words, command):
    whole = command.epilog.replace("\\\n", " ")
    examples = [line.strip() for line in whole.splitlines() if "sonicvacuum" in line]
    assert examples
    for line in examples:
        given = line.split()
        assert given[: 1 + len(words)] == ["sonicvacuum", *words]
        rest = given[1 + len(words) :]
        # Files of an example need not be there; verbs and options must.
        context = click.Context(command, resilient_parsing=True)
        given, _, _ = command.make_parser(context).parse_args(rest)
        required = [p.name for p in command.params if p.required]
        assert [name for name in required if not given.get(name)] == []


def test_exit_codes_and_completion_are_told(monkeypatch, capsys):
    assert call(monkeypatch, "--help") == 0
    told = capsys.readouterr().out
    for code in ("0    done", "1    the machine", "2    input refused", "130  interrupted"):
        assert code in told
    assert "_SONICVACUUM_COMPLETE" in told


def test_the_version_names_the_lock(monkeypatch, capsys, pytestconfig):
    assert call(monkeypatch, "--version") == 0
    digest = hashlib.sha256((pytestconfig.rootpath / "requirements.lock").read_bytes()).hexdigest()
    assert f"requirements.lock sha256 {digest[:12]}" in capsys.readouterr().out


def test_a_bad_record_is_refused_before_the_good_ones_are_searched(monkeypatch, capsys, tmp_path):
    good, bad = tmp_path / "good", tmp_path / "bad"
    for folder in (good, bad):
        assert call(monkeypatch, "record", "new", folder) == 0
    text = (bad / "record.yaml").read_text()
    (bad / "record.yaml").write_text(text.replace("chain:\n", "chian:\n", 1))
    monkeypatch.setattr("sonicvacuum.discover.session.discover", lambda *a, **k: pytest.fail("searched"))
    assert call(monkeypatch, "discover", good, bad, "--out", tmp_path / "out", "--no-figures") == 2
    assert "bad/record.yaml: " in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("wrong", "right", "place"),
    [
        ("beeds: 21", "beads: 21", "chain"),
        ("diametr_mm: 4.86", "diameter_mm: 4.86", "chain.bead"),
        ("modulus_gpa: 2.76", "modulus_GPa: 2.76", "materials.parylene-c"),
        ("speed_ms: 0.44", "speed_m_s: 0.44", "runs[0].striker"),
    ],
)
def test_a_mistyped_key_gets_the_nearest_one(monkeypatch, capsys, tmp_path, wrong, right, place):
    assert call(monkeypatch, "record", "new", tmp_path / "rec") == 0
    file = tmp_path / "rec/record.yaml"
    text = file.read_text()
    file.write_text(text.replace(right, wrong, 1))
    assert call(monkeypatch, "record", "check", tmp_path / "rec") == 2
    told = capsys.readouterr().err
    assert f"{place}.{wrong.split(':')[0]}: unknown key; did you mean {right.split(':')[0]}?" in told


def test_a_number_written_as_text_is_named_with_its_material(monkeypatch, capsys, tmp_path):
    assert call(monkeypatch, "record", "new", tmp_path / "rec") == 0
    file = tmp_path / "rec/record.yaml"
    file.write_text(file.read_text().replace("modulus_GPa: 2.76", "modulus_GPa: 2e1", 1))
    assert call(monkeypatch, "record", "check", tmp_path / "rec") == 2
    told = capsys.readouterr().err
    assert "materials.parylene-c.modulus_GPa" in told
    assert "YAML reads this as text: write 2.0e+1" in told


def test_the_command_notices_that_another_clone_s_environment_runs(tmp_path):
    """As after copying a clone: its .venv, activated, runs what it was copied from."""
    for clone in ("first", "copy"):
        (tmp_path / clone / "src/sonicvacuum").mkdir(parents=True)
        (tmp_path / clone / ".venv").mkdir()
    told = strayed(tmp_path / "copy", tmp_path / "first/.venv")
    assert str(tmp_path / "first/.venv") in told
    assert "make env" in told
    assert strayed(tmp_path / "copy", tmp_path / "copy/.venv") == ""
    assert strayed(tmp_path, tmp_path / "first/.venv") == ""


def test_make_notices_a_clone_that_was_moved(tmp_path, pytestconfig):
    names = ("Makefile", "requirements.lock", "requirements-build.lock")
    for name in names:
        shutil.copy(pytestconfig.rootpath / name, tmp_path)
    (tmp_path / ".venv").mkdir()
    stamp = tmp_path / ".venv/locked"
    locks = "".join(
        (tmp_path / name).read_text() for name in ("requirements-build.lock", "requirements.lock")
    )

    def make():
        # A Python that is none: nothing is ever built here.
        call = ["make", "PYTHON=false", ".venv/locked"]
        return subprocess.run(call, cwd=tmp_path, capture_output=True, text=True)

    stamp.write_text(f"built in {tmp_path.resolve()}\n{locks}")
    assert make().returncode == 0
    stamp.write_text(f"built in /elsewhere\n{locks}")
    assert make().returncode != 0
    stamp.write_text(f"built in {tmp_path.resolve()}\n{locks}changed\n")
    assert make().returncode != 0
