"""What the library tells the rules: the checked configuration, what figures there are, the digest of each verb's sources."""

from functools import cache

import msgspec

from sonicvacuum import config as configuration
from sonicvacuum.cli.sources import digest
from sonicvacuum.files import InputError, read_yaml
from sonicvacuum_blind import kept
from sonicvacuum_paper import columns
from sonicvacuum_paper.figures import caption, cards_of, drawable, names
from sonicvacuum_paper.shown import ANIMATIONS, own

try:
    CONFIG = columns.read(CONFIG_FILE)
except InputError as error:
    raise WorkflowError(str(error))

CARDS = configuration.card_names(CONFIG)
# Those of which every panel has a case.
FIGURES = [name for name in names() if drawable(name, CARDS)]
# Those of cases that the paper does not have.
OWN = list(filter(own, CARDS))
# Pictures of the full study and its tables as kept in git.
STUDY_TABLES = home(kept.TABLES)
STUDY = [name for name in kept.PICTURES if os.path.exists(kept.table(name, STUDY_TABLES))]


@cache
def sources(*verbs, without=()):
    """Digest of all that some verbs of the command run, read off their imports, and of the locks.

    As a parameter it reruns a rule when the code behind it changes. It is worked out once in each start of Snakemake.
    """
    return digest(verbs, without, LOCKS)


def text(*parts):
    """What the configuration says, as one line: as a parameter it reruns a rule when that changes."""
    return msgspec.json.encode(parts).decode()


def resolved(cards):
    """Text of some cards: it reruns the rules of these alone when the configuration changes."""
    parts = [
        part(CONFIG, *name.split(".")) for name in cards for part in (configuration.card, configuration.model)
    ]
    return text(*parts)


def traces_of(folder):
    """Files of traces that a record names and has; of one that is not sound its job tells what is wrong."""
    try:
        runs = read_yaml(folder / "record.yaml").get("runs")
    except InputError:
        return []
    found = [run.get("signals") for run in runs if isinstance(run, dict)] if isinstance(runs, list) else []
    return sorted({name for name in found if name and isinstance(name, str) and (folder / name).is_file()})


def model_of(card):
    """The model that a card takes, made from a record: its file, or none."""
    wanted = configuration.model(CONFIG, *card.split("."))
    return [f"results/discover/{wanted.record}/model.json"] if wanted else []


def batched():
    """Name → cards that one process makes, since starting one takes longer than most cards do.

    Those of a case, and those that wait for the model of a record.
    """
    found = {}
    for card in CARDS:
        wanted = configuration.model(CONFIG, *card.split("."))
        found.setdefault(f"model.{wanted.record}" if wanted else card.split(".")[0], []).append(card)
    return found


CARD_BATCHES = batched()


def drawn(figure):
    """Cards that a figure shows and the configuration has."""
    return [name for name in cards_of(figure) if name in CARDS]


class Caption:
    """Caption of a figure, looked up where it is printed: that loads the engine, and Snakemake's own report alone asks."""

    def __init__(self, figure):
        self.figure = figure

    def __str__(self):
        return caption(self.figure)
