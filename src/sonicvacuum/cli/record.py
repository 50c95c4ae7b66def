"""`sonicvacuum record new`, `import`, `check`: start a record of measured data, see whether it is sound."""

import click

from sonicvacuum.cli.helped import FOLDER, examples
from sonicvacuum.cli.scope import import_
from sonicvacuum.files import in_one_line


class _InOrder(click.Group):
    """A group that lists its commands in the order of the work."""

    def list_commands(self, ctx):
        return list(self.commands)


@click.group(
    cls=_InOrder,
    epilog=examples("sonicvacuum record import *.csv --list", "sonicvacuum record check my-record"),
    short_help="Make and check records of measured data.",
)
def record():
    """Make records of measured data, by hand or of a recorder's files, and check them."""


@record.command(epilog=examples("sonicvacuum record new my-record"))
@click.argument("folder", type=FOLDER)
def new(folder):
    """Write a commented record.yaml into FOLDER."""
    from sonicvacuum.records import commands

    click.echo(in_one_line(str(commands.new(folder))))


record.add_command(import_)


@record.command(
    epilog=examples("sonicvacuum record check my-record", "sonicvacuum record check records/* --json"),
    short_help="What records hold, what is expected, what is suspicious.",
)
@click.argument("folders", nargs=-1, required=True, type=click.Path())
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI units.")
@click.option("--no-limits", is_flag=True, help="Check even what seems to need more than a computer gives.")
def check(folders, as_json, no_limits):
    """Say what is in the records in FOLDERS, what the nominal model expects, what looks suspicious.

    Arrival, amplitude, speed and width of each gauge and run stand beside those of the nominal model; slips
    of the set-up that they show are named. The window to record, what discover cuts off and thins of long
    traces, and the time that it will take, are told beforehand.
    """
    from sonicvacuum.report import checked

    click.echo(checked.check(folders, as_json, limits=not no_limits))
