"""What the verbs that make records do with a list of cases: records in one folder, the truth in another."""

from collections.abc import Callable, Sequence
from pathlib import Path

import click

from sonicvacuum.files import InputError
from sonicvacuum_blind import TRUTH
from sonicvacuum_blind.cli.options import making


def make(cases: Sequence, write: Callable, records_folder, truth_folder, path=None) -> None:
    """Make the record of each case (`id`), keep its truth elsewhere, and tell the case.

    Args:
        cases: what to make.
        write: of a case and both folders.
        records_folder, truth_folder: where to.
        path: the list that the cases are from, if a user gave one.

    Raises:
        InputError: before anything is made where one folder holds the other, or holds something else; for a
            case that cannot be made.
    """
    from sonicvacuum.records.guard import check_collection

    _check_truth(truth_folder, records_folder)
    check_collection(records_folder, [c.id for c in cases], lambda name: Path(truth_folder) / name / TRUTH)
    for case in cases:
        with making(path):
            write(case, records_folder, truth_folder)
        click.echo(case.id)


def _check_truth(truth_folder, records_folder):
    """InputError where the truth would lie among the records that `discover` is given, or they in it."""
    from sonicvacuum.records.guard import check_out

    check_out(truth_folder)
    truth, records = (Path(folder).resolve() for folder in (truth_folder, records_folder))
    if truth.is_relative_to(records) or records.is_relative_to(truth):
        raise InputError(f"{truth_folder}: one folder holds the other; keep the truth away from --records")
