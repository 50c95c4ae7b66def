"""The stages of the pipeline that make tables: each reads files, writes files, and is one command."""

from collections.abc import Iterable
from pathlib import Path

from sonicvacuum.blas import one_thread
from sonicvacuum.card import Card, variant_names
from sonicvacuum.config import Config, card, model
from sonicvacuum_paper import arithmetic, assumptions, audit, compare, ledger, theory_rows
from sonicvacuum_paper.columns import Metrics, column_cards
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.rows import Row, read_rows, write_absent, write_rows


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
        modulus = metrics.find("fig3a", column, "modulus").value * 1e9
        rows += theory_rows.column_rows(column, modulus)
        rows += audit.column_rows(
            column, modulus, metrics.find("fig5b", column, "contact_time", compare.BETWEEN)
        )
    for column in config.ledger:
        rows += compare.column_rows(metrics, column)
    moduli = {c.name: c.bead.surface.modulus_Pa for c in _moduli_of_fig3a(config)}
    return [*rows, compare.modulus_row(metrics, moduli)]


def write_ledger(metrics_path, claims_path, config: Config, out) -> None:
    """Hold the metrics against the claims and write `results/ledger.csv`."""
    claims = ledger.read_table(claims_path, ledger.Claim)
    ledger.write(ledger.build(_all(metrics_path, config), claims, claims_path), out)


def write_assumptions(metrics_path, assumptions_path, config: Config, out) -> None:
    """Hold the metrics against the assumptions and write `results/assumptions.csv`."""
    table = ledger.read_table(assumptions_path, assumptions.Assumption)
    assumptions.write(assumptions.build(_all(metrics_path, config), table, assumptions_path), out)


def _all(metrics_path, config) -> Metrics:
    return Metrics(read_rows(metrics_path, absent_path(metrics_path)), config.ledger)


def _moduli_of_fig3a(config) -> list[Card]:
    """The runs of fig3a at the three moduli that the paper gives, with nothing added to the model."""
    printed = (PRINTED.modulus_handbook, PRINTED.modulus_membrane, PRINTED.modulus_matched)
    cards = [
        card(config, "fig3a", v)
        for v in variant_names(config.cases.get("fig3a", {}))
        if "fig3a" in config.cases and model(config, "fig3a", v) is None
    ]
    plain = [c for c in cards if not c.effects and c.gravity_m_s2 > 0.0]
    found = (next((c for c in plain if c.bead.surface.modulus_Pa == modulus), None) for modulus in printed)
    return [c for c in found if c is not None]
