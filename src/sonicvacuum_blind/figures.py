"""The blind study in pictures: what is taken for what, accuracy against d′, reliability, intervals, simpler
rules.

Drawn from the tables that `sonicvacuum blind score --tables` and `sonicvacuum blind baselines` write:
confusion.csv, accuracy.csv, reliability.csv, pit.csv, baselines.csv. A picture whose table is
not there is left out.
"""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas
from matplotlib.figure import Figure

from sonicvacuum.figures import style
from sonicvacuum_blind.baselines.names import DESIGNS, PANELS, RULES

CAPTIONS = {
    "confusion": style.paragraph("""
        What is hidden (rows, with the number of cases) and what is named (columns): number of cases, shade by
        share of the row. Rows none: nothing hidden; unknown: an effect from outside the catalogue. Column
        several: two effects, or an effect with a rest that nothing explains. Records of the main list only;
        1600 further empty ones count in false alarms.
    """),
    "accuracy": style.paragraph("""
        Share of records with one hidden effect that are given its exact name, against the effect's
        signal-to-noise ratio d′: (a) traces of three gauges at several speeds, (b) other records, with their
        median d′; other set-ups: one or two gauges, 8 to 40 beads, 2 to 5 runs, half of them under a preload.
        Bars: 95 % intervals (Wilson). Class level: that name, or one that the verdict calls confusable with
        it. Dashed: what an ideal rule with full knowledge of all signatures reaches on those of the records
        that it was asked about.
    """),
    "reliability": style.paragraph("""
        Stated probability against the share of cases in which what is named with it is right, with 95 %
        intervals; below, the number of cases. Dashed: perfect calibration.
    """),
    "pit": style.paragraph("""
        Posterior probability below the truth (PIT) of the parameters of effects hidden and named: its
        cumulative distribution (ECDF) less the diagonal, of all parameters together (a) and of each effect's
        by a line of its own (b), in units of the half width of the band. Grey area: the band in which
        correctly stated intervals stay in 95 % of studies, in (b) for all effects at once; orange: what
        leaves it; named in (b): the four that come nearest to leaving it. Above the line, stated values are
        too large; above on the left and below on the right, intervals are too narrow.
    """),
    "baselines": style.paragraph("""
        Simpler rules on the same records: (a) exact names of single hidden effects of all strengths and kinds
        of record, (b) records with nothing hidden that were given a name, (c) records with an effect from
        outside the catalogue (foreign) that were given a name of the catalogue. Bars with 95 % intervals;
        numbers: share in per cent and number of cases.
    """),
}


def draw(tables: Mapping[str, pandas.DataFrame], out, prefix: str = "") -> list[Path]:
    """Draw a picture of each table; the SVG files, each with its PNG.

    Args:
        tables: picture of `CAPTIONS` → its table, as `kept.read` reads it.
        out: folder for the pictures.
        prefix: of the pictures' names.
    """
    written = []
    makers = {
        "confusion": confusion,
        "accuracy": accuracy,
        "reliability": reliability,
        "pit": pit,
        "baselines": baselines,
    }
    for name, table in tables.items():
        written.append(Path(out) / f"{prefix}{name}.svg")
        style.save(makers[name](table), written[-1], written[-1].with_suffix(".png"))
    return written


def confusion(table: pandas.DataFrame) -> Figure:
    """Matrix of names, from confusion.csv."""
    hidden, named = (list(dict.fromkeys(table[c])) for c in ("hidden", "named"))
    counts = table["count"].to_numpy(float).reshape(len(hidden), len(named))
    shares = table["share"].to_numpy(float).reshape(len(hidden), len(named))
    size, left, bottom = 5.4, 37.0, 28.0
    with style.context():
        figure = style.canvas(style.DOUBLE, bottom + size * len(hidden) + 3.0)
        axes = style.panel(figure, (left, bottom, size * len(named), size * len(hidden)))
        axes.imshow(np.ma.masked_invalid(shares), cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
        for (i, j), count in np.ndenumerate(counts):
            if count:
                shade = "white" if shares[i, j] > 0.55 else "black"
                axes.text(j, i, f"{count:.0f}", ha="center", va="center", fontsize=6.5, color=shade)
        totals = counts.sum(axis=1)
        names = [f"{h} ({n:.0f})" for h, n in zip(hidden, totals, strict=True)]
        axes.set_yticks(range(len(hidden)), names)
        axes.set_xticks(range(len(named)), named, rotation=90)
        axes.set_ylabel("hidden (cases)")
        axes.set_xlabel("named")
        axes.tick_params(length=0, labelsize=7)
        _grid(axes, len(hidden), len(named))
    return figure


def _grid(axes, rows, columns):
    """Thin lines between cells, stronger ones before none, unknown and several."""
    for spine in axes.spines.values():
        spine.set_visible(True)
    axes.set_xticks(np.arange(columns - 1) + 0.5, minor=True)
    axes.set_yticks(np.arange(rows - 1) + 0.5, minor=True)
    axes.grid(which="minor", color=style.BAND, lw=0.4)
    axes.tick_params(which="minor", length=0)
    axes.axhline(rows - 2.5, color="black", lw=0.8)
    axes.axvline(columns - 3.5, color="black", lw=0.8)


# Records of a bin that is shown beside a fuller one.
FILLED = 20


def accuracy(table: pandas.DataFrame) -> Figure:
    """Shares of right names against d′, from accuracy.csv."""
    with style.context():
        figure = style.canvas(style.DOUBLE, 76.0)
        traces = table[(table.design == "traces") & (table.strength > 0)]
        axes = style.panel(figure, (14.0, 22.0, 88.0, 47.0))
        style.title(figure, 14.0, "(a) Traces, several speeds")
        _shares(axes, traces.d_prime.to_numpy(float), traces, 1.065)
        axes.set_xscale("log")
        ticks = [s for s in (3, 5, 7.5, 10, 20, 50, 150, 500) if s < 1.3 * max(traces.d_prime, default=20.0)]
        axes.set_xticks(ticks, [f"{s:g}" for s in ticks])
        axes.set_xticks([], minor=True)
        axes.set_xlim(0.84 * min(traces.d_prime, default=5.0), 1.25 * max(traces.d_prime, default=20.0))
        axes.set_xlabel("signal-to-noise ratio d′ of the hidden effect")
        axes.set_ylabel("share of records")
        handles, labels = axes.get_legend_handles_labels()
        others = _others(table)
        side = style.panel(figure, (116.0, 22.0, 55.0, 47.0))
        style.title(figure, 116.0, "(b) Other records")
        designs = list(dict.fromkeys(others.design))
        beside = others.groupby("design").cumcount() - 0.5 * (
            others.groupby("design").design.transform("size") - 1
        )
        places = others.design.map(designs.index) + 0.44 * beside
        _shares(side, places.to_numpy(float), others, None)
        side.set_xticks(places, [f"{d:.2g}" for d in others.d_prime])
        for k, one in enumerate(designs):
            words = DESIGNS.get(one, one).replace(" ", "\n")
            side.annotate(
                words, (k, 0), (0, -18), ("data", "axes fraction"), "offset points", ha="center", va="top"
            )
        side.annotate("d′", (0, 0), (-4, -7), "axes fraction", "offset points", ha="right", va="top")
        side.set_xlim(-0.5, max(len(designs), 1) - 0.5)
        bottom = min([0.4, *(table.exact_low.astype(float) - 0.05)])
        for one in (axes, side):
            one.set_ylim(max(bottom, 0.0), 1.02)
        side.set_yticklabels([])
        figure.legend(handles, labels, loc="lower center", ncols=3, borderaxespad=0.3)
    return figure


def _others(table):
    """The two fullest bins of each other design, by strength; one that is hardly filled is left out."""
    rest = table[table.design != "traces"].sort_values("count", ascending=False, kind="stable")
    fuller = rest.groupby("design").cumcount()
    chosen = rest[(fuller == 0) | ((fuller == 1) & (rest["count"] >= FILLED))]
    order = [*dict.fromkeys([*DESIGNS, *table.design])]
    return (
        chosen.assign(at=chosen.design.map(order.index))
        .sort_values(["at", "strength"])
        .reset_index(drop=True)
    )


def _shares(axes, x, rows, factor):
    """Exact and class-level shares with intervals, side by side, and the ceiling."""
    aside = (lambda k: x * factor**k) if factor else (lambda k: x + 0.06 * k)
    looks = (
        (-1, "exact", "exact", style.BLUE, "o", style.BLUE, "exact name"),
        (1, "class_level", "class", style.GREEN, "s", "white", "class level"),
    )
    for side, value, bounds, color, marker, face, label in looks:
        y = rows[value].to_numpy(float)
        low, high = (rows[f"{bounds}_{end}"].to_numpy(float) for end in ("low", "high"))
        bars = np.maximum([y - low, high - y], 0.0)
        look = {"color": color, "fmt": marker, "mfc": face, "ms": 4, "lw": 1.0, "capsize": 2}
        axes.errorbar(aside(side), y, bars, label=label, **look)
    ceiling = rows.ideal.to_numpy(float)
    dashes = (0, (4, 1.5))
    if factor:
        axes.plot(x, ceiling, color="black", lw=0.9, ls=dashes, label="ideal rule")
    else:
        axes.hlines(ceiling, x - 0.17, x + 0.17, color="black", lw=0.9, ls=dashes)
    axes.grid(axis="y", color=style.BAND, lw=0.4)


def reliability(table: pandas.DataFrame) -> Figure:
    """Right against stated, with counts below, from reliability.csv."""
    filled = table[table["count"] > 0]
    with style.context():
        figure = style.canvas(style.SINGLE, 92.0)
        axes = style.panel(figure, (15.0, 34.0, 66.0, 55.0))
        axes.plot([0, 1], [0, 1], color=style.GREY, lw=0.8, ls=(0, (4, 1.5)))
        x, y = filled.stated.to_numpy(float), filled.value.to_numpy(float)
        bars = np.maximum([y - filled.low.to_numpy(float), filled.high.to_numpy(float) - y], 0.0)
        axes.errorbar(x, y, bars, color=style.BLUE, fmt="o", ms=4, lw=1.0, capsize=2)
        axes.set_ylim(-0.02, 1.02)
        axes.set_ylabel("share right")
        below = style.panel(figure, (15.0, 11.0, 66.0, 18.0))
        middle = 0.5 * (table.low_edge + table.high_edge)
        below.bar(middle, table["count"], width=0.094, color=style.BLUE)
        for at, count in zip(middle, table["count"], strict=True):
            if count:
                below.text(at, count, f"{count:d}", ha="center", va="bottom", fontsize=6.5)
        below.set_ylim(0, 1.3 * table["count"].max())
        below.set_ylabel("cases")
        below.set_xlabel("stated probability of what is named")
        for one in (axes, below):
            one.set_xlim(0.0, 1.0)
        axes.set_xticklabels([])
    return figure


def pit(table: pandas.DataFrame) -> Figure:
    """ECDFs of posterior probabilities below the truth, from pit.csv."""
    filled = table[table["count"] > 0]
    with style.context():
        figure = style.canvas(style.DOUBLE, 78.0)
        groups = (filled[filled.effect == "all"], filled[filled.effect != "all"])
        nearest = _nearest(groups[1])
        looks = {"all": _LOOKS[0], **dict(zip(nearest, _LOOKS, strict=False))}
        for k, (rows, title) in enumerate(zip(groups, ("(a) All parameters", "(b) By effect"), strict=True)):
            axes = style.panel(figure, (17.0 + 84.0 * k, 12.0, 70.0, 58.0))
            style.title(figure, 17.0 + 84.0 * k, title)
            axes.axhspan(-1.0, 1.0, color=style.BAND, lw=0)
            for row in rows.itertuples():
                far, look = row.inside == "no", looks.get(row.effect, _REST)
                ecdf = np.array([0.0, *map(float, row.ecdf.split()), 1.0])
                x = np.linspace(0.0, 1.0, len(ecdf))
                y = (ecdf - x) / row.band
                axes.plot(x, y, **(_LEAVES if far else look))
                if far and k == 0:  # it may leave the band by less than is seen, or between the steps kept
                    _farthest(axes, x, y, row.distance / row.band)
                if far and k:
                    at = int(np.argmax(np.abs(y)))
                    side = "bottom" if y[at] > 0.0 else "top"
                    axes.text(x[at], 1.03 * y[at], row.effect, fontsize=6.5, ha="center", va=side)
                    axes.margins(y=0.12)
            if k and nearest:
                _named(axes, {name: looks[name] for name in nearest})
            axes.axhline(0.0, color=style.GREY, lw=0.6)
            axes.set_xlim(0.0, 1.0)
            axes.set_xlabel("posterior probability below the truth")
            if k == 0:
                axes.set_ylabel("(ECDF − diagonal) / half width of band")
    return figure


# Of a curve that leaves its band, of those that come nearest to doing so, by dashes as well, and of the rest.
_LEAVES = {"color": style.ORANGE, "lw": 1.4}
_LOOKS = (
    {"color": style.BLUE, "lw": 1.1},
    {"color": style.PURPLE, "lw": 1.1, "ls": (0, (5, 1.5))},
    {"color": style.GREEN, "lw": 1.1, "ls": (0, (5, 1.2, 1, 1.2))},
    {"color": "black", "lw": 1.1, "ls": (0, (1.2, 1.2))},
)
_REST = {"color": style.GREY, "lw": 0.4, "zorder": 1.5}


def _nearest(rows):
    """Effects within their band that come nearest to its end, one for each look, the nearest first."""
    within = rows[rows.inside != "no"]
    reach = (within.distance / within.band).sort_values(ascending=False, kind="stable")
    return list(within.effect[reach.index[: len(_LOOKS)]])


def _named(axes, looks):
    """Names of curves under the band and all that leaves it, where none is."""
    low, high = axes.dataLim.intervaly
    lines = [axes.plot([], [], label=name, **look)[0] for name, look in looks.items()]
    axes.set_ylim(min(low, -1.0) - 0.5, max(1.12 * high, 1.1))
    axes.set_yticks(np.linspace(-1.0, 1.0, 5))
    axes.legend(handles=lines, loc="lower center", ncols=2, fontsize=6.5, borderaxespad=0.2)


def _farthest(axes, x, y, ratio):
    """How far a curve goes, written where it does."""
    at = int(np.argmax(np.abs(y)))
    side = "bottom" if y[at] > 0.0 else "top"
    told = f"farthest: {ratio:.3f}"
    axes.text(
        x[at], math.copysign(1.03 * max(abs(y[at]), 1.0), y[at]), told, fontsize=6.5, ha="center", va=side
    )
    axes.margins(y=0.12)


def baselines(table: pandas.DataFrame) -> Figure:
    """Bars of all rules in three panels, from baselines.csv."""
    rules = [r for r in RULES if r in set(table.rule)]
    high, left, wide, gap = 5.6 * len(rules), 47.0, 36.0, 6.5
    with style.context():
        figure = style.canvas(style.DOUBLE, high + 21.0)
        for k, (measure, group, title, what) in enumerate(PANELS):
            at = left + k * (wide + gap)
            axes = style.panel(figure, (at, 11.0, wide, high))
            style.title(figure, at, title)
            rows = table[(table.measure == measure) & (table.group == group)].set_index("rule")
            _bars(axes, rows.reindex(rules), rules)
            axes.set_xlabel(f"% {what}", fontsize=7.5, loc="left")
            axes.set_yticks(range(len(rules)), [RULES[r] for r in rules] if k == 0 else [])
    return figure


def _bars(axes, rows, rules):
    value = 100.0 * rows.value.to_numpy(float)
    ends = [100.0 * rows[c].to_numpy(float) for c in ("low", "high")]
    bars = np.nan_to_num(np.maximum([value - ends[0], ends[1] - value], 0.0))
    colors = [{"sonicvacuum": style.BLUE, "ideal rule": style.GREY}.get(r, style.SKY) for r in rules]
    axes.barh(range(len(rules)), value, color=colors, height=0.62)
    known = np.flatnonzero(~np.isnan(ends[0]))
    look = {"fmt": "none", "ecolor": "black", "lw": 0.8, "capsize": 1.8}
    axes.errorbar(value[known], known, xerr=bars[:, known], **look)
    for k, (share, count) in enumerate(zip(value, rows["count"], strict=True)):
        text = "–" if np.isnan(share) else f"{_percent(share)} ({count:.0f})"
        axes.text(172.0, k, text, ha="right", va="center", fontsize=6.5)
    axes.set_xlim(0.0, 172.0)
    axes.spines["bottom"].set_bounds(0.0, 100.0)
    axes.set_xticks([0, 50, 100])
    # Rules without cases would shrink the axis of their panel.
    axes.set_ylim(len(rules) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)


def _percent(share):
    """With one decimal; a few of some thousand are not none."""
    if share in (0.0, 100.0):
        return f"{share:.0f}"
    return f"{share:.1f}" if share >= 0.05 else f"{share:.1g}"
