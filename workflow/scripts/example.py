"""The worked example of the README: four impacts on a chain of Delrin balls, as an oscilloscope saves them.

The data come from the blind study's own integrator, which shares no code with the engine; one effect is
hidden in them, `HIDDEN`. Usage: python workflow/scripts/example.py FOLDER
"""

import argparse
from pathlib import Path

import numpy as np

from sonicvacuum.files import replacing
from sonicvacuum.materials import MATERIALS
from sonicvacuum_blind import catalogue
from sonicvacuum_blind.design import Design
from sonicvacuum_blind.plan import Gauge, Plan, Solid
from sonicvacuum_blind.prediction import Errors, predict

SPEEDS = {"shot1": 0.25, "shot2": 0.5, "shot3": 1.0, "shot4": 1.6}  # m/s
GAUGES = {
    "CH1": Gauge("g5", "embedded", 5),
    "CH2": Gauge("g11", "embedded", 11),
    "CH3": Gauge("wall", "wall"),
}
NEWTON_PER_VOLT = {"CH1": 25.0, "CH2": 25.0, "CH3": 50.0}
OFFSET_V = {"CH1": 0.013, "CH2": -0.021, "CH3": 0.008}
NOISE_V = {"CH1": 0.003, "CH2": 0.003, "CH3": 0.003}
INTERVAL, SAMPLES, PRETRIGGER = 2e-6, 650, 100  # s; samples after and before the impact
HIDDEN, RATE_PER_S = "viscous-drag", 300.0
SEED = 2006
TOLERANCE = 1e-7


def design(interval: float = INTERVAL, samples: int = SAMPLES) -> Design:
    """What the laboratory knows: sixteen balls, a steel ball that strikes them, a steel wall."""

    def solid(name):
        return Solid(name, MATERIALS[name].modulus, MATERIALS[name].poisson)

    plans = [
        Plan(
            beads=16, bead=solid("delrin"), striker=solid("bearing-steel"), wall=solid("stainless-steel"),
            bead_radius=5e-3, striker_radius=3e-3, bead_mass=0.74e-3, striker_mass=0.88e-3, speed=speed,
            gauges=tuple(GAUGES.values()),
        )
        for speed in SPEEDS.values()
    ]  # fmt: skip
    return Design("traces", tuple(plans), None, interval, samples, modulus_sigma=0.05, trigger_sigma=1e-6)


def volts(made: Design, pretrigger: int = PRETRIGGER) -> np.ndarray:
    """(runs, channels, samples) V as digitised, so many samples before the impact included."""
    random = np.random.default_rng(np.random.SeedSequence(SEED))
    errors = Errors.of(made, np.clip(random.standard_normal(len(Errors.of(made).vector)), -2.0, 2.0))

    def change(plan):
        return catalogue.BY_ID[HIDDEN].put(plan, None, rate_per_s=RATE_PER_S)

    force = predict(made, change, errors, TOLERANCE).traces
    whole = np.concatenate([np.zeros((*force.shape[:2], pretrigger)), force], axis=-1)
    scale, noise, offset = (np.array(list(d.values()))[:, None] for d in (NEWTON_PER_VOLT, NOISE_V, OFFSET_V))
    return whole / scale + offset + noise * random.standard_normal(whole.shape)


def text(run: np.ndarray) -> str:
    """One run in the layout of a Tektronix MSO: keys, a line of names, times in s and volts."""
    time = INTERVAL * (np.arange(run.shape[1]) - PRETRIGGER)
    head = [
        "Model,MSO24", "Firmware Version,2.0.3", "Waveform Type,ANALOG", "Point Format,Y,",
        "Horizontal Units,s", f"Sample Interval,{INTERVAL:.8e}", f"Record Length,{run.shape[1]}",
        f"Zero Index,{PRETRIGGER}", "Vertical Units,V,V,V", "Label,,,", "",
        "TIME," + ",".join(GAUGES),
    ]  # fmt: skip
    rows = (f"{t:.6e}," + ",".join(f"{v:.4f}" for v in row) for t, row in zip(time, run.T, strict=True))
    return "\r\n".join([*head, *rows]) + "\r\n"


def write(folder) -> None:
    """One file for each impact."""
    for name, run in zip(SPEEDS, volts(design()), strict=True):
        with replacing(Path(folder) / f"{name}.csv", "wb") as stream:
            stream.write(text(run).encode("ascii"))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", metavar="FOLDER", help="where the four files are written")
    write(parser.parse_args().folder)
