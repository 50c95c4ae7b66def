"""The stage of the pipeline that draws what the paper leaves open: configuration and claims to a table."""

from collections.abc import Iterable

from sonicvacuum.blas import one_thread
from sonicvacuum.card import Card
from sonicvacuum.config import Config
from sonicvacuum_paper.claims import Claim, read_table
from sonicvacuum_paper.uncertainty import agreement, inputs, sample, table


@one_thread
def write_uncertainty(
    claims_path, config: Config, out, count: int = inputs.DRAWS, named: Iterable[Card] = ()
) -> None:
    """Draw what the paper leaves open, simulate, write how probable each statement is under each model.

    A configuration without a ledger holds no statement against its cases: the table is then empty. `named`
    are the cards with the model that `discover` names.
    """
    rows, claims = [], read_table(claims_path, Claim)
    if config.ledger:
        cards = sample.cards_of(config, named)
        sampled = sample.sample(cards, inputs.draws(count))
        rows = agreement.build(cards["fig3a"], sampled, claims)
    table.write(rows, out)
