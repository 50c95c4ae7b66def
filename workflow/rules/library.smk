"""What the library tells the rules: the checked configuration, what figures there are, the digest of each verb's sources."""

from functools import cache

import msgspec

from sonicvacuum import config as configuration
from sonicvacuum.cli.sources import digest
from sonicvacuum.files import InputError
from sonicvacuum_blind import kept
from sonicvacuum_paper.figures import caption, cards_of, drawable, names
from sonicvacuum_paper.shown import ANIMATIONS, own

try:
    CONFIG = configuration.read(CONFIG_FILE)
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


def resolved(wildcards):
    """Text of a card: it reruns the rule of this card alone when the configuration changes."""
    case, variant = wildcards.card.split(".")
    parts = configuration.card(CONFIG, case, variant), configuration.model(CONFIG, case, variant)
    return text(*parts[: 1 + (parts[1] is not None)])


def model_of(wildcards):
    """The model that a card takes, made from a record: its file, or none."""
    wanted = configuration.model(CONFIG, *wildcards.card.split("."))
    return [f"results/discover/{wanted.record}/model.json"] if wanted else []


def drawn(figure):
    """Cards that a figure shows and the configuration has."""
    return [name for name in cards_of(figure) if name in CARDS]


class Caption:
    """Caption of a figure, looked up where it is printed: that loads the engine, and Snakemake's own report alone asks."""

    def __init__(self, figure):
        self.figure = figure

    def __str__(self):
        return caption(self.figure)
