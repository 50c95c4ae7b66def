"""How well each gauge alone, and the best choices, tell effects apart."""

from sonicvacuum.figures.style import BAND, BLUE, DOUBLE, GREY, canvas, context, panel, save
from sonicvacuum.prediction.design import TARGET, Design
from sonicvacuum.prediction.design_text import place

# Below the panels, what line and band mean is told.
_HEIGHT, _BELOW, _BAR = 81.0, 21.0, BLUE


def write(found: Design, path) -> None:
    """Draw standard errors of the hardest pair and write them in the format that the path's ending names."""
    with context():
        figure = canvas(DOUBLE, _HEIGHT)
        left = panel(figure, (24.0, _BELOW, 48.0, _HEIGHT - _BELOW - 10.0))
        _bars(left, [place(g) for g in found.single], list(found.single.values()), "one gauge, one run")
        right = panel(figure, (112.0, _BELOW, DOUBLE - 116.0, _HEIGHT - _BELOW - 10.0))
        names = ["+".join(one.gauges) + f", {_runs(len(one.speeds_m_s))}" for one in found.best]
        _bars(right, names, [one.least for one in found.best], "best choices")
        handles, labels = right.get_legend_handles_labels()
        figure.legend(handles, labels, loc="lower center", ncols=2, borderaxespad=0.4)
        save(figure, path)


def _runs(count):
    return "1 run" if count == 1 else f"{count} runs"


def _bars(axes, names, values, title):
    axes.barh(range(len(names)), values, color=_BAR, height=0.7)
    told = f"{TARGET:g}: from here on effects count as told apart"
    axes.axvline(TARGET, color=GREY, lw=0.8, ls=(0, (3, 2)), label=told)
    axes.axvspan(0.0, TARGET, color=BAND, alpha=0.4, lw=0, zorder=0, label="less: not told apart")
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.set_xlabel("standard errors apart, hardest pair")
    axes.set_title(title, fontsize=8.0, loc="left")
