"""The text of gauge readings is that which numpy writes."""

import io
from types import SimpleNamespace

import numpy as np

from sonicvacuum_paper.cli.observe import write_signals


def test_signals_are_written_as_by_numpy(tmp_path):
    generator = np.random.default_rng(3)
    readings = {"g9": 10.0 ** generator.uniform(-12, 3, (50, 2)), "wall": -generator.random((50, 2))}
    readings["g9"][0] = 0.0
    simulated = SimpleNamespace(readings=lambda: readings, time=np.arange(50) * 1e-6 / 3, speeds=(0.44, 1.0))
    write_signals(simulated, tmp_path / "signals.csv")
    expected = io.StringIO("")
    expected.write("run,speed_m_s,time_us,g9,wall\n")
    for run, speed in enumerate(simulated.speeds):
        columns = [np.full(50, run), np.full(50, speed), simulated.time * 1e6]
        table = np.column_stack([*columns, *(r[:, run] for r in readings.values())])
        np.savetxt(expected, table, delimiter=",", fmt=["%d", *["%.9g"] * 4])
    assert (tmp_path / "signals.csv").read_text() == expected.getvalue()
