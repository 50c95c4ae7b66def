"""Writing a record: `record.yaml` and a CSV file for each run with traces, which `read` returns unchanged."""

from pathlib import Path

import msgspec

from sonicvacuum.files import InputError, replacing, writing
from sonicvacuum.outputs import renewed
from sonicvacuum.records import signals
from sonicvacuum.records.reader import FILE, parse
from sonicvacuum.records.record import Record

_FIRST_OF_CHAIN = ("beads", "orientation", "bead", "pattern", "bodies", "wall", "static_force_N")
_FIRST_OF_OBSERVABLE = (
    "quantity", "amplitude_N", "from", "to", "sensor", "level", "threshold", "value", "sigma", "unit"
)  # fmt: skip


def write(record: Record, path) -> None:
    """Write a record into a folder, made if need be; files take their names once all are complete, see
    `outputs.renewed` for what a kill in between leaves.

    Raises:
        InputError: for a record that `read` would refuse (nothing is written then) or an unwritable folder.
    """
    folder = Path(path)
    content = dump(record)
    parse(content, folder / FILE)
    files = {run.id: run.signals for run in record.block.runs if run.signals}
    if set(files) != set(record.signals) or len(set(files.values())) != len(files):
        raise InputError(
            f"{folder}: runs {sorted(files)} name signals and {sorted(record.signals)} have traces; "
            "each run with traces needs its own file name"
        )
    with writing(folder), renewed(folder, last=FILE) as fresh:
        for run, name in files.items():
            signals.write(record.signals[run], fresh / name)
        with replacing(fresh / FILE) as stream:
            stream.write(text(content))


def dump(record: Record) -> dict:
    """`record.yaml` as a plain mapping, keys in the order of the contract, without keys at their defaults."""
    content = msgspec.to_builtins(record.block)
    content["chain"] = _ordered(content["chain"], _FIRST_OF_CHAIN)
    for run in content["runs"]:
        if "observables" in run:
            run["observables"] = [_ordered(o, _FIRST_OF_OBSERVABLE) for o in run["observables"]]
    return content


def _ordered(mapping, first):
    """The mapping with these keys first, then the others."""
    head = {k: mapping[k] for k in first if k in mapping}
    return head | mapping


def text(content: dict) -> str:
    """YAML of that mapping."""
    import yaml

    return yaml.safe_dump(content, sort_keys=False, allow_unicode=True, default_flow_style=None, width=110)
