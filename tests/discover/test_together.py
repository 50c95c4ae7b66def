"""Records of one laboratory taken together: one data set, one verdict."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from made_records import made
from msgspec import structs

from sonicvacuum import records
from sonicvacuum.cli.discover import discover
from sonicvacuum.discover import session
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.problem import experiment, together
from sonicvacuum.files import InputError
from sonicvacuum.records.record import check_distinct


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


@pytest.mark.parametrize("renamed", [False, True])
def test_a_record_and_its_copy_are_refused(empty, tmp_path, renamed):
    paths = [str(tmp_path / name) for name in ("one", "copy")]
    records.write(empty, paths[0])
    shutil.copytree(*paths)
    if renamed:  # nor is it another one for a title and names of runs and files of its own
        runs = [structs.replace(r, id=f"new-{r.id}", signals=f"new-{r.signals}") for r in empty.block.runs]
        traces = {f"new-{id}": signals for id, signals in empty.signals.items()}
        block = structs.replace(empty.block, title="Another one", runs=runs)
        records.write(replace(empty, block=block, signals=traces), paths[1])
    asked = [*paths, "--together", "--out", str(tmp_path / "found")]
    for call in (
        lambda: CliRunner().invoke(discover, asked, catch_exceptions=False, standalone_mode=False),
        lambda: session.discover(*map(records.read, paths)),
    ):
        with pytest.raises(
            InputError, match=r"copy: (run new-v0 )?holds the same .*\bone, which would count twice"
        ):
            call()
    assert not (tmp_path / "found").exists()


def test_a_record_given_twice_is_refused(empty):
    with pytest.raises(InputError, match="made: holds the same data as made"):
        session.discover(empty, empty)


def test_a_gauge_that_is_dead_in_both_makes_no_copy(empty):
    dead = {id: records.Signals(s.time_us, {"wall": 0.0 * s.time_us}) for id, s in empty.signals.items()}
    check_distinct((replace(empty, signals=dead), replace(empty, signals=dead)), ("monday", "tuesday"))


def test_runs_of_one_name_stay_apart(empty):
    other = made(seed=5)[0]
    ids = [r.id for r in together((empty, other)).runs]
    assert len(set(ids)) == len(ids) == 4
