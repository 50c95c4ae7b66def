"""`sonicvacuum record new`, `import`, `check`: start a record of measured data, see whether it is sound."""

import click

from sonicvacuum.cli.scope import import_


@click.group()
def record():
    """Start and check records of measured data."""


@record.command()
@click.argument("folder", type=click.Path(file_okay=False))
def new(folder):
    """Write a commented record.yaml into FOLDER."""
    from sonicvacuum.records import commands

    click.echo(commands.new(folder))


@record.command()
@click.argument("folders", nargs=-1, required=True, type=click.Path())
def check(folders):
    """Read the records in FOLDERS and say what is in them and what looks suspicious."""
    from sonicvacuum.records import commands

    click.echo(commands.check(folders))


record.add_command(import_)
