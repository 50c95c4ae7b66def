"""Simulated cards as verbs that draw them are given them."""

from collections.abc import Iterator
from pathlib import Path

from sonicvacuum.cli.cards import read_card


def loaded(cards, histories) -> Iterator:
    """The simulated cards of some card files, one at a time: together they would fill the memory."""
    from sonicvacuum import simulation

    for card in cards:
        yield simulation.load(read_card(card), Path(histories) / f"{Path(card).stem}.npz")
