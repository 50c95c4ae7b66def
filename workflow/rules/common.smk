"""What all rules share: the checked configuration, the names of cards and figures, the sources of each layer."""

import sys
from pathlib import Path

import msgspec
from snakemake.exceptions import WorkflowError

from sonicvacuum import config as configuration
from sonicvacuum.figures import caption, cards_of
from sonicvacuum.files import InputError

CONFIG_FILE = "config.yaml"
# For runs with conda; `make` has put the same packages on the path already.
ENVIRONMENT = "../envs/locked.yaml"
# Jobs call the command that stands beside this interpreter, whether or not its environment is activated.
shell.prefix(f'export PATH="{Path(sys.executable).parent}:$PATH"; ')
FIGURES = ["fig3", "fig4", "fig5", "fig6"]


try:
    CONFIG = configuration.read(CONFIG_FILE)
except InputError as error:
    raise WorkflowError(str(error))

CARDS = configuration.card_names(CONFIG)
# Record of measured data → its folder.
RECORDS = CONFIG.records
for folder in RECORDS.values():
    if not Path(folder, "record.yaml").is_file():
        raise WorkflowError(f"{CONFIG_FILE}: discover: {folder}: no record.yaml in this folder")


wildcard_constraints:
    card="[A-Za-z0-9_-]+[.][A-Za-z0-9_-]+",
    figure="fig[0-9]+",
    record="[^/]+",


# Snakemake does not see edits to an installed package: each rule names the sources it runs as inputs.
# A layer is a module or a package below src/sonicvacuum; every rule depends on the locked environment too.
LAYERS = {
    "card": ["card.py", "materials.py", "config.py", "files.py", "cli/__init__.py", "cli/card.py"],
    "model": ["paper/named.py", "discover/compare.py", "discover/verdict.py"],
    "physics": ["physics", "effects", "study.py", "observe/sensor.py", "cli/simulate.py"],
    "observe": ["observe", "paper", "cli/observe.py"],
    "ledger": ["paper", "cli/ledger.py"],
    "figures": ["figures", "observe", "paper", "cli/draw.py"],
    "report": ["report", "cli/report.py"],
    "pages": [
        "report",
        "figures/discovery.py",
        "figures/disagreement.py",
        "figures/posterior.py",
        "figures/style.py",
    ],
    "discover": ["observe", "records", "discover", "cli/discover.py"],
    "blind": ["observe", "records", "blind", "cli/blind.py"],
}
LOCKS = ["requirements.lock", "requirements-build.lock"]


def sources(*layers):
    """Source files of some layers and the locks, in a fixed order."""
    package = Path("src/sonicvacuum")
    found = set()
    for part in (part for layer in layers for part in LAYERS[layer]):
        path = package / part
        found.update(
            (p for kind in ("*.py", "*.j2", "*.css") for p in path.rglob(kind)) if path.is_dir() else [path]
        )
    return sorted(str(path) for path in found if path.name != "bench.py") + LOCKS


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
