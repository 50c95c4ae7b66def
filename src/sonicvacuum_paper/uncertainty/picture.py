"""Which modulus, thickness and loss the printed numbers allow: three maps, drawn from their table alone."""

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from sonicvacuum.figures import style
from sonicvacuum_paper.printed import PRINTED

CAPTION = style.paragraph("""
What 197 m/s, 130 m/s at 0.25 N, 130 µs and at most about 3 N (so Fig. 7 is read) allow of a coating with a
Kuwabara–Kono loss, in each panel averaged over the third quantity: inner, 68 %; outer, 95 %. Dots: the
printed 50 µm with 2.76 and 4.75 GPa; triangle: 15 GPa on a coating so thick that the contact is all but
Hertz's.
""")
_TITLES = {
    "modulus_GPa": "Modulus (GPa)",
    "thickness_um": "Thickness (µm)",
    "loss_us": "Loss (µs)",
}
_TICKS = {
    "modulus_GPa": (2, 3, 5, 10, 15, 20),
    "thickness_um": (20, 50, 100, 200, 400),
    "loss_us": (0.3, 1, 3, 10),
}


def draw(table: pd.DataFrame) -> Figure:
    """The figure of these numbers; columns as in `uncertainty.identify`."""
    with style.context():
        figure = style.canvas(style.DOUBLE, 58.0)
        for place, (pair, part) in enumerate(table.groupby(["x", "y"], sort=False)):
            axes = style.panel(figure, (12.0 + 58.0 * place, 11.0, 42.0, 42.0))
            _panel(axes, pair, part)
    return figure


def _panel(axes, pair, part):
    grid = part.pivot(index="y_value", columns="x_value", values="content")
    filled = {"levels": [0.0, 0.68, 0.95], "colors": ["#0072B2", "#a9cfe6"]}
    axes.contourf(grid.columns, grid.index, grid.to_numpy(), **filled)
    axes.set(xscale="log", yscale="log", xlabel=_TITLES[pair[0]], ylabel=_TITLES[pair[1]])
    for axis, name in ((axes.xaxis, pair[0]), (axes.yaxis, pair[1])):
        axis.set_major_locator(FixedLocator(_TICKS[name]))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_locator(NullLocator())
    if pair == ("modulus_GPa", "thickness_um"):
        thickness = 1e6 * PRINTED.coating
        for modulus in (PRINTED.modulus_handbook, PRINTED.modulus_membrane):
            axes.plot(modulus / 1e9, thickness, "o", color="#CC0000", ms=4.0)
        axes.plot(PRINTED.modulus_matched / 1e9, grid.index[-1], "^", color="#CC0000", ms=5.0, clip_on=False)
