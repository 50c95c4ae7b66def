"""`sonicvacuum blind calibrate`: what `discover` learns from training cases."""

import click

from sonicvacuum.cli.helped import examples
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.options import present


@click.command(
    epilog=examples(
        "sonicvacuum blind calibrate --truth truth --verdicts found --out calibration.json",
    )
)
@click.option("--truth", required=True, type=present, help="Folder of truths.")
@click.option("--verdicts", required=True, type=present, help="Folder of verdicts.")
@click.option("--out", required=True, type=click.Path(dir_okay=False), help="Calibration (JSON) to write.")
def calibrate(truth, verdicts, out):
    """Find how the evidence that discover works out becomes probabilities that come true."""
    from sonicvacuum_blind.baselines import calibrate as calibration

    check_apart([out], [truth, verdicts])
    cases = calibration.outcomes(truth, verdicts)
    found = calibration.calibrate(cases)
    calibration.write(found, out)
    click.echo(f"temper {found.temper:g}, unknown {found.unknown:+g} and x{found.unknown_slope:g}")
