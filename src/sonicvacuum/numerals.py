"""Numbers as people write them: what to write where something else stands in a number's place."""

import re
from typing import Any


def number_cure(value: Any) -> str:
    """What to write instead of text or a truth value where a number is wanted; nothing for other values."""
    if isinstance(value, str) and re.fullmatch(r"[-+]?\d+(\.\d*)?[eE][-+]?\d+", value):
        mantissa, exponent = re.split("[eE]", value)
        mantissa = mantissa if "." in mantissa else mantissa + ".0"
        sign = exponent if exponent[0] in "+-" else "+" + exponent
        return f"; YAML reads this as text: write {mantissa}e{sign}"
    if isinstance(value, str) and re.fullmatch(r"[-+]?\d*,\d+", value):
        example = "" if re.search(r",\d{3}$", value) else f": write {value.replace(',', '.')}"
        return f"; decimals take a point, and thousands no mark{example}"
    if isinstance(value, bool):
        return "; YAML reads bare yes, no, on, off as true and false: write a number, or quote the word"
    if isinstance(value, str):
        return "; write a number without quotes or unit" if re.match(r"^[\d.+-]", value) else ""
    return ""
