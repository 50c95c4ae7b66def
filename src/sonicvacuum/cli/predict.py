"""`sonicvacuum predict`: what a chain will show before it is built or measured."""

import json

import click

from sonicvacuum.cli.helped import WRITTEN, verb

# The chain to be built, as `predict` and `design` ask for it.
_CHAIN = (
    click.option("--beads", type=click.IntRange(1), required=True, help="Number of beads; bead 1 is struck."),
    click.option("--diameter", required=True, metavar="LENGTH", help="Outer diameter of a bead, as in 20mm."),
    click.option("--material", required=True, help="What touches; names: sonicvacuum materials."),
    click.option("--speed", metavar="M/S", help="Of the striker."),
    click.option("--mass", metavar="MASS", help="Of a bead, as in 33g; from the density otherwise."),
    click.option("--coating", metavar="LENGTH", help="Thickness of a coating of --material, as in 50um."),
    click.option("--core", metavar="MATERIAL", help="What coated beads are inside."),
    click.option("--wall", metavar="MATERIAL", help="Of the wall; the beads' (their core's) otherwise."),
    click.option("--orientation", type=click.Choice(["horizontal", "vertical"]), default="horizontal"),
    click.option("--preload", metavar="FORCE", help="Static force on bead 1, as in 2N."),
    click.option(
        "--striker", type=click.Choice(["sphere", "flat"]), default="sphere", help="A ball by default."
    ),
    click.option("--striker-mass", metavar="MASS", help="A bead's otherwise, or from its size and density."),
    click.option(
        "--striker-diameter", metavar="LENGTH", help="A bead's otherwise, or from mass and density."
    ),
    click.option("--striker-material", metavar="MATERIAL", help="The beads' (their core's) otherwise."),
    click.option("--gauges", metavar="3,7,wall", help="Beads that hold a gauge, and wall."),
)


def chain_options(command):
    """The command with the options that say what the chain is."""
    for option in reversed(_CHAIN):
        command = option(command)
    return command


@verb(
    "sonicvacuum predict --beads 10 --diameter 20mm --material bearing-steel --speed 0.5",
    "sonicvacuum predict --beads 10 --diameter 20mm --material bearing-steel --aim 5N --gauges 3,7,wall",
    short_help="What a chain will show: speed, force, arrivals, sampling.",
)
@chain_options
@click.option(
    "--aim",
    metavar="[GAUGE=]FORCE",
    help="Find the speed for this peak at the first gauge; the search begins at --speed.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("--out", type=WRITTEN, help="Picture (.svg, .png, .pdf) to write as well.")
@click.option(
    "--no-limits", is_flag=True, help="Simulate even what seems to need more than a computer gives."
)
def predict(as_json, out, no_limits, **given):
    """Say what a chain of equal beads will show: wave speed, forces, durations, arrivals, what to record."""
    if out:
        from sonicvacuum.figures.prediction import check_name, write

        check_name(out)
    from sonicvacuum.prediction import predict as predicted
    from sonicvacuum.prediction.text import content, text

    found = predicted(**given, limits=not no_limits)
    if out:
        write(found, out)
    click.echo(json.dumps(content(found), indent=1, allow_nan=False) if as_json else text(found))
