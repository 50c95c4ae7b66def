"""What a verdict is on: the records as they were given, beside the verdict in `given.json`.

It holds `record.yaml` as it was read, the SHA-256 of the files and the version of this program, so that a
folder of results says by itself what it came from. No time and no path enter it.
"""

from importlib.metadata import version
from pathlib import Path

from msgspec import Struct

from sonicvacuum.files import read_json
from sonicvacuum.records import Record
from sonicvacuum.records.reader import parse
from sonicvacuum.records.writer import dump

FILE = "given.json"


class Given(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One record.

    Attributes:
        name: of its folder.
        sha256: of its files one after the other, see `Record.digest`.
        record: content of record.yaml.
    """

    name: str
    sha256: str
    record: dict


class Inputs(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The content of the file.

    Attributes:
        version: of the program that gave the verdict.
        records: one, or several taken together.
        notes: what was done to the traces before anything else, one line each.
    """

    format: int = 1
    version: str
    records: list[Given]
    notes: list[str] = []


def inputs(records: tuple[Record, ...], notes: tuple[str, ...] = ()) -> Inputs:
    """What is written of records."""
    given = [Given(name=r.name, sha256=r.digest, record=dump(r)) for r in records]
    return Inputs(version=version("sonicvacuum"), records=given, notes=list(notes))


def read(folder: Path) -> tuple[Inputs, list[Record]] | None:
    """Content of the file in a folder of results, and its records without traces; None where there is none.

    Raises:
        InputError: for a file that discover did not write.
    """
    path = Path(folder) / FILE
    if not path.exists():
        return None
    found = read_json(path, Inputs)
    return found, [
        Record(parse(_numbered(g.record), path), name=g.name, digest=g.sha256) for g in found.records
    ]


def _numbered(content: dict) -> dict:
    """`record.yaml` with numbers of beads as keys: JSON knows none but text."""
    chain = content.get("chain", {})
    if not isinstance(chain, dict) or not isinstance(bodies := chain.get("bodies"), dict):
        return content
    by_number = {int(k) if k.isdecimal() else k: body for k, body in bodies.items()}
    return content | {"chain": chain | {"bodies": by_number}}
