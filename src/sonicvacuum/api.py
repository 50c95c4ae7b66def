"""Public functions, as `import sonicvacuum as sv` shows them; `sv.discover` stands in `discover.session`.

Each is a few lines over the module that does the work. SI units throughout, except where a key carries its
unit in its name, as in `config.yaml` and `record.yaml`.
"""

from os import PathLike
from typing import Any

from sonicvacuum import config, simulation
from sonicvacuum.card import Card, CaseBlock, resolve
from sonicvacuum.discover import compare as comparison
from sonicvacuum.discover.compare import Comparison
from sonicvacuum.discover.verdict import Model
from sonicvacuum.files import InputError, convert
from sonicvacuum.laboratory.ranges import LaboratoryError
from sonicvacuum.physics.run import available_threads
from sonicvacuum.records import Record
from sonicvacuum.records import read as read_record
from sonicvacuum.simulation import Simulation

Path = str | PathLike[str]


def read(folder: Path) -> Record:
    """The record of measured data in a folder: `record.yaml` and a CSV of traces for each run that has any.

    Raises:
        InputError: naming file, key or line, value and cure, where the folder does not hold a sound record.
    """
    return read_record(folder)


def case(title: str = "case", **blocks: Any) -> Card:
    """A case of one's own, resolved into SI: the same keys as a case of `config.yaml`, as Python objects.

    Args:
        title: one line.
        **blocks: `chain`, `striker`, `sensors`, `duration_us`; optional `sample_us`, `materials`, `effects`.

    Raises:
        InputError: for an unknown key, a value out of range, a gauge outside the chain and the like.

    >>> import sonicvacuum as sv
    >>> steel = {"diameter_mm": 5.0, "mass_g": 0.5, "material": "bearing-steel"}
    >>> wall = {"material": "bearing-steel"}
    >>> card = sv.case(
    ...     chain={"beads": 8, "orientation": "horizontal", "bead": steel, "wall": wall},
    ...     striker={"shape": "sphere", **steel, "speed_m_s": 0.5},
    ...     sensors=[{"id": "wall", "kind": "wall"}],
    ...     duration_us=200,
    ... )
    >>> card.beads, card.bead.mass_kg
    (8, 0.0005)
    """
    block = convert({"title": title, **blocks}, CaseBlock, "case")
    try:
        return resolve("case", "own", block)
    except LaboratoryError as error:
        raise InputError(f"case: {error}") from None


def read_case(path: Path, name: str, variant: str = "nominal") -> Card:
    """One variant of one case of a configuration file, resolved into SI.

    Raises:
        InputError: naming file, key, value and cure.
    """
    return config.card(config.read(path), name, variant, path)


def simulate(card: Card) -> Simulation:
    """A card integrated at the chosen step and at half of it; `readings()` of the result are its gauges.

    Returns:
        `Simulation`: `time` (samples,) in s, `force` (samples, contacts, runs) in N, `readings()` gauge →
        (samples, runs) in N without the static part; runs in the order of the striker's speeds.

    Raises:
        InputError: for an effect that does not exist, or an aim that no speed reaches.

    >>> import sonicvacuum as sv
    >>> steel = {"diameter_mm": 5.0, "mass_g": 0.5, "material": "bearing-steel"}
    >>> wall = {"material": "bearing-steel"}
    >>> found = sv.simulate(sv.case(
    ...     chain={"beads": 3, "orientation": "horizontal", "bead": steel, "wall": wall},
    ...     striker={"shape": "sphere", **steel, "speed_m_s": 0.5},
    ...     sensors=[{"id": "wall", "kind": "wall"}], duration_us=200,
    ... ))
    >>> found.readings()["wall"].shape
    (401, 1)
    """
    return simulation.run(card)


def compare(model: Model | Path, record: Record, threads: int | None = None) -> Comparison:
    """A model's score on a record; only the record's own nuisances are fitted.

    Args:
        model: what `discover` found, or the path of a `model.json`.
        record: what to score it on.
        threads: as in `discover`.

    Raises:
        InputError: for a file that holds no model, or a model that does not fit the record.
    """
    known = model if isinstance(model, Model) else comparison.read_model(model)
    return comparison.compare(known, record, threads or available_threads())
