"""Calls of the command as a shell makes them, and a small case to call it with."""

import sys

from sonicvacuum import cli


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


def failing(monkeypatch, capsys, *arguments):
    """What a call that must be refused says on standard error."""
    assert call(monkeypatch, *arguments) == 2
    shown = capsys.readouterr().err
    assert "Traceback" not in shown
    return shown
