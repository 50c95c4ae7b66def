"""What all rules share: where things lie, and what the library knows of the configuration."""

import os
import shlex
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError

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


# Snakemake alone is enough to read, list and lint the rules, as the workflow catalogue does.
try:
    import sonicvacuum

    KNOWN = "library.smk"
except ModuleNotFoundError:
    KNOWN = "absent.smk"


include: KNOWN


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
# The verb `discover` loads these for pictures and page, which the workflow makes by the verb `page`.
PAGES = ("sonicvacuum.cli.page", "sonicvacuum.drawn")
# Verbs that take a card load this where a model is put into it.
MODEL = ("sonicvacuum.cli.model",)


def repeated(option, values):
    """Words of a command: the option before each value, to be interpolated with :q."""
    return [word for value in values for word in (option, str(value))]


def place(wildcards, output):
    """Where a verb writes what it makes of several things: one file, or the folder of several."""
    return output[0] if len(output) == 1 else Path(output[0]).parent


def record_files(wildcards):
    """What discover reads of a record: the traces that it names, whatever they are called, and nothing else."""
    folder = Path(RECORDS[wildcards.record])
    return [str(folder / name) for name in ("record.yaml", *traces_of(folder))]
