"""Whether the wheel, installed without extras, can search a record: built, installed and run in a new folder.

Its dependencies take the versions of requirements.lock. Run it from the top of the repository with the
locked environment's Python: `make bare`. Ends with 1 and the reason where something fails.
"""

import argparse
import re
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

EXTRAS = ("grimp", "matplotlib", "pandas", "snakemake", "sklearn")


def run(*command: str | Path, folder: Path | None = None) -> str:
    """Standard output of a command; SystemExit with its complaint where it fails."""
    done = subprocess.run([str(c) for c in command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def record() -> str:
    """The small record of the tests."""
    sys.path.insert(0, "tests/workflow")
    from ball import RECORD

    return RECORD


def main() -> None:
    """Build, install, search."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        pip = ("-m", "pip", "--quiet", "--disable-pip-version-check")
        run(sys.executable, *pip, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, ".")
        (wheel,) = folder.glob("*.whl")
        pinned = re.findall(r"^[\w.-]+==\S+", Path("requirements.lock").read_text("utf-8"), re.MULTILINE)
        (folder / "pinned.txt").write_text("\n".join(pinned) + "\n", encoding="utf-8")
        venv.create(folder / "bare", with_pip=True)
        python = folder / "bare/bin/python"
        run(python, *pip, "install", "--constraint", folder / "pinned.txt", wheel)
        found = run(
            python, "-c", f"import importlib.util as u; print([n for n in {EXTRAS} if u.find_spec(n)])"
        )
        if found.strip() != "[]":
            raise SystemExit(f"not bare: {found.strip()} came with the library")
        (folder / "ball").mkdir()
        (folder / "ball/record.yaml").write_text(record(), encoding="utf-8")
        command = folder / "bare/bin/sonicvacuum"
        print(run(command, "discover", "ball", "--out", "found", "--no-figures", folder=folder).strip())
        if not (folder / "found/verdict.json").is_file():
            raise SystemExit("no verdict.json was written")
        print("the bare wheel works")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.parse_args()
    main()
