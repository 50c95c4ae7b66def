"""What of the full blind study is kept in git: its tables, and the pictures drawn from them."""

from pathlib import Path

from sonicvacuum.files import InputError, reading

# Picture, by the stem of its file → what it shows.
PICTURES = {
    "blind_accuracy": "Blind study: right names",
    "blind_confusion": "Blind study: what is taken for what",
    "blind_reliability": "Blind study: stated probabilities",
    "blind_pit": "Blind study: stated intervals",
    "blind_baselines": "Blind study: simpler rules",
}
# Folder of the tables.
TABLES = "workflow/resources/reference/blind_full"


def table(name: str, folder=TABLES) -> str:
    """File of the table that a picture is drawn from; not every one is made of every study."""
    return f"{folder}/{name.removeprefix('blind_')}.csv"


def caption(name: str) -> str:
    """Caption of a picture, one paragraph of plain text; InputError for an unknown one."""
    if name not in PICTURES:
        raise InputError(f"picture {name!r}: unknown; use one of {', '.join(PICTURES)}")
    from sonicvacuum_blind.figures import CAPTIONS

    return CAPTIONS[name.removeprefix("blind_")]


def read(folder, wanted=()) -> dict:
    """Picture, without the prefix of its file → its table, a pandas.DataFrame; of those wanted, or of all
    whose tables are in the folder.

    Raises:
        InputError: where a wanted table, or every table, is missing, or one cannot be read.
    """
    import pandas

    paths = {name.removeprefix("blind_"): Path(table(name, folder)) for name in PICTURES}
    chosen = list(wanted) or [name for name, path in paths.items() if path.exists()]
    missing = [name for name in chosen or paths if not paths[name].exists()]
    if missing:
        command = "blind baselines --out" if missing[0] == "baselines" else "blind score --tables"
        raise InputError(f"{folder}: {missing[0]}.csv is missing; make it with sonicvacuum {command}")
    found = {}
    for name in chosen:
        # "none" is a name here; numbers that do not exist are written nan.
        with reading(paths[name], "make it with sonicvacuum blind score --tables, or blind baselines --out"):
            found[name] = pandas.read_csv(paths[name], keep_default_na=False, na_values=["", "nan"])
    return found
