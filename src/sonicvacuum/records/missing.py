"""Required keys that a record.yaml lacks, all of them at once: what is still to be filled in."""

from typing import Any, get_args

import msgspec
from msgspec import NODEFAULT, Struct


def missing(content: Any, kind: Any, place: str = "") -> list[str]:
    """Places of required keys of the block type `kind` that a YAML mapping lacks, in the order of the format.

    A block that is absent as a whole counts once; what is there with a wrong type is left to the conversion.
    """
    if isinstance(content, list):
        entry = _inner(kind, list)
        return [p for k, e in enumerate(content) for p in missing(e, entry, f"{place}[{k}]")]
    block = _block(kind, content)
    if block is None or not isinstance(content, dict):
        return []
    found = []
    for field in msgspec.structs.fields(block):
        at = f"{place}.{field.encode_name}" if place else field.encode_name
        if field.encode_name in content:
            found += missing(content[field.encode_name], field.type, at)
        elif field.default is NODEFAULT and field.default_factory is NODEFAULT:
            found.append(at)
    return found


def _inner(kind, outer):
    """Type of the entries of a list, looked for through annotations and unions."""
    if getattr(kind, "__origin__", None) is outer:
        return get_args(kind)[0]
    return next((e for a in get_args(kind) if (e := _inner(a, outer)) is not None), None)


def _block(kind, content):
    """The block type of a mapping; of a union the one that its tag names."""
    if isinstance(kind, type) and issubclass(kind, Struct):
        config = kind.__struct_config__
        tagged = config.tag_field is None or (
            isinstance(content, dict) and content.get(config.tag_field) == config.tag
        )
        return kind if tagged else None
    if getattr(kind, "__origin__", None) in (list, dict):
        return None
    return next((b for a in get_args(kind) if (b := _block(a, content)) is not None), None)
