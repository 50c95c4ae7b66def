"""Mutants of every file that a user can hand over, and what the program makes of them.

A mutant is either another tree (a value of another kind, size or sign, a key too many or too few), another
table (a cell changed, lost, put in twice) or other bytes (cut, flipped, in another encoding). Each must be
accepted, and then mean something, or be refused by an `InputError` with the file's name; anything else is a
fault. Run as a script, it tries many and writes a table:

    python tests/fuzz/mutants.py results/fuzz.csv 5000
"""

import copy
import json
import math
import random
import shutil
import sys
import tempfile
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import yaml

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), *(str(HERE.parent / folder) for folder in ("records", "report", "unit"))]

from made_verdicts import write  # noqa: E402
from record_cases import CONTENT  # noqa: E402
from tables import Tables, in_cell  # noqa: E402
from test_card import CASE  # noqa: E402
from test_histories import CARD, PARTS  # noqa: E402

from sonicvacuum import card, config, simulation  # noqa: E402
from sonicvacuum.cli.cards import read_card  # noqa: E402
from sonicvacuum.discover.compare import read_model  # noqa: E402
from sonicvacuum.files import InputError  # noqa: E402
from sonicvacuum.records.reader import read as read_record  # noqa: E402
from sonicvacuum.report.record import section  # noqa: E402

VALUES = [
    None, True, 0, -1, 1, 10**400, 2**63, 0.0, -0.0, -1.0, 0.5, 1e-300, 1e300, math.nan, math.inf, -math.inf,
    "", "2e0", "1e999", "nan", "µm", "a" * 5000, "<script>", "../x", "$(id)", "\u0000", "\ud7ff", [], [[]],
    {}, {"": 0}, [1.0] * 50, {"x": {"y": []}}, "2020-13-45",
]  # fmt: skip
FACTORS = [-1.0, 1e-3, 1e3, 1e-6, 1e6, 1e-9, 1e9, 0.5, 2.0]


def places(tree, at=()):
    """Paths of all values of nested mappings and lists."""
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in items:
        yield (*at, key)
        yield from places(value, (*at, key))


def mutated(tree, draw: random.Random):
    """(mutant, kind of mutation) of a tree."""
    tree = copy.deepcopy(tree)
    *parents, last = draw.choice(list(places(tree)))
    block = tree
    for key in parents:
        block = block[key]
    kind = draw.choice(["value", "value", "scale", "scale", "remove", "add", "rename", "repeat"])
    value = block[last]
    if kind == "scale" and isinstance(value, int | float) and not isinstance(value, bool):
        block[last] = value * draw.choice(FACTORS)
    elif kind == "remove":
        del block[last]
    elif kind == "add" and isinstance(block, dict):
        block[draw.choice(["extra", "", "µ", 3, None])] = copy.deepcopy(value)
    elif kind == "rename" and isinstance(block, dict):
        block[f"{last}s"] = block.pop(last)
    elif kind == "repeat" and isinstance(block, list):
        block.append(copy.deepcopy(value))
    else:
        kind, block[last] = "value", copy.deepcopy(draw.choice(VALUES))
    return tree, kind


def spoiled(whole: bytes, draw: random.Random):
    """(mutant, kind of mutation) of a file's bytes."""
    kind = draw.choice(["cut", "flip", "insert", "drop", "utf-16", "latin-1", "double", "empty"])
    at = draw.randrange(len(whole) + 1)
    if kind == "cut":
        return whole[:at], kind
    if kind == "flip":
        return bytes([*whole[:at], draw.randrange(256), *whole[at + 1 :]]), kind
    if kind == "insert":
        return whole[:at] + draw.choice([b"\x00", b"\xff", b",", b'"', b"\n", b"{", b"&a *a", b"-"]) + whole[
            at:
        ], kind
    if kind == "drop":
        return whole[:at] + whole[at + draw.randrange(1, 40) :], kind
    if kind in ("utf-16", "latin-1"):
        return whole.decode("utf-8", "replace").encode(kind, "replace"), kind
    return (whole + whole if kind == "double" else b""), kind


class Files:
    """One sound file of each kind in a folder, and how each is read.

    Attributes:
        trees: kind → (file, content, writer) of those that are trees.
        readers: kind → (file, what reads it and says whether what it found means something).
    """

    def __init__(self, folder: Path):
        self.folder = folder
        content = {"cases": {"c": {**CASE, "effects": {"tsuji": {"alpha": 0.1}}}}, "ledger": {"x": ["soft"]}}
        resolved = config.card(config.Config(cases=content["cases"], ledger={}), "c", "soft", "config.yaml")
        write(folder / "found", "pair")
        model = json.loads((folder / "found" / "model.json").read_bytes())
        model["effects"] = {"tsuji": {"alpha": 0.1}, "mass-defect": {"mass_ratio": 1.2, "bead": 3.0}}
        (folder / "record").mkdir()
        (folder / "record" / "record.yaml").write_text(yaml.safe_dump(CONTENT))
        time = np.arange(-10.0, 190.0, 0.25)
        pulse = 10.0 * np.exp(-(((time - 60.0) / 15.0) ** 2))
        rows = "\n".join(f"{t:g},{a:.4f},{a:.4f},{a:.4f}" for t, a in zip(time, pulse, strict=True))
        for name in ("slow", "fast"):
            (folder / "record" / f"{name}.csv").write_text("time_us,near,far,wall\n" + rows + "\n")
        np.savez(folder / "history.npz", **PARTS)
        said = json.loads((folder / "found" / "verdict.json").read_bytes())
        self.trees = {
            "config": ("config.yaml", content, yaml.safe_dump),
            "card": ("card.json", json.loads(card.dump(resolved)), json.dumps),
            "record": ("record/record.yaml", CONTENT, yaml.safe_dump),
            "model": ("model.json", model, json.dumps),
            "verdict": ("found/verdict.json", said, json.dumps),
        }
        self.readers = {
            "config": ("config.yaml", self._config),
            "card": ("card.json", lambda path: simulation.set_up(read_card(path))),
            "record": ("record/record.yaml", lambda path: read_record(path.parent)),
            "signals": ("record/fast.csv", lambda path: read_record(path.parent).signals),
            "model": ("model.json", read_model),
            "verdict": ("found/verdict.json", lambda path: section(path.parent)),
            "where": ("found/where.csv", lambda path: section(path.parent)),
            "candidates": ("found/candidates.csv", lambda path: section(path.parent)),
            "gap": ("found/gap.csv", lambda path: section(path.parent)),
            "limits": ("found/limits.csv", lambda path: section(path.parent)),
            "history": ("history.npz", lambda path: simulation.load(CARD, path)),
        }
        for file, tree, dumped in self.trees.values():
            (folder / file).write_text(dumped(tree))
        tables = Tables(folder / "tables")
        self.trees |= {kind: (f"tables/{file}", *rest) for kind, (file, *rest) in tables.trees.items()}
        self.readers |= {kind: (f"tables/{file}", read) for kind, (file, read) in tables.readers.items()}
        self.whole = {kind: (folder / file).read_bytes() for kind, (file, _) in self.readers.items()}

    @staticmethod
    def _config(path):
        found = config.read(path)
        for name in config.card_names(found):
            case, variant = name.split(".")
            one = config.card(found, case, variant, path)
            card.check(one)
            simulation.set_up(one)

    def attempt(self, kind: str, draw: random.Random) -> tuple[str, str, str]:
        """(kind of mutation, accepted | refused | other, what was said) of one mutant."""
        file, read = self.readers[kind]
        path = self.folder / file
        if kind in self.trees and draw.random() < 0.7:
            _, tree, dumped = self.trees[kind]
            tree, mutation = mutated(tree, draw)
            try:
                mutant = dumped(tree).encode("utf-8", "surrogatepass")
            except (TypeError, ValueError):  # keys that JSON does not have
                return mutation, "refused", "not written"
        elif path.suffix == ".csv" and draw.random() < 0.7:
            mutant, mutation = in_cell(self.whole[kind], draw), "cell"
        else:
            mutant, mutation = spoiled(self.whole[kind], draw)
        path.write_bytes(mutant)
        try:
            read(path)
            return mutation, "accepted", ""
        except InputError as error:
            return mutation, "refused" if "\n" not in str(error) else "other", str(error)
        except Exception as error:
            return mutation, "other", f"{type(error).__name__}: {error}"
        finally:
            path.write_bytes(self.whole[kind])


def main(table: str, count: str) -> None:
    """Try `count` mutants and write how many of each kind were accepted, refused, and neither."""
    warnings.filterwarnings("error", module="sonicvacuum")  # as in the tests: our own overflows are faults
    tally, faults = Counter(), []
    folder = Path(tempfile.mkdtemp())
    try:
        files = Files(folder)
        kinds = sorted(files.readers)
        for number in range(int(count)):
            kind = kinds[number % len(kinds)]
            mutation, outcome, told = files.attempt(kind, random.Random(number))
            tally[kind, mutation, outcome] += 1
            if outcome == "other":
                faults.append(f"{number} {kind} {mutation}: {told[:300]}")
    finally:
        shutil.rmtree(folder)
    Path(table).parent.mkdir(parents=True, exist_ok=True)
    with open(table, "w", encoding="utf-8") as stream:
        stream.write("file,mutation,accepted,refused,other\n")
        for kind, mutation in sorted({key[:2] for key in tally}):
            counts = [tally[kind, mutation, outcome] for outcome in ("accepted", "refused", "other")]
            stream.write(f"{kind},{mutation},{','.join(map(str, counts))}\n")
    print("\n".join(faults) or f"{count} mutants, none neither accepted nor refused")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main(*sys.argv[1:])
