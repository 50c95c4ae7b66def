"""Verdicts computed for a plain 64-bit processor beside those for this machine's own.

Names must be equal. Numbers differ by roundings, which a least-squares fit carries into what it finds: the
tolerances lie far above these (1e-9 and less was measured) and far below anything that a reader would see.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

# Two records of the small study: an effect beside another, and none.
BATCH = "6/14"
TOLERANCES = {"probabilities": 1e-6, "parameters, in errors": 1e-4, "limits": 1e-4, "gap": 1e-6}


def made(folder: Path, processor: dict[str, str]) -> dict[str, dict]:
    """Record → its verdict, computed with further variables in the environment."""
    environment = os.environ | processor
    verdicts = folder / ("generic" if processor else "own")
    records = sorted(map(str, (folder / "records").iterdir()))
    words = ["discover", *records, "--out", str(verdicts), "--no-figures", "--threads", "1"]
    subprocess.run([_command(), *words], env=environment, check=True, stdout=subprocess.DEVNULL)
    return {
        Path(r).name: json.loads((verdicts / Path(r).name / "verdict.json").read_bytes()) for r in records
    }


def hidden(folder: Path) -> None:
    """Make the records."""
    words = ["--study", "small", "--batch", BATCH]
    words += ["--records", str(folder / "records"), "--truth", str(folder / "truth")]
    subprocess.run([_command(), "blind", "hide", *words], check=True, stdout=subprocess.DEVNULL)


def _command():
    return str(Path(sys.executable).with_name("sonicvacuum"))


def apart(one: dict, other: dict) -> dict[str, float]:
    """Largest difference of two verdicts in each kind of number; infinite where names differ."""
    if any(one[key] != other[key] for key in ("named", "confusable", "not_testable")):
        return dict.fromkeys(TOLERANCES, float("inf"))
    names = one["probabilities"].keys() | other["probabilities"].keys()
    pairs = {
        "probabilities": [[v["probabilities"].get(n, 0.0) for v in (one, other)] for n in names],
        "gap": [[v["gap"]["fitted"][key] for v in (one, other)] for key in ("before", "after")],
    }
    found = {kind: max((abs(a - b) for a, b in several), default=0.0) for kind, several in pairs.items()}
    found["parameters, in errors"] = max(
        (
            abs(value["value"] - other["parameters"][effect][name]["value"]) / (value["sigma"] or 1.0)
            for effect, values in one["parameters"].items()
            for name, value in values.items()
        ),
        default=0.0,
    )
    limits = [
        (limit, other["upper_limits"][effect][name])
        for effect, values in one["upper_limits"].items()
        for name, limit in values.items()
    ]
    found["limits"] = max((abs(a - b) / abs(a) for a, b in limits if a), default=0.0)
    return found


def rows(folder: Path, processor: dict[str, str], columns: tuple[str, ...]) -> list[dict]:
    """One row for each record and kind of number, in the columns of `generic`."""
    hidden(folder)
    own, plain = made(folder, {}), made(folder, processor)
    found = []
    for record, verdict in own.items():
        for kind, difference in apart(verdict, plain[record]).items():
            values = (
                f"verdict {record}",
                kind,
                "",
                f"{difference:.3g}",
                "",
                int(difference > TOLERANCES[kind]),
            )
            found.append(dict(zip(columns, values, strict=True)))
    return found
