"""A damaged history is told as such, before it fills the memory or is taken for a result."""

import io
import zipfile

import numpy as np
import pytest
from msgspec.structs import replace
from test_card import CASE, resolved

from sonicvacuum import simulation
from sonicvacuum.files import InputError

CARD = replace(resolved(CASE), duration_s=1e-5, interval_s=1e-6)
SHAPE = (11, 6, 1)
PARTS = {
    "speeds": np.array([0.44]),
    "contacts": np.arange(6),
    "force": np.zeros(SHAPE),
    "refined": np.zeros(SHAPE),
    "energy": np.zeros((3, 1)),
    "momentum": np.zeros((3, 1)),
}


def saved(path, **changes):
    np.savez(path, **{k: v for k, v in (PARTS | changes).items() if v is not None})


def test_a_whole_one_is_read(tmp_path):
    saved(tmp_path / "h.npz")
    assert simulation.load(CARD, tmp_path / "h.npz").force.shape == SHAPE


@pytest.mark.parametrize(
    "changes",
    [
        {"force": None},
        {"force": np.zeros((10, 6, 1))},
        {"refined": np.full(SHAPE, np.nan)},
        {"speeds": np.array([0.4, 0.5])},
        {"contacts": np.array([0, 1, 2, 3, 4, 9])},
        {"contacts": np.array("text")},
        {"force": np.zeros(SHAPE, dtype=complex)},
        {"energy": np.array([{}], dtype=object)},
        {"more": np.zeros(1)},
    ],
    ids=str,
)
def test_other_contents_are_refused(tmp_path, changes):
    saved(tmp_path / "h.npz", **changes)
    with pytest.raises(InputError, match=r"h.npz: .*; run sonicvacuum simulate again"):
        simulation.load(CARD, tmp_path / "h.npz")


def test_a_file_that_unpacks_to_far_more_is_refused_unread(tmp_path):
    with zipfile.ZipFile(tmp_path / "h.npz", "w", zipfile.ZIP_DEFLATED) as bomb:
        array = io.BytesIO()
        np.save(array, np.zeros(10_000_000))
        bomb.writestr("force.npy", array.getvalue())
    with pytest.raises(InputError, match="it is packed"):
        simulation.load(CARD, tmp_path / "h.npz")


@pytest.mark.parametrize("keep", [0, 3, 100, -30])
def test_a_cut_one_is_refused(tmp_path, keep):
    saved(tmp_path / "h.npz")
    whole = (tmp_path / "h.npz").read_bytes()
    (tmp_path / "h.npz").write_bytes(whole[:keep])
    with pytest.raises(InputError, match=r"h.npz"):
        simulation.load(CARD, tmp_path / "h.npz")
