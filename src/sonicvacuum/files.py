"""Reading and writing files: whole or not at all, and one clear message for what is wrong with a file."""

import csv
import errno
import math
import os
import re
import stat
import zipfile
import zlib
from collections.abc import Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import msgspec

from sonicvacuum.schema_errors import explain

# No file written by hand comes near: config.yaml expands to 860 values on 9 levels.
LARGEST_YAML = 4 << 20
MOST_VALUES = 200_000
DEEPEST = 50
# What the YAML library says → what to do about it.
_YAML_CURES = {
    r"'\t'": "YAML indents with spaces only: replace the tab by spaces",
    "<block end>": "begin all keys of one block, and the dashes of one list, in the same column",
    "but got": "close the bracket, and part entries by commas",
}


# What moves a terminal's cursor or turns its writing round, tabs and new lines aside; halves of characters
# (surrogates: escapes in YAML, bytes of a file's name), which nothing can write.
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")

# What parsers raise at content that is not theirs; programming errors elsewhere stay visible.
_DAMAGED = (
    ArithmeticError,
    AttributeError,
    EOFError,
    LookupError,
    RuntimeError,  # of zipfile at an encrypted member or an unknown compression; of deep nesting
    TypeError,
    ValueError,
    csv.Error,
    zipfile.BadZipFile,
    zlib.error,
)


# What no other input would change: a disk that is full, beyond a quota, or fails; a reader that has gone.
MACHINE = {errno.ENOSPC, errno.EFBIG, errno.EDQUOT, errno.EIO, errno.EPIPE}


class InputError(Exception):
    """Bad input; the message names file, place, value and cure.

    The command line prints it and exits with 2.
    """


@contextmanager
def replacing(path: str | os.PathLike, mode: str = "w"):
    """Open a file for writing that takes its name only once it is complete.

    An exception inside leaves whatever stood there before. A link stays, and what it points to is replaced.
    """
    check_written(path)
    path = Path(os.path.realpath(path)) if os.path.islink(path) else Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    # Drawn: threads share a process, and computers a file system with numbers of processes of their own.
    partial = path.with_name(f".{path.name}.{os.urandom(4).hex()}.partial")
    text = {} if "b" in mode else {"encoding": "utf-8", "newline": "\n"}
    try:
        with open(partial, mode, **text) as stream:
            yield stream
        partial.replace(path)
    except OSError as error:
        if error.filename is None or Path(error.filename) == partial:  # a full disk names no file
            error.filename = str(path)
        raise
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)


@contextmanager
def writing(folder: str | os.PathLike):
    """Turn a refusal to write into a folder into one InputError; a full disk stays an OSError."""
    try:
        yield
    except OSError as error:
        if error.errno in MACHINE:
            raise
        raise InputError(
            f"{folder}: {error.strerror or error}; choose a folder that can be written"
        ) from None


@contextmanager
def reading(path: str | os.PathLike, cure: str):
    """Turn what a parser stumbles over in a damaged file into one InputError with the file and the cure."""
    try:
        yield
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not a text file (byte {error.start} is not UTF-8); {cure}") from None
    except OSError as error:
        if error.errno in MACHINE:
            raise
        raise InputError(f"{path}: {error.strerror or error}; {cure}") from None
    except _DAMAGED as error:
        told = " ".join(str(error).split()) or type(error).__name__
        told = f"no {told}" if isinstance(error, KeyError) else told
        raise InputError(f"{path}: damaged, or not what is read here ({told}); {cure}") from None


def check_file(path: str | os.PathLike) -> None:
    """InputError where a path is no regular file: a pipe, say, for which a reader would wait for ever."""
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError) as error:
        told = getattr(error, "strerror", None) or error
        raise InputError(f"{path}: {told}; give the path of a readable file") from None
    if not stat.S_ISREG(mode):
        raise InputError(f"{path}: is {_kind(mode)}; give the path of a readable file")


def check_written(path: str | os.PathLike) -> None:
    """InputError where something stands that no file may replace: a folder, a pipe, a device."""
    with suppress(OSError, ValueError):
        if not stat.S_ISREG(mode := os.stat(path).st_mode):
            raise InputError(f"{path}: is {_kind(mode)}; give the path of a file to write")


def _kind(mode):
    return "a folder" if stat.S_ISDIR(mode) else "a pipe or a device"


def read_text(path: str | os.PathLike) -> str:
    """Text of a file; InputError where it cannot be read."""
    check_file(path)
    try:
        return Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}; give the path of a readable file") from None
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path}: not a text file (byte {error.start} is not UTF-8); save it as UTF-8"
        ) from None


def read_json(path: str | os.PathLike, kind: type) -> Any:
    """What discover wrote into a file, as an instance of a msgspec type; InputError where it is none."""
    try:
        return msgspec.json.decode(read_text(path), type=kind)
    except (msgspec.DecodeError, msgspec.ValidationError) as error:
        raise InputError(f"{path}: not what sonicvacuum discover writes ({error}); run it again") from None


def read_yaml(path: str | os.PathLike) -> dict[str, Any]:
    """Mapping of a YAML file; InputError names the line at fault.

    Faults are also keys that stand twice, numbers that are not decimal (`strict_yaml`), and more than a
    hand-written file holds (`LARGEST_YAML`, `MOST_VALUES`, `DEEPEST`): aliases let a few lines stand for more
    values than a computer holds.
    """
    import yaml

    from sonicvacuum.strict_yaml import loader_of

    check_file(path)
    if os.path.getsize(path) > LARGEST_YAML:
        raise InputError(f"{path}: larger than {LARGEST_YAML >> 20} MB; leave out what does not belong here")
    try:
        loader = loader_of(path)(read_text(path))
        node = loader.get_single_node()
        _check_extent(node, path)
        content = loader.construct_document(node) if node else None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f", line {mark.line + 1}" if mark else ""
        raise _not_yaml(path, place, getattr(error, "problem", None) or error) from None
    except (ValueError, TypeError, AttributeError, RecursionError) as error:
        # What the YAML library stumbles over without a word of its own: impossible dates, lists as keys.
        raise _not_yaml(path, "", error) from None
    if not isinstance(content, dict):
        found = "nothing" if content is None else f"a {type(content).__name__}"
        raise InputError(f"{path}: expected keys and values (key: value), found {found}")
    return content


def _check_extent(root, path):
    """Count what a YAML tree holds once its aliases are written out; each shared part is visited once."""
    extents = {}

    def extent(node):
        """(values, depth) below a node."""
        if isinstance(node.value, str):
            return 1, 1
        if id(node) not in extents:
            extents[id(node)] = math.inf, math.inf  # what a part holds that holds itself
            parts = [p for pair in node.value for p in (pair if isinstance(pair, tuple) else (pair,))]
            found = [extent(part) for part in parts]
            extents[id(node)] = 1 + sum(f[0] for f in found), 1 + max((f[1] for f in found), default=0)
        return extents[id(node)]

    values, depth = extent(root) if root else (0, 0)
    if values > MOST_VALUES or depth > DEEPEST:
        raise InputError(
            f"{path}: holds more than {MOST_VALUES} values or {DEEPEST} levels once its aliases (*name) are "
            "written out; write fewer"
        )


def _not_yaml(path, place, problem):
    told = " ".join(str(problem).split())
    cure = next((c for mark, c in _YAML_CURES.items() if mark in told), "quote texts with special characters")
    return InputError(f"{path}{place}: not valid YAML: {told}; {cure}")


def convert(
    content: Any,
    kind: type,
    path: str | os.PathLike,
    prefix: str = "",
    cures: Mapping[str, str] | None = None,
) -> Any:
    """`content` as an instance of a msgspec type; InputError names file, key, value and cure.

    `cures` tell what to write at keys, see `schema_errors.explain`.
    """
    try:
        return msgspec.convert(content, kind)
    except msgspec.ValidationError as error:
        raise InputError(explain(error, content, path, prefix, kind, cures)) from None


def in_one_line(text: str) -> str:
    """A text to be printed, whoever wrote it: control characters and new lines as Python writes them."""
    return re.sub(r"[\t\n]|" + _CONTROL.pattern, lambda found: repr(found[0])[1:-1], text)


def check_values(content: Any, path: str | os.PathLike, place: str = "") -> None:
    """InputError for a number that is none (YAML knows .nan and .inf) or a text with control characters."""
    if isinstance(content, dict):
        for key in content:
            if in_one_line(str(key)) != str(key):
                raise InputError(
                    f"{path}: {place or 'top level'}: key {key!r} holds control characters; remove them"
                )
        parts = [(f"{place}.{k}" if place else str(k), v) for k, v in content.items()]
    elif isinstance(content, list):
        parts = [(f"{place}[{k}]", v) for k, v in enumerate(content)]
    else:
        if isinstance(content, float) and not math.isfinite(content):
            raise InputError(f"{path}: {place}: is {content}; write a finite number, or leave the key out")
        if isinstance(content, str) and _CONTROL.search(content):
            raise InputError(f"{path}: {place}: is {content!r}, which holds control characters; remove them")
        return
    for key, value in parts:
        check_values(value, path, key)
