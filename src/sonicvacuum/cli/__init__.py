"""The command `sonicvacuum`: one verb per step of the pipeline, each in its own file and loaded when called.

Bad input ends in one line on standard error and exit code 2, never in a traceback.
"""

import os
import sys
from importlib import import_module

import click

from sonicvacuum.files import InputError

# Sums must not depend on the number of processors, nor on the threads that Snakemake gives a rule: numpy's
# linear algebra gets one. It reads this when it is loaded, which no verb has done yet.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

# Verb → module that holds it; the order is the order of the work.
VERBS = {
    "card": "card",
    "materials": "card",
    "effects": "card",
    "schema": "card",
    "simulate": "simulate",
    "observe": "observe",
    "metrics": "observe",
    "ledger": "ledger",
    "audit": "ledger",
    "draw": "draw",
    "report": "report",
    "publish": "report",
    "timings": "report",
    "record": "record",
    "discover": "discover",
    "page": "discover",
    "compare": "discover",
    "hide": "blind",
    "score": "blind",
    "follow": "follow",
    "resolved": "follow",
    "calibrate": "baselines",
    "baselines": "baselines",
    "draw-study": "baselines",
    "publish-study": "baselines",
}


class Verbs(click.Group):
    """A group whose commands are imported on demand, so that each verb starts fast."""

    def list_commands(self, ctx):
        """The verbs in the order of the work."""
        return list(VERBS)

    def get_command(self, ctx, name):
        """The command of one verb, None for an unknown one."""
        if name not in VERBS:
            return None
        return getattr(import_module(f"{__name__}.{VERBS[name]}"), name.replace("-", "_"))


@click.group(cls=Verbs, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="sonicvacuum")
def cli():
    """Strongly nonlinear waves in chains of beads: simulate, compare with the paper, report."""


def main():
    """Run the command line; bad input and interruption end quietly."""
    try:
        cli(standalone_mode=False)
    except click.ClickException as error:
        error.show()
        sys.exit(2)
    except InputError as error:
        click.echo(f"Error: {error}", err=True)
        sys.exit(2)
    except (click.Abort, KeyboardInterrupt):
        sys.exit(130)


def existing(**options):
    """Type of a path argument that must be a readable file."""
    return click.Path(exists=True, dir_okay=False, readable=True, **options)
