"""One verb, run in this process; what it spent until it could begin is written beside it.

`python -P workflow/bench/started.py OUT VERB …` runs `sonicvacuum VERB …` and writes to OUT, as JSON in
processor seconds: `load`, the interpreter's start and all import statements together, wherever they stand;
`kernels`, reading compiled kernels from the cache, for which Numba first fills its tables of types.
"""

import atexit
import builtins
import importlib
import json
import sys
import time
from pathlib import Path

SPENT = {"load": time.process_time(), "kernels": 0.0}
WITHIN: list[str] = []


def counting(function, name):
    """The function; what its calls take is counted, but for those made within another counted call."""

    def call(*args, **options):
        if WITHIN:
            return function(*args, **options)
        WITHIN.append(name)
        start = time.process_time()
        try:
            return function(*args, **options)
        finally:
            WITHIN.pop()
            SPENT[name] += time.process_time() - start
            watch_kernels()

    return call


def watch_kernels():
    """Count what Numba's functions take to be compiled or read, as soon as Numba is there."""
    numba = sys.modules.get("numba.core.dispatcher")
    if numba and hasattr(numba, "Dispatcher") and numba.Dispatcher.compile.__name__ != "call":
        numba.Dispatcher.compile = counting(numba.Dispatcher.compile, "kernels")


if __name__ == "__main__":
    out = Path(sys.argv[1]).resolve()
    sys.argv = ["sonicvacuum", *sys.argv[2:]]
    atexit.register(lambda: out.write_text(json.dumps(SPENT), encoding="utf-8"))
    builtins.__import__ = counting(builtins.__import__, "load")
    importlib.import_module = counting(importlib.import_module, "load")
    from sonicvacuum.cli import main

    main()
