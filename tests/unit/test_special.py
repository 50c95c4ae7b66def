"""Special functions are scipy's own, whether `scipy.special` is loaded or not."""

import subprocess
import sys

import numpy as np
import scipy

from sonicvacuum import special

ALONE = """
import sys, threading
{before}
from sonicvacuum.special import functions
own = functions()
print("scipy.special" in sys.modules)
import scipy.special
print(all(getattr(own, name) is getattr(scipy.special, name) for name in ("chdtrc", "chdtri", "pdtrc")))
print(scipy.special.logsumexp([0.0, 0.0]) > 0.69, own.ndtr(0.0), scipy.special.ndtr(0.0))
"""


def ran(before=""):
    code = ALONE.format(before=before)
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_they_are_loaded_by_themselves_and_scipy_works_afterwards():
    assert ran().split() == ["False", "True", "True", "0.5", "0.5"]


def test_the_whole_package_is_loaded_where_another_thread_could_see_half_of_it():
    waiting = "wait = threading.Event(); threading.Thread(target=wait.wait, daemon=True).start()"
    assert ran(waiting).split()[0] == "True"


def test_the_whole_package_is_loaded_where_its_parts_are_built_otherwise(monkeypatch):
    def missing(name):
        assert sys.modules["scipy.special"] is not scipy.special  # the stand-in
        raise ImportError(name)

    scipy.special.ndtr  # an attribute of scipy from now on  # noqa: B018
    monkeypatch.delitem(sys.modules, "scipy.special")
    monkeypatch.setattr(special.importlib, "import_module", missing)
    special.functions.cache_clear()
    assert special.functions() is scipy.special
    assert np.isclose(special.functions().ndtri(0.975), 1.959963984540054)  # as tables have it
    special.functions.cache_clear()
