"""`sonicvacuum blind draw`: the pictures of a study."""

import click

from sonicvacuum.cli.helped import FOLDER, PRESENT, verb


@verb("sonicvacuum blind draw workflow/resources/reference/blind_full --picture accuracy --out pictures")
@click.argument("folder", type=PRESENT)
@click.option(
    "--picture",
    "wanted",
    multiple=True,
    type=click.Choice(["confusion", "accuracy", "reliability", "pit", "baselines"]),
    help="Only these; repeat.",
)
@click.option("--out", type=FOLDER, help="Folder for the pictures instead of FOLDER.")
@click.option("--prefix", default="", help="Put before their names.")
def draw(folder, wanted, out, prefix):
    """Draw the tables of a blind study in FOLDER: confusion, accuracy, reliability, pit, baselines."""
    from sonicvacuum_blind import kept

    tables = kept.read(folder, wanted)
    from sonicvacuum_blind import figures  # long to load: what is missing is said before

    for path in figures.draw(tables, out or folder, prefix):
        click.echo(str(path))
