"""Bad input of the command ends in one line and exit code 2."""

import io
import json
import os
from pathlib import Path

import numpy as np
import pytest
from commands import CONFIG, call, failing


def test_cards_of_one_name_or_without_a_folder_are_refused(monkeypatch, capsys, card, config, tmp_path):
    twice = ["simulate", card, card, "--out", tmp_path / "histories"]
    assert "small.nominal: given twice" in failing(monkeypatch, capsys, *twice)
    two = ["card", "--config", config, "--case", "small", "--case", "small.nominal"]
    assert "give --out with the folder" in failing(monkeypatch, capsys, *two)
    outputs = ["--signals", tmp_path / "s", "--metrics", tmp_path / "m"]
    assert "--histories" in failing(monkeypatch, capsys, "paper", "observe", card, *outputs)
    assert not [path for path in tmp_path.iterdir() if path not in (card, config)]


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
