"""Compiled code is never stale, survives the process, and many processes may make it at once."""

import os
import shutil
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numba
import numpy as np
import pytest
from filelock import FileLock

import sonicvacuum
from sonicvacuum.physics import compiled
from sonicvacuum.physics.fingerprint import fingerprint
from sonicvacuum.physics.laws import HERTZ, LawSet, Term, hertz_force

PACKAGE = Path(sonicvacuum.__file__).parent
# Prints the largest force and how often code was compiled and loaded.
SCRIPT = """
import math
from sonicvacuum.physics import compiled
from sonicvacuum.physics.chain import Body, Chain, Elastic
from sonicvacuum.physics.run import advance, simulate
body = Elastic("coating", 15e9, 0.388)
chain = Chain(3, Body(body, 0.44e-3, 2.43e-3), body, body, math.inf, 0.47e-3, 0.44)
print(repr(float(simulate(chain, [0], 1e-4, 1e-6).force.max())))
print(sum(advance.stats.cache_misses.values()), sum(advance.stats.cache_hits.values()))
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


# What is loaded leaves Numba as it is; in the same process it still compiles.
AND_ANOTHER = """
import numpy as np
from sonicvacuum.physics import resample
rows = np.arange(20.0).reshape(1, 1, 20)
weights = np.array([[0.0, 0.0, 0.5, 0.5, 0.0, 0.0]])
place, gain = np.zeros(1, dtype=int), np.ones((1, 1))
assert resample.resampled(rows, place, place + 5, weights, gain, 1, 3).tolist() == [[[5.5, 6.5, 7.5]]]
assert sum(resample._compiled.stats.cache_misses.values()) == 1
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
    assert sorted(counts for _, counts in results) == ["0 1"] * 7 + ["1 0"]
    assert len(list(cache.glob("*/*.bin"))) == 1


def test_after_loading_one_function_another_still_compiles(crowd, copy, tmp_path):
    cache, results = crowd
    own = shutil.copytree(cache, tmp_path / "cache")
    assert finish(start(copy, own, AND_ANOTHER)) == (results[0][0], "0 1")
    assert len(list(own.glob("*/*.bin"))) == 2


def test_an_edited_callee_takes_effect_at_once_and_back(crowd, copy):
    cache, results = crowd
    laws = copy / "sonicvacuum" / "physics" / "laws.py"
    text = laws.read_text()
    edited = text.replace("return stiffness * power_3_2(delta)", "return 2.0 * stiffness * power_3_2(delta)")
    assert edited != text
    laws.write_text(edited)
    force, counts = finish(start(copy, cache))
    assert counts == "1 0"
    # F scales as K^{2/5}; the step still is that of K.
    assert force == pytest.approx(2**0.4 * results[0][0], rel=1e-3)
    laws.write_text(text)
    assert finish(start(copy, cache)) == (results[0][0], "0 1")


def test_a_damaged_file_is_replaced(crowd, copy):
    cache, results = crowd
    (path,) = [p for p in cache.glob("*/*.bin") if p.parent == max(cache.iterdir(), key=os.path.getmtime)]
    path.write_bytes(path.read_bytes()[:1000])
    assert finish(start(copy, cache)) == (results[0][0], "1 0")
    assert path.stat().st_size > 1000


def test_without_a_writable_folder_code_is_compiled_afresh(crowd, copy, tmp_path):
    (tmp_path / "file").write_text("no folder can be made here")
    assert finish(start(copy, tmp_path / "file" / "cache")) == (crowd[1][0][0], "1 0")


def test_what_another_user_could_have_written_is_not_loaded(monkeypatch, tmp_path):
    path = tmp_path / "code.bin"
    path.write_bytes(b"mine")
    path.chmod(0o600)
    assert compiled._own(path) == b"mine"
    path.chmod(0o620)
    with pytest.raises(PermissionError):
        compiled._own(path)
    path.chmod(0o600)
    owner = path.stat().st_uid
    monkeypatch.setattr(os, "getuid", lambda: owner + 1)
    with pytest.raises(PermissionError):
        compiled._own(path)


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


def twice(x):
    return x + x


def test_while_another_process_compiles_what_is_asked_for_soon_is_compiled(monkeypatch, tmp_path):
    """The other, which this test stands for, lets go of the lock once that has happened."""
    monkeypatch.setattr(compiled, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(compiled, "_prepared", set())
    dispatcher = compiled.cached(numba.njit(twice))
    asked, soon = (
        dispatcher._cache.path((numba.typeof(x),), dispatcher.targetctx) for x in (1.0, np.int64(1))
    )
    lock = FileLock(asked.with_suffix(".lock"), thread_local=False)
    lock.acquire()
    seen = []

    def other():
        while not soon.exists() and threading.main_thread().is_alive():
            time.sleep(0.01)
        seen.append(asked.exists())
        lock.release()

    thread = threading.Thread(target=other)
    thread.start()
    compiled.prepare(dispatcher, "float", (1.0,), {"float": 1.0, "whole": np.int64(1)})
    thread.join()
    assert seen == [False]
    assert asked.exists()
    assert dispatcher(2.5) == 5.0


def test_of_several_threads_one_prepares_a_kernel(monkeypatch):
    made = []

    def slowly(dispatcher, signature, left):
        time.sleep(0.05)  # the others come meanwhile
        made.append(signature)

    monkeypatch.setattr(compiled, "_load_or_compile", slowly)
    monkeypatch.setattr(compiled, "_prepared", set())
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda k: compiled.prepare(None, "one kernel", (1.0,)), range(8)))
    assert len(made) == 1
