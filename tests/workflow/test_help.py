"""Every verb explains itself, by examples that parse."""

import hashlib

import click
import pytest
from commands import call

from sonicvacuum import cli
from sonicvacuum.cli import VERBS


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_has_help(monkeypatch, capsys, verb):
    assert call(monkeypatch, verb, "--help") == 0
    assert "Usage: " in capsys.readouterr().out


def test_the_help_lists_all_verbs(monkeypatch, capsys):
    assert call(monkeypatch, "--help") == 0
    shown = capsys.readouterr().out
    assert all(f"  {verb}" in shown for verb in VERBS)


@pytest.mark.parametrize("group", ["paper", "blind"])
def test_every_verb_of_a_group_has_help(monkeypatch, capsys, group):
    for verb in cli.cli.get_command(None, group).verbs:
        assert call(monkeypatch, group, verb, "--help") == 0
        assert f"sonicvacuum {group} {verb}" in capsys.readouterr().out.replace("__main__.py", "sonicvacuum")


def leaves(group, path=()):
    """(words, command) of every verb, those in groups included."""
    for name in group.list_commands(None):
        command = group.get_command(None, name)
        below = isinstance(command, click.Group)
        yield from leaves(command, (*path, name)) if below else [((*path, name), command)]


@pytest.mark.parametrize(("words", "command"), list(leaves(cli.cli)))
def test_the_help_of_every_verb_ends_with_examples_that_parse(words, command):
    whole = command.epilog.replace("\\\n", " ")
    examples = [line.strip() for line in whole.splitlines() if "sonicvacuum" in line]
    assert examples
    for line in examples:
        given = line.split()
        assert given[: 1 + len(words)] == ["sonicvacuum", *words]
        rest = given[1 + len(words) :]
        # Files of an example need not be there; verbs and options must.
        context = click.Context(command, resilient_parsing=True)
        given, _, _ = command.make_parser(context).parse_args(rest)
        required = [p.name for p in command.params if p.required]
        assert [name for name in required if not given.get(name)] == []


def test_exit_codes_and_completion_are_told(monkeypatch, capsys):
    assert call(monkeypatch, "--help") == 0
    told = capsys.readouterr().out
    for code in ("0    done", "1    the machine", "2    input refused", "130  interrupted"):
        assert code in told
    assert "_SONICVACUUM_COMPLETE" in told


def test_the_version_names_the_lock(monkeypatch, capsys, pytestconfig):
    assert call(monkeypatch, "--version") == 0
    digest = hashlib.sha256((pytestconfig.rootpath / "requirements.lock").read_bytes()).hexdigest()
    assert f"requirements.lock sha256 {digest[:12]}" in capsys.readouterr().out
