"""The folder of a verdict: all files of one search, whole or not at all, whoever asked for it."""

from os import PathLike
from typing import TYPE_CHECKING

from sonicvacuum.outputs import renewed

if TYPE_CHECKING:
    from sonicvacuum.discover.session import Result

LAST = "verdict.json"


def write(result: "Result", folder: str | PathLike[str], figures: bool = True) -> Exception | None:
    """Write verdict, model and tables of a search and, with `figures`, its pictures and its page.

    The verdict took minutes and holds without pictures: where drawing fails none of them is left, and all
    else is.

    Args:
        result: what `discover` returned.
        folder: where the files go; those of an earlier verdict make room, others are left.
        figures: pictures and page too.

    Returns:
        What pictures or page failed with, None where nothing did.

    Raises:
        OSError: where the folder cannot be written; what stood there before is there still.
    """
    from sonicvacuum.discover import written

    with renewed(folder, last=LAST, stale=sometimes()) as fresh:
        written.write(result, fresh)
        return _drawn(fresh, result.found.forward.experiment.catalogue) if figures else None


def sometimes() -> tuple[str, ...]:
    """Names of the files that not every verdict has; those of an earlier one would stand beside this one."""
    from sonicvacuum.discover import draws, quantities
    from sonicvacuum.drawn import page_files

    return (*page_files(), draws.FILE, quantities.FILE, "law.csv")


def _drawn(fresh, known):
    """Pictures and page of a folder; what they failed with, None where nothing did."""
    from sonicvacuum import drawn

    try:
        drawn.illustrate(fresh, known)
    except Exception as error:
        for name in drawn.page_files():
            (fresh / name).unlink(missing_ok=True)
        return error
    return None
