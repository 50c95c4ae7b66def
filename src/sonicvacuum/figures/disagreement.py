"""Where the nominal model and the data disagree: by run, gauge and feature, or by measured quantity."""

import numpy as np

from sonicvacuum.figures.style import BAND, BLUE, DOUBLE, GREY, ORANGE, SINGLE, canvas, panel

# Scores beyond this are drawn in the full colour.
LIMIT = 10.0


def where(cells: list[dict[str, str]]):
    """Map of scores: features down, runs and gauges across; None without traces."""
    cells = [c for c in cells if c["sensor"]]
    if not cells:
        return None
    places = list(dict.fromkeys((c["run"], c["sensor"]) for c in cells))
    features = list(dict.fromkeys(c["feature"] for c in cells))
    table = np.full((len(features), len(places)), np.nan)
    for c in cells:
        table[features.index(c["feature"]), places.index((c["run"], c["sensor"]))] = float(c["z_before"])
    wide = min(DOUBLE, 45.0 + 9.0 * len(places))
    room = 6.0 + 1.25 * max(len(f"{r} {s}") for r, s in places)
    high = max(6.0 * len(features), 30.0)  # the least that the label of the colours needs
    figure = canvas(wide, room + high + 3.0)
    axes = panel(figure, (22.0, room, wide - 46.0, high))
    image = axes.imshow(table, cmap="PuOr", vmin=-LIMIT, vmax=LIMIT, aspect="auto")
    for (i, j), z in np.ndenumerate(table):
        if abs(z) >= 3.0 and len(places) <= 16:
            shade = "white" if abs(z) > 7.0 else "black"
            axes.text(j, i, f"{z:.0f}".replace("-", "−"), ha="center", va="center", fontsize=6, color=shade)
    axes.set_xticks(
        range(len(places)), [f"{r} {s}" for r, s in places], rotation=60, ha="right", rotation_mode="anchor"
    )
    axes.set_yticks(range(len(features)), features)
    axes.tick_params(length=0)
    bar = figure.colorbar(image, cax=panel(figure, (wide - 20.0, room, 3.0, high)), extend="both")
    bar.set_label("score $z$ of the residual")
    return figure


def scalars(cells: list[dict[str, str]]):
    """Score of each measured quantity before (open) and after (filled); None without any."""
    cells = [c for c in cells if not c["sensor"]]
    if not cells:
        return None
    labels = [f"{c['run']}, {c['feature'].replace('_', ' ')}" for c in cells]
    left = min(50.0, 4.0 + 1.25 * max(map(len, labels)))
    figure = canvas(SINGLE, 16.0 + 4.5 * len(cells))
    axes = panel(figure, (left, 10.0, SINGLE - left - 4.0, 4.5 * len(cells)))
    rank = np.arange(len(cells))[::-1]
    before, after = ([float(c[key]) for c in cells] for key in ("z_before", "z_after"))
    axes.axvspan(-2.0, 2.0, color=BAND, lw=0)
    axes.hlines(rank, before, after, color=GREY, lw=0.6)
    axes.plot(before, rank, "o", mfc="white", mec=ORANGE, ms=4, label="nominal")
    axes.plot(after, rank, "o", color=BLUE, ms=2.5, label="extended")
    axes.set_yticks(rank, labels, fontsize=6.5)
    axes.set_ylim(-0.7, len(cells) - 0.3)
    axes.set_xlim(min(-3.0, 1.1 * min(before + after)), max(3.0, 1.1 * max(before + after)))
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("score $z$ of the residual")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.0, handletextpad=0.1)
    return figure
