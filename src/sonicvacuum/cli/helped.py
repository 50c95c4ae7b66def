"""What help pages share: examples as they are typed, exit codes, completion; and which lock is in use."""

import hashlib
from pathlib import Path

EXIT_CODES = """\b
Exit codes:
  0    done, whatever a verdict says
  1    the machine's fault: a full disk, too little memory
  2    input refused; one line says file, key, value and cure
  130  interrupted"""
COMPLETION = """\b
Completion of verbs and options:
  eval "$(_SONICVACUUM_COMPLETE=bash_source sonicvacuum)"      # or zsh_source, fish_source"""
# Digits of a SHA-256 that tell locks apart.
DIGITS = 12


def examples(*lines: str) -> str:
    """Epilog of a verb: commands as they are typed, one a line, never wrapped."""
    return "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)


def locked() -> str:
    """Which lock of requirements this program stands beside, by the beginning of its SHA-256."""
    lock = Path(__file__).resolve().parents[3] / "requirements.lock"
    if not lock.is_file():
        return "installed as a package, no requirements.lock beside it"
    return f"requirements.lock sha256 {hashlib.sha256(lock.read_bytes()).hexdigest()[:DIGITS]}"
