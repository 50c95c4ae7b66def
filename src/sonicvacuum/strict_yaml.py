"""YAML as people write it by hand: what means something else than it seems to is refused."""

import re
from itertools import pairwise

import yaml

from sonicvacuum.files import InputError

# YAML 1.1 reads 010 as eight, 1:30 as ninety and 1_5 as fifteen; who writes a record does not.
_DECIMAL = re.compile(
    r"[-+]?(0|[1-9][0-9]*|[0-9]*\.[0-9]*([eE][-+]?[0-9]+)?|\.(inf|Inf|INF))|\.(nan|NaN|NAN)"
)

# The two parts of a number with a comma.
_WHOLE, _REST = re.compile(r"[-+]?\d+"), re.compile(r"\d+([eE][-+]?\d+)?")


def loader_of(path) -> type[yaml.SafeLoader]:
    """Class of a safe loader for one file; InputError names the line of a key that stands twice, of a
    number that is not decimal, or has a decimal comma."""

    class Loader(yaml.SafeLoader):
        pass

    def mapping(loader, node):
        _refuse_comma(path, node)
        seen = {}
        for key_node, _ in node.value:
            key = key_node.value
            if key in seen and key != "<<":
                line = key_node.start_mark.line + 1
                raise InputError(f"{path}, line {line}: key {key!r} stands here twice; remove one")
            seen[key] = True
        loader.flatten_mapping(node)
        return yaml.SafeLoader.construct_mapping(loader, node, deep=True)

    def number(loader, node):
        kind = node.tag.rpartition(":")[2]
        value = getattr(yaml.SafeLoader, f"construct_yaml_{kind}")(loader, node)
        if _DECIMAL.fullmatch(node.value):
            return value
        line = node.start_mark.line + 1
        raise InputError(f"{path}, line {line}: {node.value} is {value} in YAML; write that, or quote a text")

    Loader.add_constructor(yaml.resolver.BaseResolver.DEFAULT_MAPPING_TAG, mapping)
    for kind in ("int", "float"):
        Loader.add_constructor(f"tag:yaml.org,2002:{kind}", number)
    return Loader


def _refuse_comma(path, node):
    """InputError for a decimal comma within braces, which YAML takes for the end of a number and a key."""
    for (key, value), (rest, nothing) in pairwise(node.value):
        cut = isinstance(nothing, yaml.ScalarNode) and nothing.value == "" and nothing.style is None
        if cut and _WHOLE.fullmatch(str(value.value)) and _REST.fullmatch(str(rest.value)):
            line, told = rest.start_mark.line + 1, f"is {value.value},{rest.value}"
            raise InputError(
                f"{path}, line {line}: {key.value}: {told}, which YAML reads as {value.value} and a key "
                f"{rest.value}; decimals take a point, and thousands no mark"
            )
