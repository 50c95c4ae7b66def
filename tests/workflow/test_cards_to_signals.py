"""From a card to the signals of its gauges, verb by verb."""

import numpy as np
from commands import CONFIG, call


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


def test_the_same_card_gives_the_same_bytes(monkeypatch, card, tmp_path):
    files = [tmp_path / name for name in ("a.npz", "b.npz")]
    for file in files:
        assert call(monkeypatch, "simulate", card, "--out", file) == 0
    assert files[0].read_bytes() == files[1].read_bytes()
