"""The stage of the pipeline that draws: reads configuration and claims, writes the table of probabilities."""

from sonicvacuum.blas import one_thread
from sonicvacuum.config import Config
from sonicvacuum_paper.claims import Claim, read_table
from sonicvacuum_paper.uncertainty import agreement, inputs, sample, table


@one_thread
def write_uncertainty(claims_path, config: Config, out, count: int = inputs.DRAWS) -> None:
    """Draw what the paper leaves open, simulate, write how probable each statement is under each model."""
    sampled = sample.sample(config, inputs.draws(count))
    table.write(agreement.build(config, sampled, read_table(claims_path, Claim)), out)
