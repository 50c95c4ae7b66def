"""Compiled code is never stale, survives the process, and many processes may make it at once."""

import errno
import os
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import sonicvacuum
from sonicvacuum.physics import compiled, kernels
from sonicvacuum.physics.entry import kinds_of
from sonicvacuum.physics.fingerprint import fingerprint
from sonicvacuum.physics.laws import HERTZ, LawSet, Term, hertz_force

PACKAGE = Path(sonicvacuum.__file__).parent
# Prints the largest force, how much was compiled (frame and stepper), and whether Numba was loaded.
SCRIPT = """
import math, sys
from sonicvacuum.physics import compiled
from sonicvacuum.physics.chain import Body, Chain, Elastic
from sonicvacuum.physics.run import simulate
body = Elastic("coating", 15e9, 0.388)
chain = Chain(3, Body(body, 0.44e-3, 2.43e-3), body, body, math.inf, 0.47e-3, 0.44)
print(repr(float(simulate(chain, [0], 1e-4, 1e-6).force.max())))
print(len(compiled.made), "numba" in sys.modules)
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the physics that may be edited."""
    root = tmp_path_factory.mktemp("source")
    (root / "sonicvacuum").mkdir()
    for name in ("__init__.py", "stages.py"):
        shutil.copy(PACKAGE / name, root / "sonicvacuum")
    unwanted = shutil.ignore_patterns("__pycache__")
    for part in ("physics", "laboratory"):
        shutil.copytree(PACKAGE / part, root / "sonicvacuum" / part, ignore=unwanted)
    return root


def start(copy, cache, more=""):
    environment = os.environ | {"PYTHONPATH": str(copy), "SONICVACUUM_CACHE_DIR": str(cache)}
    # A folder of its own, so that the package found is the copy and not the one beside the tests.
    return subprocess.Popen(
        [sys.executable, "-c", SCRIPT + more], cwd=copy, env=environment, stdout=subprocess.PIPE, text=True
    )


# What is loaded takes no compiler; in the same process it still compiles.
AND_ANOTHER = """
import numpy as np
from sonicvacuum.physics import resample
rows = np.arange(20.0).reshape(1, 1, 20)
weights = np.array([[0.0, 0.0, 0.5, 0.5, 0.0, 0.0]])
place, gain = np.zeros(1, dtype=int), np.ones((1, 1))
assert resample.resampled(rows, place, place + 5, weights, gain, 1, 3).tolist() == [[[5.5, 6.5, 7.5]]]
assert [name.split()[0] for name in compiled.made] == ["resampled"]
"""


def finish(process):
    output, _ = process.communicate(timeout=120)
    assert process.returncode == 0
    force, counts = output.splitlines()
    return float(force), counts


@pytest.fixture(scope="module")
def crowd(copy, tmp_path_factory):
    """Eight processes that need the same code at once, with an empty cache."""
    cache = tmp_path_factory.mktemp("cache")
    return cache, [finish(p) for p in [start(copy, cache) for _ in range(8)]]


def test_of_many_processes_one_compiles_and_the_others_load(crowd):
    cache, results = crowd
    assert len({force for force, _ in results}) == 1
    assert sorted(counts for _, counts in results) == ["0 False"] * 7 + ["2 True"]
    assert len(list(cache.glob("*/*.bin"))) == 2


def test_after_loading_one_function_another_still_compiles(crowd, copy, tmp_path):
    cache, results = crowd
    own = shutil.copytree(cache, tmp_path / "cache")
    assert finish(start(copy, own, AND_ANOTHER)) == (results[0][0], "0 False")
    assert len(list(own.glob("*/*.bin"))) == 3


def test_an_edited_callee_takes_effect_at_once_and_back(crowd, copy):
    cache, results = crowd
    laws = copy / "sonicvacuum" / "physics" / "laws.py"
    text = laws.read_text()
    edited = text.replace("return stiffness * power_3_2(delta)", "return 2.0 * stiffness * power_3_2(delta)")
    assert edited != text
    laws.write_text(edited)
    force, counts = finish(start(copy, cache))
    assert counts == "2 True"
    # F scales as K^{2/5}; the step still is that of K.
    assert force == pytest.approx(2**0.4 * results[0][0], rel=1e-3)
    laws.write_text(text)
    assert finish(start(copy, cache)) == (results[0][0], "0 False")


def test_a_damaged_file_is_replaced(crowd, copy):
    cache, results = crowd
    paths = [p for p in cache.glob("*/*.bin") if p.parent == max(cache.iterdir(), key=os.path.getmtime)]
    whole = {path: path.read_bytes() for path in paths}
    frame, stepper = sorted(whole, key=lambda path: len(whole[path]), reverse=True)
    # Cut off; a bit turned. Laws are put into a frame that is there without Numba.
    for content in (whole[stepper][:1000], whole[stepper][:-1] + b"?"):
        stepper.write_bytes(content)
        assert finish(start(copy, cache)) == (results[0][0], "1 False")
        assert finish(start(copy, cache)) == (results[0][0], "0 False")
    frame.write_bytes(b"")
    stepper.unlink()
    assert finish(start(copy, cache)) == (results[0][0], "2 True")


def test_code_for_a_plain_processor_is_made_apart(crowd, copy, monkeypatch):
    cache, results = crowd
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    monkeypatch.setenv("NUMBA_CPU_FEATURES", "")
    force, counts = finish(start(copy, cache))
    assert counts == "2 True"
    # Square roots of lanes are good to 6e-13 where the processor estimates them, else exact.
    assert force == pytest.approx(results[0][0], rel=1e-11)


def test_without_a_writable_folder_code_is_compiled_afresh(crowd, copy, tmp_path):
    (tmp_path / "file").write_text("no folder can be made here")
    assert finish(start(copy, tmp_path / "file" / "cache")) == (crowd[1][0][0], "2 True")


@pytest.mark.parametrize("fault", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt()])
def test_nothing_is_left_of_a_file_that_could_not_be_written(monkeypatch, tmp_path, fault):
    def full(*_):
        raise fault

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(type(fault)):
        compiled.write(tmp_path / "code.bin", b"code")
    assert list(tmp_path.iterdir()) == []


def test_what_another_user_could_have_written_is_not_loaded(monkeypatch, tmp_path):
    path = tmp_path / "code.bin"
    path.write_bytes(b"mine")
    path.chmod(0o600)
    assert compiled.own(path) == b"mine"
    path.chmod(0o620)
    with pytest.raises(PermissionError):
        compiled.own(path)
    path.chmod(0o600)
    owner = path.stat().st_uid
    monkeypatch.setattr(os, "getuid", lambda: owner + 1)
    with pytest.raises(PermissionError):
        compiled.own(path)


def test_folders_long_unused_are_removed(monkeypatch, tmp_path):
    for k in range(12):
        folder = tmp_path / f"compiled-{k}"
        folder.mkdir()
        os.utime(folder, (k, k))
    (tmp_path / "other").mkdir()
    monkeypatch.setenv("SONICVACUUM_CACHE_DIR", str(tmp_path))
    folder = compiled.cache_folder.__wrapped__()
    left = {p.name for p in tmp_path.iterdir()}
    assert left == {"other", folder.name, *(f"compiled-{k}" for k in range(5, 12))}


FACTOR = 1.0


def _helper(delta):
    return FACTOR * delta


def _law(delta, stiffness):
    return stiffness * _helper(delta)


def test_fingerprint_sees_code_constants_closures_and_what_is_called(monkeypatch):
    def scaled(factor):
        return lambda delta, stiffness: factor * stiffness * delta

    distinct = [
        hertz_force,
        scaled(1.0),
        scaled(2.0),
        lambda delta, stiffness: stiffness * delta + 1.0,
        lambda delta, stiffness: stiffness * delta + 2.0,
        lambda delta, stiffness: np.sqrt(delta) * stiffness,
        lambda delta, stiffness: np.cbrt(delta) * stiffness,
        _law,
    ]
    found = [fingerprint(f) for f in distinct]
    assert len(set(found)) == len(found)
    assert fingerprint(scaled(1.0)) == found[1]
    monkeypatch.setattr(sys.modules[__name__], "FACTOR", 3.0)
    assert fingerprint.__wrapped__(_law) != found[-1]


def test_fingerprint_sees_arrays_and_what_stands_in_other_modules(monkeypatch):
    """A middle number of a long array, which `repr` leaves out, and a constant of an imported module."""
    here = sys.modules[__name__]
    monkeypatch.setattr(here, "FACTOR", np.ones(2000))
    before = fingerprint.__wrapped__(_law)
    here.FACTOR[1000] = 0.5
    assert fingerprint.__wrapped__(_law) != before

    def law(delta, stiffness):
        return compiled.SHARES.factor * stiffness * delta

    monkeypatch.setattr(compiled, "SHARES", sys, raising=False)
    monkeypatch.setattr(sys, "factor", 1.0, raising=False)
    before = fingerprint.__wrapped__(law)
    monkeypatch.setattr(sys, "factor", 2.0)
    assert fingerprint.__wrapped__(law) != before


def test_fingerprint_does_not_see_where_objects_lie_in_memory():
    """As `numpy.where` does: else its users would be compiled afresh by every process."""

    def using(thing):
        return lambda delta, stiffness: thing

    one, other = object(), object()
    assert repr(one) != repr(other)
    assert fingerprint(using(one)) == fingerprint(using(other))


def test_law_sets_are_told_apart_by_their_formulas_not_their_names():
    one, two = (Term("x", "elastic", f, 1) for f in (lambda d, k: k * d, lambda d, k: k * d * d))
    assert LawSet((one,)) != LawSet((two,))
    assert LawSet((one,)).name != LawSet((two,)).name
    assert LawSet() == LawSet((HERTZ,))
    assert LawSet().name != LawSet(preloaded=True).name != LawSet(symplectic=False).name


def test_of_several_threads_one_prepares_a_kernel(monkeypatch):
    made = []

    def slowly(kinds):
        time.sleep(0.05)  # the others come meanwhile
        made.append(kinds)
        return lambda *given: None

    monkeypatch.setattr(kernels, "_ready", {})
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda k: kernels._made_ready("one kernel", (1.0, np.zeros((2, 3))), slowly), range(8)))
    assert made == [("d", "d2")]


@pytest.mark.parametrize("array", [np.zeros(3, dtype=np.float32), np.zeros((4, 4))[:, ::2]])
def test_compiled_code_gets_no_other_array_than_it_was_made_for(array):
    with pytest.raises(TypeError, match="none for compiled code"):
        kinds_of((array,))


# A law that takes what only Numba has, an exception, and is asked for twice in processes of its own.
RAISING = """
import math, sys
from sonicvacuum.physics import compiled
from sonicvacuum.physics.chain import Body, Chain, Elastic
from sonicvacuum.physics.kernels import Compiled
import numpy as np
def halves(x, out):
    a, b = x
    out[0] = a - b
found = np.empty(1)
Compiled(lambda: (halves, {"_nrt": False}), "halves")(np.array([3.0, 1.0]), found)
print(found[0], len(compiled.made))
"""


def test_code_that_may_raise_an_exception_is_loaded_with_what_raises_it(tmp_path):
    environment = os.environ | {"SONICVACUUM_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", RAISING]
    said = [subprocess.run(command, env=environment, capture_output=True, text=True) for _ in range(2)]
    assert [one.stdout for one in said] == ["2.0 1\n", "2.0 0\n"]
