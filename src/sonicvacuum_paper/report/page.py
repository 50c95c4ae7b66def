"""`results/report.html`: what was asked, the figures, the ledger, the audit, and how each number was made."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from sonicvacuum.card import Card
from sonicvacuum.effects import IDS
from sonicvacuum.report import inline, interactive, record
from sonicvacuum.simulation import Simulation
from sonicvacuum_blind import report as study
from sonicvacuum_paper import ladder
from sonicvacuum_paper.assumptions import AUDITED
from sonicvacuum_paper.figures import caption
from sonicvacuum_paper.report import answer, provenance, rivals, runs, tables, uncertain
from sonicvacuum_paper.report.steps import masses, settings, steps
from sonicvacuum_paper.shown import ANIMATIONS


@dataclass(frozen=True)
class Sources:
    """What the page is made of; only the tables must be there.

    Attributes:
        ledger, assumptions, metrics, claims: CSV files that the pipeline wrote or reads.
        figures: SVG files, named figN.svg, the CSV that each is drawn from beside it where values are told.
        cards: resolved `Card`s.
        locks: lock files of the environment.
        discoveries: folders that `sonicvacuum discover` wrote.
        blind_full: folder of the full blind study's tables, None where there is none.
        own: simulated cards of cases that a user added.
        animations: SVG files that move, named by `shown.ANIMATIONS`.
        linked: names of the pages beside this one, of `runs.html`, `blind.html` and `sure.html`.
        contours, experiments, relaxation, losses, explained: tables of `sonicvacuum paper rivals`.
        map_picture: the picture of the first of them (SVG).
    """

    ledger: Path
    assumptions: Path
    metrics: Path
    claims: Path
    figures: Sequence[Path] = ()
    cards: Sequence[Card] = ()
    locks: Sequence[Path] = ()
    discoveries: Sequence[Path] = ()
    blind_full: Path | None = None
    own: Iterable[Simulation] = ()
    animations: Sequence[Path] = ()
    linked: Sequence[str] = ()
    contours: Path | None = None
    map_picture: Path | None = None
    experiments: Path | None = None
    relaxation: Path | None = None
    losses: Path | None = None
    explained: Path | None = None


def build(given: Sources) -> str:
    """The page as HTML text, figures inside.

    Raises:
        InputError: when a table has other columns than it should.
    """
    ledger = _ledger(given)
    metrics = tables.read(given.metrics, tables.METRICS)
    open_questions = _open(given, ledger)
    own = [runs.told(one, metrics) for one in given.own]
    template = inline.environment("sonicvacuum_paper.report").get_template("page.html.j2")
    return template.render(
        ledger=[_claim_row(row) for row in ledger.to_dict("records")],
        counts=tables.counts(ledger),
        verdicts=tables.VERDICTS,
        disagreements=tables.disagreements(ledger).to_dict("records"),
        assumptions=tables.read(given.assumptions, tables.ASSUMPTIONS).to_dict("records"),
        audited=[(c, ladder.title(c)) for c in AUDITED],
        headline=tables.headline(ledger),
        answer=answer.sentences(ledger, metrics, open_questions.get("by_law")),
        steps=steps(ledger.to_dict("records")),
        settings=settings(ledger.to_dict("records")),
        masses=masses(metrics),
        models=[(c, m.title, m.free) for c, m in ladder.MODELS.items() if m.counted],
        first=tables.first(ledger),
        **open_questions,
        alone=False,
        totals={t.model: t for t in ladder.totals(ledger.to_dict("records"))},
        figures=[_figure(Path(svg)) for svg in given.figures],
        cards=[_card_row(card, metrics) for card in given.cards],
        own=own,
        of_paper=tables.asked(ledger) or not own,
        catalogue=len(IDS),
        discoveries=[record.section(folder) for folder in given.discoveries],
        full=given.blind_full and study.read(given.blind_full),
        animations=[_animation(Path(svg)) for svg in given.animations],
        runs_page="runs.html" in given.linked,
        blind_page="blind.html" in given.linked,
        sure_page="sure.html" in given.linked,
        versions=provenance.versions(),
        source=provenance.source_digest(),
        lock=provenance.digest(given.locks),
        script=interactive.script(),
    )


def sure(given: Sources) -> str:
    """The page on what the paper leaves open, as HTML text.

    Raises:
        InputError: when a table has other columns than it should.
    """
    template = inline.environment("sonicvacuum_paper.report").get_template("sure.html.j2")
    return template.render(**_open(given, _ledger(given)), alone=True, script=interactive.script())


def _open(given, ledger):
    """What the paper leaves open: probabilities of its statements, and what sets rival models apart."""
    of_rivals = (given.contours, given.experiments, given.relaxation, given.losses, given.explained)
    drawn = given.map_picture and _figure(Path(given.map_picture), _caption_of_map())
    return {**uncertain.context(ledger), **rivals.context(*of_rivals), "map_picture": drawn}


def _caption_of_map():
    from sonicvacuum_paper.uncertainty.picture import CAPTION  # and with it matplotlib

    return CAPTION


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


def _ledger(given: Sources):
    """The ledger with statements, their tests and notes, and the models that a row excludes."""
    ledger = tables.read_ledger(given.ledger)
    claims = tables.read(given.claims, CLAIMS).set_index("claim")
    ledger["statement"] = [claims["statement"].get(c, "") for c in ledger["claim"]]
    ledger["test"] = [claims["test"].get(c, "") for c in ledger["claim"]]
    ledger["note"] = [claims["note"].get(c, "") for c in ledger["claim"]]
    ledger["printed"] = [_printed(claims["test"].get(row.claim, ""), row) for row in ledger.itertuples()]
    ledger["excluded_by"] = ledger["excluded"].map(tables.shown)
    ledger["probable"] = [uncertain.shown(row) for row in ledger.to_dict("records")]
    return ledger


def _printed(test, row):
    """What the paper prints with its error, or the bound that its words are taken for."""
    bound = {"at_least": "≥ ", "at_most": "≤ "}.get(test, "")
    value = " to ".join(tables.number(part) for part in row.measured.split(".."))
    error = tables.number(row.sigma, 2)
    return f"{bound}{value}" + (f" ± {error}" if error not in ("", "0") else "")


def _claim_row(row: dict) -> dict:
    """A row with `decides`, the number of the model that decides, and `others`, what all others give."""
    first = next((c for c in ladder.DECIDING if row[c]), None)
    differing = (
        [c for c in ladder.COLUMNS if c != first and row[c]] if row["kind"] == ladder.SIMULATION else []
    )
    others = [f"{ladder.title(c)}: {tables.number(row[c])}" for c in differing]
    return {**row, "decides": row[first] if first else "", "others": others}


def _figure(svg: Path, told: str | None = None) -> dict:
    """One figure, its SVG inlined, with the scales of its CSV; `told` is its caption, if not its own."""
    from sonicvacuum_paper.report import cursor  # and with it matplotlib: not before the tables are read

    name, table = svg.stem, svg.with_suffix(".csv")
    return {
        "name": name,
        "number": name.removeprefix("fig"),
        "svg": inline.svg(svg, name, told or caption(name)),
        "caption": inline.with_subscripts(told or caption(name)),
        "scales": cursor.of_figure(name, table) if table.exists() and not told else "",
    }


def _animation(svg: Path):
    """Name, drawing and what is seen."""
    return svg.stem, inline.svg(svg, f"moving-{svg.stem}"), ANIMATIONS[svg.stem][1]


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
