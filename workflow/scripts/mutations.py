"""Whether the tests of discover's statistics can fail: each is broken once, in a copy of the source.

Prints one line for each mutation with the tests that notice it; ends with 1 where none does. Run it from the
top of the repository: `python workflow/scripts/mutations.py`.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# What is broken, file, text that stands there once, what takes its place.
MUTATIONS = (
    ("better is always true", "heldout.py", "return len(gain) < 2 or bool(", "return True or bool("),
    (
        "noise is never correlated",
        "noise.py",
        "rho = _correlations(",
        "rho = 0.0 * _correlations(",
    ),
    ("no whitening", "whitening.py", "if not np.any(correlation):", "if True:"),
    (
        "one-sided 1.645 is 0",
        "degenerate.py",
        "_ONE_SIDED, _TWO_SIDED = policy.NINETY",
        "_ONE_SIDED, _TWO_SIDED = 0.0",
    ),
    ("NULL_MISFIT is 0", "policy.py", "NULL_MISFIT = 1e-3", "NULL_MISFIT = 0.0"),
    ("occam_strength is 0", "evidence.py", "return math.log(min(1.0, factor))", "return 0.0"),
    (
        "separation is constant",
        "next_experiment.py",
        "return np.maximum(apart, 0.0)",
        "return 0.0 * apart + 1.0",
    ),
    ("temper is 1 in the formula", "calibration.py", "self.temper * value", "1.0 * value"),
    ("temper is 1 in the package", "calibration.json", None, None),
    ("FALSE_ALARM is 0.05", "policy.py", "FALSE_ALARM = 0.01", "FALSE_ALARM = 0.05"),
)
TESTS = tuple(
    f"tests/discover/test_{name}.py" for name in ("linear_gaussian", "linear_predictions", "statistics")
)


def mutated(text: str, old: str | None, new: str | None) -> str:
    """The text with the one place changed; the calibration's temper without `old`.

    Raises:
        SystemExit: where the place is not found once.
    """
    if old is None:
        result, count = re.subn(r'"temper": [0-9.]+', '"temper": 1.0', text)
    else:
        result, count = text.replace(old, new), text.count(old)
    if count != 1:
        raise SystemExit(f"{old!r} stands {count} times; write the mutation anew")
    return result


def failures(source: Path) -> list[str]:
    """Names of the tests that fail with the package in `source`."""
    environment = os.environ | {"PYTHONPATH": str(source)}
    command = [sys.executable, "-m", "pytest", *TESTS, "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise SystemExit(done.stdout + done.stderr)
    return re.findall(r"^FAILED \S+::(\w+)", done.stdout, flags=re.MULTILINE)


def main() -> int:
    """Break, test and restore, one after the other."""
    unnoticed = 0
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "src"
        shutil.copytree("src", source, ignore=shutil.ignore_patterns("__pycache__"))
        for title, name, old, new in (("nothing", "rounds.py", "", ""), *MUTATIONS):
            path = next(
                p
                for p in sorted((source / "sonicvacuum" / "discover").rglob(name))
                if "faults" not in p.parts
            )
            text = path.read_text(encoding="utf-8")
            path.write_text(mutated(text, old, new) if title != "nothing" else text, encoding="utf-8")
            red = sorted(set(failures(source)))
            path.write_text(text, encoding="utf-8")
            unnoticed += (not red) != (title == "nothing")
            print(f"{title}: {len(red)} red{': ' if red else ''}{', '.join(red)}", flush=True)
    return int(unnoticed > 0)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.parse_args()
    sys.exit(main())
