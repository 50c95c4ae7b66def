"""Public functions, as `import sonicvacuum as sv` shows them.

Cases are built in `builders`; `sv.discover` stands in `discover.session`, `sv.predict` in `prediction`.

Each is a few lines over the module that does the work. SI units throughout, except where a key carries its
unit in its name, as in `config.yaml` and `record.yaml`.
"""

from os import PathLike

from sonicvacuum import config, simulation
from sonicvacuum.card import Card
from sonicvacuum.discover import compare as comparison
from sonicvacuum.discover.compare import Comparison
from sonicvacuum.discover.verdict import Model
from sonicvacuum.physics.run import available_threads
from sonicvacuum.records import Record
from sonicvacuum.records import read as read_record
from sonicvacuum.simulation import Simulation

Path = str | PathLike[str]


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
    return config.card(config.read(path), name, variant, path)


def simulate(card: Card) -> Simulation:
    """A card integrated at the chosen step and at half of it; `readings()` of the result are its gauges.

    Args:
        card: from `sv.case` or `sv.read_case`.

    Returns:
        Simulation: `time` (samples,) in s, `force` (samples, contacts, runs) in N, `readings()` gauge →
        (samples, runs) in the gauge's unit without the static part; runs in the order of the speeds.

    Raises:
        InputError: for an effect that does not exist, or an aim that no speed reaches.

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
    return simulation.simulate(card)


def compare(model: Model | Path, record: Record, threads: int | None = None) -> Comparison:
    """A model's score on a record; only the record's own nuisances are fitted.

    Args:
        model: what `discover` found, or the path of a `model.json`.
        record: what to score it on.
        threads: as in `discover`.

    Returns:
        Comparison: misfit over the noise before and after (`gap`), run by run too, and `warnings`.

    Raises:
        InputError: for a file that holds no model, or a model that does not fit the record.
    """
    known = model if isinstance(model, Model) else comparison.read_model(model)
    return comparison.compare(known, record, threads or available_threads())
