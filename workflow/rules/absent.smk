"""In place of the library where it is not installed: no case is known, and whatever is to be made is refused."""

from types import SimpleNamespace

CONFIG = SimpleNamespace(cases={}, ledger={}, records={})
CARDS = FIGURES = OWN = STUDY = ANIMATIONS = ()
CARD_BATCHES = {}
STUDY_TABLES = ""


def refused(*_):
    """Stands for all that a job would have to know."""
    raise WorkflowError(
        f"The Python of this Snakemake ({sys.executable}) has no package sonicvacuum: "
        f"run `make` in {HOME}, or {COMMANDS}/pip install {shlex.quote(str(HOME))}[workflow]"
    )


def sources(*_, **__):
    return refused


resolved = traces_of = model_of = drawn = Caption = text = refused
