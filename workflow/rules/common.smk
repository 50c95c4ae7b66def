"""What all rules share: the checked configuration, the names of cards and figures, the digest of each verb's sources."""

import os
import shlex
import sys
from functools import cache
from pathlib import Path

import msgspec
from snakemake.exceptions import WorkflowError

from sonicvacuum import config as configuration
from sonicvacuum.cli.sources import digest
from sonicvacuum.files import InputError
from sonicvacuum_paper.figures import caption, cards_of, drawable, names
from sonicvacuum_paper.shown import ANIMATIONS, own

# `--configfile FILE` names another one, and so may a workflow that uses this one as a module: config: {"configuration": FILE}.
GIVEN = [str(path) for path in workflow.overwrite_configfiles if "cases" in config]
CONFIG_FILE = config.get("configuration", GIVEN[-1] if GIVEN else "config.yaml")
# For runs with conda; `make` has put the same packages on the path already.
ENVIRONMENT = "../envs/locked.yaml"
# Where this workflow lies; the working folder is another one where it is used as a module.
HOME = Path(workflow.current_basedir.get_path_or_uri(secret_free=True)).resolve().parents[1]
# Jobs call the command that stands beside this interpreter, whether or not its environment is activated.
# Braces are doubled for Snakemake, which formats the prefix.
COMMANDS = shlex.quote(str(Path(sys.executable).parent)).replace("{", "{{").replace("}", "}}")
shell.prefix(f'export PATH={COMMANDS}:"$PATH"; ')


def home(path):
    """A file of this project, relative to the working folder if that is the project's."""
    found, here = HOME / path, Path.cwd()
    return str(found.relative_to(here) if found.is_relative_to(here) else found)


try:
    CONFIG = configuration.read(CONFIG_FILE)
except InputError as error:
    raise WorkflowError(str(error))

CARDS = configuration.card_names(CONFIG)
# Those of which every panel has a case.
FIGURES = [name for name in names() if drawable(name, CARDS)]
# Those of cases that the paper does not have.
OWN = list(filter(own, CARDS))
# Record of measured data → its folder.
RECORDS = CONFIG.records
for folder in RECORDS.values():
    if not Path(folder, "record.yaml").is_file():
        raise WorkflowError(f"{CONFIG_FILE}: discover: {folder}: no record.yaml in this folder")


wildcard_constraints:
    card="[A-Za-z0-9_-]+[.][A-Za-z0-9_-]+",
    figure="fig[0-9]+",
    record="[^/]+",


LOCKS = [home("requirements.lock"), home("requirements-build.lock")]
# The verb `discover` loads this for pictures and page, which the workflow makes by the verb `page`.
PAGES = ("sonicvacuum.cli.page",)
# Verbs that take a card load this where a model is put into it.
MODEL = ("sonicvacuum.cli.model",)


@cache
def sources(*verbs, without=()):
    """Digest of all that some verbs of the command run, read off their imports, and of the locks.

    As a parameter it reruns a rule when the code behind it changes. It is worked out once in each start of Snakemake.
    """
    return digest(verbs, without, LOCKS)


def repeated(option, values):
    """Words of a command: the option before each value, to be interpolated with :q."""
    return [word for value in values for word in (option, str(value))]


def resolved(wildcards):
    """Text of a card: as a parameter it reruns the rule of this card alone when the configuration changes."""
    case, variant = wildcards.card.split(".")
    parts = [configuration.card(CONFIG, case, variant), configuration.model(CONFIG, case, variant)]
    return msgspec.json.encode(parts[: 1 + (parts[1] is not None)]).decode()


def model_of(wildcards):
    """The model that a card takes, made from a record: its file, or none."""
    wanted = configuration.model(CONFIG, *wildcards.card.split("."))
    return [f"results/discover/{wanted.record}/model.json"] if wanted else []


def record_files(wildcards):
    """What discover reads of a record."""
    folder = Path(RECORDS[wildcards.record])
    return sorted(str(path) for kind in ("*.yaml", "*.csv") for path in folder.glob(kind))


def drawn(figure):
    """Cards that a figure shows and the configuration has."""
    return [name for name in cards_of(figure) if name in CARDS]


class Caption:
    """Caption of a figure, looked up where it is printed: that loads the engine, and Snakemake's own report alone asks."""

    def __init__(self, figure):
        self.figure = figure

    def __str__(self):
        return caption(self.figure)
