"""`sonicvacuum blind hide`: data with something hidden in them."""

import click

from sonicvacuum.cli.helped import FOLDER, WRITTEN, verb
from sonicvacuum.files import InputError
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.made import make
from sonicvacuum_blind.cli.options import batch_of, of_cases


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
    from sonicvacuum_blind import study as studies

    specs = studies.chosen(study, path, *((0, 1) if listing else batch_of(batch)))
    if listing:
        check_apart([listing], [path])
        studies.write_cases(specs, listing)
        return
    if not (records_folder and truth_folder):
        raise InputError("hide: --records and --truth are both needed to make data (or --list to list cases)")
    from sonicvacuum_blind.hide import write

    make(specs, write, records_folder, truth_folder, path)
