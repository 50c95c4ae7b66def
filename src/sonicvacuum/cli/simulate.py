"""`sonicvacuum simulate`: cards, integrated at the chosen step and at half of it."""

from pathlib import Path

import click

from sonicvacuum.cli import existing, progress
from sonicvacuum.cli.cards import read_card
from sonicvacuum.cli.helped import PLACE, places_of, verb
from sonicvacuum.cli.own_effects import catalogue, own_effects
from sonicvacuum.files import InputError
from sonicvacuum.outputs import check_apart

# Steps of a bead that a core does in a second, from a chain in many runs to a long one; told from so many on.
RATES = (5e7, 5e8)
LONG = 2e9
LARGE = 1 << 30  # bytes


@verb(
    "sonicvacuum simulate card.json --out history.npz",
    "sonicvacuum simulate cards/*.json --out histories",
)
@click.argument("cards", nargs=-1, required=True, type=existing())
@click.option(
    "--model",
    type=existing(),
    help="model.json of discover to put into the chain first; to observe the result, put it into the card.",
)
@click.option(
    "--no-limits", is_flag=True, help="Simulate even what seems to need more than a computer gives."
)
@click.option(
    "--out", required=True, type=PLACE, help="History (.npz) to write, of several cards the folder."
)
@own_effects
def simulate(cards, model, no_limits, out, own):
    """Integrate the chains of CARDS and keep the contact forces.

    The history of one card is written to OUT, those of several to OUT/NAME.npz, a card being NAME.json.
    All cards are read before the first is simulated.
    """
    from sonicvacuum import simulation

    places = places_of(out, [Path(path).stem for path in cards], ".npz")
    check_apart(places, [*cards, model, *own])
    known = catalogue(own)
    resolved = [read_card(path) for path in cards]
    if model:
        from sonicvacuum.cli.model import with_model

        resolved = [with_model(card, model, known) for card in resolved]
    for path, card in zip(cards, resolved, strict=True):
        try:
            _tell_beforehand(card, known, not no_limits)
        except InputError as error:
            raise InputError(f"{path}{f' with {model}' if model else ''}: {error}") from None
    for card, place in zip(resolved, places, strict=True):
        with progress():
            simulated = simulation.simulate(card, known, limits=not no_limits)
        for told in simulated.warnings:
            click.echo(f"Warning: {card.name}: {told}", err=True)
        simulation.save(simulated, place)


def _tell_beforehand(card, known, limits):
    """What a long or large simulation asks for, on standard error; InputError beyond the ceilings."""
    from sonicvacuum import simulation

    asked = simulation.check_extent(card, known) if limits else simulation.extent(card, known)
    if asked.work > LONG or asked.memory > LARGE:
        least, most = (asked.work / rate for rate in reversed(RATES))
        click.echo(
            f"{card.name}: {asked.work:.2g} steps of a bead, some {least:.3g} to {most:.3g} s of one core; "
            f"{asked.memory / 2**30:.2g} GiB of memory",
            err=True,
        )
