"""`sonicvacuum record new`, `import`, `check`: start a record of measured data, see whether it is sound."""

import click

from sonicvacuum.cli.helped import examples
from sonicvacuum.cli.scope import import_


@click.group(epilog=examples("sonicvacuum record check my-record"))
def record():
    """Start and check records of measured data."""


@record.command(epilog=examples("sonicvacuum record new my-record"))
@click.argument("folder", type=click.Path(file_okay=False))
def new(folder):
    """Write a commented record.yaml into FOLDER."""
    from sonicvacuum.records import commands

    click.echo(commands.new(folder))


@record.command(
    epilog=examples("sonicvacuum record check my-record", "sonicvacuum record check records/* --json")
)
@click.argument("folders", nargs=-1, required=True, type=click.Path())
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI units.")
def check(folders, as_json):
    """Say what is in the records in FOLDERS, what the nominal model expects, what looks suspicious.

    Arrival, amplitude, speed and width of each gauge and run stand beside those of the nominal model; slips
    of the set-up that they betray are named, the window to record and the time of a search estimated.
    """
    from sonicvacuum.records import commands

    click.echo(commands.check(folders, as_json))
    if not as_json:
        _echo_slips(folders)


def _echo_slips(folders):
    """What the traces alone betray, as `discover` would say it."""
    from sonicvacuum.discover.faults.examine import examine
    from sonicvacuum.records import read
    from sonicvacuum.report.bench import slip

    for folder in folders:
        for found in examine(read(folder))[1]:
            click.echo(f"{folder}: check first: {slip(found)}")


record.add_command(import_)
