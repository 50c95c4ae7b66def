"""`sonicvacuum simulate`: one card, integrated at the chosen step and at half of it."""

import click

from sonicvacuum.cli import existing, progress
from sonicvacuum.cli.cards import read_card
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.cli.own_effects import catalogue, own_effects
from sonicvacuum.outputs import check_apart

# Steps of a bead that a core does in a second, from a chain in many runs to a long one; told from so many on.
RATES = (5e7, 5e8)
LONG = 2e9
LARGE = 1 << 30  # bytes


@verb("sonicvacuum simulate card.json --out history.npz")
@click.argument("card", type=existing())
@click.option(
    "--model",
    type=existing(),
    help="model.json of discover to put into the chain first; to observe the result, put it into the card.",
)
@click.option(
    "--no-limits", is_flag=True, help="Simulate even what seems to need more than a computer gives."
)
@click.option("--out", required=True, type=WRITTEN, help="History (.npz) to write.")
@own_effects
def simulate(card, model, no_limits, out, own):
    """Integrate the chains of a CARD and keep the contact forces."""
    from sonicvacuum import simulation

    check_apart([out], [card, model, *own])
    resolved, known = read_card(card), catalogue(own)
    if model:
        from sonicvacuum.cli.model import with_model

        resolved = with_model(resolved, model, known)
    _tell_beforehand(resolved, known, not no_limits)
    with progress():
        simulated = simulation.simulate(resolved, known, limits=not no_limits)
    for told in simulated.warnings:
        click.echo(f"Warning: {resolved.name}: {told}", err=True)
    simulation.save(simulated, out)


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
