"""Options that several verbs of the blind test share."""

import re

import click

from sonicvacuum.files import InputError

STUDIES = click.Choice(["small", "full", "training"])


def batch_of(text: str) -> tuple[int, int]:
    """(k, n) of k/n; InputError where there is no such batch."""
    found = re.fullmatch(r"(\d+)/(\d+)", text)
    if not found or not int(found[1]) < int(found[2]):
        raise InputError(f"--batch: is {text!r}; write k/n with k from 0 to n - 1, such as 0/4")
    return int(found[1]), int(found[2])


def say(lines) -> None:
    """Print the lines of a summary that count something: share, 95 % interval, number, goal."""
    for line in lines:
        if line.count:
            interval = f"{line.value:.3f} [{line.low:.3f}, {line.high:.3f}]"
            click.echo(f"{line.measure}, {line.group}: {interval} of {line.count}  {line.goal}".rstrip())
