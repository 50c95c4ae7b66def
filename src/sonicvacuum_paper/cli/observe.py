"""`sonicvacuum paper observe`: what the gauges of a card read, and the numbers derived from it."""

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.cards import read_card
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.cli.own_effects import catalogue, own_effects
from sonicvacuum.files import replacing
from sonicvacuum.outputs import check_apart


@verb("sonicvacuum paper observe card.json history.npz --signals signals.csv --metrics metrics.csv")
@click.argument("card", type=existing())
@click.argument("history", type=existing())
@click.option("--signals", required=True, type=WRITTEN, help="Gauge readings (CSV) to write.")
@click.option("--metrics", required=True, type=WRITTEN, help="Metrics (CSV) to write.")
@own_effects
def observe(card, history, signals, metrics, own):
    """Read the gauges of a simulated CARD's HISTORY and measure the pulses."""
    from sonicvacuum import simulation
    from sonicvacuum_paper.metrics import card_rows
    from sonicvacuum_paper.rows import write_rows

    check_apart([signals, metrics], [card, history])
    simulated = simulation.load(read_card(card), history, catalogue(own))
    write_signals(simulated, signals)
    write_rows(card_rows(simulated), metrics)


def write_signals(simulated, path):
    """CSV with the columns run, speed_m_s, time_us and one per gauge (N, without the static part)."""
    import numpy as np

    readings = simulated.readings()
    time = simulated.time * 1e6
    with replacing(path) as stream:
        stream.write(",".join(["run", "speed_m_s", "time_us", *readings]) + "\n")
        for run, speed in enumerate(simulated.speeds):
            columns = [np.full(len(time), run), np.full(len(time), speed), time]
            table = np.column_stack([*columns, *(r[:, run] for r in readings.values())])
            np.savetxt(stream, table, delimiter=",", fmt=["%d", "%.9g", "%.9g", *["%.9g"] * len(readings)])
