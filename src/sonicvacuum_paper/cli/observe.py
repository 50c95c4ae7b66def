"""`sonicvacuum paper observe`: what the gauges of cards read, and the numbers derived from it."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.cards import read_card
from sonicvacuum.cli.helped import PLACE, PRESENT, places_in, verb
from sonicvacuum.cli.own_effects import catalogue, own_effects
from sonicvacuum.files import InputError, check_written, replacing
from sonicvacuum.outputs import check_apart


@verb(
    "sonicvacuum paper observe card.json history.npz --signals signals.csv --metrics metrics.csv",
    "sonicvacuum paper observe cards/*.json --histories histories --signals signals --metrics metrics",
)
@click.argument("files", nargs=-1, required=True, type=existing(), metavar="CARD HISTORY | CARDS...")
@click.option("--histories", type=PRESENT, help="Folder of the simulations of any number of CARDS.")
@click.option("--signals", required=True, type=PLACE, help="Gauge readings (CSV) to write, or their folder.")
@click.option("--metrics", required=True, type=PLACE, help="Metrics (CSV) to write, or their folder.")
@own_effects
def observe(files, histories, signals, metrics, own):
    """Read the gauges of a simulated CARD's HISTORY and measure the pulses.

    With --histories, those of any number of CARDS: the history of NAME.json is NAME.npz in that folder, and
    what is written is NAME.csv in the folders of readings and of metrics.
    """
    from sonicvacuum import simulation
    from sonicvacuum_paper.metrics import card_rows
    from sonicvacuum_paper.rows import write_rows

    if histories:
        names = [Path(card).stem for card in files]
        found = [Path(histories, f"{name}.npz") for name in names]
        jobs = list(
            zip(files, found, *(places_in(f, names, ".csv") for f in (signals, metrics)), strict=True)
        )
    elif len(files) == 2:
        check_written(signals)
        check_written(metrics)
        jobs = [(*files, signals, metrics)]
    else:
        raise InputError("give one CARD and its HISTORY, or CARDS and --histories with the folder of theirs")
    check_apart([path for job in jobs for path in job[2:]], [path for job in jobs for path in job[:2]])
    known = catalogue(own)
    for card, history, readings, measured in jobs:
        simulated = simulation.load(read_card(card), history, known)
        write_signals(simulated, readings)
        write_rows(card_rows(simulated), measured)


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
            # As `numpy.savetxt` has it, which formats row after row and takes twice as long.
            row = ",".join(["%d", *["%.9g"] * (table.shape[1] - 1)]) + "\n"
            stream.write(row * len(table) % tuple(table.ravel().tolist()))
