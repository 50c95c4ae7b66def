"""The commands of the README work as they are printed, one after the other."""

import re
import shlex
from itertools import pairwise

import click
import pytest

from sonicvacuum.cli import cli

ACTIVATION = "source .venv/bin/activate"


@pytest.fixture(scope="module")
def commands(pytestconfig):
    """Lines of the README's fenced blocks in order, comments left out."""
    text = (pytestconfig.rootpath / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```\w*\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    blocks = [re.sub(r"\\\n\s*", "", block) for block in blocks]  # continued lines
    return [line.split("#")[0].strip() for block in blocks for line in block.splitlines()]


def test_the_command_is_put_on_the_path_before_it_is_called(commands):
    """The environment has been built before, and whoever starts at the records is told too."""
    first = next(k for k, line in enumerate(commands) if line.startswith("sonicvacuum "))
    assert commands[first - 1] == ACTIVATION
    assert commands.index("make env") < commands.index(ACTIVATION)


def test_every_call_names_a_verb_and_options_that_exist(commands):
    calls = [shlex.split(line)[1:] for line in commands if line.startswith("sonicvacuum ")]
    assert len(calls) >= 5
    for words in calls:
        parsed(cli, words)


def parsed(command, words):
    """Parse without running; click.UsageError where a verb or option does not exist."""
    context = click.Context(command)
    if isinstance(command, click.Group):
        _, inner, rest = command.resolve_command(context, words)
        return parsed(inner, rest)
    _, left, _ = command.make_parser(context).parse_args(list(words))
    given = {option for option in command.params for name in option.opts if name in words}
    assert left == []
    assert all(p in given for p in command.params if p.required and isinstance(p, click.Option)), words
    return words


def test_no_word_stands_for_a_file_that_is_not_there(commands, pytestconfig):
    """Each file or folder that a call reads was written by an earlier one, or belongs to the project."""
    made = set()
    for line in (line for line in commands if line.startswith("sonicvacuum ")):
        words = shlex.split(line)[1:]
        words = [w for w in words if "*" not in w and w != "--record"]
        names = [
            w for w in words if re.fullmatch(r"(?!\d)[\w.-]+(/[\w.-]+)*", w) and ("-record" in w or "." in w)
        ]
        written = {after for w, after in pairwise(words) if w in ("--out", "--json")}
        written |= {words[2]} if words[:2] == ["record", "new"] else set()
        if words[:2] == ["record", "import"]:
            names = [n for n in names if not n.endswith(".csv")]  # the recorder's own files
        for name in set(names) - written:
            assert name.split("/")[0] in made or (pytestconfig.rootpath / name).exists(), line
        made |= written
