"""`figures/README.md`: each figure with its caption, and what it is made from."""

from pathlib import Path
from re import escape, search

from sonicvacuum.tables import read_csv
from sonicvacuum_blind import kept
from sonicvacuum_paper.figures import CARDS, caption

_HEAD = """# Figures

Figures 3–6 are drawn from the CSV beside each, which the rule `draw` writes first; nothing else enters the
picture. Those of the blind study are drawn from the tables that are kept of it. Make all of them with
`snakemake --cores 2`, one with `snakemake --cores 2 figures/fig3.png`. The captions stand in the modules
named below; this page is made from them by `sonicvacuum_paper.report.guide`.

The pictures of a record that `sonicvacuum discover` looked into are not kept here: they lie beside its
verdict, in `results/discover/NAME`, drawn from the tables there by `src/sonicvacuum/figures/discovery.py`,
and stand with their captions on the page `index.html` beside them.
"""


def text(claims) -> str:
    """Text of `figures/README.md`: figure, cards, rule and claims, with the captions.

    Args:
        claims: path of the table of claims; a claim belongs to the figures that its section names.

    Pictures of the blind study are those whose tables are kept below the working folder.
    """
    lines = [_HEAD]
    found = _claims(claims)
    for name in CARDS:
        title = f"Fig. {name[3:]}"
        lines += [
            f"## {title}\n",
            f"![{title}]({name}.png)\n",
            f"{caption(name)}\n",
            f"* Files: [{name}.csv]({name}.csv), [{name}.svg]({name}.svg), [{name}.png]({name}.png)",
            f"* Module: `src/sonicvacuum_paper/figures/{name}.py`; "
            "rule: `draw` in `workflow/rules/figures.smk`",
            f"* Cards: {', '.join(f'`{card}`' for card in CARDS[name])}",
            f"* Claims: {', '.join(f'`{claim}`' for claim in found[name])}\n",
        ]
    for name, title in kept.PICTURES.items():
        table = kept.table(name)
        if not Path(table).exists():
            continue
        lines += [
            f"## {title}\n",
            f"![{title}]({name}.png)\n",
            f"{kept.caption(name)}\n",
            f"* Files: [{name}.svg]({name}.svg), [{name}.png]({name}.png); table: [{table}](../{table})",
            "* Module: `src/sonicvacuum_blind/figures.py`; rule: `draw_kept` in `workflow/rules/blind.smk`\n",
        ]
    return "\n".join(lines)


def _claims(path) -> dict[str, list[str]]:
    rows = read_csv(path)
    named = {name: rf"Fig\. {escape(name[3:])}(?!\d)" for name in CARDS}
    return {name: [r["claim"] for r in rows if search(mark, r["section"])] for name, mark in named.items()}
