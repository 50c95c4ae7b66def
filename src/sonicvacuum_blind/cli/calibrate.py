"""`sonicvacuum blind calibrate`: what `discover` learns from training cases."""

import click

from sonicvacuum.cli.helped import WRITTEN, verb
from sonicvacuum.outputs import check_apart
from sonicvacuum_blind.cli.options import held_against


@verb("sonicvacuum blind calibrate --truth truth --verdicts found --out calibration.json")
@held_against
@click.option("--out", required=True, type=WRITTEN, help="Calibration (JSON) to write.")
def calibrate(truth, verdicts, out):
    """Find how the evidence that discover works out becomes probabilities that come true."""
    from sonicvacuum_blind.baselines import calibrate as calibration

    check_apart([out], [truth, verdicts])
    cases = calibration.outcomes(truth, verdicts)
    found = calibration.calibrate(cases)
    calibration.write_json(found, out)
    click.echo(f"temper {found.temper:g}, unknown {found.unknown:+g} and x{found.unknown_slope:g}")
