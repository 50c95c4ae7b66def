"""Bytes of a text file to characters: encoding, byte order mark and line ends, whatever wrote them."""

import codecs
import re
from pathlib import Path

from sonicvacuum.files import InputError

_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_LOOKED_AT = 4096
# Beginning and end of a file of datasets, of which 58 holds functions of time.
_UNIVERSAL = re.compile(r"    -1[ ]*\n {2,4}\d{2,4}[bB]?\b.*\n    -1\s*", re.DOTALL)
# Typographic signs before digits (minus, figure and en dash and their like), which stand for a minus.
_DASH = re.compile("[\u2212\u2012\u2013\ufe63\uff0d](?=[\\d.,∞])")
# Share of zero bytes at every other place from which text is UTF-16 without a mark.
_WIDE = 0.7


def read(path: Path) -> tuple[str, str]:
    """Text of a file with lines ended by a line feed alone, and the name of its encoding.

    Raises:
        InputError: for a file that cannot be opened, is empty or holds no text.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}; give the path of a readable file") from None
    if not data.strip(b"\0 \t\r\n\x1a"):
        raise InputError(f"{path}: the file is empty; export the traces again")
    encoding = encoding_of(data)
    if encoding is None:
        raise InputError(
            f"{path}: is a binary file of no kind that is read here; export the traces as text (CSV)"
        )
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path}: not valid {encoding} at byte {error.start}; export the file again"
        ) from None
    text = text.rstrip("\0\x1a").replace("\r\r\n", "\n").replace("\r\n", "\n").replace("\r", "\n")
    if _UNIVERSAL.fullmatch(text):
        raise InputError(
            f"{path}: is a universal file (UFF), whose samples stand several to a line; export the traces as "
            "a table, with a column for each channel"
        )
    return text if text.isascii() else _DASH.sub("-", text), encoding


def encoding_of(data: bytes) -> str | None:
    """Encoding of bytes that hold text, None for binary ones."""
    for mark, name in _MARKS:
        if data.startswith(mark):
            return name
    head = data[:_LOOKED_AT]
    for name, high in (("utf-16-le", head[1::2]), ("utf-16-be", head[::2])):
        if high.count(0) > _WIDE * len(head) / 2:
            # Numbers, pictures and sounds in bytes are often zero there as well.
            return None if _is_binary(head.decode(name, "replace")) else name
    if _is_binary(head.decode("latin-1")):
        return None
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8"


def _is_binary(text):
    """Whether more than one character in a hundred is a control one, other than those of white space."""
    return sum(ord(c) < 9 or 13 < ord(c) < 32 for c in text) > 0.01 * len(text)
