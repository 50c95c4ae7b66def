"""`sonicvacuum blind follow`: one more run for cases left ambiguous."""

from pathlib import Path

import click

from sonicvacuum.cli.helped import FOLDER, PRESENT, verb
from sonicvacuum.files import InputError
from sonicvacuum_blind.cli.options import batch_of, making, of_cases

# Designs whose records all have traces, so that a further run can be asked for.
TRACED = ("traces", "one-speed")


@verb("sonicvacuum blind follow --study small --verdicts found --choice proposed --records further")
@of_cases
@click.option("--verdicts", required=True, type=PRESENT, help="Folder of the verdicts on their records.")
@click.option("--records", "out", required=True, type=FOLDER, help="Folder for the records of further runs.")
@click.option(
    "--choice",
    required=True,
    type=click.Choice(["proposed", "random", "fresh"]),
    help="The run that the verdict proposes, or one drawn from all that could be; fresh: that, of all.",
)
def follow(study, path, verdicts, out, choice, batch):
    """Make one more run of the same laboratory for each case that its verdict leaves ambiguous, or for all.

    Ambiguous: one effect is hidden, one is named, others could not be told from it, and the hidden one is
    among them. Take the record of a case and OUT/<id> together with sonicvacuum discover --together.
    """
    from sonicvacuum.records.guard import check_collection
    from sonicvacuum_blind import followup
    from sonicvacuum_blind import study as studies

    specs = studies.chosen(study, path, *batch_of(batch))
    check_apart_from_verdicts(out, verdicts)
    check_collection(out, [spec.id for spec in specs], lambda name: Path(out) / name / followup.FILE)
    # The folder stands for the batch also where nothing in it is ambiguous.
    Path(out).mkdir(parents=True, exist_ok=True)
    for spec, verdict in _chosen(specs, verdicts, choice):
        with making(path):
            followup.write(spec, verdict, choice, out)
        click.echo(spec.id)


def check_apart_from_verdicts(out, verdicts):
    """InputError where records would be written among the verdicts that are read."""
    if Path(out).resolve().is_relative_to(Path(verdicts).resolve()):
        raise InputError(f"{out}: lies in {verdicts}, which is read here; give another folder for --records")


def _chosen(specs, verdicts, choice):
    """(case, verdict) of ambiguous cases, or for fresh runs of all that hide effects in traces; InputError
    where one has no verdict, or not a whole one.
    """
    from sonicvacuum_blind.followup import FRESH, ambiguous
    from sonicvacuum_blind.score import found_in, load, whole

    paths = found_in(verdicts, "verdict.json")
    missing = [spec.id for spec in specs if spec.id not in paths]
    if missing:
        raise InputError(
            f"{verdicts}: no verdict for {len(missing)} of {len(specs)} cases, first {missing[0]}; "
            "run sonicvacuum discover on their records"
        )
    for spec in specs:
        verdict = load(paths[spec.id])
        with whole(paths[spec.id], "run sonicvacuum discover again"):
            chosen = spec.effects and spec.design in TRACED if choice == FRESH else ambiguous(spec, verdict)
        if chosen:
            yield spec, verdict
