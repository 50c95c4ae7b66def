"""Examples at the end of a verb's help run as they stand, up to the files that are not there.

Those of the reproduction and of the blind study, some of which take minutes, are parsed only
(`tests/workflow/test_command_line.py`).
"""

import shlex

import click
import pytest
from click.testing import CliRunner

from sonicvacuum import cli
from sonicvacuum.files import InputError

# What is said of a file or folder that an example only supposes.
ABSENT = ("no such file", "no such folder", "does not exist")


def examples(command):
    """Arguments of every example in the help of a command and of those below it."""
    for line in (command.epilog or "").replace("\\\n", " ").splitlines():
        if line.strip().startswith("sonicvacuum "):
            yield tuple(shlex.split(line, comments=True)[1:])
    if isinstance(command, click.Group):
        for name in set(command.list_commands(None)) - set(cli.GROUPS):
            yield from examples(command.get_command(None, name))


@pytest.mark.parametrize("given", sorted(set(examples(cli.cli))), ids=" ".join)
def test_an_example_runs_or_misses_a_file_and_nothing_else(tmp_path, monkeypatch, given):
    monkeypatch.chdir(tmp_path)
    ended = CliRunner().invoke(cli.cli, given)
    told = f"{ended.output}{ended.exception}"
    if ended.exit_code:
        assert isinstance(ended.exception, InputError | SystemExit | FileNotFoundError), told
        assert any(words in told.lower() for words in ABSENT), told
