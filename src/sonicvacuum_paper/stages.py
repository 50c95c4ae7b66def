"""The stages of the pipeline that make tables: each reads files, writes files, and is one command."""

from collections.abc import Iterable
from pathlib import Path

from sonicvacuum.blas import one_thread
from sonicvacuum.card import variant_names
from sonicvacuum.config import Config, card, model
from sonicvacuum.files import InputError
from sonicvacuum_paper import arithmetic, assumptions, audit, compare, ledger, theory_rows
from sonicvacuum_paper.columns import Metrics, column_cards
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.rows import Row, read_rows, write_absent, write_rows
from sonicvacuum_paper.uncertainty import table


def absent_path(metrics_path) -> Path:
    """Where the reasons of absent metrics stand: `absent.csv` beside the table of metrics."""
    return Path(metrics_path).with_name("absent.csv")


@one_thread
def write_metrics(card_metrics: Iterable, config: Config, out) -> None:
    """Gather the metrics of all cards, add those of theory, arithmetic, audit and comparison, and write them.

    Args:
        card_metrics: paths of the tables that `rows.write_rows` wrote for single cards.
        config: the cases and the columns of the ledger.
        out: `results/metrics.csv`; the reasons of absent metrics go to `absent.csv` beside it.
    """
    simulated = [row for path in card_metrics for row in read_rows(path)]
    rows = [*simulated, *derived_rows(simulated, config)]
    write_rows(rows, out, reasons=False)
    write_absent(rows, absent_path(out))


def derived_rows(simulated: list[Row], config: Config) -> list[Row]:
    """Rows of the pseudo-cases theory, paper, audit and compare."""
    metrics = Metrics(simulated, config.ledger)
    rows = [*theory_rows.rows(), *arithmetic.rows(), *audit.rows()]
    for column in column_cards(config, "fig3a"):
        # As simulated: what discover named may have changed it.
        found = metrics.find("fig3a", column, "modulus")
        if found is None:
            raise InputError(f"no modulus of fig3a in the column {column}; give the metrics of all cards")
        modulus = found.value * 1e9
        rows += theory_rows.column_rows(column, modulus)
        rows += audit.column_rows(
            column, modulus, metrics.find("fig5b", column, "contact_time", compare.BETWEEN)
        )
    for column in config.ledger:
        rows += compare.column_rows(metrics, column)
    rows += [
        compare.equivalent_row(metrics, column, case, _hertz_moduli(config, case))
        for column in config.ledger
        for case in ("fig3a", "small-amplitude")
    ]
    return [*rows, compare.modulus_row(metrics, _hertz_moduli(config, "fig3a"))]


def write_ledger(metrics_path, claims_path, config: Config, out, probable_path=None) -> None:
    """Hold the metrics against the claims and write `results/ledger.csv`.

    `probable_path`: the table of probabilities, `results/uncertainty.csv`, if there is one.
    """
    claims = ledger.read_table(claims_path, ledger.Claim)
    probable = table.read(probable_path) if probable_path else None
    ledger.write(ledger.build(_all(metrics_path, config), claims, claims_path, probable), out)


def write_assumptions(metrics_path, assumptions_path, config: Config, out) -> None:
    """Hold the metrics against the assumptions and write `results/assumptions.csv`."""
    table = ledger.read_table(assumptions_path, assumptions.Assumption)
    assumptions.write(assumptions.build(_all(metrics_path, config), table, assumptions_path), out)


def _all(metrics_path, config) -> Metrics:
    return Metrics(read_rows(metrics_path, absent_path(metrics_path)), config.ledger)


def _hertz_moduli(config, case) -> dict[str, float]:
    """Card of a case → modulus in Pa, of its Hertz runs at the three moduli that the paper gives."""
    if case not in config.cases:
        return {}
    cards = [
        card(config, case, v) for v in variant_names(config.cases[case]) if model(config, case, v) is None
    ]
    plain = [c for c in cards if not c.effects and c.gravity_m_s2 > 0.0]
    printed = (PRINTED.modulus_handbook, PRINTED.modulus_membrane, PRINTED.modulus_matched)
    found = (next((c for c in plain if c.bead.surface.modulus_Pa == modulus), None) for modulus in printed)
    return {c.name: c.bead.surface.modulus_Pa for c in found if c is not None}
