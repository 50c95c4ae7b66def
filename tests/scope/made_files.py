"""Small files in the layouts of many recorders, made here: the same pulse, as each maker writes it.

Every maker takes times in s and volts and gives the bytes of a file. `LAYOUTS` names file, maker and what
must come back: channels by name with the factor on the pulse.
"""

from dataclasses import dataclass, field

import numpy as np

COUNT, STEP, START = 200, 1e-6, -1e-4
TIMES = START + STEP * np.arange(COUNT)
PULSE = np.round(
    2.0 * np.exp(-(((np.arange(COUNT) - 120) / 12.0) ** 2)) + 0.01 * ((np.arange(COUNT) * 7) % 5 - 2), 4
)


def table(head, columns, cell=",", end="\n", form="{:.6e}", decimal=".", encoding="utf-8", close=""):
    """Bytes of a header and rows of numbers."""
    rows = [
        cell.join(form.format(v).replace(".", decimal) for v in row) + close
        for row in zip(*columns, strict=True)
    ]
    return (end.join([*head, *rows]) + end).encode(encoding)


def tds(times, volts):
    keys = ["Record Length,2.000000e+02,", "Sample Interval,1.000000e-06,", "Trigger Point,1.0000e+02,",
            ",,", "Source,CH2,", "Vertical Units,V,", "Horizontal Units,s,",
            "Pt Fmt,Y,", "Model Number,TDS2024B,",
            "Firmware Version,FV:v22.01,"]  # fmt: skip
    keys += [",,"] * (len(times) - len(keys))
    return "\r\n".join(
        f"{k},{t:018.12f},  {v:.5f}," for k, t, v in zip(keys, times, volts, strict=True)
    ).encode()


def tbs(times, volts):
    head = ["Model,TBS1202C", "Firmware Version,1.2", "", "Point Format,Y,", "Horizontal Units,s,",
            "Sample Interval,1e-06,", "Record Length,200,", "Probe Attenuation,1,1", "Vertical Units,V,V",
            "Label,,",
            "TIME,CH1,CH2"]  # fmt: skip
    return table(head, (times, volts, -volts), end="\r\n")


def siglent_old(times, volts):
    head = ["Record Length,200", "Sample Interval,CH1:0.000001000 CH2:0.000001000",
            "Vertical Units,CH1:V CH2:V,,",
            "Vertical Scale,CH1:0.05 CH2:0.10,,", "Horizontal Units,s,,", "Model Number,ADS1202CL+,,", "",
            "Source,CH1,CH2", "Second,Volt,Volt"]  # fmt: skip
    return table(head, (times, volts, -volts), form="{:.11f}")


def siglent_new(times, volts):
    """The header counts time in us, the column in s."""
    head = ["Record Length,Analog:200,", "Sample Interval,Analog:1.000000E-06,",
            "Vertical Units,CH1:V,CH3:mV,", "Horizontal Units,us,", "Model Number,SDS1104X-U,",
            "Source,CH1,CH3", "Second,Value,Value"]  # fmt: skip
    return table(head, (times, volts, 1e3 * volts), form="{:+.6E}")


def siglent_binary_converted(times, volts):
    head = ["Record Length,Analog:200", "Sample Rate,1000000.0", "Vertical Scale,CH1: 1.00", "Second,Volt"]
    return table(head, (times, volts), cell=", ", form="{:.9f}")


def picoscope(times, volts):
    """Milliseconds and millivolts; the second channel leaves its range at one sample."""
    rows = [
        f"{t * 1e3:.8f},{v * 1e3:.5f},{'∞' if k == 120 else v}"
        for k, (t, v) in enumerate(zip(times, volts, strict=True))
    ]
    return "\r\n".join(["Time,Channel A,Channel B", "(ms),(mV),(V)", "", *rows, ""]).encode()


def picoscope_german(times, volts):
    head = ["\ufeffZeit;Kanal A;Kanal B", "(us);(V);(mV)", ""]
    return table(head, (times * 1e6, volts, 1e3 * volts), cell=";", form="{:.8f}", decimal=",")


def picoscope_latin(times, volts):
    return table(["Time,Channel A", "(µs),(V)", ""], (times * 1e6, volts), form="{:.6f}", encoding="latin-1")


def digilent(times, volts):
    head = ["#Digilent WaveForms Oscilloscope Acquisition", "#Device Name: Discovery2",
            "#Date Time: 2021-03-09 12:00:00.123.456.789", "#Sample rate: 1e+06Hz", "#Samples: 200",
            "#Channel 1: Range: 500 mV/div Offset: 0 V", "",
            "Time (s),Channel 1 (V),Channel 2 (V)"]  # fmt: skip
    return table(head, (times, volts, -volts))


def phyphox(times, volts):
    head = ['"Time (s)"\t"Linear Acceleration x (m/s^2)"']
    return table(head, (times, volts), cell="\t", form="{:.9E}", decimal=",")


def lecroy(times, volts):
    head = ["LECROYWR104MXi-A,52137,Waveform", "Segments,1,SegmentSize,200",
            "Segment,TrigTime,TimeSinceSegment1",
            "#1,03-Apr-2017 14:53:22,0                 ", "Time,Ampl"]  # fmt: skip
    return table(head, (times, volts), form="{:.9g}")


def gw_instek_keys(mode):
    return ["Format,1.0B,", "Memory Length,200,", "Trigger Address,100,", "Source,CH1,", "Vertical Units,V,",
            "Vertical Units Div,0,", "Label,,", "Vertical Scale,2.500e-03,", "Horizontal Units,S,",
            "Sampling Period,1.000e-06,", "Firmware,V0.99,", f"Mode,{mode},", "Waveform Data,"]  # fmt: skip


def gw_instek_counts(times, volts):
    """Whole counts, 25 to a division: a step of 0.1 mV here."""
    return table(gw_instek_keys("Fast"), (np.round(volts / 1e-4),), form="{:.0f},")


def gw_instek_volts(times, volts):
    return table(gw_instek_keys("Detail"), (times, volts), close=",")


def hantek(times, volts):
    head = ["#CHANNEL:CH1", "#CLOCK=1.0us", "#SIZE=200", "#UNITS:mV", ""]
    return table(head, (1e3 * volts,), end="\r\n", form="{:.2f}")


def yokogawa(times, volts):
    head = ['"Header Size",16', '"Model Name","DL850"', '"BlockNumber",1', '"TraceName","CH1","CH2"',
            '"BlockSize",200,200', '"VUnit","V","mV"', '"SampleRate",1.0000000E+06,1.0000000E+06',
            '"HResolution",1.000000E-06,1.000000E-06', '"HOffset",-1.000000E-04,-1.000000E-04',
            '"HUnit","s","s"', '"Date","2009/01/01","2009/01/01"', ""]  # fmt: skip
    rows = [f",{v:.6E},{1e3 * v:.6E}" for v in volts]
    return "\r\n".join([*head, *rows, ""]).encode()


def keysight(times, volts):
    rows = [f"{t * 1e6:+.5f}E-06,{v * 1e3:+.5f}E-03" for t, v in zip(times, volts, strict=True)]
    return "\n".join(["x-axis,1", "second,Volt", *rows, ""]).encode()


def infiniium(times, volts):
    head = ["Revision:,0", "Type:,raw", "Start:,0", "Points:,200", "XInc:,1.0E-06", "XOrg:,-1.0E-04",
            "YInc:,1", "Frame:,54853A:MY4", "Data:,"]  # fmt: skip
    return table(head, (volts,), form="{:+.6E}")


def rigol_sequence(times, volts):
    head = ["X,CH1,CH2,Start,Increment,", "Sequence,Volt,Volt,-1.000000e-04,1.000000e-06,"]
    return table(head, (np.arange(len(times)), volts, -volts), end="\r\n", form="{:.10g}", close=",")


def rigol_inline(times, volts):
    head = ["CH1V,CH2V,t0 =-1.000000e-04, tInc = 1.000000e-06,"]
    return table(head, (volts, -volts), close=",,")


def rohde_schwarz(times, volts):
    return table(["in s,C1 in V,C2 in V"], (times, volts, -volts), form="{:.8E}")


def dewesoft(times, volts):
    head = ["Data file\tC:\\data\\x.dxd", "Start time\t12.03.2020 12:00:00.123", "Number of channels\t2",
            "Sample rate\t1000000", "", "Events", "1\tstoring started\t0\t", "",
            "Time (s)\tForce (N)\tAcc [m/s2]"]  # fmt: skip
    return table(
        head, (times, volts, -volts), cell="\t", end="\r\n", form="{:.7f}", decimal=",", encoding="utf-16"
    )


def elsys(times, volts):
    head = ["TranAX;4.1", "Zeit [ms];Kanal 1A [mV];Kanal 1B [V]"]
    columns = (times * 1e3, 1e3 * volts, volts)
    return table(head, columns, cell=";", end="\r", form="{:.7f}", decimal=",", encoding="latin-1")


def lvm(times, volts):
    head = ["LabVIEW Measurement\t", "Writer_Version\t2", "Separator\tTab", "Decimal_Separator\t,",
            "X_Columns\tNo",
            "***End_of_Header***\t", "\t", "Channels\t2\t\t", "Samples\t200\t200\t",
            "Y_Unit_Label\tNewtons\tVolts\t",
            "X_Dimension\tTime\tTime\t", "X0\t-1,0E-4\t-1,0E-4\t", "Delta_X\t1,000000E-6\t1,000000E-6\t",
            "***End_of_Header***\t\t\t", "X_Value\tHammer\tGauge\tComment"]  # fmt: skip
    return (
        table(head, (volts, -volts), cell="\t", form="\t{:.6f}", decimal=",")
        .replace(b"\t\t-", b"\t-")
        .replace(b"\t\t", b"\t")
    )


def plain_blanks(times, volts):
    return table(
        ["# Time (us)   Force (N)   Speed (m/s)"], (times * 1e6, volts, -volts), cell="  ", form="{:12.4f}"
    )


def no_header(times, volts):
    return table([], (times, volts), cell="  ", form="{: .7e}")


def units_below(times, volts):
    return table(["Time;F1;", "ms;N;"], (times * 1e3, volts), cell=";", form="{:.6f}", close=";")


def long_header(times, volts):
    head = [f"Comment {k},some text" for k in range(5000)] + ["Time (us),CH1 (mV)"]
    return table(head, (times * 1e6, 1e3 * volts), form="{:.4f}")


def contradicting(times, volts):
    """The column claims s, header and interval speak for us."""
    head = ["Horizontal Units,us", "Sample Interval,1e-6", "Time (s),CH1 (V)"]
    return table(head, (times * 1e6, volts), form="{:.4f}")


def quoted_commas(times, volts):
    head = ['"Time (ms)","F (kN)"']
    return table(head, (times * 1e3, volts / 1e3), cell=",", form='"{:.9f}"', decimal=",")


def index_and_rate(times, volts):
    return table(
        ["Sampling Frequency [kHz];1000", "Start;-1e-4", "Index;F [N]"],
        (np.arange(len(times)), volts),
        cell=";",
        form="{:.10g}",
    )


@dataclass(frozen=True)
class Made:
    """A file, its maker, the layout to be recognised, channel → (unit, factor on the pulse), and what is odd.

    `over` names the channel with a sample over range; `start` is the time of the first sample in s.
    """

    file: str
    maker: object
    layout: str
    channels: dict = field(default_factory=dict)
    over: str = ""
    start: float = START


V, NEG = ("V", 1.0), ("V", -1.0)
LAYOUTS = [
    Made("F0000CH2.CSV", tds, "tektronix", {"CH2": V}),
    Made("T0000.CSV", tbs, "tektronix", {"CH1": V, "CH2": NEG}),
    Made("ADS1.csv", siglent_old, "siglent", {"CH1": V, "CH2": NEG}),
    Made("SDS1.csv", siglent_new, "siglent", {"CH1": V, "CH3": V}),
    Made("conv.csv", siglent_binary_converted, "siglent", {"CH1": V}),
    Made("pico.csv", picoscope, "picoscope", {"Channel A": V, "Channel B": V}, over="Channel B"),
    Made("pico_de.csv", picoscope_german, "picoscope", {"Kanal A": V, "Kanal B": V}),
    Made("pico_latin.csv", picoscope_latin, "picoscope", {"Channel A": V}),
    Made("acq.csv", digilent, "digilent-waveforms", {"Channel 1": V, "Channel 2": NEG}),
    Made("Raw Data.csv", phyphox, "phyphox", {"Linear Acceleration x": ("m/s^2", 1.0)}),
    Made("C3Trace00001.txt", lecroy, "lecroy", {"C3": V}),
    Made("DS0001.csv", gw_instek_counts, "gw-instek", {"CH1": V}),
    Made("DS0002.csv", gw_instek_volts, "gw-instek", {"CH1": V}),
    Made("h.csv", hantek, "hantek", {"CH1": V}, start=0.0),
    Made("dl.csv", yokogawa, "yokogawa", {"CH1": V, "CH2": V}),
    Made("scope_1.csv", keysight, "keysight", {"1": V}),
    Made("inf.csv", infiniium, "keysight", {"CH1": V}),
    Made("NewFile1.csv", rigol_sequence, "rigol", {"CH1": V, "CH2": NEG}),
    Made("RigolDS0.csv", rigol_inline, "rigol", {"CH1": V, "CH2": NEG}),
    Made("RTB.csv", rohde_schwarz, "rohde-schwarz", {"C1": V, "C2": NEG}),
    Made("dewe.txt", dewesoft, "dewesoft", {"Force": ("N", 1.0), "Acc": ("m/s^2", -1.0)}),
    Made("elsys.csv", elsys, "elsys", {"Kanal 1A": V, "Kanal 1B": V}),
    Made("m.lvm", lvm, "lvm", {"Hammer": ("N", 1.0), "Gauge": NEG}),
    Made("blanks.txt", plain_blanks, "table", {"Force": ("N", 1.0), "Speed": ("m/s", -1.0)}),
    Made("none.txt", no_header, "table", {"CH1": ("", 1.0)}),
    Made("below.csv", units_below, "table", {"F1": ("N", 1.0)}),
    Made("long.csv", long_header, "table", {"CH1": V}),
    Made("contra.csv", contradicting, "table", {"CH1": V}),
    Made("quoted.csv", quoted_commas, "table", {"F": ("N", 1.0)}),
    Made("rate.csv", index_and_rate, "table", {"F": ("N", 1.0)}),
]
