"""The command `sonicvacuum`: one verb per step of the pipeline, each in its own file and loaded when called.

Bad input ends in one line on standard error and exit code 2, never in a traceback.
"""

import gc
import os
import sys
from contextlib import contextmanager, suppress
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path

import click

from sonicvacuum.blas import THREADS
from sonicvacuum.cli.ended import blamed, code_of, heard
from sonicvacuum.cli.helped import BEGINNING, COMPLETION, EXIT_CODES, Checked, locked, strayed
from sonicvacuum.cli.stage_lines import compiling_told
from sonicvacuum.files import MACHINE, InputError, check_file, in_one_line

# Verb → where it stands; the order is the order of the work. The two groups at the end belong to packages
# that the library does not import.
VERBS = {
    "card": "sonicvacuum.cli.card:card",
    "materials": "sonicvacuum.cli.card:materials",
    "effects": "sonicvacuum.cli.card:effects",
    "schema": "sonicvacuum.cli.card:schema",
    "simulate": "sonicvacuum.cli.simulate:simulate",
    "predict": "sonicvacuum.cli.predict:predict",
    "design": "sonicvacuum.cli.design:design",
    "record": "sonicvacuum.cli.record:record",
    "discover": "sonicvacuum.cli.discover:discover",
    "page": "sonicvacuum.cli.page:page",
    "compare": "sonicvacuum.cli.compare:compare",
    "export": "sonicvacuum.cli.export:export",
    "paper": "sonicvacuum_paper.cli:paper",
    "blind": "sonicvacuum_blind.cli:blind",
}
GROUPS = ("paper", "blind")


class Verbs(click.Group):
    """A group whose commands are imported on demand, so that each verb starts fast.

    Attributes:
        verbs: verb → `module:attribute` of its command, in the order of the work.
    """

    def __init__(self, *args, verbs=None, **options):
        super().__init__(*args, **options)
        self.verbs = verbs or {}

    def list_commands(self, ctx):
        """The verbs in the order of the work."""
        return list(self.verbs)

    def get_command(self, ctx, name):
        """The command of one verb, None for an unknown one."""
        if name not in self.verbs:
            return None
        module, attribute = self.verbs[name].split(":")
        return getattr(import_module(module), attribute)

    def resolve_command(self, ctx, args):
        """The command that the arguments name; a verb that does not exist gets the nearest ones named."""
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            near = self.nearest(ctx, args[0])
            if near:
                error.message = f"No such command {args[0]!r}. Did you mean {' or '.join(map(repr, near))}?"
            raise

    def nearest(self, ctx, name: str) -> list[str]:
        """Verbs of that name in a group below, or else up to two that are spelled like it."""
        groups = {verb: self.get_command(ctx, verb) for verb in self.verbs if verb in GROUPS}
        inside = sorted(f"{verb} {name}" for verb, group in groups.items() if name in group.verbs)
        return inside or get_close_matches(name, list(self.verbs), n=2)


def _show_version(ctx, param, asked):
    if asked and not ctx.resilient_parsing:
        from importlib.metadata import version

        click.echo(f"sonicvacuum {version('sonicvacuum')} ({locked()})")
        ctx.exit()


@click.group(
    cls=Verbs,
    verbs=VERBS,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=f"{BEGINNING}\n\n{EXIT_CODES}\n\n{COMPLETION}",
)
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_show_version,
    help="Show the version and the lock of its requirements.",
)
def cli():
    """Impacts in chains of beads: simulate them, find what is missing from the model of measured ones, hold
    both against a paper.
    """


# Package that only a part of the command needs → extra that brings it.
EXTRAS = {
    "grimp": "workflow",
    "matplotlib": "figures",
    "pandas": "workflow",
    "pysindy": "study",
    "sklearn": "study",
}


# Objects made between two looks for garbage, and looks between those that go further back. Nearly all of them
# are what a verb loads: looking through that again and again takes a twentieth of a search.
GARBAGE = (50_000, 50, 50)


def main():
    """Run the command line; bad input and interruption end quietly."""
    gc.set_threshold(*GARBAGE)
    # Before numpy is loaded: then none of scipy's libraries has to be loaded only to be limited.
    os.environ[THREADS] = "1"
    with suppress(OSError):  # a working folder that is gone
        if told := strayed(Path.cwd(), Path(sys.prefix)):
            click.echo(f"Warning: {in_one_line(told)}", err=True)
    came: list[int] = []
    try:
        with heard() as came, compiling_told():
            cli(standalone_mode=False)
        gc.freeze()  # nor is it looked through once more at the end
    except click.ClickException as error:
        error.show()
        sys.exit(2)
    except InputError as error:
        click.echo(f"Error: {in_one_line(str(error))}", err=True)
        sys.exit(2)
    except OSError as error:  # a full disk is the machine's fault, a place that cannot be written is not
        told = f"{error.filename or 'output'}: {error.strerror or error}"
        click.echo(f"Error: {in_one_line(told)}", err=True)
        _forget_output()
        sys.exit(1 if error.errno in MACHINE else 2)
    except ModuleNotFoundError as error:
        if error.name not in EXTRAS:
            raise
        cure = f"pip install 'sonicvacuum[{EXTRAS[error.name]}]'"
        click.echo(f"Error: {error.name} is not installed; this verb needs it: {cure}", err=True)
        sys.exit(2)
    except MemoryError as error:
        click.echo(f"Error: the memory does not suffice: {error}", err=True)
        sys.exit(1)
    except (click.Abort, KeyboardInterrupt):
        # At once: a compiler may still be at work in a thread that nobody waits for.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code_of(came[0]) if came else 130)
    except Exception as error:
        if not (told := blamed(error)):
            raise
        click.echo(f"Error: {in_one_line(told)}", err=True)
        sys.exit(2)


def _forget_output():
    """What a full output still holds would fail once more at exit, with a code of its own."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextmanager
def progress():
    """On a terminal, a bar that moves within each long simulation."""
    from tqdm import tqdm

    from sonicvacuum.physics.watch import told_to

    bars = []

    def move(part):
        if not bars:  # not before its kernels are compiled: of that a line tells
            bars.append(tqdm(total=1.0, disable=None, leave=False, bar_format="{l_bar}{bar}| {elapsed}"))
        bars[0].n = part
        bars[0].refresh()

    try:
        with told_to(move):
            yield
    finally:
        for bar in bars:
            bar.close()


def existing(**options):
    """Type of a path argument that must be a readable file: of a pipe no reader would see the end."""
    return Checked(check_file, exists=True, dir_okay=False, readable=True, **options)
