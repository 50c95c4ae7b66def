"""`sonicvacuum baselines`, `calibrate`, `draw-study`, `publish-study`: simpler rules on the cases of a blind
study, what is learnt from training cases, its pictures, and what of it is kept in git.
"""

from pathlib import Path

import click

from sonicvacuum.cli import existing

_FOLDER = click.Path(exists=True, file_okay=False)
_RULES = ("best-chi2", "bic", "nearest-shape", "forest", "state")


@click.command()
@click.option("--records", required=True, type=_FOLDER, help="Folder of the cases' records.")
@click.option("--truth", required=True, type=_FOLDER, help="Folder of truths.")
@click.option("--verdicts", required=True, type=_FOLDER, help="Folder of verdicts.")
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="Table (CSV) to write.")
@click.option("--training", type=_FOLDER, help="Folder with records/, truth/ and verdicts/ to learn from.")
@click.option(
    "--rule",
    "wanted",
    multiple=True,
    type=click.Choice(_RULES),
    help="Only these; repeat. forest and state need the packages that make study installs.",
)
@click.option(
    "--state-cases",
    default=200,
    show_default=True,
    type=click.IntRange(1),
    help="So many cases, evenly spread, for the rule state, which integrates each chain again.",
)
def baselines(records, truth, verdicts, out, training, wanted, state_cases):
    """Name what is hidden by simpler rules on the same cases, and count how often they are right."""
    from sonicvacuum.baselines import table
    from sonicvacuum.baselines.cases import read
    from sonicvacuum.blind.score import write_table

    cases = read(records, truth, verdicts)
    known = read(*(Path(training) / part for part in ("records", "truth", "verdicts"))) if training else []
    lines = table.compare(cases, known, wanted or table.RULES, state_cases)
    write_table(lines, table.Line, out)
    for line in lines:
        text = f"{line.rule}, {line.measure}, {line.group}: {line.value:.3f}"
        click.echo(f"{text} [{line.low:.3f}, {line.high:.3f}] of {line.count}")


@click.command()
@click.option("--truth", required=True, type=_FOLDER, help="Folder of truths.")
@click.option("--verdicts", required=True, type=_FOLDER, help="Folder of verdicts.")
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="Calibration (JSON) to write.")
def calibrate(truth, verdicts, out):
    """Find how the evidence that discover works out becomes probabilities that come true."""
    from sonicvacuum.baselines import calibrate as calibration

    cases = calibration.outcomes(truth, verdicts)
    found = calibration.calibrate(cases)
    calibration.write(found, out)
    click.echo(f"temper {found.temper:g}, unknown {found.unknown:+g} and x{found.unknown_slope:g}")


@click.command()
@click.argument("folder", type=_FOLDER)
@click.option(
    "--picture",
    "wanted",
    multiple=True,
    type=click.Choice(["confusion", "accuracy", "reliability", "baselines"]),
    help="Only these; repeat.",
)
@click.option("--out", type=click.Path(file_okay=False), help="Folder for the pictures instead of FOLDER.")
@click.option("--prefix", default="", help="Put before their names.")
def draw_study(folder, wanted, out, prefix):
    """Draw the tables of a blind study in FOLDER: confusion, accuracy, reliability, baselines."""
    from sonicvacuum.figures.study import draw

    for path in draw(Path(folder), wanted, out, prefix):
        click.echo(str(path))


@click.command()
@click.argument("folder", type=_FOLDER)
@click.option("--readme", required=True, type=existing(), help="README whose part on the study is renewed.")
@click.option("--keep", required=True, type=click.Path(file_okay=False), help="Where the tables are kept.")
def publish_study(folder, readme, keep):
    """Keep the tables of the blind study in FOLDER in git, and in the README."""
    from sonicvacuum.report.study import publish

    publish(folder, readme, keep)
