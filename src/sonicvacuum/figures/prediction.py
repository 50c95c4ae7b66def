"""What each gauge of a chain will read over time; shaded, what to record: first pulses, and the echo too."""

import math
from pathlib import Path

from sonicvacuum.figures.style import (
    BAND,
    BLUE,
    DOUBLE,
    GREEN,
    METADATA,
    ORANGE,
    PURPLE,
    SKY,
    canvas,
    context,
    panel,
    save,
)
from sonicvacuum.files import InputError
from sonicvacuum.outputs import check_folder
from sonicvacuum.prediction.measure import ChainPrediction

# Okabe and Ito's, in the order of the gauges.
_COLORS = (BLUE, ORANGE, GREEN, PURPLE, "#E69F00", SKY, "#000000")
# Without the names above the panel, and a row of these.
_HEIGHT, _ROW, _ABREAST = 68.0, 5.0, 5


def check_name(path) -> None:
    """InputError for a picture of a format that is not written here, or in a folder that cannot be."""
    ending = Path(path).suffix.lstrip(".").lower()
    if ending not in METADATA:
        raise InputError(
            f"{path}: pictures are written as {', '.join(METADATA)}; choose one of these endings"
        )
    check_folder(Path(path).parent)


def _shaded(prediction):
    """What is shaded, how strongly, and what it is called. First pulses alone end before the echo does, which
    may then be cut anywhere: that it is another choice has to be seen.
    """
    window, echo = prediction.window_us, prediction.echo_until_us
    if not window:
        return []
    shaded = [(window, 1.0, "to record: rest and first pulses")]
    return shaded + ([((window[1], echo), 0.45, "and for the wall's echo")] if echo else [])


def _shown(prediction):
    """First and last instant drawn: what is to be recorded, and more than first pulses where that is all."""
    if not prediction.window_us:
        return 0.0, prediction.time_us[-1]
    first, last = prediction.window_us
    return first, max(last, prediction.echo_until_us or 1.3 * last)


def write(prediction: ChainPrediction, path) -> None:
    """Draw the readings and write them in the format that the path's ending names."""
    with context():
        shaded = _shaded(prediction)
        rows = math.ceil((len(shaded) + len(prediction.readings_N)) / _ABREAST)
        figure = canvas(DOUBLE, _HEIGHT + _ROW * rows)
        axes = panel(figure, (16.0, 12.0, DOUBLE - 20.0, _HEIGHT - 14.0))
        for window, opacity, label in shaded:
            axes.axvspan(*window, color=BAND, alpha=opacity, lw=0, label=label)
        for k, (gauge, reading) in enumerate(prediction.readings_N.items()):
            label = f"bead {gauge}" if gauge.isdigit() else gauge
            axes.plot(prediction.time_us, reading, color=_COLORS[k % len(_COLORS)], lw=1.0, label=label)
        axes.set_xlim(*_shown(prediction))
        axes.set_xlabel("time after the impact (µs)")
        axes.set_ylabel("reading (N)")
        # Above the panel, where neither curves nor shades are.
        figure.legend(loc="upper center", ncols=_ABREAST, borderaxespad=0.3)
        save(figure, path)
