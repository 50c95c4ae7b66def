"""`sonicvacuum blind hide`: data with something hidden in them."""

import click

from sonicvacuum.cli import existing
from sonicvacuum.files import InputError
from sonicvacuum_blind.cli.options import STUDIES, batch_of, folder


@click.command()
@click.option("--study", type=STUDIES, help="A fixed list of cases.")
@click.option("--cases", "path", type=existing(), help="List of cases (CSV), instead of --study.")
@click.option(
    "--list", "listing", type=click.Path(dir_okay=False), help="Write the list of cases (CSV) only."
)
@click.option("--batch", default="0/1", show_default=True, help="k/n: every n-th case from the k-th on.")
@click.option("--records", "records_folder", type=folder, help="Folder for the records, one for each case.")
@click.option(
    "--truth", "truth_folder", type=folder, help="Folder for the truth; keep it away from discover."
)
def hide(study, path, listing, batch, records_folder, truth_folder):
    """Make records in which an effect is hidden, and keep the truth elsewhere."""
    from sonicvacuum_blind import study as studies

    if (study is None) == (path is None):
        raise InputError("hide: give --study or --cases, one of them")
    specs = studies.cases(study) if study else studies.read_cases(path)
    if listing:
        studies.write_cases(specs, listing)
        return
    if not (records_folder and truth_folder):
        raise InputError("hide: --records and --truth are both needed to make data (or --list to list cases)")
    from sonicvacuum_blind.hide import write

    for spec in studies.batch(specs, *batch_of(batch)):
        try:
            write(spec, records_folder, truth_folder)
        except ValueError as error:
            raise InputError(str(error)) from None
        click.echo(spec.id)
