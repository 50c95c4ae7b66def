"""`sonicvacuum discover`, `page`, `compare`: what a record of measured data says is missing, told on a page,
and a model's score on a record.
"""

from pathlib import Path

import click

from sonicvacuum.cli import existing


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
def discover(records, out, together, figures, threads):
    """Find what is missing from the nominal model of measured data in the folders RECORDS.

    One record is written to OUT; of several each has its own folder OUT/<folder name>.
    """
    from sonicvacuum.discover import session
    from sonicvacuum.physics.run import available_threads
    from sonicvacuum.records import read

    groups = {Path(out): records} if together else {f: (p,) for p, f in _folders(records, Path(out)).items()}
    for folder, paths in groups.items():
        result = session.discover(*(read(p) for p in paths), threads=threads or available_threads())
        session.write(result, folder)
        if figures:
            _illustrate(folder)
        click.echo(f"{', '.join(paths)}: {_sentence(result.verdict)}")


@click.command()
@click.argument("folders", nargs=-1, required=True, type=click.Path(exists=True, file_okay=False))
def page(folders):
    """Draw the pictures of what discover wrote into FOLDERS, and write its page, index.html."""
    from sonicvacuum.report.record import section

    for folder in map(Path, folders):
        section(folder)  # what is not a discovery's folder is refused before anything is drawn
        _illustrate(folder)


def _illustrate(folder):
    from sonicvacuum.figures.discovery import draw
    from sonicvacuum.report.record import write_page

    draw(folder)
    write_page(folder)


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
    if not verdict.named and verdict.sees_nothing:
        return "none, but no effect of the catalogue would show in these data"
    named = verdict.named or ["none"]
    sure = verdict.probabilities.get(named[0], 0.0) if len(named) == 1 else None
    text = " + ".join(named) + (f" (probability {sure:.2f})" if sure is not None else "")
    alike = "; ".join(", ".join(c[1:]) for c in verdict.confusable)
    return text + (f"; could also be {alike}" if alike else "")


@click.command()
@click.argument("record", type=click.Path())
@click.option("--model", required=True, type=existing(), help="model.json of sonicvacuum discover.")
@click.option("--json", "path", required=True, type=click.Path(dir_okay=False), help="Score (JSON) to write.")
@click.option("--threads", type=click.IntRange(1), help="Threads; all processors by default.")
def compare(record, model, path, threads):
    """Score a MODEL on a RECORD; only the record's own nuisances are fitted."""
    from sonicvacuum.discover import compare as scoring
    from sonicvacuum.discover.verdict import write_json
    from sonicvacuum.physics.run import available_threads
    from sonicvacuum.records import read

    score = scoring.compare(scoring.read_model(model), read(record), threads or available_threads())
    write_json(score, Path(path))
    click.echo(f"{record}: {score.gap.before:.3g} before, {score.gap.after:.3g} after, floor 1")
