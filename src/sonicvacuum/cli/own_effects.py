"""The option `--effects` of several verbs: effects of the user's own beside those of the catalogue.

It stands apart, so that verbs without it do not depend on the engine, with which such effects are tried.
"""

import click

from sonicvacuum.cli import existing

own_effects = click.option(
    "--effects",
    "own",
    multiple=True,
    type=existing(),
    metavar="FILE",
    help="Python file with an effect of your own (EFFECT or EFFECTS), for the catalogue; may be repeated.",
)


def catalogue(files=()):
    """The project's effects, those of installed packages and those of files."""
    from sonicvacuum.plugins import catalogue

    return catalogue(files)
