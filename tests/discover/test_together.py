"""Records of one laboratory taken together: one data set, one verdict."""

from dataclasses import replace

import numpy as np
import pytest
from made_records import made
from msgspec import structs

from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment, together
from sonicvacuum.files import InputError


def test_two_halves_of_a_record_are_the_record(empty):
    first, second = (_part(empty, k) for k in (0, 1))
    whole, joined = nominal(Forward(experiment(empty))), nominal(Forward(together((first, second))))
    # The same data in the same model; only sums in another order.
    assert joined.objective == pytest.approx(whole.objective, rel=1e-9)
    np.testing.assert_allclose(joined.nu, whole.nu, atol=1e-6)


def _part(record, k):
    block = structs.replace(record.block, runs=[record.block.runs[k]])
    return replace(record, block=block, name=f"part {k}")


def test_another_chain_is_refused(empty):
    block = structs.replace(empty.block, chain=structs.replace(empty.block.chain, beads=11))
    with pytest.raises(InputError, match="beads is 11, in made 10"):
        together((empty, replace(empty, block=block)))


def test_runs_of_one_name_stay_apart(empty):
    other = made(seed=5)[0]
    ids = [r.id for r in together((empty, other)).runs]
    assert len(set(ids)) == len(ids) == 4
