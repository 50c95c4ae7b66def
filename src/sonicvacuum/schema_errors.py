"""What msgspec finds wrong with content, in one sentence: file, key, value, what was expected, the cure."""

import datetime
import os
import re
import textwrap
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import Any, Literal, get_args, get_origin

import msgspec

from sonicvacuum.numerals import number_cure

_BOUND = re.compile(r"`(?:int|float)` (>=|>|<=|<) (\S+)$")
_BOUNDS = {">": "above {}", ">=": "of {} or more", "<": "below {}", "<=": "of {} or less"}
_BOOL = "YAML reads bare yes, no, on, off as true and false: "
# What stands among the words that a key may hold where it may hold numbers too.
NUMBER = "a number"
_LENGTH = re.compile(r"of length (>= )?(\d+)")


def explain(
    error: msgspec.ValidationError,
    content: Any,
    path: str | os.PathLike,
    prefix: str = "",
    kind: type | None = None,
    cures: Mapping[str, str] | None = None,
) -> str:
    """One sentence for a validation error.

    Args:
        error, content, path: of msgspec, what it looked at, and the file that this stands in.
        prefix: place of the content in the file.
        kind: type that was asked for; with it, keys that users choose (names of materials, say) and the words
            that a key may hold are named too.
        cures: what to write at keys, where the types cannot say it in plain words; `key[]` is for what stands
            as a key in the mapping there.
    """
    text = str(error)
    found = re.search(r" - at (`key` in )?`\$([^`]*)`$", text)
    problem = text[: found.start()] if found else text
    inner = found.group(2).lstrip(".") if found else ""
    if kind and "[...]" in inner:
        inner = _named(inner, content, kind, text)
    unknown = re.search(r"unknown field `([^`]*)`", problem)
    missing = re.search(r"missing required field `([^`]*)`", problem)
    place = ".".join(p for p in (prefix, inner, *(m.group(1) for m in (unknown, missing) if m)) if p)
    where = ": ".join(p for p in (str(path), place) if p)
    if unknown:
        near = likely(unknown.group(1), keys_of(kind, content, inner) if kind else [])
        meant = f"{near} Otherwise " if near else ""
        return f"{where}: unknown key; {meant}check its spelling and its place, or remove it"
    if missing:
        return f"{where}: missing; this key is required"
    value = _value_at(content, inner)
    own = cures or {}
    name = re.sub(r"\[\d+\]$", "", inner).rpartition(".")[2]
    if found and found.group(1):
        odd, cure = _odd_key(problem, value)
        told = "" if "regex" in problem else f": {_plain(problem)}"
        return f"{where}: a key here is not allowed{odd}{told}; {own.get(name + '[]', cure)}"
    shown = f"is {_shown(value)}: " if place and value is not _ABSENT else ""
    cure = _cure(problem, value, _words(kind, content, inner) if kind else [], own.get(name, ""))
    return f"{where}: {shown}{_plain(problem)}; {cure}"


def likely(name: str, known: Sequence[str]) -> str:
    """`did you mean X?` with the known name that is nearest to a mistyped one, "" where none is near."""
    near = get_close_matches(name, known, n=1)
    return f"did you mean {near[0]}?" if near else ""


def _plain(problem):
    """The problem without capital letter and without patterns, which nobody reads."""
    problem = re.sub(r"Expected `str` matching regex .*", "not allowed here", problem, flags=re.DOTALL)
    return problem[0].lower() + problem[1:]


def _shown(value):
    if isinstance(value, datetime.date):
        return value.isoformat()
    return "empty" if value is None else textwrap.shorten(repr(value), 200)


def _cure(problem, value, words, own):
    """What to write instead of a value, `own` where the caller knows better than the types do."""
    wanted = re.match(r"Expected `([^`]*)`", problem)
    kinds = set(wanted.group(1).split(" | ")) - {"null"} if wanted else set()
    if kinds == {"str"} and not words and isinstance(value, int | float | datetime.date):
        return _BOOL + "quote the word" if isinstance(value, bool) else f"quote it: '{value}'"
    if own:
        return own
    if kinds == {"array"}:
        return _list_cure(problem, words)
    if kinds == {"object"}:
        return "write keys with their values, as in {key: value}, or one on each line, indented"
    if kinds & {"int", "float"} or NUMBER in words:
        return _number_cure(problem, value, kinds, words)
    if words:
        return _BOOL * isinstance(value, bool) + f"write {' or '.join(words)}"
    if "date" in problem:
        return "write the day as in 2026-05-01"
    if value is None:
        return "write a text, or leave the key out where it is optional"
    return "write one text, in quotes" if kinds == {"str"} else "correct it"


def _number_cure(problem, value, kinds, words):
    others = "".join(f", or {w}" for w in words if w != NUMBER)
    whole = "float" not in kinds and NUMBER not in words
    cure = number_cure(value).removeprefix("; ")
    if cure and not (whole and isinstance(value, str)):
        return cure + (others if isinstance(value, str) else "")
    bound = _BOUND.search(problem)
    limit = f" {_BOUNDS[bound.group(1)].format(bound.group(2).removesuffix('.0'))}" if bound else ""
    return f"write {'a whole number' if whole else NUMBER}{limit}{others}"


def _list_cure(problem, words):
    length = _LENGTH.search(problem)
    if length and length.group(1):
        return f"give at least {length.group(2)}"
    if length:
        return f"give {length.group(2)}, with decimal points where they are numbers"
    example = ", ".join(words) or "a, b"
    return f"write a list, as in [{example}], or with a dash before each entry"


def _odd_key(problem, mapping):
    """The key at fault, to be put into the message ("" where it is not to be seen), and its cure."""
    keys = list(mapping) if isinstance(mapping, dict) else []
    pattern = re.search(r"matching regex '(.*)'$", problem, re.DOTALL)
    if "`int`" in problem.partition(",")[0]:
        odd = [k for k in keys if not isinstance(k, int) or k < 1]
        cure = "write a whole number of 1 or more"
    elif pattern:
        allowed = re.compile(pattern.group(1).replace(r"\\", "\\"))
        odd = [k for k in keys if not allowed.search(k)]
        cure = "use other characters"
    else:
        odd = [k for k in keys if not isinstance(k, str)]
        # A block has words as keys, so that a number among them is the rest of something else.
        of_block = ", got" not in problem
        cure = "write decimals with a point, as in 1.6, or remove it" if of_block else "quote it"
    return f", {textwrap.shorten(repr(odd[0]), 80)}" if odd else "", cure


def keys_of(kind: Any, content: Any, inner: str) -> list[str]:
    """Keys that a block may have at a place such as `chain.bead` or `runs[0].striker` of a msgspec type."""
    return [f.encode_name for block in _way(kind, content, inner)[0] for f in msgspec.structs.fields(block)]


def _words(kind, content, inner):
    """Words that a key at a place may hold, NUMBER before them where it may hold such; [] for other keys."""
    _, fields = _way(kind, content, inner)
    words = [str(w) for f in fields for w in _parts(f.type, Literal)]
    numbers = any(_parts(f.type, float) or _parts(f.type, int) for f in fields)
    return list(dict.fromkeys([NUMBER] * numbers + words)) if words else []


def _way(kind, content, inner):
    """Blocks that may stand at a place of a msgspec type, and the fields of the last key on the way there."""
    blocks, fields = _blocks(kind), []
    for step in re.findall(r"\[[^\]]*\]|[^.\[\]]+", inner):
        blocks = [b for b in blocks if _may_be(b, content)]
        fields = [f for b in blocks for f in msgspec.structs.fields(b) if f.encode_name == step] or fields
        content = _value_at(content, step)
        # A step into a list or a mapping stays with the blocks that it holds.
        blocks = [b for f in fields for b in _blocks(f.type)] or blocks
    return [b for b in blocks if _may_be(b, content)], fields


def _may_be(block, content):
    """Whether content may be a block, as the tag says that tells it from others."""
    config = block.__struct_config__
    told = content.get(config.tag_field) if config.tag_field and isinstance(content, dict) else None
    return told is None or told == config.tag


def _parts(kind, wanted):
    """The words of a type (of `Literal`), or a type of numbers if it holds that, through unions and lists."""
    if kind is wanted:
        return [kind]
    if isinstance(kind, msgspec.Meta):  # words that only a schema for editors names
        return (kind.extra_json_schema or {}).get("enum", []) if wanted is Literal else []
    if get_origin(kind) is Literal:
        return list(get_args(kind)) if wanted is Literal else []
    return [found for part in get_args(kind) for found in _parts(part, wanted)]


def _blocks(kind) -> list[type]:
    """The msgspec structures that a type is made of, looked for through unions, lists and annotations."""
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        return [kind]
    return [block for part in get_args(kind) for block in _blocks(part)]


def _named(inner, content, kind, text):
    """The place of an error with each `[...]`, which stands for any key, replaced by the key at fault.

    It is the one without the others beside it that gives the same error.
    """
    while "[...]" in inner:
        before = inner[: inner.index("[...]")]
        for key in mapping if isinstance(mapping := _value_at(content, before), dict) else ():
            alone = _with_value(content, before, {key: mapping[key]})
            try:
                msgspec.convert(alone, kind)
            except msgspec.ValidationError as error:
                if str(error) == text:
                    content, inner = alone, inner.replace("[...]", f".{key}", 1).lstrip(".")
                    break
        else:
            return inner
    return inner


def _with_value(content, inner, value):
    """A copy of nested mappings and lists with another value at a place."""
    if not inner:
        return value
    first, rest = re.fullmatch(r"[.\[]*([^.\[\]]+)\]?(.*)", inner).groups()
    if isinstance(content, list):
        return [_with_value(c, rest, value) if str(k) == first else c for k, c in enumerate(content)]
    return content | {first: _with_value(content[first], rest, value)}


_ABSENT = object()


def _value_at(content, inner):
    for part in re.findall(r"[^.\[\]]+|\[\.\.\.\]", inner):
        number = part.isdigit() and (
            isinstance(content, list) or (isinstance(content, dict) and part not in content)
        )
        try:
            content = content[int(part) if number else part]
        except (KeyError, IndexError, ValueError, TypeError):
            return _ABSENT
    return content
