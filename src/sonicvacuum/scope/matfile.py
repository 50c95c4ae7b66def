"""The bytes of MATLAB's .mat files of versions 4 to 7: names and numbers, structures as dictionaries.

After "MAT-File Format" (MathWorks, R2023a): elements with a tag of type and length, matrices made of such
elements, and in version 7 each of them deflated. Nothing is evaluated, sizes are those of the bytes that are
there, and any byte may be wrong: `scipy.io.loadmat` ends the whole process at some damaged files.
"""

import zlib
from dataclasses import dataclass

import numpy as np

# Types of elements → numbers in them.
_TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_MATRIX, _DEFLATED = 14, 15
_STRUCTURE, _NUMBERS, _OPAQUE = 2, range(6, 16), 17
# Class of an array → what is left out of it.
_OTHER = {1: "cell", 3: "object", 4: "text", 5: "sparse", 16: "function", 17: "object"}
_COMPLEX, _LOGICAL = 0x0800, 0x0200
# Numbers in a matrix of version 4.
_OLD = {0: "f8", 1: "f4", 2: "i4", 3: "i2", 4: "u2", 5: "u1"}
# Structures within structures are followed so far down; bytes that a variable may have once inflated.
DEEPEST = 5
LARGEST = 1 << 31


@dataclass(frozen=True)
class LeftOut:
    """What is no plain numbers, and what it is instead."""

    kind: str


Value = np.ndarray | dict | LeftOut


def read(data: bytes) -> dict[str, Value]:
    """Variables of a file by name: arrays of numbers, dictionaries of single structures, else `LeftOut`.

    Raises:
        ValueError: where the bytes are no such file, or are cut off.
    """
    if data[:6] == b"MATLAB":
        if len(data) < 128 or data[126:128] not in (b"IM", b"MI"):
            raise ValueError("the header is damaged")
        return dict(_variables(memoryview(data)[128:], "<" if data[126:128] == b"IM" else ">"))
    return dict(_old(data))


def _variables(data, order):
    for kind, body in _elements(data, order):
        if kind == _DEFLATED:
            (kind, body), *_ = _elements(memoryview(_inflated(body)), order)
        if kind == _MATRIX:
            name, value = _matrix(body, order)
            if name:
                yield name, value


def _inflated(body):
    try:
        unpack = zlib.decompressobj()
        data = unpack.decompress(body, LARGEST)
    except zlib.error as error:
        raise ValueError(f"a variable is not sound ({error})") from None
    if not unpack.eof:
        raise ValueError("a variable is cut off or too large")
    return data


def _elements(data, order):
    """Type and bytes of each element; of deflated ones as they are."""
    at = 0
    while at + 8 <= len(data):
        kind, size = (int(n) for n in np.frombuffer(data[at : at + 8], order + "u4"))
        begin = at + 8
        if kind >> 16:  # a small one: its length beside its type, its bytes in place of the length
            kind, size, begin = kind & 0xFFFF, kind >> 16, at + 4
            if size > 4:
                raise ValueError("an element is damaged")
        if begin + size > len(data):
            raise ValueError("the file is cut off or damaged")
        yield kind, data[begin : begin + size]
        at = at + 8 if begin == at + 4 else begin + size + (0 if kind == _DEFLATED else -size % 8)


def _numbers(element, order):
    kind, body = element
    if kind not in _TYPES:
        raise ValueError(f"numbers of an unknown kind ({kind})")
    form = np.dtype(order + _TYPES[kind])
    return np.frombuffer(body[: len(body) // form.itemsize * form.itemsize], form)


def _matrix(body, order, depth=0):
    """Name and value of a matrix."""
    parts = list(_elements(body, order))
    if not parts:
        return "", np.zeros((0, 0))
    flags = _numbers(parts[0], order)
    if not len(flags):
        raise ValueError("a variable has no class")
    flag = int(flags[0])
    kind = flag & 0xFF
    if kind == _OPAQUE:  # has no dimensions
        return _text(parts[1]) if len(parts) > 1 else "", LeftOut("object")
    if len(parts) < 3:
        raise ValueError("a variable is cut off")
    shape, name = [int(n) for n in _numbers(parts[1], order)], _text(parts[2])
    return name, _value(kind, flag, shape, parts[3:], order, depth)


def _text(element):
    return bytes(element[1]).split(b"\0")[0].decode("latin-1")


def _value(kind, flag, shape, parts, order, depth):
    if kind == _STRUCTURE:
        return _structure(shape, parts, order, depth)
    if kind not in _NUMBERS:
        return LeftOut(_OTHER.get(kind, "unknown"))
    if flag & (_COMPLEX | _LOGICAL):
        return LeftOut("complex" if flag & _COMPLEX else "logical")
    numbers = _numbers(parts[0], order) if parts else np.zeros(0)
    if len(shape) != 2:
        return LeftOut("more than two dimensions")
    if min(shape) < 0 or shape[0] * shape[1] != len(numbers):
        raise ValueError("a variable has other dimensions than numbers")
    with np.errstate(invalid="ignore"):  # of a damaged number that is none
        return numbers.astype(float).reshape(shape, order="F")


def _structure(shape, parts, order, depth):
    if any(n != 1 for n in shape) or depth >= DEEPEST:
        return LeftOut("structure of several" if depth < DEEPEST else "structure in many others")
    if len(parts) < 2 or not len(width := _numbers(parts[0], order)) or not 0 < width[0] <= 1024:
        raise ValueError("a structure is damaged")
    names, size = bytes(parts[1][1]), int(width[0])
    fields = [names[k : k + size].split(b"\0")[0].decode("latin-1") for k in range(0, len(names), size)]
    values = [_matrix(body, order, depth + 1)[1] for kind, body in parts[2:] if kind == _MATRIX]
    if len(values) != len(fields):
        raise ValueError("a structure is cut off")
    return dict(zip(fields, values, strict=True))


def _old(data):
    """Variables of version 4."""
    at = 0
    while at + 20 <= len(data):
        order = "<" if data[at + 3] == 0 else ">"
        mark, rows, columns, imaginary, length = (
            int(n) for n in np.frombuffer(data[at : at + 20], order + "i4")
        )
        digits = f"{mark:04d}"
        form, kind = _OLD.get(mark // 10 % 10), mark % 10
        if len(digits) != 4 or digits[0] not in "01" or digits[1] != "0" or form is None or kind > 2:
            raise ValueError("its beginning is none of a .mat file")
        size = np.dtype(form).itemsize * rows * columns
        begin = at + 20 + length
        end = begin + size * (2 if imaginary else 1)
        if min(rows, columns) < 0 or not 0 < length < 256 or imaginary not in (0, 1) or end > len(data):
            raise ValueError("the file is cut off or damaged")
        name = data[at + 20 : begin].split(b"\0")[0].decode("latin-1")
        if kind or imaginary:
            yield name, LeftOut("complex" if imaginary else ("", "text", "sparse")[kind])
        else:
            numbers = np.frombuffer(data[begin : begin + size], order + form).astype(float)
            yield name, numbers.reshape((rows, columns), order="F")
        at = end
    if at == 0 or at != len(data):
        raise ValueError("the file is cut off or damaged")
