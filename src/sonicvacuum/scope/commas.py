"""Whether commas are decimal marks or stand between columns, where the last lines alone read either way.

Whole numbers with commas between them, as `1000,998`, look like one column of numbers with decimal commas.
The digits behind the commas of all lines tell, else the words above them; where these do not, the text is
refused.
"""

import re
from itertools import pairwise

from sonicvacuum.files import InputError
from sonicvacuum.scope.dialect import Dialect
from sonicvacuum.scope.keys import MARKER, is_key, meaning
from sonicvacuum.scope.units import unit_of

_INTEGER = re.compile(r"[-+]?\d+")
_TAIL = re.compile(r"\d+([eE][-+]?\d+)?")
_PAIR = re.compile(r"^[^\S\n]*([-+]?\d*),([-+]?\d+(?:[eE][-+]?\d+)?)[^\S\n]*$", re.MULTILINE)
_BARE = re.compile(r"^[^\S\n]*[-+]?\d+[^\S\n]*$", re.MULTILINE)
# Lines of three and more whole numbers that each have at most three digits, as 100,998,997.
_GROUPS = re.compile(r"[-+]?\d{1,3}(,\d{3}){2,}")
# Other numbers behind the comma from which on none of them ends in 0 by chance, if they are whole.
_MANY = 60
_CURE = "export with semicolons or tabs between the columns, or with a line that names each column"


def settled(dialect: Dialect, text: str, lines: list[str], path) -> Dialect:
    """The dialect of a text whose last lines read in the one given; InputError where nothing tells it."""
    if dialect == Dialect(",", "."):
        return _with_decimals(lines, path)
    bare = [line.strip() for line in lines]
    if any(mark in line for line in bare for mark in (dialect.delimiter or " ", ";", '"', "|", "\t")):
        return dialect
    if dialect.decimal == "," and sum(map(bool, map(_PAIR.match, bare))) >= 0.6 * len(bare):
        return _of_pairs(dialect, text, path)
    if dialect.decimal == "." and sum(map(bool, map(_GROUPS.fullmatch, bare))) >= 0.6 * len(bare):
        return _of_groups(text, bare, path)
    return dialect


def _with_decimals(lines, path):
    """Commas alone may be decimal marks: digits with leading zeros behind them give that away."""
    dialect = Dialect(",", ".")
    rows = [[c for c in dialect.cells(line) if c] for line in lines]
    rows = [
        r for r in rows if r and all(map(_INTEGER.fullmatch, r[::2])) and all(map(_TAIL.fullmatch, r[1::2]))
    ]
    if len(rows) < 0.6 * len(lines):
        return dialect
    tails = [c for r in rows for c in r[1::2]]
    if not any(re.match(r"0\d|\d+[eE]", c) for c in tails):
        return dialect
    if max(map(len, rows)) <= 2:
        return Dialect(";", ",")
    raise both(path)


def _of_pairs(dialect, text, path):
    """One column with decimal commas, or two of whole numbers."""
    pairs, first = _PAIR.findall(text), _PAIR.search(text).start()
    two = _surely_two(pairs, len(_BARE.findall(text, first)))
    if two is None:
        likely, named = _likely_two(pairs), _two_named(text[:first])
        two = likely if named is None else None if likely and not named else named
    if two is None:
        raise InputError(
            f"{path}: {','.join(pairs[-1])!r} and the other lines may each be one number with a decimal "
            f"comma or two whole numbers; {_CURE}"
        )
    return Dialect(",", ".") if two else dialect


def _surely_two(pairs, bare):
    """Whether pairs of digits are two whole numbers, with so many lines of one beside; None: may be both."""
    if any(b[0] in "+-" for _, b in pairs):
        return True
    padded = any(re.match(r"[-+]?0\d", a) for a, _ in pairs)
    zeros = any(re.match(r"0\d", b) for _, b in pairs)
    if (zeros and not padded) or any("e" in b.lower() for _, b in pairs):
        return False
    # Whole columns have no cell without digits, no -0, and no row of one cell.
    if bare > 1 or any(a in ("", "-", "+", "-0") for a, _ in pairs):
        return False
    # Times or counts in front rise by as much each.
    steps = {int(b) - int(a) for (a, _), (b, _) in pairwise(pairs)}
    return True if len(pairs) > 4 and len(steps) == 1 and steps.pop() > 0 else None


def _likely_two(pairs):
    """Decimals have as many digits behind the comma, or in all, in each line, or no last zeros."""
    behind, digits = {len(b) for _, b in pairs}, {len(a.strip("+-")) + len(b) for a, b in pairs}
    if len(behind) == 1 or len(digits) == 1:
        return None
    different = {b for _, b in pairs}
    if any(len(b) > 1 and b[-1] == "0" for b in different):
        return True
    return False if len(different) >= _MANY else None


def _two_named(above):
    """Whether the line above the numbers names two columns; None where there is none, or it is no such."""
    lines = [line.strip().lstrip("#% ") for line in above.split("\n")[-100:]]
    for line in reversed([x for x in lines if re.search(r"[^\W\d_]", x)]):
        if MARKER.fullmatch(line):
            continue
        line = line.rstrip(",; \t")
        cells = [c.strip() for c in line.split(",")]
        words = [c for c in cells if re.search(r"[^\W\d_]", c)]
        if is_key(cells[0]) and len(cells) > 1:
            # Of a key's values, as of the names in one line with `Source`, there is one for each column.
            if meaning(cells[0]) in ("name", "unit") and len(words) == len(cells) == 3:
                return True
            continue
        if len(cells) == 1:
            return None if re.search("[:=;\t]", line) or is_key(line) else False
        # `Force, N` and `F, N` are one name with its unit, `mV,V` are two units.
        named = not unit_of(cells[0]) or cells[0] in "ACFHJKTWgm"
        single = len(cells) == 2 and unit_of(cells[1]) and named
        return len(words) == len(cells) == 2 if not single else None
    return None


def _of_groups(text, bare, path):
    """One column with thousands apart, or several of whole numbers."""
    count = bare[-1].count(",")
    rows = re.findall(rf"^[^\S\n]*[-+]?\d+(?:,[-+]?\d+){{{count}}}[^\S\n]*$", text, re.MULTILINE)
    above = next((x for x in reversed(text.split("\n")) if re.search(r"[^\W\d_]", x)), "")
    named = len([c for c in above.split(",") if re.search(r"\w", c)]) in (count + 1, count + 2)
    if named or not all(_GROUPS.fullmatch(r.strip()) for r in rows):
        return Dialect(",", ".")
    raise InputError(
        f"{path}: {bare[-1]!r} and the other lines may each be one number with thousands apart or several "
        f"whole numbers; {_CURE}"
    )


def both(path) -> InputError:
    """The refusal of a file in which commas are decimal marks and stand between columns as well."""
    return InputError(
        f"{path}: commas serve both as decimal marks and between columns, which cannot be told apart; export "
        "with semicolons or tabs between the columns"
    )
