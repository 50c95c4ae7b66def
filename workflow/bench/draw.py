"""Draw the benchmark's figures from its tables: python workflow/bench/draw.py FOLDER."""

import sys
from pathlib import Path

import pandas
import pictures

from sonicvacuum.figures import style

folder = Path(sys.argv[1])
tables = {name: pandas.read_csv(folder / f"bench_{name}.csv") for name in ("accuracy", "length", "lanes")}
for name, figure in (
    ("accuracy", pictures.draw_accuracy(tables["accuracy"])),
    ("cost", pictures.draw_cost(tables["length"], tables["lanes"])),
):
    style.save(figure, folder / f"bench_{name}.svg", folder / f"bench_{name}.png")
