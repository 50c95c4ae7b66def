"""From the files of a recorder (oscilloscope, logger) to a record of measured data.

`read` gives the channels of one file in base units with their time base, whatever the layout; `layouts` holds
what single makers' files have of their own; `listing` shows what is in files; `shots` finds the pulse,
cleans and thins; `importing` writes the record.
"""

from sonicvacuum.scope.recording import Channel, Recording

__all__ = ["Channel", "Recording", "read"]


def __getattr__(name):
    """`read` is loaded when it is asked for: it needs pandas, which what finds and thins pulses does not."""
    if name != "read":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from sonicvacuum.scope.reader import read

    return read
