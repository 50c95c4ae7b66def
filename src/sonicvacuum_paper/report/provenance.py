"""How the numbers were made: version of the code, hashes of its source and of the lock, the cards."""

import hashlib
from importlib.metadata import version
from pathlib import Path

import sonicvacuum


def digest(paths) -> str:
    """First 12 hexadecimal digits of the SHA-256 over names and contents of some files, sorted by name."""
    total = hashlib.sha256()
    for path in sorted(map(Path, paths)):
        total.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return total.hexdigest()[:12]


def source_digest() -> str:
    """Digest of the source of the three packages."""
    root = Path(sonicvacuum.__file__).parents[1]
    packages = ("sonicvacuum", "sonicvacuum_blind", "sonicvacuum_paper")
    total = hashlib.sha256()
    for path in sorted(path for package in packages for path in (root / package).rglob("*.py")):
        total.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return total.hexdigest()[:12]


def versions() -> dict[str, str]:
    """Version of the package and of those that make its numbers."""
    names = ("sonicvacuum", "numpy", "scipy", "numba", "pandas", "matplotlib", "snakemake")
    return {name: version(name) for name in names}
