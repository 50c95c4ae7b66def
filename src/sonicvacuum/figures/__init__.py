"""Figures 3–6 of the paper, redrawn from simulated cards: numbers first, pictures from these numbers only.

Each module `figN` has `table(studies)`, which returns the numbers drawn, `draw(table)`, which makes a figure
of them and of nothing else, and `CAPTION`. Importing this package loads neither matplotlib nor pandas.
"""

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path

from sonicvacuum.files import InputError, replacing

# Figure → the cards it shows, panel by panel.
CARDS = {
    "fig3": ("fig3a.matched", "fig3a.handbook", "fig3b.nominal"),
    "fig4": (
        "fig4a.matched",
        "fig4a.membrane",
        "fig4a.handbook",
        "fig4a.matched-horizontal",
        "fig4a.handbook-horizontal",
        "fig4b.nominal",
        "fig4b.horizontal",
    ),
    "fig5": ("fig5a.matched", "fig5a.handbook", "fig5b.nominal"),
    "fig6": (
        "fig6a.matched",
        "fig6a.membrane",
        "fig6a.handbook",
        "fig6b.matched",
        "fig6b.membrane",
        "fig6b.handbook",
    ),
}


def names() -> tuple[str, ...]:
    """The figures there are."""
    return tuple(CARDS)


def cards_of(name: str) -> tuple[str, ...]:
    """Cards that a figure shows; InputError for an unknown figure."""
    if name not in CARDS:
        raise InputError(f"figure {name!r}: unknown; use one of {', '.join(CARDS)}")
    return CARDS[name]


def caption(name: str) -> str:
    """Caption of a figure, one paragraph of plain text."""
    return _module(name).CAPTION


# Pictures of the full blind study, drawn from the tables that are kept of it: stem → what it shows.
STUDY = {
    "blind_accuracy": "Blind study: right names",
    "blind_confusion": "Blind study: what is taken for what",
    "blind_reliability": "Blind study: stated probabilities",
    "blind_baselines": "Blind study: simpler rules",
}
STUDY_TABLES = "workflow/resources/reference/blind_full"


def study_caption(name: str) -> str:
    """Caption of a picture of the blind study; InputError for an unknown one."""
    if name not in STUDY:
        raise InputError(f"picture {name!r}: unknown; use one of {', '.join(STUDY)}")
    return import_module(f"{__name__}.study").CAPTIONS[name.removeprefix("blind_")]


def readme(claims) -> str:
    """Text of `figures/README.md`: figure, cards, rule and claims, with the captions.

    Args:
        claims: path of the table of claims; a claim belongs to the figures that its section names.
    """
    lines = [_README_HEAD]
    found = _claims(claims)
    for name in CARDS:
        title = f"Fig. {name[3:]}"
        lines += [
            f"## {title}\n",
            f"![{title}]({name}.png)\n",
            f"{caption(name)}\n",
            f"* Files: [{name}.csv]({name}.csv), [{name}.svg]({name}.svg), [{name}.png]({name}.png)",
            f"* Module: `src/sonicvacuum/figures/{name}.py`; rule: `draw` in `workflow/rules/figures.smk`",
            f"* Cards: {', '.join(f'`{card}`' for card in CARDS[name])}",
            f"* Claims: {', '.join(f'`{claim}`' for claim in found[name])}\n",
        ]
    for name, title in STUDY.items():
        table = f"{STUDY_TABLES}/{name.removeprefix('blind_')}.csv"
        lines += [
            f"## {title}\n",
            f"![{title}]({name}.png)\n",
            f"{study_caption(name)}\n",
            f"* Files: [{name}.svg]({name}.svg), [{name}.png]({name}.png); table: [{table}](../{table})",
            "* Module: `src/sonicvacuum/figures/study.py`; rule: `draw_kept` in `workflow/rules/blind.smk`\n",
        ]
    return "\n".join(lines)


def _claims(path) -> dict[str, list[str]]:
    import csv
    from re import escape, search

    with open(path, encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    named = {name: rf"Fig\. {escape(name[3:])}(?!\d)" for name in CARDS}
    return {name: [r["claim"] for r in rows if search(mark, r["section"])] for name, mark in named.items()}


_README_HEAD = """# Figures

Figures 3–6 are drawn from the CSV beside each, which the rule `draw` writes first; nothing else enters the
picture. Those of the blind study are drawn from the tables that are kept of it. Make all of them with
`snakemake --cores 2`, one with `snakemake --cores 2 figures/fig3.png`. The captions stand in the modules
named below; this page is made from them by `sonicvacuum.figures.readme`.

The pictures of a record that `sonicvacuum discover` looked into are not kept here: they lie beside its
verdict, in `results/discover/NAME`, drawn from the tables there by `figures/discovery.py` of the package, and
stand with their captions on the page `index.html` beside them.
"""


def make(name: str, studies: Mapping, out_dir) -> tuple[Path, Path, Path]:
    """Write `name`.csv, then read it back and draw `name`.svg and `name`.png from it.

    Equal studies give equal bytes.

    Args:
        name: of the figure.
        studies: card name → `sonicvacuum.study.Study` of the cards in `cards_of(name)`; others are ignored,
            and a card may be absent as long as its panel has another.
        out_dir: folder, made where it does not exist.

    Returns:
        The paths of the three files.

    Raises:
        InputError: for an unknown figure or a panel without a card.
    """
    from sonicvacuum.figures import style

    wanted = {card: studies[card] for card in cards_of(name) if card in studies}
    for panel in dict.fromkeys(card.split(".")[0] for card in CARDS[name]):
        if not any(card.startswith(f"{panel}.") for card in wanted):
            known = ", ".join(c for c in CARDS[name] if c.startswith(f"{panel}."))
            raise InputError(f"figure {name}: no simulated card of {panel}; simulate one of {known}")
    module, stem = _module(name), Path(out_dir) / name
    paths = tuple(stem.with_suffix(suffix) for suffix in (".csv", ".svg", ".png"))
    with replacing(paths[0]) as stream:
        module.table(wanted).to_csv(stream, index=False, float_format="%.9g", lineterminator="\n")
    figure = draw(name, paths[0])
    style.save(figure, *paths[1:])
    return paths


def draw(name: str, path):
    """The matplotlib Figure of the numbers in a CSV that `make` wrote; InputError where it is not one."""
    import pandas

    module = _module(name)
    try:
        table = pandas.read_csv(path)
    except (OSError, ValueError) as error:
        raise InputError(
            f"{path}: cannot be read as CSV ({error}); draw {name} from its cards again"
        ) from None
    if list(table.columns) != module.COLUMNS or table.empty:
        raise InputError(f"{path}: not the numbers of {name}; draw it from its cards again")
    return module.draw(table)


def _module(name):
    cards_of(name)
    return import_module(f"{__name__}.{name}")
