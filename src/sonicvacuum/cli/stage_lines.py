"""What a terminal shows while a search runs: each stage with steps done, time gone and time left; and what
any verb says where kernels must be compiled first.
"""

import sys
from contextlib import contextmanager

import click

from sonicvacuum.stages import compilations_told_to

# Told while kernels are compiled, which happens once for a computer: beside a stage, or by a verb that shows
# none. A verb takes a few kernels, a search dozens.
COMPILING = "compiling kernels, once on this computer"
LENGTH = "some seconds; before a first search of all up to half a minute"
# Where the folder of kernels cannot be written.
NOT_KEPT = (
    "compiling kernels; they cannot be kept, so that each command does so again: "
    "name a folder that can be written in SONICVACUUM_CACHE_DIR"
)


@contextmanager
def compiling_told():
    """Within this, the first kernel that must be compiled is told of, in one plain line on standard error."""
    told = []

    def tell(change):
        if change < 0 or told:
            return
        told.append(True)
        from sonicvacuum.physics.compiled import cache_folder  # loaded: it is what tells

        context = click.get_current_context(silent=True)
        name = context.command_path if context else "sonicvacuum"
        click.echo(f"{name}: {f'{COMPILING}: {LENGTH}' if cache_folder() else NOT_KEPT}", err=True)

    with compilations_told_to(tell):
        yield


@contextmanager
def stages_shown(name: str, quiet: bool):
    """On a terminal, a line with the stage of a search, steps done, time gone and left; nothing in a log."""
    if quiet:
        with compilations_told_to(lambda change: None):
            yield
        return
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.progress import Progress, TextColumn

    from sonicvacuum.stages import told_to

    columns = (TextColumn("{task.description}"), _state_column())
    with Progress(*columns, console=Console(stderr=True)) as shown:
        # The first kernels are compiled before the first stage.
        tasks = [shown.add_task(f"{name}: start", total=None, compiling=0)]

        def tell(stage, done, total):
            if not done:
                shown.stop_task(tasks[-1])
                tasks.append(shown.add_task(f"{name}: {stage}", total=total, compiling=0))
            shown.update(tasks[-1], completed=done)

        def compiling(change):
            shown.update(tasks[-1], compiling=max(0, shown.tasks[-1].fields["compiling"] + change))

        with told_to(tell), compilations_told_to(compiling):
            yield


def state(done: float, total: float | None, gone: float, left: float | None, compiling: bool) -> str:
    """What stands behind the name of a stage.

    Args:
        done: steps done.
        total: steps in all; None where a stage has no steps.
        gone: time since it began, s.
        left: time left, s; None where it is not known, or the stage is over.
        compiling: whether a kernel is being compiled.
    """
    parts = [f"{done:.0f} of {total:.0f}"] if total else []
    parts.append(_clock(gone))
    parts += [f"about {_clock(left)} left"] if left else []
    return ", ".join([*parts, COMPILING] if compiling else parts)


def _clock(seconds):
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest:02d} s" if minutes else f"{rest} s"


def _state_column():
    """A column of `rich` that shows `state`; a class of its own, as `rich` is long to load."""
    from rich.progress import ProgressColumn
    from rich.text import Text

    class State(ProgressColumn):
        def render(self, task):
            left = None if task.stop_time else task.time_remaining
            compiling = bool(task.fields["compiling"]) and task.stop_time is None
            return Text(state(task.completed, task.total, task.elapsed or 0.0, left, compiling))

    return State()
