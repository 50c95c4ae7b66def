"""From scope files to a verdict, for each layout: the worked example as each maker would write it.

`python workflow/bench/ten_minutes.py OUT [LAYOUT …]` writes two shots of docs/example in every layout, and
runs the README's commands on them: import, check, discover. One row for each layout: processor seconds of
each step (user and system), what was named, and what the import had to be told besides the README's options.
"""

import argparse
import csv
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "docs/example"
SHOTS = ("shot2", "shot4")
GAUGES = {"g5": "25N/V±2%", "g11": "25N/V±2%", "wall": "50N/V±2%"}
COUNT, STEP, START = 750, 2e-6, -2e-4


@dataclass(frozen=True)
class Layout:
    """How one maker writes three channels.

    Attributes:
        channels: their names.
        head: lines before the numbers.
        lead, cell, end, close, decimal, encoding: how the numbers are set.
        ending: of the file's name.
        scale: of time; None: no column of times. index: numbers of samples stand there instead.
        told: options that the import needs besides the README's.
    """

    channels: tuple[str, str, str]
    head: tuple[str, ...]
    lead: str = ""
    cell: str = ","
    end: str = "\r\n"
    close: str = ""
    decimal: str = "."
    encoding: str = "utf-8"
    ending: str = "csv"
    scale: float | None = 1.0
    index: bool = False
    told: tuple[str, ...] = ()

    def text(self, times: np.ndarray, volts: np.ndarray) -> bytes:
        """The file of one shot; volts (samples, 3)."""
        first = [] if self.scale is None else [np.arange(len(times)) if self.index else times * self.scale]
        form = "{:.9g}" if self.decimal == "." else "{:.9f}"
        rows = (
            self.lead + self.cell.join(form.format(v).replace(".", self.decimal) for v in row) + self.close
            for row in zip(*first, *volts.T, strict=True)
        )
        return (self.end.join([*self.head, *rows]) + self.end).encode(self.encoding)


CH = ("CH1", "CH2", "CH3")
LAYOUTS = {
    "tektronix": Layout(CH, (
        "Model,MSO24", "Horizontal Units,s", "Sample Interval,2e-06", "Record Length,750",
        "Vertical Units,V,V,V", "", "TIME,CH1,CH2,CH3",
    )),
    "siglent": Layout(CH, (
        "Record Length,Analog:750", "Sample Interval,Analog:2.000000E-06", "Vertical Units,CH1:V,CH2:V,CH3:V",
        "Horizontal Units,s", "Model Number,SDS1104X-U", "Source,CH1,CH2,CH3", "Second,Volt,Volt,Volt",
    )),
    "picoscope, German": Layout(
        ("Kanal A", "Kanal B", "Kanal C"), ("Zeit;Kanal A;Kanal B;Kanal C", "(ms);(V);(V);(V)", ""),
        cell=";", decimal=",", scale=1e3,
    ),
    "digilent": Layout(("Channel 1", "Channel 2", "Channel 3"), (
        "#Digilent WaveForms Oscilloscope Acquisition", "#Sample rate: 500000Hz", "#Samples: 750", "",
        "Time (s),Channel 1 (V),Channel 2 (V),Channel 3 (V)",
    )),
    "keysight": Layout(("1", "2", "3"), ("x-axis,1,2,3", "second,Volt,Volt,Volt"), end="\n"),
    "rigol": Layout(CH, (
        "X,CH1,CH2,CH3,Start,Increment,", "Sequence,Volt,Volt,Volt,-2.000000e-04,2.000000e-06,",
    ), close=",", index=True),
    "rohde-schwarz": Layout(("C1", "C2", "C3"), ("in s,C1 in V,C2 in V,C3 in V",), end="\n"),
    "rohde-schwarz, values only": Layout(
        CH, (), scale=None, end="\n", told=("--interval", "2us", "--impact-at", "200us")
    ),
    "yokogawa": Layout(CH, (
        '"Header Size",16', '"Model Name","DL850"', '"BlockNumber",1', '"TraceName","CH1","CH2","CH3"',
        '"BlockSize",750,750,750', '"VUnit","V","V","V"', '"SampleRate",5.0E+05,5.0E+05,5.0E+05',
        '"HResolution",2.0E-06,2.0E-06,2.0E-06', '"HOffset",-2.0E-04,-2.0E-04,-2.0E-04',
        '"HUnit","s","s","s"', "",
    ), lead=",", scale=None),
    "dewesoft": Layout(("Ai1", "Ai2", "Ai3"), (
        "Data file\tC:\\data\\x.dxd", "Sample rate\t500000", "", "Time (s)\tAi1 (V)\tAi2 (V)\tAi3 (V)",
    ), cell="\t", decimal=",", encoding="utf-16", ending="txt"),
    "elsys": Layout(("Kanal 1A", "Kanal 1B", "Kanal 2A"), (
        "TranAX;4.1", "Zeit [ms];Kanal 1A [V];Kanal 1B [V];Kanal 2A [V]",
    ), cell=";", end="\r", decimal=",", encoding="latin-1", scale=1e3, ending="asc"),
    "LabVIEW": Layout(("G5", "G11", "Wall"), (
        "LabVIEW Measurement\t", "Writer_Version\t2", "Separator\tTab", "Decimal_Separator\t.",
        "X_Columns\tOne", "***End_of_Header***\t", "\t", "Channels\t3\t\t\t",
        "Samples\t750\t750\t750\t", "Y_Unit_Label\tVolts\tVolts\tVolts\t",
        "X_Dimension\tTime\tTime\tTime\t", "X0\t-2.0E-4\t-2.0E-4\t-2.0E-4\t",
        "Delta_X\t2.0E-6\t2.0E-6\t2.0E-6\t", "***End_of_Header***\t\t\t\t",
        "X_Value\tG5\tG11\tWall\tComment",
    ), cell="\t", ending="lvm"),
    "plain table": Layout(("A", "B", "C"), ("Time (us);A (V);B (V);C (V)",), cell=";", scale=1e6),
}  # fmt: skip


def shots() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Name → times in s and volts (samples, 3)."""
    found = {}
    for name in SHOTS:
        lines = (EXAMPLE / f"{name}.csv").read_text(encoding="utf-8").splitlines()
        first = next(k for k, line in enumerate(lines) if line.startswith("TIME")) + 1
        table = np.array([line.split(",") for line in lines[first:]], dtype=float)
        found[name] = table[:, 0], table[:, 1:]
    return found


def run(*words) -> tuple[float, str, int]:
    """Processor seconds, what was said, exit code."""
    command = [sys.executable, "-c", "from sonicvacuum.cli import main; main()", *map(str, words)]
    with subprocess.Popen(
        command, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    ) as process:
        said = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime, said.strip(), process.returncode


def trial(name: str, layout: Layout, folder: Path) -> list[str]:
    """Row of one layout."""
    files = []
    for shot, (times, volts) in shots().items():
        files.append(folder / f"{shot}.{layout.ending}")
        files[-1].write_bytes(layout.text(times, volts))
    known = yaml.safe_load((EXAMPLE / "chain.yaml").read_text(encoding="utf-8"))
    known["runs"] = [run_ for run_ in known["runs"] if run_["id"] in SHOTS]
    (folder / "chain.yaml").write_text(yaml.safe_dump(known), encoding="utf-8")
    listed = run("record", "import", *files, "--list")
    given = [w for c, g in zip(layout.channels, GAUGES, strict=True) for w in ("--channel", f"{c}={g}")]
    given += [w for g, s in GAUGES.items() for w in ("--scale", f"{g}={s}")]
    told = layout.told or ("--impact-at", "0us")
    record, found = folder / "record", folder / "found"
    steps = [
        listed,
        run("record", "import", *files, "--record", folder / "chain.yaml", *told, *given, "--out", record),
        run("record", "check", record),
        run("discover", record, "--out", found, "--threads", "1", "--no-figures", "--quiet"),
    ]
    failed = next((said.splitlines()[-1] for _, said, code in steps if code), "")
    named = failed or steps[-1][1].splitlines()[-1].split(": ", 1)[1]
    return [name, *(f"{seconds:.1f}" for seconds, _, _ in steps), named, " ".join(layout.told)]


def main(out: Path, names: list[str]) -> None:
    """Try all layouts, or those named, and write the table."""
    with open(out, "w", encoding="utf-8", newline="") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(["layout", "list_s", "import_s", "check_s", "discover_s", "named", "told_besides"])
        for name in names or LAYOUTS:
            with tempfile.TemporaryDirectory() as folder:
                table.writerow(trial(name, LAYOUTS[name], Path(folder)))
            stream.flush()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", metavar="OUT", type=Path, help="table (CSV) to write")
    parser.add_argument("layouts", metavar="LAYOUT", nargs="*", help=f"by default all: {', '.join(LAYOUTS)}")
    given = parser.parse_args()
    if unknown := set(given.layouts) - set(LAYOUTS):
        parser.error(f"no such layout: {', '.join(sorted(unknown))}")
    main(given.out, given.layouts)
