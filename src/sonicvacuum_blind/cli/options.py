"""Options that several verbs of the blind test share."""

import re
from contextlib import contextmanager

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import FOLDER, PRESENT, WRITTEN
from sonicvacuum.files import InputError

STUDIES = click.Choice(["small", "full", "nulls", "again", "training", "laws", "beside", "beside-training"])


def batch_of(text: str) -> tuple[int, int]:
    """(k, n) of k/n; InputError where there is no such batch."""
    found = re.fullmatch(r"(\d+)/(\d+)", text)
    if not found or not int(found[1]) < int(found[2]):
        raise InputError(f"--batch: is {text!r}; write k/n with k from 0 to n - 1, such as 0/4")
    return int(found[1]), int(found[2])


@contextmanager
def making(path=None):
    """Turn a case that cannot be made, or asked about, into one InputError; with the list that it is from."""
    try:
        yield
    except ValueError as error:
        raise InputError(f"{path}: {error}" if path else str(error)) from None


def _all_of(*options):
    """One decorator for several options, in this order."""

    def given(function):
        for option in reversed(options):
            function = option(function)
        return function

    return given


_BATCH = click.option(
    "--batch", default="0/1", show_default=True, help="k/n: every n-th case from the k-th on."
)
# Which cases, of a verb that takes a study or a list.
of_cases = _all_of(
    click.option("--study", type=STUDIES, help="A fixed list of cases."),
    click.option("--cases", "path", type=existing(), help="List of cases (CSV), instead of --study."),
    _BATCH,
)
# Where a verb that makes records writes them.
made_into = _all_of(
    _BATCH,
    click.option(
        "--records",
        "records_folder",
        required=True,
        type=FOLDER,
        help="Folder for the records, one for each case.",
    ),
    click.option(
        "--truth",
        "truth_folder",
        required=True,
        type=FOLDER,
        help="Folder for the truth; keep it away from discover.",
    ),
)
# What a verb that counts reads.
held_against = _all_of(
    click.option("--truth", required=True, type=PRESENT, help="Folder of truths."),
    click.option("--verdicts", required=True, type=PRESENT, help="Folder of verdicts."),
)
# Where a verb that counts writes; `page` is one of docs/.
counted_into = _all_of(
    click.option("--out", required=True, type=WRITTEN, help="Row of each record (CSV) to write."),
    click.option("--summary", required=True, type=WRITTEN, help="Table (CSV) to write."),
    click.option("--page", type=existing(), help="Page (Markdown) whose table is written anew."),
)
partly = click.option("--partly", is_flag=True, help="Leave out cases that have no verdict yet.")


def say(lines) -> None:
    """Print the lines of a summary that count something: share, 95 % interval, number, goal."""
    for line in lines:
        if line.count:
            interval = f"{line.value:.3f} [{line.low:.3f}, {line.high:.3f}]"
            click.echo(f"{line.measure}, {line.group}: {interval} of {line.count}  {line.goal}".rstrip())


def keep(rows, kind: type, lines, out, summary, page=None) -> None:
    """Write rows of a dataclass and the lines of their summary, renew the page's table, print the lines."""
    from sonicvacuum_blind import table_page
    from sonicvacuum_blind.score import SummaryLine, write_table

    if page:
        # A page without a place for the table is found out before anything is written.
        table_page.around(page)
    write_table(rows, kind, out)
    write_table(lines, SummaryLine, summary)
    if page:
        table_page.write(lines, page)
    say(lines)
