"""C's way into compiled code: what a call from Python hands over, an array as its address and its shape.

The *kind* of an argument is "d" for a real number, "q" for a whole one, and "d3" for an array of real numbers
with three axes.
"""

import ctypes

import numpy as np

_C = {"d": ctypes.c_double, "q": ctypes.c_int64}


def kinds_of(arguments: tuple) -> tuple[str, ...]:
    """Kinds of arguments.

    Raises:
        TypeError: for an array that is not of float64 or int64, or not in C's order.
    """
    return tuple(_kind(argument) for argument in arguments)


def _kind(argument):
    if not isinstance(argument, np.ndarray):
        return "d" if isinstance(argument, float) else "q"
    letter = {"f8": "d", "i8": "q"}.get(argument.dtype.str[1:])
    if letter is None or not argument.flags.c_contiguous:
        raise TypeError(f"an array of {argument.dtype}, strides {argument.strides}: none for compiled code")
    return f"{letter}{argument.ndim}"


def prototype(kinds: tuple[str, ...]):
    """Type of a C function of arguments of these kinds, which lets other threads run."""
    taken = []
    for letter, *axes in kinds:
        if axes:
            taken += [ctypes.c_void_p, *[ctypes.c_int64] * int(axes[0])]
        else:
            taken.append(_C[letter])
    return ctypes.CFUNCTYPE(None, *taken)


def handed_over(arguments: tuple) -> list:
    """What C is given for arguments; they must live as long as the call."""
    given = []
    for argument in arguments:
        if isinstance(argument, np.ndarray):
            given += [argument.ctypes.data, *argument.shape]
        else:
            given.append(argument)
    return given
