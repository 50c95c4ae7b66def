"""Reading and writing files: whole or not at all, and one clear message for what is wrong with a file."""

import os
import re
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import msgspec


class InputError(Exception):
    """Bad input; the message names file, place, value and cure.

    The command line prints it and exits with 2.
    """


@contextmanager
def replacing(path: str | os.PathLike, mode: str = "w"):
    """Open a file for writing that takes its name only once it is complete.

    An exception inside leaves whatever stood there before.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    text = {} if "b" in mode else {"encoding": "utf-8", "newline": "\n"}
    try:
        with open(partial, mode, **text) as stream:
            yield stream
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def read_text(path: str | os.PathLike) -> str:
    """Text of a file; InputError where it cannot be read."""
    try:
        return Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}; give the path of a readable file") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not a text file (byte {error.start} is not UTF-8)") from None
    except ValueError as error:
        raise InputError(f"{path}: {error}; give the path of a readable file") from None


def read_yaml(path: str | os.PathLike) -> dict[str, Any]:
    """Mapping of a YAML file; InputError names the line at fault, duplicate keys among the faults."""
    import yaml

    class Loader(yaml.SafeLoader):
        pass

    def mapping(loader, node):
        seen = {}
        for key_node, _ in node.value:
            key = key_node.value
            if key in seen and key != "<<":
                line = key_node.start_mark.line + 1
                raise InputError(f"{path}, line {line}: key {key!r} stands here twice; remove one")
            seen[key] = True
        loader.flatten_mapping(node)
        return yaml.SafeLoader.construct_mapping(loader, node, deep=True)

    Loader.add_constructor(yaml.resolver.BaseResolver.DEFAULT_MAPPING_TAG, mapping)
    try:
        content = yaml.load(read_text(path), Loader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f", line {mark.line + 1}" if mark else ""
        raise _not_yaml(path, place, getattr(error, "problem", None) or error) from None
    except (ValueError, TypeError, AttributeError, RecursionError) as error:
        # What the YAML library stumbles over without a word of its own: impossible dates, lists as keys.
        raise _not_yaml(path, "", error) from None
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected keys and values at the top level, found {type(content).__name__}")
    return content


def _not_yaml(path, place, problem):
    told = " ".join(str(problem).split())
    return InputError(f"{path}{place}: not valid YAML: {told}; quote texts with special characters")


def convert(content: Any, kind: type, path: str | os.PathLike, prefix: str = "") -> Any:
    """`content` as an instance of a msgspec type; InputError names file, key, value and cure."""
    try:
        return msgspec.convert(content, kind)
    except msgspec.ValidationError as error:
        raise InputError(explain(error, content, path, prefix)) from None


def explain(error: msgspec.ValidationError, content: Any, path: str | os.PathLike, prefix: str = "") -> str:
    """One sentence for a validation error: file, key, value, what was expected and, where known, the cure."""
    text = str(error)
    found = re.search(r" - at `(key in )?\$([^`]*)`$", text)
    problem = text[: found.start()] if found else text
    inner = found.group(2).lstrip(".") if found else ""
    unknown = re.search(r"unknown field `([^`]*)`", problem)
    missing = re.search(r"missing required field `([^`]*)`", problem)
    place = ".".join(p for p in (prefix, inner, *(m.group(1) for m in (unknown, missing) if m)) if p)
    if unknown:
        return f"{path}: {place}: unknown key; check its spelling and its place, or remove it"
    if missing:
        return f"{path}: {place}: missing; this key is required"
    value = _value_at(content, inner)
    shown = "" if value is _ABSENT else f"is {value!r}: "
    return f"{path}: {place}: {shown}{problem[0].lower()}{problem[1:]}{_cure(value)}"


_ABSENT = object()


def _value_at(content, inner):
    for part in re.findall(r"[^.\[\]]+|\[\.\.\.\]", inner):
        try:
            content = content[int(part)] if isinstance(content, list) else content[part]
        except (KeyError, IndexError, ValueError, TypeError):
            return _ABSENT
    return content


def _cure(value):
    if isinstance(value, str) and re.fullmatch(r"[-+]?\d+(\.\d*)?[eE][-+]?\d+", value):
        mantissa, exponent = re.split("[eE]", value)
        mantissa = mantissa if "." in mantissa else mantissa + ".0"
        sign = exponent if exponent[0] in "+-" else "+" + exponent
        return f"; YAML reads this as text: write {mantissa}e{sign}"
    if isinstance(value, bool):
        return "; YAML reads bare yes, no, on, off as true and false: write a number, or quote the word"
    if isinstance(value, str):
        return "; write a number without quotes or unit" if re.match(r"^[\d.+-]", value) else ""
    return ""
