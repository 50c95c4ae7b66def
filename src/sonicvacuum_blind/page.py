"""`results/blind.html`: the full blind study as kept in git, and the small one of the run."""

from collections.abc import Iterable
from pathlib import Path

from sonicvacuum.report import inline, interactive
from sonicvacuum.report.tables import read
from sonicvacuum_blind import published, report

# Groups of fresh runs with fewer records have no interval to speak of.
FEWEST = 5


def build(small_path=None, full_folder=None, pictures: Iterable = ()) -> str:
    """The page as HTML text.

    Args:
        small_path: summary of the small study, None where there is none.
        full_folder: folder of the full study's tables, None where there is none.
        pictures: of the full study: pairs of an SVG file and its caption.

    Raises:
        InputError: when a table has other columns than it should.
    """
    template = inline.environment("sonicvacuum_blind").get_template("study.html.j2")
    return template.render(
        full=full_folder and _full(report.read(full_folder)),
        small=small_path and report.findings(read(small_path, report.SUMMARY, report.NUMBERS)),
        pictures=[_picture(svg, caption) for svg, caption in pictures],
        script=interactive.script(),
    )


def _full(found: report.Study) -> dict:
    """What the page shows of the full study."""
    return {
        "told": _told(found),
        "meant": "" if found.score is None else published.MEANT,
        "results": report.results(found.summary),
        "held_out": published.HELD_OUT,
        "baselines": None if found.baselines is None else report.rivals(found.baselines),
        "fresh": None if found.fresh is None else report.followed(found.fresh, FEWEST),
        "fewest": FEWEST,
        "followed": None if found.resolved is None else report.followed(found.resolved),
    }


def _told(found: report.Study) -> str:
    """Records, goals, and when one is met."""
    met, undecided, missed = found.goals
    return (
        f"{found.cases} records. Of {met + undecided + missed} goals {met} are met, {undecided} open and "
        f"{missed} missed. A goal is met if the whole 95 % interval fulfils it, missed if none of it does, "
        "and open otherwise."
    )


def _picture(svg, caption) -> dict:
    """A drawing, its SVG inlined."""
    name = Path(svg).stem
    narrow = inline.is_narrow(svg)
    return {
        "name": name,
        "svg": inline.svg(svg, name, caption),
        "narrow": narrow,
        "caption": inline.with_subscripts(caption),
    }
