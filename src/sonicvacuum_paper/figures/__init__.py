"""Figures 3–6 of the paper, redrawn from simulated cards: numbers first, pictures from these numbers only.

Each module `figN` has `table(simulations)`, which returns the numbers drawn, `draw(table)`, which makes a
figure of them and of nothing else, and `CAPTION`. Importing this package loads neither matplotlib nor pandas.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path

from sonicvacuum.blas import one_thread
from sonicvacuum.files import InputError, reading, replacing

# Figure → the cards it shows, panel by panel.
CARDS = {
    "fig3": ("fig3a.layer-loss", "fig3a.layer", "fig3a.matched", "fig3b.nominal"),
    "fig4": (
        "fig4a.layer-loss",
        "fig4a.layer",
        "fig4a.matched",
        "fig4a.handbook",
        "fig4b.nominal",
        "fig4b.horizontal",
    ),
    "fig5": ("fig5a.layer-loss", "fig5a.matched", "fig5b.nominal"),
    "fig6": tuple(
        f"fig6{panel}.{model}"
        for panel in "ab"
        for model in ("layer-loss", "layer-loss-geometry", "layer", "matched")
    ),
}

# Significant digits of their numbers: finer than what simulations err by, about 1e-6, and coarser than what
# processors round differently, so that `make` writes the same tables on another machine but for a rare digit.
DIGITS = 7

# Columns of their tables that hold words; the others hold numbers.
WORDS = ["panel", "series", "model", "orientation", "sensor"]


def names() -> tuple[str, ...]:
    """The figures there are."""
    return tuple(CARDS)


def cards_of(name: str) -> tuple[str, ...]:
    """Cards that a figure shows; InputError for an unknown figure."""
    if name not in CARDS:
        raise InputError(f"figure {name!r}: unknown; use one of {', '.join(CARDS)}")
    return CARDS[name]


def panels(name: str) -> dict[str, list[str]]:
    """Panel of a figure, the case that it shows → its cards, one of which must be there."""
    found: dict[str, list[str]] = {}
    for card in cards_of(name):
        found.setdefault(card.split(".")[0], []).append(card)
    return found


def drawable(name: str, cards: Iterable[str]) -> bool:
    """Whether every panel of a figure has one of these cards."""
    known = set(cards)
    return all(known.intersection(shown) for shown in panels(name).values())


def caption(name: str) -> str:
    """Caption of a figure, one paragraph of plain text."""
    return _module(name).CAPTION


@one_thread
def make(name: str, simulations: Mapping, out_dir, points=()) -> tuple[Path, Path, Path]:
    """Write `name`.csv, then read it back and draw `name`.svg and `name`.png from it.

    Equal simulations give equal bytes.

    Args:
        name: of the figure.
        simulations: card name → `Simulation` of the cards in `cards_of(name)`; others are ignored, and
            a card may be absent as long as its panel has another.
        out_dir: folder, made where it does not exist.
        points: sets of `sonicvacuum_paper.digitised`; those of other figures are ignored.

    Returns:
        The paths of the three files.

    Raises:
        InputError: for an unknown figure or a panel without a card.
    """
    from sonicvacuum.figures import style

    wanted = {card: simulations[card] for card in cards_of(name) if card in simulations}
    for panel, shown in panels(name).items():
        if not wanted.keys() & set(shown):
            raise InputError(
                f"figure {name}: no simulated card of {panel}; simulate one of {', '.join(shown)}"
            )
    module, stem = _module(name), Path(out_dir) / name
    paths = tuple(stem.with_suffix(suffix) for suffix in (".csv", ".svg", ".png"))
    with replacing(paths[0]) as stream:
        table = with_points(name, module.table(wanted), points)
        table.to_csv(stream, index=False, float_format=f"%.{DIGITS}g", lineterminator="\n")
    figure = draw(name, paths[0])
    style.save(figure, *paths[1:])
    return paths


def with_points(name: str, table, points):
    """The table of a figure with the rows of the points that somebody read off it."""
    import pandas

    from sonicvacuum_paper import digitised

    found = [row for one in points if one.figure == name for row in digitised.rows(one)]
    if not found:
        return table
    rows = _module(name).placed(pandas.DataFrame(found, columns=table.columns), table)
    return pandas.DataFrame([*table.to_dict("records"), *rows.to_dict("records")], columns=table.columns)


def draw(name: str, path):
    """The matplotlib Figure of the numbers in a CSV that `make` wrote; InputError where it is not one."""
    return _module(name).draw(read(name, path))


def read(name: str, path):
    """The pandas.DataFrame of a figure's numbers; InputError where the file does not hold them."""
    import pandas

    cure = f"draw {name} from its cards again"
    with reading(path, cure):
        table = pandas.read_csv(path)
    if list(table.columns) != _module(name).COLUMNS or table.empty:
        raise InputError(f"{path}: not the numbers of {name}; {cure}")
    for column in table.columns.difference(WORDS):
        if not pandas.api.types.is_numeric_dtype(table[column]):
            raise InputError(f"{path}: {column}: holds what is no number; {cure}")
    return table


def _module(name):
    cards_of(name)
    # Written out, so that what a figure depends on can be read off the imports.
    from sonicvacuum_paper.figures import fig3, fig4, fig5, fig6

    return {"fig3": fig3, "fig4": fig4, "fig5": fig5, "fig6": fig6}[name]
