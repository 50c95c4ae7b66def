"""Where each product comes from, in a file beside it: `provenance.json` in every folder of products.

For each file its SHA-256, the rule and the command that made it, the digest of the sources that this command
runs, and the SHA-256 of each input; inputs that were made themselves are listed with theirs, back to what a
user wrote. No times: the same run gives the same bytes. Read off what Snakemake keeps of its jobs.
"""

import argparse
import base64
import hashlib
import json
import re
import subprocess
from functools import cache
from importlib.metadata import version
from pathlib import Path

NAME = "provenance.json"
METADATA = Path(".snakemake/metadata")
# A parameter of each rule, see `sources` in workflow/rules/library.smk.
SOURCES = re.compile(r"'([0-9a-f]{64})'")


def kept() -> dict[str, dict]:
    """Product, relative to the working folder → what Snakemake keeps of the job that made it."""
    found = {}
    for path in METADATA.rglob("*"):
        if path.is_file():
            # Long names are cut into folders whose names begin with @.
            name = "".join(part.removeprefix("@") for part in path.relative_to(METADATA).parts)
            found[base64.b64decode(name).decode()] = json.loads(path.read_bytes())
    return found


@cache
def digest(path: str) -> str:
    """SHA-256 of a file; of a folder that of the names and digests of all files in it."""
    place, whole = Path(path), hashlib.sha256()
    if not place.is_dir():
        whole.update(place.read_bytes())
    else:
        for inner in sorted(p for p in place.rglob("*") if p.is_file()):
            whole.update(f"{inner.relative_to(place).as_posix()}\0{digest(str(inner))}\n".encode())
    return whole.hexdigest()


def chain(products: list[str], jobs: dict[str, dict]) -> dict[str, dict]:
    """Products, and of their inputs those that were made, in order: path → how it was made."""
    found, waiting = {}, list(products)
    while waiting:
        path = waiting.pop()
        if path in found or (path not in jobs and path not in products):
            continue
        job = jobs.get(path, {})
        inputs = sorted(p for p in job.get("input") or [] if Path(p).exists())
        code = [match[1] for text in job.get("params") or [] if (match := SOURCES.fullmatch(text))]
        found[path] = {
            "sha256": digest(path),
            "rule": job.get("rule"),
            "command": job.get("shellcmd"),
            "sources": code[0] if code else None,
            "inputs": {p: digest(p) for p in inputs},
        }
        waiting += inputs
    return dict(sorted(found.items()))


def commit(home: Path) -> str | None:
    """The commit of the workflow, with `-dirty` where files in git differ from it; None outside of git."""
    words = ["git", "-C", str(home), "describe", "--always", "--abbrev=40", "--dirty", "--exclude=*"]
    try:
        return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None


def main() -> None:
    """Write the file of each folder; a file of the chain stands in that of the nearest folder above it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("products", nargs="+")
    parser.add_argument("--out", nargs="+", required=True, help=f"FOLDER/{NAME}, one for each folder.")
    parser.add_argument("--given", nargs="+", default=[], help="Configuration and lock files.")
    asked = parser.parse_args()
    head = {
        "format": 1,
        "version": version("sonicvacuum"),
        "commit": commit(Path(__file__).parent),
        "given": {path: digest(path) for path in asked.given},
    }
    files: dict[str, dict] = {str(Path(path).parent): {} for path in asked.out}
    for path, made in chain(asked.products, kept()).items():
        above = next((str(p) for p in Path(path).parents if str(p) in files), None)
        if above is not None:
            files[above][path] = made
    for path in asked.out:
        text = json.dumps(head | {"files": files[str(Path(path).parent)]}, indent=1, ensure_ascii=False)
        Path(path).write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
