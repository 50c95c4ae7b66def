"""What verbs share: examples as they are typed, exit codes, completion, types of paths; the lock in use."""

import hashlib
from collections.abc import Callable, Sequence
from pathlib import Path

import click

from sonicvacuum.files import InputError, check_written
from sonicvacuum.outputs import check_folder

BEGINNING = """\b
With files of a recorder:
  sonicvacuum record import *.csv --list       # what is in them
  sonicvacuum record import --help             # make a record of them: my-record
  sonicvacuum record check my-record           # what is seen beside what is expected
  sonicvacuum discover my-record --out found   # then open found/index.html"""
EXIT_CODES = """\b
Exit codes:
  0    done, whatever a verdict says
  1    the machine's fault: a full disk, too little memory; or the program's
  2    input refused; one line says file, key, value and cure
  130  interrupted; 143 or 129 where asked to end by kill or a closing terminal"""
COMPLETION = """\b
Completion of verbs and options:
  eval "$(_SONICVACUUM_COMPLETE=bash_source sonicvacuum)"      # or zsh_source, fish_source"""


class Checked(click.Path):
    """A path that a function looks at as well, before anything is computed."""

    def __init__(self, check: Callable[[str], None], **options):
        super().__init__(**options)
        self.check = check

    def convert(self, value, param, ctx):
        path = super().convert(value, param, ctx)
        self.check(path)
        return path


def _check_named(path):
    """The empty path of a shell's unset variable would be the folder at work."""
    if not path:
        raise click.BadParameter("is empty; give the path of a folder, . for this one")


# Paths: a file to write, a folder to write, a folder to read, a file to write or the folder for
# several; a file to read is `sonicvacuum.cli.existing`.
WRITTEN = Checked(check_written, dir_okay=False)
FOLDER = Checked(_check_named, file_okay=False)
PRESENT = click.Path(exists=True, file_okay=False)
PLACE = click.Path()
# Digits of a SHA-256 that tell locks apart.
DIGITS = 12


def examples(*lines: str) -> str:
    """Epilog of a verb: commands as they are typed, one a line, never wrapped."""
    return "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)


def verb(*lines: str, **settings):
    """Decorator that makes a verb of a function, its examples at the end of its help."""
    return click.command(epilog=examples(*lines), **settings)


def places_of(out, names: Sequence[str], suffix: str) -> list[Path]:
    """Where a verb writes what it makes of some things: of one to `out`, of several to `out`/NAME.suffix.

    Raises:
        InputError: where two have one name, or that place cannot be written.
    """
    if len(names) == 1:
        check_written(out)
        return [Path(out)]
    return places_in(out, names, suffix)


def places_in(folder, names: Sequence[str], suffix: str) -> list[Path]:
    """Files of some names in a folder; InputError where two are one, or the folder cannot be written."""
    if twice := [name for k, name in enumerate(names) if name in names[:k]]:
        raise InputError(f"{twice[0]}: given twice; each is written to a file of its name: give it once")
    check_folder(folder)
    return [Path(folder, name + suffix) for name in names]


def locked() -> str:
    """Which lock of requirements this program stands beside, by the beginning of its SHA-256."""
    lock = Path(__file__).resolve().parents[3] / "requirements.lock"
    if not lock.is_file():
        return "installed as a package, no requirements.lock beside it"
    return f"requirements.lock sha256 {hashlib.sha256(lock.read_bytes()).hexdigest()[:DIGITS]}"


def strayed(here: Path, environment: Path) -> str:
    """What is wrong where a clone has an environment of its own and that of another one runs, "" elsewhere.

    An environment holds its own place: activated in a copy, it runs the code of the clone it was made in.
    """
    own = here / ".venv"
    if not (own.is_dir() and (here / "src/sonicvacuum").is_dir()) or own.resolve() == environment.resolve():
        return ""
    return (
        f"{here}: what runs is {environment}, not the .venv of this clone: was it moved or copied? Run make "
        "env here, then source .venv/bin/activate"
    )
