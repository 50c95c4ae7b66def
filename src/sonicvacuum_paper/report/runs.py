"""`results/runs.html`: every simulated run as a space-time map linked to its gauges, with its numbers.

A case that a user adds to `config.yaml` stands here like those of the paper, and in the report as well.
"""

from collections.abc import Iterable

import pandas as pd

from sonicvacuum.report import inline, interactive
from sonicvacuum.report.tables import number, read
from sonicvacuum.simulation import Simulation
from sonicvacuum_paper.report import space_time
from sonicvacuum_paper.rows import COLUMNS
from sonicvacuum_paper.shown import own

# What is told of each gauge, and of each pair: quantity → its name.
AT_GAUGES = {
    "amplitude": "peak",
    "arrival": "arrives",
    "duration": "lasts",
    "duration_half": "at half height",
    "width": "width",
    "pulse_count": "pulses",
}
BETWEEN = {"speed": "speed"}


def build(simulations: Iterable[Simulation], metrics_path) -> str:
    """The page as HTML text.

    Args:
        simulations: the simulated cards, each loaded when it is its turn.
        metrics_path: `results/metrics.csv`.

    Raises:
        InputError: when the table has other columns than it should.
    """
    metrics = read(metrics_path, COLUMNS)
    template = inline.environment("sonicvacuum_paper.report").get_template("runs.html.j2")
    return template.render(
        cards=[told(s, metrics) for s in simulations],
        script=interactive.script(),
    )


def told(simulation: Simulation, metrics: pd.DataFrame) -> dict:
    """What the page says of one card: its runs, each with drawing and numbers."""
    card = simulation.card
    lanes = range(len(simulation.speeds))
    single = len(lanes) == 1
    runs = []
    for lane in lanes:
        speed = float(simulation.speeds[lane])
        name = card.name if single else f"{card.name}@{speed:g}"
        anchor = f"run-{name.replace('@', '-at-')}"
        # In a sweep a case's own name is that of the whole.
        rows = metrics[metrics["case"] == name]
        runs.append(
            {
                "speed": f"{speed:.4g}",
                "anchor": anchor,
                **space_time.drawing(simulation, lane, anchor),
                **_numbers(rows, [g.id for g in simulation.sensors]),
            }
        )
    return {
        "name": card.name,
        "title": card.title,
        "own": own(card.name),
        "runs": runs,
        "warnings": simulation.warnings,
    }


def _numbers(rows, gauges):
    """`columns`: what is known of any gauge; `gauges`: (gauge, its cells); `between`: words on pairs."""
    known = {(r["quantity"], r["sensor"]): r for r in rows.to_dict("records")}
    every = {q: [_cell(known.get((q, s))) for s in gauges] for q in AT_GAUGES}
    every = {q: cells for q, cells in every.items() if set(cells) != {"–"}}
    cells = list(zip(gauges, zip(*every.values(), strict=True), strict=False))
    # The metrics read virtual gauges as well, where the paper has its own.
    pairs = [(q, s) for q, s in known if q in BETWEEN and set(s.split("-")) <= set(gauges)]
    between = [f"{BETWEEN[q]} {s}: {_cell(known[q, s])}" for q, s in sorted(pairs)]
    return {"columns": [AT_GAUGES[q] for q in every], "gauges": cells, "between": between}


def _cell(row):
    if row is None or not row["value"]:
        return "–"
    unit = {"us": "µs", "1": "", "diameters": "diam."}.get(row["unit"], row["unit"])
    return f"{number(row['value'])} {unit}".strip()
