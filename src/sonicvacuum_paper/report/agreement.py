"""Whether two versions of a table agree: each column within its own tolerance, text to the letter.

A tolerance is absolute or relative, whichever is larger; words must agree, numbers inside a sentence
to the sentence's own relative tolerance.
"""

import math
import re

import pandas as pd

from sonicvacuum.files import InputError, reading

TOLERANCES = ["table", "column", "absolute", "relative", "reason"]
DIFFERENCES = ["table", "row", "column", "reference", "fresh", "allowed"]
_NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


def read_tolerances(path) -> pd.DataFrame:
    """The tolerances of all columns; every row must give its reason.

    Raises:
        InputError: for other columns or a row without a reason.
    """
    with reading(path, f"write {','.join(TOLERANCES)}"):
        table = pd.read_csv(path, keep_default_na=False)
    if list(table.columns) != TOLERANCES:
        raise InputError(f"{path}: columns are {','.join(table.columns)}; expected {','.join(TOLERANCES)}")
    bare = table[table["reason"].str.strip() == ""]
    if len(bare):
        raise InputError(
            f"{path}, line {bare.index[0] + 2}: no reason given; say why this tolerance is right"
        )
    return table


def differences(
    name: str, reference: pd.DataFrame, fresh: pd.DataFrame, tolerances: pd.DataFrame
) -> list[dict]:
    """What differs between two versions of table `name`, one entry for each cell (keys `DIFFERENCES`).

    Both tables hold text. A column without tolerance of its own uses the one of column `*`; without that,
    its cells must be equal.
    """
    if list(reference.columns) != list(fresh.columns):
        return [_entry(name, "", "(columns)", ",".join(reference.columns), ",".join(fresh.columns), "equal")]
    if len(reference) != len(fresh):
        return [_entry(name, "", "(rows)", len(reference), len(fresh), "equal")]
    own = tolerances[tolerances["table"] == name].set_index("column")
    found = []
    for column in reference.columns:
        rule = next((own.loc[key] for key in (column, "*") if key in own.index), None)
        absolute, relative = (
            (0.0, 0.0) if rule is None else (float(rule["absolute"]), float(rule["relative"]))
        )
        for row, (old, new) in enumerate(zip(reference[column], fresh[column], strict=True)):
            if old != new and not _agree(old, new, absolute, relative):
                allowed = f"{absolute:g} or {relative:g} of the value"
                found.append(_entry(name, row + 2, column, old, new, allowed))
    return found


def _entry(*values):
    return dict(zip(DIFFERENCES, map(str, values), strict=True))


def _agree(old, new, absolute, relative):
    """Equal words, and every number within the tolerance."""
    old_numbers, new_numbers = _NUMBER.findall(old), _NUMBER.findall(new)
    if _NUMBER.sub("#", old) != _NUMBER.sub("#", new) or len(old_numbers) != len(new_numbers):
        return False
    pairs = [(_value(a), _value(b)) for a, b in zip(old_numbers, new_numbers, strict=True)]
    return all(math.isclose(a, b, rel_tol=relative, abs_tol=absolute) for a, b in pairs)


def _value(text):
    return float(text.replace("−", "-"))


def readable(found: list[dict], most: int = 40) -> str:
    """The differences as a table for a terminal, the first `most` of them."""
    if not found:
        return "no differences"
    shown = pd.DataFrame(found[:most], columns=DIFFERENCES).to_string(index=False, max_colwidth=48)
    rest = f"\n… and {len(found) - most} more" if len(found) > most else ""
    return shown + rest
