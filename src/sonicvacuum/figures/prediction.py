"""What each gauge of a chain will read over time, the window to record shaded."""

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
_HEIGHT = 70.0


def check_name(path) -> None:
    """InputError for a picture of a format that is not written here, or in a folder that cannot be."""
    ending = Path(path).suffix.lstrip(".").lower()
    if ending not in METADATA:
        raise InputError(
            f"{path}: pictures are written as {', '.join(METADATA)}; choose one of these endings"
        )
    check_folder(Path(path).parent)


def write(prediction: ChainPrediction, path) -> None:
    """Draw the readings and write them in the format that the path's ending names."""
    with context():
        figure = canvas(DOUBLE, _HEIGHT)
        axes = panel(figure, (16.0, 12.0, DOUBLE - 20.0, _HEIGHT - 16.0))
        if prediction.window_us:
            axes.axvspan(*prediction.window_us, color=BAND, lw=0, label="to be recorded")
        for k, (gauge, reading) in enumerate(prediction.readings_N.items()):
            label = f"bead {gauge}" if gauge.isdigit() else gauge
            axes.plot(prediction.time_us, reading, color=_COLORS[k % len(_COLORS)], lw=1.0, label=label)
        first = prediction.window_us[0] if prediction.window_us else 0.0
        last = prediction.echo_until_us or prediction.time_us[-1]
        axes.set_xlim(first, max(last, prediction.window_us[1] if prediction.window_us else 0.0))
        axes.set_xlabel("time after the impact (µs)")
        axes.set_ylabel("reading (N)")
        axes.legend(loc="upper right")
        save(figure, path)
