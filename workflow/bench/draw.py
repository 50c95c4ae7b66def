"""Draw the benchmark's figures from its tables: python workflow/bench/draw.py FOLDER."""

import argparse
from pathlib import Path

import pandas
import pictures

from sonicvacuum.figures import style

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("folder", metavar="FOLDER", type=Path, help="of the tables, and of the figures")
folder = parser.parse_args().folder
tables = {name: pandas.read_csv(folder / f"bench_{name}.csv") for name in ("accuracy", "length", "lanes")}
for name, figure in (
    ("accuracy", pictures.draw_accuracy(tables["accuracy"])),
    ("cost", pictures.draw_cost(tables["length"], tables["lanes"])),
):
    style.save(figure, folder / f"bench_{name}.svg", folder / f"bench_{name}.png")
