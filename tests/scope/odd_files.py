"""Text files built line by line, with cells that are numbers or any words, and what is read of them."""

from made_files import PULSE, TIMES

from sonicvacuum.scope import read

__all__ = ["PULSE", "SECOND", "TIMES", "recording", "rows", "seen"]
SECOND = -0.5 * PULSE


def recording(folder, text, name="t.csv"):
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read(path)


def rows(*columns, cell=",", form="{:.7g}"):
    """Lines of columns, of which cells that are texts stay as they are."""
    return "".join(
        cell.join(c if isinstance(c, str) else form.format(c) for c in row) + "\n"
        for row in zip(*columns, strict=True)
    )


def seen(found):
    """Name, segment, unit and number of samples of each channel."""
    return [(c.name, c.segment, c.unit, c.samples) for c in found.channels]
