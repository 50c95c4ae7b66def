"""What of the full blind study is kept in git: its tables, and the pictures drawn from them."""

from sonicvacuum.files import InputError

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
