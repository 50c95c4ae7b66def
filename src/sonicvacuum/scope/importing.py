"""Files of a recorder to a folder with record.yaml and a CSV file per run, and what the reader says of it."""

from pathlib import Path

from sonicvacuum.files import InputError, check_values, replacing, writing
from sonicvacuum.laboratory.checks import TIME
from sonicvacuum.outputs import renewed
from sonicvacuum.records import reader, signals
from sonicvacuum.scope import draft
from sonicvacuum.scope.clean import CleanRun, clean
from sonicvacuum.scope.options import Options
from sonicvacuum.scope.runs import shots
from sonicvacuum.scope.timebase import SECONDS

# Runs that are named in one line.
NAMED = 5


def import_files(
    files, folder, options: Options, *, like=None, record=None, title=None, force=False
) -> list[str]:
    """Write the record and return what was done and what is to be filled in, line by line.

    Raises:
        InputError: for a title with control characters, files that cannot be read or do not fit together, a
            record that stands there already (without `force`), or a folder that cannot be written; nothing is
            written then.
    """
    folder = Path(folder)
    check_values({"title": title}, folder)
    if (folder / reader.FILE).exists() and not force:
        raise InputError(f"{folder / reader.FILE}: exists already; choose another folder, or give --force")
    given = draft.template(like, record)
    draft.check_gauges(given, options, like if record is None else record)
    files = [Path(f) for f in files]
    runs = [clean(s, options) for s in shots(files, options)]
    _spare(folder, runs, {f.resolve() for g in (files, *options.runs.values()) for f in g}, force)
    content = draft.content(runs, given, options, title)
    _write(folder, draft.text(content, runs, options, given), runs)
    seconds = [r.id for r in runs if any(n.endswith(SECONDS) for n in r.notes)]
    return [
        *_report(runs),
        *(draft.unused(given, runs) if record else ()),
        *draft.unread(given, content, like if record is None else record),
        *_assumed(seconds),
        *_checked(folder, bool(seconds)),
    ]


def _spare(folder, runs, raw, force):
    """Refuse to write over the raw files themselves, and over other files without `force`."""
    for target in (folder / f"{r.id}.csv" for r in runs):
        try:
            same = target.resolve() in raw
        except (OSError, RuntimeError):
            raise InputError(
                f"{target}: leads round in a loop of links; choose another folder for --out"
            ) from None
        if same:
            raise InputError(f"{target}: is one of the files to import; choose another folder for --out")
        if target.exists() and not force:
            raise InputError(f"{target}: exists already; choose another folder, or give --force")


def _write(folder, text, runs: list[CleanRun]):
    with writing(folder), renewed(folder, last=reader.FILE) as fresh:
        for run in runs:
            signals.write(run.signals, fresh / f"{run.id}.csv")
        with replacing(fresh / reader.FILE) as stream:
            stream.write(text)


def _report(runs):
    for run in runs:
        yield (
            f"run {run.id}: {run.signals.samples} samples, {run.signals.interval_s * 1e6:.6g} us apart, from "
            f"{round(run.signals.start_s * 1e6, 3) + 0.0:.6g} us"
        )
        yield from (f"  {note}" for note in run.notes)


def _assumed(runs):
    """That times were taken for seconds, in a line of its own: all else depends on it."""
    if runs:
        named = ", ".join(runs) if len(runs) <= NAMED else f"{len(runs)} runs"
        yield (
            f"times of {named}: no unit is given, so they were taken as seconds, as most oscilloscopes write "
            "them; if they are none, write the unit into the header, as in Time (us), or give --interval "
            "with its unit, and import again with --force"
        )


def _checked(folder, seconds):
    """What the reader of records says of the folder; `seconds`: whether times were taken for such."""
    try:
        reader.read(folder)
    except InputError as error:
        told = str(error)
        if seconds and f"column {TIME}: " in told:
            # The cure is for times that the user wrote, and nobody wrote these.
            told = f"{told.rpartition('; ')[0]}; seconds were assumed, as said above"
        yield f"written, but still to be completed: {told}"
    else:
        yield f"{folder}: complete; next: sonicvacuum record check {folder}"
