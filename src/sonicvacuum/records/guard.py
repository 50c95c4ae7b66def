"""No result is written into a record: measured data are irreplaceable."""

import os
from collections.abc import Callable, Iterable
from pathlib import Path

from sonicvacuum.files import InputError
from sonicvacuum.outputs import check_apart, check_folder
from sonicvacuum.records.reader import FILE


def check_out(folder, records: Iterable = ()) -> None:
    """Refuse a folder for results that would touch a record or cannot be written.

    Args:
        folder: to be written.
        records: folders of the records that are read, or their `record.yaml`.

    Raises:
        InputError: where the folder is that of a record (any, not only those read), lies in one, or holds a
            file of one that is read, be it through links; or where it cannot be made or written.
    """
    place = Path(os.path.realpath(folder))
    for above in (place, *place.parents):
        if (above / FILE).is_file():
            told = "is the folder of a record" if above == place else f"lies in the record {above}"
            raise InputError(f"{folder}: {told}; give a folder outside of it to write")
    check_folder(folder)
    if place.is_dir():
        read = (path.parent if path.is_file() else path for path in map(Path, records))
        check_apart(place.iterdir(), read)


def check_collection(folder, names: Iterable[str], mark: Callable[[str], Path]) -> None:
    """Refuse a folder for records that are made, one below it for each name, where it would touch others.

    Args:
        folder: to be written.
        names: of the records.
        mark: name → a file that stands only where the verb at hand has made this record.

    Raises:
        InputError: for a folder that is a record or lies in one, or holds a record of such a name that was
            not made here; or that cannot be written.
    """
    check_out(folder)
    for name in names:
        if (Path(folder) / name / FILE).exists() and not mark(name).exists():
            raise InputError(
                f"{Path(folder) / name}: holds a record that this command has not made; give another folder"
            )
