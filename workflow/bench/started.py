"""One verb, run in this process; what it spent until it could begin is written beside it.

`python -P workflow/bench/started.py OUT VERB …` runs `sonicvacuum VERB …` and writes to OUT, as JSON in
processor seconds: `begun`, all until the first file is read that the command line names or that lies in a
folder it names, which is when a verb has checked its arguments and turns to its work (of a verb that is given
no file, the first table of data; of one that reads nothing, all that it loads);
`load`, the interpreter's start and all import statements together, wherever they stand; `kernels`, reading
compiled kernels from the cache.
"""

import atexit
import builtins
import importlib
import json
import os
import site
import sys
import sysconfig
import time
from pathlib import Path

SPENT = {"begun": None, "load": time.process_time(), "kernels": 0.0}
WITHIN: list[str] = []
# What lies there is code and its own data: of Python, of packages, of caches in the home folder.
FOREIGN = tuple(
    str(Path(p).resolve()) + os.sep
    for p in (
        *sysconfig.get_paths().values(),
        *site.getsitepackages(),
        Path.home() / ".cache",
        "/proc",
        "/sys",
        "/etc",
    )
)
CODE = (".py", ".pyc", ".pyi", ".so", ".pth", ".j2")


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
    """Count what compiled functions take to be compiled or read, as soon as what does so is there."""
    kernels = sys.modules.get("sonicvacuum.physics.kernels")
    if kernels and hasattr(kernels, "_made_ready") and kernels._made_ready.__name__ != "call":
        kernels._made_ready = counting(kernels._made_ready, "kernels")
    numba = sys.modules.get("numba.core.dispatcher")
    if numba and hasattr(numba, "Dispatcher") and numba.Dispatcher.compile.__name__ != "call":
        numba.Dispatcher.compile = counting(numba.Dispatcher.compile, "kernels")


def watch_inputs(words: list[str]) -> None:
    """Note when the first input of a command line is read."""
    before = ["", *words]
    given = [Path(w).resolve() for k, w in enumerate(words) if before[k] != "--out" and Path(w).exists()]
    # What verbs of the reproduction read without being told to.
    given += [Path("config.yaml").resolve()] if given else []

    def opened(event, arguments):
        if (
            event != "open"
            or SPENT["begun"] is not None
            or not isinstance(arguments[0], str | bytes | os.PathLike)
        ):
            return
        mode, flags = arguments[1] or "r", arguments[2] or 0
        if set(mode) & set("wax+") or flags & (os.O_WRONLY | os.O_RDWR):
            return
        path = Path(os.fsdecode(arguments[0])).resolve()
        ours = path.suffix not in CODE and not str(path).startswith(FOREIGN)
        if any(path == one or one in path.parents for one in given) if given else ours:
            SPENT["begun"] = time.process_time()

    sys.addaudithook(opened)


def told(out: Path) -> None:
    """Write what was measured."""
    if SPENT["begun"] is None:
        SPENT["begun"] = SPENT["load"]
    out.write_text(json.dumps(SPENT), encoding="utf-8")


if __name__ == "__main__":
    target = Path(sys.argv[1]).resolve()
    sys.argv = ["sonicvacuum", *sys.argv[2:]]
    watch_inputs(sys.argv[2:])
    atexit.register(told, target)
    builtins.__import__ = counting(builtins.__import__, "load")
    importlib.import_module = counting(importlib.import_module, "load")
    from sonicvacuum.cli import main

    main()
