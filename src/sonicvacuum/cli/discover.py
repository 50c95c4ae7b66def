"""`sonicvacuum discover`: what records of measured data say is missing from the model."""

import sys
import traceback
from dataclasses import dataclass
from pathlib import Path

import click

from sonicvacuum import stages
from sonicvacuum.cli.ended import blamed
from sonicvacuum.cli.helped import FOLDER, verb
from sonicvacuum.cli.own_effects import catalogue, own_effects
from sonicvacuum.cli.stage_lines import compiling_told, stages_shown
from sonicvacuum.files import in_one_line


@verb(
    "sonicvacuum discover my-record --out found",
    "sonicvacuum discover monday tuesday --together --out found",
    "sonicvacuum discover records/* --out found --no-figures --quiet",
    short_help="Find what is missing from the model of measured data.",
)
@click.argument("records", nargs=-1, required=True, type=click.Path())
@click.option("--out", required=True, type=FOLDER, help="Folder to write.")
@click.option("--together", is_flag=True, help="RECORDS are of one chain and its gauges: one verdict on all.")
@click.option(
    "--figures/--no-figures",
    default=True,
    show_default=True,
    help="Draw the pictures and write the page, index.html.",
)
@click.option(
    "--threads",
    type=click.IntRange(1),
    help="Processors to use; all of them by default. Results do not depend on it.",
)
@click.option("--quiet", is_flag=True, help="Say nothing but the verdicts.")
@click.option(
    "--no-limits", is_flag=True, help="Search even where it seems to need more than a computer gives."
)
@own_effects
def discover(records, out, together, figures, threads, own, quiet, no_limits):
    """Find what is missing from the nominal model of measured data in the folders RECORDS.

    One record is written to OUT; of several each has its own folder OUT/<folder name>, and as many are
    searched at a time as there are threads. All of them are read before the first is searched; one whose
    search fails is told of, and the others go on. A verdict whose pictures fail is written without them, and
    that is told. On a terminal, a line shows how far the search is.
    """
    known = catalogue(own)
    groups = {Path(out): records} if together else {f: (p,) for p, f in _folders(records, Path(out)).items()}
    kept = _sound(records, groups, known, not no_limits)
    # Long to load: what is wrong with a record is said before.
    from sonicvacuum.physics.run import available_threads

    threads = threads or available_threads()
    if len(groups) == 1:
        (folder,) = groups
        with stages_shown(", ".join(records), quiet):
            found = _search(kept, folder, known, figures, threads, not no_limits)
        _tell(records, found, quiet)
        if found.undrawn:
            sys.exit(1)
        return
    processes = min(threads, len(groups))
    how = (own, figures, threads // processes, not no_limits)
    _tell_all(groups, _outcomes(groups, processes, how, quiet), quiet)


def _sound(records, groups, known, limits):
    """All records, read before hours are spent on the first; InputError for the first that is not sound.

    Of several groups none is kept: all at once may be more than the memory holds.
    """
    from sonicvacuum.discover.model import window
    from sonicvacuum.discover.model.present import check_priors
    from sonicvacuum.records import read
    from sonicvacuum.records.extent import check_extent
    from sonicvacuum.records.guard import check_out
    from sonicvacuum.records.record import check_distinct

    for folder in groups:
        check_out(folder, records)
    kept = []
    for path in records:
        record = read(path)
        check_priors(record, known, path)
        if len(groups) == 1:
            kept.append(record)
        elif limits:
            check_extent(window.fitted(record, known)[0])
    if kept:
        check_distinct(kept, records)
    return kept


def _tell_all(groups, outcomes, quiet):
    """Tell each of several searches as it ends; exit code 1 or 2 where one failed."""
    failed, undrawn = [], 0
    for paths, outcome in zip(groups.values(), outcomes, strict=True):
        if isinstance(outcome, Failure):
            click.echo(outcome.told(", ".join(paths)), err=True)
            failed.append(outcome)
        else:
            _tell(paths, outcome, quiet)
            undrawn += bool(outcome.undrawn)
    if failed or undrawn:
        told = [f"{len(failed)} of {len(groups)} searches failed"] if failed else []
        told += [f"{undrawn} of {len(groups)} verdicts have no pictures"] if undrawn else []
        click.echo(f"Error: {', '.join(told)}, as told above", err=True)
        sys.exit(1 if undrawn or any(f.broken for f in failed) else 2)


@dataclass(frozen=True)
class Failure:
    """What went wrong with one record: its search among several, or the pictures of its verdict.

    Attributes:
        error: the message.
        broken: the traceback where the program is to blame; empty where the record or the machine is.
    """

    error: str
    broken: str = ""

    def told(self, paths: str) -> str:
        """In one line, a traceback above it."""
        return self.broken + "Error: " + in_one_line(f"{paths}: {self.error}")


@dataclass(frozen=True)
class Found:
    """What is told of one search that came to a verdict.

    Attributes:
        notes: what was done to the traces before anything else.
        sentence: the verdict in words.
        undrawn: why it stands without pictures and page; None where nothing failed.
    """

    notes: tuple[str, ...]
    sentence: str
    undrawn: Failure | None = None


def _outcomes(groups, processes, how, quiet):
    """Of each search what it Found, or its Failure; in their order, as they end."""
    if processes == 1:
        for folder, paths in groups.items():
            with stages_shown(", ".join(paths), quiet):
                outcome = _attempt(paths, folder, *how)
            yield outcome
        return
    from sonicvacuum.cli.many import side_by_side

    with stages_shown(f"{len(groups)} records", quiet):
        stages.begin("search", len(groups))
        tasks = [(quiet, paths, folder, *how) for folder, paths in groups.items()]
        yield from side_by_side(_alone, tasks, processes)


def _alone(quiet, *task):
    """One search in a process of its own, which tells of no stages."""
    with stages_shown("", quiet=True) if quiet else compiling_told():
        return _attempt(*task)


def _attempt(paths, folder, own, figures, threads, limits):
    """One search of several; what a full disk or memory ends, it would end for the others as well."""
    from sonicvacuum.files import InputError
    from sonicvacuum.records import read

    try:
        return _search([read(p) for p in paths], folder, catalogue(own), figures, threads, limits)
    except InputError as error:
        return Failure(str(error))
    except (OSError, ImportError, MemoryError):
        raise
    except Exception as error:
        if own_fault := blamed(error):
            return Failure(own_fault)
        told = f"the search broke, {type(error).__name__}: {error}; please report it with the record"
        return Failure(told, traceback.format_exc())


def _search(records, folder, known, figures, threads, limits):
    """Search records, write what is found; what is told of it."""
    from sonicvacuum import folder as verdicts
    from sonicvacuum.discover import session

    result = session.discover(*records, threads=threads, catalogue=known, limits=limits)
    error = verdicts.write(result, folder, figures)
    return Found(result.notes, _sentence(result.verdict, records), _undrawn(folder, error))


def _undrawn(folder, error):
    """The Failure of a verdict whose pictures failed with an error, to be told from where that was caught."""
    if error is None:
        return None
    machine = isinstance(error, OSError | MemoryError)
    why = f"{type(error).__name__}: {getattr(error, 'strerror', None) or error}"
    cure = f"make them with sonicvacuum page {folder}" if machine else "please report it with the record"
    told = f"{folder} holds the verdict without pictures and page, which failed ({why}); {cure}"
    return Failure(told, "" if machine else "".join(traceback.format_exception(error)))


def _tell(paths, found, quiet):
    for line in (*(() if quiet else found.notes), found.sentence):
        click.echo(in_one_line(f"{', '.join(paths)}: {line}"))
    if found.undrawn:
        click.echo(found.undrawn.told(", ".join(paths)), err=True)


def _folders(records, out):
    """Record → folder to write, InputError where two would share one."""
    from sonicvacuum.files import InputError

    if len(records) == 1:
        return {records[0]: out}
    folders: dict[str, Path] = {}
    for path in records:
        own = Path(path).resolve()
        folder = out / own.name
        if own in (Path(p).resolve() for p in folders):
            raise InputError(f"{path}: is given twice; give it once")
        if folder in folders.values():
            raise InputError(f"{path}: another record has the folder name {folder.name}; rename one of them")
        folders[path] = folder
    return folders


def _sentence(verdict, records=()):
    from sonicvacuum.cli.page import slips_of

    slips = slips_of(verdict, records)
    return f"check first: {slips}; missing: {_named(verdict)}" if slips else _named(verdict)


def _named(verdict):
    from sonicvacuum.cli.page import likely

    if not verdict.named and verdict.sees_nothing:
        return "none, but no effect of the catalogue would show in these data"
    named = verdict.named or ["none"]
    sure = verdict.probability
    text = " + ".join(named) + (f" (probability {likely(sure)})" if sure is not None else "")
    several = sum(name != "unknown" for name in named) > 1
    for own, *others in verdict.confusable:
        text += f"; {own if several else ''} could also be {', '.join(others)}".replace("  ", " ")
    return text
