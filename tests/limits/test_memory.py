"""Memory follows what is asked for: the beads that the wave reaches and the samples that are kept."""

import math
import tracemalloc

import numpy as np
import pytest

from sonicvacuum.physics.bodies import Body, Elastic
from sonicvacuum.physics.chain import Chain
from sonicvacuum.physics.run import simulate

MIB = 2**20


def chain(modulus, beads):
    body = Elastic("coating", modulus, 0.388)
    return Chain(beads, Body(body, 0.44e-3, 2.43e-3), body, body, math.inf, 0.47e-3, 0.44)


def largest_use(*arguments):
    """Bytes allocated at most while simulating, machine code aside."""
    simulate(*arguments)
    tracemalloc.start()
    try:
        simulate(*arguments)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("beads", [100_000, 1_000_000])
def test_a_long_chain_takes_no_more_than_its_wave(beads):
    # Some 150 bodies of 4 numbers and 2001 samples: 50 kB; the temporaries are of that size too.
    assert largest_use(chain(15e9, beads), [12, 13], 2e-3, 1e-6) < 1 * MIB


def test_a_thousand_chains():
    # Samples take 601 × 8 B × 1000 = 4.6 MiB, bodies 23 × 4 × 8 B × 1000 = 0.7 MiB.
    assert largest_use(chain(np.linspace(2.76e9, 30e9, 1000), 21), [12], 0.6e-3, 1e-6) < 12 * MIB
