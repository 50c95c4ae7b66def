"""`results/report.html`: what was asked, the figures, the ledger, the audit, and how each number was made."""

from pathlib import Path

from sonicvacuum.card import Card
from sonicvacuum.effects import IDS
from sonicvacuum.report import inline, record
from sonicvacuum_blind import report as study
from sonicvacuum_paper import ladder
from sonicvacuum_paper.report import answer, provenance, tables, uncertain


def build(
    ledger_path,
    assumptions_path,
    metrics_path,
    claims_path,
    figures,
    cards,
    locks,
    discoveries=(),
    blind_small=None,
    blind_full=None,
    pictures=(),
) -> str:
    """The page as HTML text, figures inside.

    Args:
        ledger_path, assumptions_path, metrics_path, claims_path: CSV files that the pipeline wrote or reads.
        figures: pairs of an SVG file, named figN.svg, and its caption in plain text.
        cards: resolved `Card`s.
        locks: lock files of the environment.
        discoveries: folders that `sonicvacuum discover` wrote.
        blind_small: summary of the small blind study, None where there is none.
        blind_full: folder of the full study's tables, None where there is none.
        pictures: of the full study: pairs of an SVG file and its caption.

    Raises:
        InputError: when a table has other columns than it should.
    """
    ledger = tables.read(ledger_path, tables.LEDGER)
    claims = tables.read(claims_path, CLAIMS).set_index("claim")
    ledger["statement"] = [claims["statement"].get(c, "") for c in ledger["claim"]]
    ledger["note"] = [claims["note"].get(c, "") for c in ledger["claim"]]
    ledger["excluded_by"] = ledger["excluded"].map(tables.shown)
    ledger["probable"] = ledger["probability"].map(uncertain.shown)
    metrics = tables.read(metrics_path, tables.METRICS)
    return (
        inline.environment("sonicvacuum_paper.report")
        .get_template("page.html.j2")
        .render(
            ledger=ledger.to_dict("records"),
            counts=tables.counts(ledger),
            verdicts=tables.VERDICTS,
            disagreements=tables.disagreements(ledger).to_dict("records"),
            assumptions=tables.read(assumptions_path, tables.ASSUMPTIONS).to_dict("records"),
            headline=tables.headline(ledger),
            answer=answer.sentences(ledger, metrics),
            models=[(c, m.title, m.free) for c, m in ladder.MODELS.items() if m.counted],
            first=tables.first(ledger),
            **uncertain.context(ledger),
            totals={t.model: t for t in ladder.totals(ledger.to_dict("records"))},
            figures=[_figure(svg, caption) for svg, caption in figures],
            cards=[_card_row(card, metrics) for card in cards],
            catalogue=len(IDS),
            discoveries=[record.section(folder) for folder in discoveries],
            full=blind_full and _full(study.read(blind_full)),
            pictures=[_figure(svg, caption) for svg, caption in pictures],
            small=blind_small and study.findings(tables.read(blind_small, study.SUMMARY)),
            versions=provenance.versions(),
            source=provenance.source_digest(),
            lock=provenance.digest(locks),
        )
    )


CLAIMS = [
    "claim",
    "section",
    "statement",
    "quantity",
    "unit",
    "value",
    "sigma",
    "sigma_source",
    "test",
    "metric",
    "note",
    "needs",
    "fitted",
    "reading",
]


def _figure(svg, caption):
    """One figure, its SVG inlined."""
    name = Path(svg).stem
    return {
        "name": name,
        "number": name.removeprefix("fig"),
        "svg": inline.svg(svg, name),
        "narrow": inline.is_narrow(svg),
        "caption": inline.with_subscripts(caption),
    }


def _full(found):
    """What the page shows of the full study."""
    return {
        "cases": found.cases,
        "goals": found.goals,
        "results": study.results(found.summary),
        "held_out": study.HELD_OUT,
        "baselines": None if found.baselines is None else study.rivals(found.baselines),
        "followed": None if found.resolved is None else study.followed(found.resolved),
    }


def _card_row(card: Card, metrics):
    own = metrics[metrics["case"].str.split("@").str[0] == card.name]
    speeds = card.striker.speeds_m_s
    worst = {q: own.loc[own["quantity"] == q, "value"] for q in ("energy_drift", "momentum_drift")}
    return {
        "name": card.name,
        "title": card.title,
        "beads": f"{card.beads} × {card.bead.diameter_m * 1e3:g} mm, {card.bead.mass_kg * 1e3:g} g",
        "modulus": card.bead.surface.modulus_Pa / 1e9,
        "striker": f"{card.striker.mass_kg * 1e3:g} g, "
        + _range(speeds)
        + (" (aimed)" if card.striker.aim else ""),
        "gravity": "vertical" if card.gravity_m_s2 else "horizontal",
        **{q: max(map(float, filter(None, v)), default="") for q, v in worst.items()},
    }


def _range(speeds):
    return (
        f"{speeds[0]:g} m/s"
        if len(speeds) == 1
        else f"{min(speeds):g}–{max(speeds):g} m/s, {len(speeds)} runs"
    )
