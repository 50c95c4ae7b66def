"""Public functions, as `import sonicvacuum as sv` shows them.

Cases are built in `builders`; `sv.discover` stands in `discover.session`, `sv.predict` and `sv.design` in
`prediction`.

Each is a few lines over the module that does the work. SI units throughout, except where a key carries its
unit in its name, as in `config.yaml` and `record.yaml`.
"""

import pathlib
from os import PathLike
from typing import TYPE_CHECKING

from sonicvacuum import config, plugins, simulation
from sonicvacuum import folder as verdict_folder
from sonicvacuum.card import Card
from sonicvacuum.discover import compare as comparison
from sonicvacuum.discover.compare import Comparison
from sonicvacuum.discover.extended import extended
from sonicvacuum.discover.model.abreast import processors
from sonicvacuum.discover.verdict import Model
from sonicvacuum.effects import Catalogue
from sonicvacuum.files import InputError, writing
from sonicvacuum.records import Record, check_records
from sonicvacuum.records import read as read_record
from sonicvacuum.records.guard import check_out
from sonicvacuum.simulation import Simulation

if TYPE_CHECKING:
    from sonicvacuum.discover.session import Result

Path = str | PathLike[str]


def _check_path(verb: str, given: object, cure: str) -> None:
    """InputError for what is no path; a number would be taken for an open file."""
    if not isinstance(given, str | PathLike):
        raise InputError(f"{verb}: is given {given!r:.100}; give {cure}")


def read(folder: Path) -> Record:
    """The record of measured data in a folder: `record.yaml` and a CSV of traces for each run that has any.

    Args:
        folder: its path.

    Returns:
        Record: laboratory, gauges and runs in SI; `signals` run → traces, (samples,) for each gauge, in the
        gauge's unit over `time_us`.

    Raises:
        InputError: naming file, key or line, value and cure, where the folder does not hold a sound record.
    """
    _check_path("read", folder, "the path of a record's folder")
    return read_record(folder)


def read_case(path: Path, name: str, variant: str = "nominal") -> Card:
    """One variant of one case of a configuration file, resolved into SI.

    Args:
        path: of the file, as `config.yaml`.
        name: key of the case below `cases`.
        variant: key of the variant below the case; `nominal` is the case as it is written.

    Returns:
        `Card`, what `sv.simulate` takes.

    Raises:
        InputError: naming file, key, value and cure.
    """
    _check_path("read_case", path, "the path of a configuration, as of config.yaml")
    return config.card(config.read(path), name, variant, path)


def catalogue(*files: Path) -> Catalogue:
    """The effects that a model may lack: the project's, those of installed packages, those of files.

    Args:
        *files: Python files with effects of one's own, as `--effects` takes them.

    Returns:
        Catalogue, what `sv.discover`, `sv.compare` and `sv.simulate` take; without one they take that of no
        file. `.ids` are its effects.

    Raises:
        InputError: naming file, line or effect, what is wrong and the cure.

    Examples:
        >>> import sonicvacuum as sv
        >>> sv.catalogue().effect("tsuji").parameters[0].name
        'alpha'
    """
    for file in files:
        _check_path("catalogue", file, "the path of a Python file, as in sv.catalogue('my_law.py')")
    return plugins.catalogue(files)


def simulate(
    card: Card,
    catalogue: Catalogue | None = None,
    limits: bool = True,
    model: "Result | Model | Path | None" = None,
) -> Simulation:
    """A card integrated at the chosen step and at half of it; `readings()` of the result are its gauges.

    Args:
        card: from `sv.case` or `sv.read_case`.
        catalogue: holds the effects of card and model, see `sv.catalogue`.
        limits: refuse what asks for more time or memory than a computer gives.
        model: what `discover` returned, or the path of a `model.json`, to put into the chain first: its
            effects and its modulus.

    Returns:
        Simulation: `time` (samples,) in s, `force` (samples, contacts, runs) in N, `readings()` gauge →
        (samples, runs) in the gauge's unit without the static part; runs in the order of the speeds.

    Raises:
        InputError: for what is no card or model, an effect that does not exist or cannot act in this chain,
            an aim that no speed reaches, or (`limits`) more than a computer gives.

    Examples:
        >>> import sonicvacuum as sv
        >>> big, small = (sv.bead(diameter_mm=d, material="bearing-steel") for d in (20.0, 10.0))
        >>> dimer = sv.chain(pattern=[big, small], beads=20)
        >>> vibrometer = sv.gauge("velocity", bead=15)
        >>> card = sv.case(dimer, sv.striker(big, speed_m_s=0.5), [vibrometer], duration_us=800)
        >>> seen = sv.simulate(card)
        >>> seen.readings()["velocity-15"].shape  # samples, runs; m/s
        (1601, 1)
    """
    if not isinstance(card, Card):
        raise InputError(f"simulate: is given {card!r:.100}; give a card, as of sv.case or sv.read_case")
    effects = plugins.given(catalogue, "simulate")
    if model is not None:
        card = extended(card, _model("simulate", model, effects), None, effects)
    return simulation.simulate(card, effects, limits)


def compare(
    model: "Result | Model | Path",
    record: Record,
    threads: int | None = None,
    catalogue: Catalogue | None = None,
) -> Comparison:
    """A model's score on a record; only the record's own nuisances are fitted.

    Args:
        model: what `discover` returned, its `model`, or the path of a `model.json`.
        record: what to score it on.
        threads: as in `discover`.
        catalogue: holds the model's effects, see `sv.catalogue`.

    Returns:
        Comparison: χ² per datum of the nominal model and of this one (`gap`; 1 is the noise), run by run too
        (`runs`), and `warnings`.

    Raises:
        InputError: for a file that holds no model, a model that does not fit the record, or no processor.
    """
    check_records((record,), "compare")
    threads = processors(threads, "compare")
    effects = plugins.given(catalogue, "compare")
    return comparison.compare(_model("compare", model, effects), record, threads, effects)


def write_verdict(result: "Result", folder: Path, figures: bool = True) -> pathlib.Path:
    """Write what `sonicvacuum discover --out` writes: verdict.json, model.json, tables, pictures and page.

    By the same code, so that `sonicvacuum page`, `compare` and `simulate --model` take the folder too. All of
    it is written to a temporary place first and renamed, verdict.json last; files of an earlier verdict make
    room, other files are left.

    Args:
        result: what `sv.discover` returned.
        folder: its path; made if need be.
        figures: pictures and `index.html` too.

    Returns:
        Path of the folder; `model.json` in it is what `sv.compare` and `sv.simulate` take.

    Raises:
        InputError: for what is no result or no path; for a folder that is that of a record, lies in one or
            cannot be written, of which nothing is touched.
        Exception: what pictures or page failed with; a note says that the verdict stands without them.
    """
    from sonicvacuum.discover.session import Result  # a Result has loaded it

    if not isinstance(result, Result):
        raise InputError(f"write_verdict: is given {result!r:.100} as a result; give what discover returned")
    _check_path("write_verdict", folder, "the path of a folder to write")
    check_out(folder)
    with writing(folder):
        error = verdict_folder.write(result, folder, figures)
    if error is not None:
        error.add_note(f"{folder} holds the verdict without pictures and page, which failed")
        raise error
    return pathlib.Path(folder)


def _model(verb: str, given: object, effects: Catalogue) -> Model:
    """A model, or that of a file; InputError for what is none, or has effects that the catalogue lacks."""
    found = getattr(given, "model", None)
    if isinstance(found, Model):  # of a Result, whose type would load the whole search
        given = found
    if isinstance(given, Model):
        for name in given.effects:
            comparison.check_source(f"model of {given.record}", name, given.sources, effects)
        return given
    if isinstance(given, str | PathLike):
        return comparison.read_model(given, effects)
    raise InputError(f"{verb}: is given {given!r:.100} as a model; give what discover returned, or a path")
