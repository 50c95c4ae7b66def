"""The beginning of a record tells what the whole tells, or that it is not settled yet."""

import math

import numpy as np
import pytest

from sonicvacuum.effects import CATALOGUE, Setup
from sonicvacuum.forward.columns import Columns
from sonicvacuum.forward.motion import see
from sonicvacuum.forward.together import runs_of
from sonicvacuum.gauges import Gauge
from sonicvacuum.observe.quantities import QUANTITIES, measure_run
from sonicvacuum.observe.run import Geometry
from sonicvacuum.observe.trace import Unsettled
from sonicvacuum.physics.chain import Body, Chain, Elastic
from sonicvacuum.physics.scales import COUNTING, passage_of, sampling_of

BEADS, DIAMETER = 16, 5e-3
GAUGES = (
    Gauge("top", "embedded", 5, droop_s=1e-3),
    Gauge("low", "embedded", 11, lowpass_s=2e-6),
    Gauge("speed", "velocity", 8),
    Gauge("wall", "wall", None),
)
SENSORS = [g.id for g in GAUGES]
# The samples are the same; only the interval of equidistant times is rounded otherwise.
ROUNDING = 1e-9


def struck(modulus=200e9, striker_mass=0.5e-3, speed=0.5, static_force=0.0):
    """A chain of steel beads, or of something softer."""
    return Chain(
        beads=BEADS,
        bodies=Body(Elastic("bead", modulus, 0.3), 0.5e-3, 0.5 * DIAMETER),
        striker=Elastic("striker", 200e9, 0.3),
        wall=Elastic("wall", 100e9, 0.3),
        striker_radius=math.inf,
        striker_mass=striker_mass,
        speed=speed,
        static_force=static_force,
    )


CHAINS = {
    "steel": (struck(), {}),
    "a train of pulses": (struck(striker_mass=2e-3), {}),
    "as soft as rubber": (struck(modulus=5e6), {}),
    "a static force": (struck(static_force=2.0), {}),
    "damped": (struck(), {"kuwabara-kono": {"time_us": 1.0}}),
    "overdamped": (struck(striker_mass=2e-3), {"linear-dashpot": {"damping_kg_s": 20.0}}),
}
ASKED = [
    (quantity, options)
    for quantity, entry in QUANTITIES.items()
    if entry.over == "run"
    for options in (
        [{"from": "top", "to": "low", **({"sensor": "low"} if "sensor" in entry.needs else {})}]
        if "from" in entry.needs
        else [{"sensor": sensor} for sensor in SENSORS]
    )
]


def readings(name):
    """Readings of a chain for as long as the slowest pulse needs to come and go, with their times."""
    chain, effects = CHAINS[name]
    setup = Setup(chain, GAUGES)
    for effect, values in effects.items():
        setup = CATALOGUE.effect(effect).apply(setup, **values)
    seen = see(setup, passage_of(chain, COUNTING), sampling_of(chain))
    return seen.readings, seen.history.time


def told(quantity, run, options):
    """Value and reason; None while more may change them."""
    try:
        found = measure_run(quantity, run, **options)
    except Unsettled:
        return None
    return found.value, found.reason


@pytest.mark.parametrize("name", CHAINS)
def test_what_is_settled_stays(name):
    signals, time = readings(name)
    geometry = Geometry(BEADS, DIAMETER, GAUGES)
    whole = runs_of(signals, time, geometry)[0]
    known = {k: told(quantity, whole, options) for k, (quantity, options) in enumerate(ASKED)}
    early = set()
    for samples in np.linspace(20, len(time), 60).astype(int):
        runs = runs_of(signals[..., :samples], time[:samples], geometry, goes_on=True)
        columns = Columns(runs)
        for k, (quantity, options) in enumerate(ASKED):
            found, column = told(quantity, runs[0], options), columns.of(quantity, options)[0]
            if found is not None:
                assert found[1] == known[k][1], (quantity, options, samples)
                np.testing.assert_allclose(found[0], known[k][0], rtol=ROUNDING, err_msg=f"{quantity}")
                early |= {k} if samples < 0.6 * len(time) else set()
            # What is told side by side is told one by one as well.
            assert np.isnan(column) or (found is not None and column == found[0])
    if name in ("steel", "a train of pulses", "damped"):
        # Everything that is told at all is told long before the end.
        assert early >= {k for k, (value, _) in known.items() if not math.isnan(value)}


def test_a_whole_record_is_never_unsettled():
    signals, time = readings("as soft as rubber")
    for samples in (20, len(time) // 3, len(time)):
        run = runs_of(signals[..., :samples], time[:samples], Geometry(BEADS, DIAMETER, GAUGES))[0]
        assert None not in [told(quantity, run, options) for quantity, options in ASKED]


def test_a_pulse_may_be_dwarfed_by_what_follows():
    """The main pulse is the first to reach a quarter of the largest force: a later one five times as high
    makes it none.
    """
    time = np.arange(400) * 1e-6

    def pulse(middle, height):
        return height / np.cosh(np.clip((time - middle) / 1e-5, -50.0, 50.0)) ** 4

    for height, samples, stays in ((1.0, 250, True), (3.0, 360, False), (5.0, 360, True)):
        signal = pulse(1e-4, 1.0) + pulse(3e-4, height)
        begun = runs_of(
            signal[None, None, :samples], time[:samples], Geometry(BEADS, DIAMETER, GAUGES[:1]), True
        )[0]
        assert (told("amplitude", begun, {"sensor": "top"}) is not None) == stays
