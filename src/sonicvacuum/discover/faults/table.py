"""The vocabulary of slips: id, what it is in the words of the bench, what to check there."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """The header of one kind of slip.

    Attributes:
        id: canonical name, never given another meaning.
        says: what it is; `{sensor}`, `{run}` and `{value}` stand for those of the record.
        check: what to look at at the bench.
        unit: of the value, "" where it is a ratio or a number.
        of_reading: whether the value is in the unit of the gauge.
        negative: what it is where the value is negative, `{value}` being its size; "" where `says` does.
        corrected: whether the rest of the verdict is of the record put right.
        alias: nuisance such that an effect which acts like it (`Parameter.acts_like`) moves the same data in
            the same way, "" where there is none.
        stretches: whether effects may do much the same: it moves all times or forces at once, or stays behind
            after every pulse.
        curved: whether no nuisance is like it, so that beside strong pulses slopes mislead on its size.
        of_table: what it is where it concerns values of a table, `{quantity}`; "" where `says` does.
        look_up: what to look at there.
        of_gauge: what it is where it concerns one gauge only; "" where `says` does.
        valueless: what it is where it has no value; "" where `says` does.
        told_as: id under which a verdict tells it with its run and gauge, that of a slip which has neither:
            readers know no others. "" where its own is told.
    """

    id: str
    says: str
    check: str
    unit: str = ""
    corrected: bool = True
    alias: str = ""
    negative: str = ""
    stretches: bool = False
    curved: bool = False
    of_table: str = ""
    look_up: str = ""
    of_gauge: str = ""
    valueless: str = ""
    of_reading: bool = False
    told_as: str = ""


FAULTS: dict[str, Fault] = {
    f.id: f
    for f in (
        Fault(
            "noise-misstated",
            "the noise of {sensor} before the pulse is {value} times the stated one",
            "check the stated noise and the channel's range",
            corrected=False,
            of_table="the errors of {quantity} look {value} times the stated ones",
            look_up="check how sigma was worked out: of single values or of means, and in which unit",
        ),
        Fault(
            "spikes",
            "{sensor} has {value} samples far off their neighbours",
            "check shielding and connectors",
            of_table="{quantity} is {value} times what all others make it, a value that no other supports",
            look_up="look it up where it was written down: its digits, the power of ten, the unit, the row",
        ),
        Fault(
            "drift",
            "{sensor} drifts by {value} over the record",
            "check the coupling and the amplifier's time constant",
            stretches=True,
            of_reading=True,
        ),
        Fault(
            "baseline",
            "{sensor} does not rest at 0 but at {value}",
            "check the channel's zero before each run",
            of_reading=True,
        ),
        Fault(
            "pickup",
            "{sensor} picks up a steady oscillation at {value} kHz",
            "check grounding, lamps, pumps and supplies",
            "kHz",
        ),
        Fault(
            "gauges-swapped",
            "gauges {sensor} look swapped, or one of them taken for both",
            "check the cables and the channels' names",
            of_table="{quantity} of gauges {sensor} look exchanged",
            look_up="check the rows of that run",
        ),
        Fault(
            "gauge-inverted", "gauge {sensor} has the wrong sign", "check its poles and the channel's sign"
        ),
        Fault(
            "gauge-dead",
            "gauge {sensor} shows no pulse where one must have passed",
            "check its cable, amplifier and channel",
        ),
        Fault(
            "gauge-clipped",
            "gauge {sensor} is cut off at {value}",
            "check the channel's range",
            of_reading=True,
        ),
        Fault(
            "gauge-delayed",
            "gauge {sensor} is late by {value} us",
            "check the delays set in its channel and its cable",
            "us",
            negative="gauge {sensor} is early by {value} us",
        ),
        Fault(
            "gauge-misplaced",
            "gauge {sensor} seems to sit in bead {value}",
            "count the beads from the struck end, and look whether the gauge is in a bead or at the wall",
            valueless="gauge {sensor} seems to sit at the wall",
        ),
        Fault(
            "gain-common",
            "all gauges read {value} times the force",
            "check the calibration that all gauges share, terminations (a factor of 2) and probes (of 10)",
            stretches=True,
        ),
        Fault(
            "gauge-gain",
            "gauge {sensor} reads {value} times the force in run {run}",
            "check the range, attenuation and probe that were set for that run",
            told_as="gain-common",
        ),
        Fault(
            "runs-swapped",
            "runs {run} look exchanged, or one of them taken for both",
            "check which file belongs to which striker speed",
            of_gauge="the traces of {sensor} in runs {run} look exchanged, or one of them taken for both",
            of_table="{quantity} of runs {run} look exchanged",
            look_up="check the rows of both runs",
        ),
        Fault("run-off", "run {run} was struck at {value} times the stated speed", "check that run's speed"),
        Fault(
            "run-without-impact",
            "run {run} shows no pulse in any gauge",
            "check whether the striker was let go and the recorder armed",
        ),
        Fault("bead-count", "the chain seems to have {value} beads", "count the beads", stretches=True),
        Fault(
            "bead-mass",
            "the beads weigh {value} times the stated mass",
            "weigh the beads",
            stretches=True,
            curved=True,
        ),
        Fault(
            "bead-size",
            "the beads measure {value} times the stated diameter",
            "measure the beads",
            stretches=True,
        ),
        Fault(
            "striker-mass",
            "the striker weighs {value} times the stated mass",
            "weigh the striker",
            alias="speed",
            curved=True,
        ),
        Fault(
            "speed-common",
            "all strikers move at {value} times the stated speed",
            "check drop heights, or the distance between the light gates",
            alias="speed",
        ),
        Fault(
            "clock",
            "the recorder's time runs {value} times as fast as stated",
            "check the sampling interval",
            stretches=True,
        ),
        Fault(
            "time-zero",
            "the stated time zero is {value} us after the impact",
            "check what the recorder was triggered on: the impact, or the arrival at a gauge",
            "us",
            negative="the stated time zero is {value} us before the impact",
            stretches=True,
            valueless="time zeros are not known as well as stated, each run having its own",
        ),
    )
}


def told(fault: str) -> str:
    """The id under which a verdict tells a slip."""
    return FAULTS[fault].told_as or fault


def header(fault: str, run: str | None, sensor: str | list[str] | None) -> Fault:
    """The header of a slip as a verdict tells it, by its id, run and gauges."""
    single = (one for one in FAULTS.values() if one.told_as == fault)
    return next(single, FAULTS[fault]) if run and isinstance(sensor, str) else FAULTS[fault]
