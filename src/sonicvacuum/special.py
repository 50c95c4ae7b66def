"""The compiled special functions of scipy, loaded by themselves.

`scipy.special` wraps them for arrays of other libraries than numpy and loads parts of numpy for that which
nothing else here asks for: a tenth of a second, of the 0.7 that an empty record takes to be searched.
"""

import importlib
import sys
import threading
from functools import cache
from pathlib import Path
from types import ModuleType

import scipy

WHOLE = "scipy.special"


@cache
def functions() -> ModuleType:
    """The module of `chdtrc`, `ndtr` and their like; `scipy.special` where that is loaded already, where
    other threads could see it half loaded, or where this release of scipy is built otherwise.
    """
    if WHOLE in sys.modules or threading.active_count() > 1:
        return scipy.special
    package = ModuleType(WHOLE)
    package.__path__ = [str(Path(folder) / "special") for folder in scipy.__path__]
    sys.modules[WHOLE] = package
    try:
        return importlib.import_module(f"{WHOLE}._ufuncs")
    except ImportError:
        pass
    finally:
        del sys.modules[WHOLE]
    return scipy.special
