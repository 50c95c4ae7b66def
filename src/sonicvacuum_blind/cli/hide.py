"""`sonicvacuum blind hide`: data with something hidden in them."""

from pathlib import Path

import click

from sonicvacuum.cli.helped import FOLDER, WRITTEN, verb
from sonicvacuum.files import InputError
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind import TRUTH
from sonicvacuum_blind.cli.options import batch_of, making, of_cases


@verb(
    "sonicvacuum blind hide --study small --list cases.csv",
    "sonicvacuum blind hide --study small --batch 0/4 --records records --truth truth",
)
@of_cases
@click.option("--list", "listing", type=WRITTEN, help="Write the list of cases (CSV) only.")
@click.option("--records", "records_folder", type=FOLDER, help="Folder for the records, one for each case.")
@click.option(
    "--truth", "truth_folder", type=FOLDER, help="Folder for the truth; keep it away from discover."
)
def hide(study, path, listing, batch, records_folder, truth_folder):
    """Make records in which an effect is hidden, and keep the truth elsewhere."""
    from sonicvacuum.records.guard import check_collection
    from sonicvacuum_blind import study as studies

    specs = studies.chosen(study, path, *((0, 1) if listing else batch_of(batch)))
    if listing:
        check_apart([listing], [path])
        studies.write_cases(specs, listing)
        return
    if not (records_folder and truth_folder):
        raise InputError("hide: --records and --truth are both needed to make data (or --list to list cases)")
    from sonicvacuum_blind.hide import write

    check_truth(truth_folder, records_folder)
    check_collection(records_folder, [s.id for s in specs], lambda name: Path(truth_folder) / name / TRUTH)
    for spec in specs:
        with making(path):
            write(spec, records_folder, truth_folder)
        click.echo(spec.id)


def check_truth(truth_folder, records_folder):
    """InputError where the truth would lie among the records that `discover` is given, or they in it."""
    from sonicvacuum.records.guard import check_out

    check_out(truth_folder)
    truth, records = (Path(folder).resolve() for folder in (truth_folder, records_folder))
    if truth.is_relative_to(records) or records.is_relative_to(truth):
        raise InputError(f"{truth_folder}: one folder holds the other; keep the truth away from --records")
