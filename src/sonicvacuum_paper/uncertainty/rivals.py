"""The stage of the pipeline that compares rivals: the two lossy models, relaxing solids, fits to the record.

Apart from the draws (`stage`), which a change of the search for effects must not remake.
"""

from collections.abc import Mapping

from sonicvacuum.blas import one_thread
from sonicvacuum.config import Config
from sonicvacuum.files import InputError, replacing
from sonicvacuum.records import Record
from sonicvacuum_paper.columns import column_cards
from sonicvacuum_paper.uncertainty import decide, explained, identify, losses, viscoelastic
from sonicvacuum_paper.uncertainty.formats import HEADERS


@one_thread
def write_rivals(config: Config, record: Record, out: Mapping[str, str]) -> None:
    """Write the tables in which the two lossy models, and a relaxing solid, are held against each other.

    Args:
        config: must have fig3a, fig5a and fig6b under the models compared; the tables are empty without a
            ledger.
        record: what the paper prints of its coated chain.
        out: name of `formats.HEADERS` → file.
    """
    if not config.ledger:
        for name, header in HEADERS.items():
            with replacing(out[name]) as stream:
                stream.write(",".join(header) + "\n")
        return
    cards = column_cards(config, "fig3a")
    missing = [model for model in ("layer_loss", "matched_loss", "matched") if model not in cards]
    if missing:
        raise InputError(f"cases.fig3a: no variant for the ledger's column {missing[0]}; add one")
    lossy = {case: column_cards(config, case) for case in losses.CASES}
    for case, of_case in lossy.items():
        for model in losses.CONTACTS:
            if model not in of_case:
                raise InputError(f"cases.{case}: no variant for the ledger's column {model}; add one")
    tables = {
        "map": lambda: identify.table(cards["layer_loss"]),
        "experiments": lambda: decide.table(cards),
        "relaxation": lambda: viscoelastic.table(cards["matched"]),
        "losses": lambda: losses.table(lossy),
        "explained": lambda: explained.table(record),
    }
    for name, made in tables.items():
        with replacing(out[name]) as stream:
            made().to_csv(stream, index=False, float_format="%.6g", lineterminator="\n")
