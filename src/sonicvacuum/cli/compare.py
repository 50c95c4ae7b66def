"""`sonicvacuum compare`: a model's score on a record."""

from pathlib import Path

import click

from sonicvacuum.cli import existing
from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.cli.own_effects import catalogue, own_effects
from sonicvacuum.files import in_one_line


@verb(
    "sonicvacuum compare other-record --model found/model.json --json score.json",
    short_help="Score a model on a record that it has not seen.",
)
@click.argument("record", type=click.Path())
@click.option("--model", required=True, type=existing(), help="model.json of sonicvacuum discover.")
@click.option("--json", "path", required=True, type=WRITTEN, help="Score (JSON) to write.")
@click.option("--threads", type=click.IntRange(1), help="Threads; all processors by default.")
@own_effects
def compare(record, model, path, threads, own):
    """Score a MODEL on a RECORD; only the record's own nuisances are fitted."""
    from sonicvacuum.discover import compare as scoring
    from sonicvacuum.discover.verdict import write_json
    from sonicvacuum.outputs import check_apart, check_folder
    from sonicvacuum.records import read

    check_apart([path], [record, model, *own])
    check_folder(Path(path).parent)
    known = catalogue(own)
    found, measured = scoring.read_model(model, known), read(record)
    from sonicvacuum.physics.run import available_threads  # long to load: what is wrong is said before

    score = scoring.compare(found, measured, threads or available_threads(), known)
    write_json(score, Path(path))
    for told in score.warnings:
        click.echo(f"Warning: {in_one_line(record)}: {told}", err=True)
    gap = f"nominal model {score.gap.before:.3g}, MODEL {score.gap.after:.3g}"
    click.echo(f"{in_one_line(record)}: mean squared misfit over that of the noise: {gap}")
