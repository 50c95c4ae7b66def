"""The kernels one by one, for pytest-benchmark: pytest workflow/bench/bench_kernels.py."""

import numpy as np
import pytest
from problems import INTERVAL, PROBLEMS, STEP

from sonicvacuum.effects import Setup, effect
from sonicvacuum.physics.run import simulate

EFFECTS = ["bare", "contact-exponent", "kuwabara-kono", "relaxing-contact", "static-preload"]
OPTIONS = {
    "default": {},
    "verlet": {"method": "verlet", "step": STEP},
    "runge-kutta": {"symplectic": False},
    "audited": {"audit": True},
}


def chain(lanes, name="bare"):
    """So many chains of P3 with one effect at a typical strength."""
    setup = Setup(PROBLEMS["P3"].chain.take(np.linspace(0, 999, lanes).astype(int)))
    if name != "bare":
        e = effect(name)
        setup = e.apply(setup, **{p.name: p.at(1.0, setup) for p in e.parameters})
    return setup.chain


@pytest.mark.parametrize("lanes", [1, 64])
@pytest.mark.parametrize("options", OPTIONS)
def test_steppers(benchmark, lanes, options):
    h = benchmark(simulate, chain(lanes), [12], 0.6e-3, INTERVAL, alone=True, **OPTIONS[options])
    assert h.force.max() > 1.0


@pytest.mark.parametrize("name", EFFECTS)
def test_laws(benchmark, name):
    h = benchmark(simulate, chain(64, name), [12], 0.6e-3, INTERVAL)
    assert h.force.max() > 1.0
