"""`sonicvacuum discover`: what records of measured data say is missing from the model."""

from importlib import import_module
from pathlib import Path

import click

from sonicvacuum.cli.own_effects import catalogue, own_effects


@click.command()
@click.argument("records", nargs=-1, required=True, type=click.Path())
@click.option("--out", required=True, type=click.Path(file_okay=False), help="Folder to write.")
@click.option("--together", is_flag=True, help="RECORDS are of one chain and its gauges: one verdict on all.")
@click.option(
    "--figures/--no-figures",
    default=True,
    show_default=True,
    help="Draw the pictures and write the page, index.html.",
)
@click.option(
    "--threads",
    type=click.IntRange(1),
    help="Threads; all processors by default. Results do not depend on it.",
)
@own_effects
def discover(records, out, together, figures, threads, own):
    """Find what is missing from the nominal model of measured data in the folders RECORDS.

    One record is written to OUT; of several each has its own folder OUT/<folder name>.
    """
    from sonicvacuum.cli.page import illustrate, page_files
    from sonicvacuum.discover import session
    from sonicvacuum.outputs import renewed
    from sonicvacuum.physics.run import available_threads
    from sonicvacuum.records import read
    from sonicvacuum.records.guard import check_out

    if figures:
        # Where matplotlib is missing, that is said before the search and not after it.
        import_module("sonicvacuum.figures.style")
    known = catalogue(own)
    groups = {Path(out): records} if together else {f: (p,) for p, f in _folders(records, Path(out)).items()}
    for folder in groups:
        check_out(folder, records)
    for folder, paths in groups.items():
        result = session.discover(
            *(read(p) for p in paths), threads=threads or available_threads(), catalogue=known
        )
        with renewed(folder, last="verdict.json", stale=page_files()) as fresh:
            session.write(result, fresh)
            if figures:
                illustrate(fresh, known)
        click.echo(f"{', '.join(paths)}: {_sentence(result.verdict)}")


def _folders(records, out):
    """Record → folder to write, InputError where two would share one."""
    from sonicvacuum.files import InputError

    if len(records) == 1:
        return {records[0]: out}
    folders: dict[str, Path] = {}
    for path in records:
        folder = out / Path(path).resolve().name
        if folder in folders.values():
            raise InputError(f"{path}: another record has the folder name {folder.name}; rename one of them")
        folders[path] = folder
    return folders


def _sentence(verdict):
    from sonicvacuum.cli.page import slips_of

    slips = slips_of(verdict)
    return f"check first: {slips}; missing: {_named(verdict)}" if slips else _named(verdict)


def _named(verdict):
    if not verdict.named and verdict.sees_nothing:
        return "none, but no effect of the catalogue would show in these data"
    named = verdict.named or ["none"]
    sure = verdict.probability
    text = " + ".join(named) + (f" (probability {sure:.2f})" if sure is not None else "")
    alike = "; ".join(", ".join(c[1:]) for c in verdict.confusable)
    return text + (f"; could also be {alike}" if alike else "")
